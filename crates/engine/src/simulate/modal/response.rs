//! Response to a harmonic load of size one: (K + iω C − ω² M) x = f on the motions that the constraints allow, for a
//! load along an output u: f = ∂u/∂q. A state y is iω times its coordinate, so that its row is iω y = ∂f/∂q x + iω
//! ∂f/∂v x + ∂f/∂y y for its rate f.

use nalgebra::{DMatrix, DVector};

use crate::numerics::{RowSpace, combined, dot};
use crate::simulate::statics::{Linearised, reduced, times};

/// Real and imaginary parts of forces, or of coordinates, n each.
#[derive(Clone, Debug)]
pub struct Load {
    /// Part in phase.
    pub re: Vec<f64>,
    /// A quarter of a period ahead.
    pub im: Vec<f64>,
}

impl Load {
    /// No load.
    pub fn nothing(n: usize) -> Self {
        Self { re: vec![0.0; n], im: vec![0.0; n] }
    }
}

/// The equations about a configuration, ready for loads.
pub struct Response<'l> {
    linear: &'l Linearised,
    space: RowSpace,
    /// M, C and K there.
    small: [DMatrix<f64>; 3],
}

impl<'l> Response<'l> {
    /// Response about a configuration.
    pub fn new(linear: &'l Linearised) -> Self {
        let space = RowSpace::of(&linear.jacobian, linear.motion.len());
        let small = [&linear.mass, &linear.damping, &linear.stiffness].map(|matrix| reduced(matrix, &space.null));
        Self { linear, space, small }
    }

    /// Real and imaginary part of an output, whose derivatives by q, v, w and λ are given, under the load `force` at ω,
    /// rad/s. NaN at the frequency of a mode without damping.
    pub fn of(&self, force: &[f64], output: [&[f64]; 4], omega: f64) -> [f64; 2] {
        let load = Load { re: force.to_vec(), im: vec![0.0; force.len()] };
        self.to(&load, omega).map_or([f64::NAN; 2], |motion| self.output(&motion, &load, output, omega))
    }

    /// The motion under a load at ω, rad/s; `None` at the frequency of a mode without damping.
    pub fn to(&self, load: &Load, omega: f64) -> Option<Load> {
        let (k, n) = (self.space.null.len(), load.re.len());
        let [mass, damping, stiffness] = &self.small;
        let mut matrix = DMatrix::zeros(2 * k, 2 * k);
        for (row, column) in (0..k).flat_map(|row| (0..k).map(move |column| (row, column))) {
            let real = stiffness[(row, column)] - omega * omega * mass[(row, column)];
            let imaginary = omega * damping[(row, column)];
            matrix[(row, column)] = real;
            matrix[(k + row, k + column)] = real;
            matrix[(row, k + column)] = -imaginary;
            matrix[(k + row, column)] = imaginary;
        }
        let mut right = DVector::zeros(2 * k);
        for (index, vector) in self.space.null.iter().enumerate() {
            right[index] = dot(vector, &load.re);
            right[k + index] = dot(vector, &load.im);
        }
        if k > 0 && !matrix.lu().solve_mut(&mut right) {
            return None;
        }
        let parts = right.as_slice();
        let [re, im] = [&parts[..k], &parts[k..]].map(|part| combined(&self.space.null, part, n));
        Some(Load { re, im })
    }

    /// Real and imaginary part of an output in the motion under a load at ω, rad/s.
    pub fn output(&self, motion: &Load, load: &Load, output: [&[f64]; 4], omega: f64) -> [f64; 2] {
        let (n, Load { re, im }) = (load.re.len(), motion);
        let [by_q, by_v, by_w, by_lambda] = output;
        let by_position = |x: &[f64]| dot(by_q, x) - omega * omega * dot(by_w, x);
        let by_speed = |x: &[f64]| omega * dot(by_v, x);
        let mut found = [by_position(re) - by_speed(im), by_position(im) + by_speed(re)];
        if by_lambda.iter().any(|&value| value != 0.0) {
            // Constraints hold the part of the load that causes no motion.
            let dynamic = |x: &[f64]| {
                let (held, inertial) = (times(&self.linear.stiffness, x), times(&self.linear.mass, x));
                held.iter().zip(&inertial).map(|(a, b)| a - omega * omega * b).collect::<Vec<f64>>()
            };
            let damped =
                |x: &[f64]| times(&self.linear.damping, x).iter().map(|part| omega * part).collect::<Vec<f64>>();
            let (of_re, of_im, damped_re, damped_im) = (dynamic(re), dynamic(im), damped(re), damped(im));
            let rest_re: Vec<f64> = (0..n).map(|i| load.re[i] - of_re[i] + damped_im[i]).collect();
            let rest_im: Vec<f64> = (0..n).map(|i| load.im[i] - of_im[i] - damped_re[i]).collect();
            let rows = self.linear.jacobian.len();
            for (part, rest) in found.iter_mut().zip([rest_re, rest_im]) {
                *part += dot(by_lambda, &self.space.multipliers(&rest, rows));
            }
        }
        found
    }
}
