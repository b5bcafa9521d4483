//! A row's expanded motion, and the outputs that follow from it through the loop closure.

use super::ensemble::Closure;
use crate::numerics::{ParameterBox, SparseBasis, SparseWork};

/// Polynomials of the 2n lines of a motion in one row over a box.
#[derive(Clone, Copy)]
pub(super) struct Expansion<'r> {
    pub basis: &'r SparseBasis,
    pub domain: &'r ParameterBox,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
    /// Of each of the 2n lines; what follows them is not looked at.
    pub coefficients: &'r [f64],
    /// Least and largest of each of the 2n lines over the samples.
    pub extent: &'r [(f64, f64)],
}

impl Expansion<'_> {
    /// Every output at some ξ with some lines shifted, output by output, shift by shift, point by point.
    pub fn evaluate_shifted<P: AsRef<[f64]>>(&self, points: &[P], shifts: &[Vec<(usize, f64)>]) -> Vec<f64> {
        let lines = if self.closure.needs_velocities() { self.extent.len() } else { self.extent.len() / 2 };
        let mut expanded = vec![0.0; lines * points.len()];
        self.expand(points, &mut expanded);
        let count = shifts.len() * points.len();
        let mut motion = vec![0.0; self.extent.len() * count];
        for (line, values) in expanded.chunks_exact(points.len().max(1)).enumerate() {
            for (place, shift) in shifts.iter().enumerate() {
                let by: f64 = shift.iter().filter(|shift| shift.0 == line).map(|shift| shift.1).sum();
                let into = &mut motion[line * count + place * points.len()..][..points.len()];
                into.iter_mut().zip(values).for_each(|(into, value)| *into = value + by);
            }
        }
        // Dependent coordinates are only a guess, and are kept within what the samples have.
        let n = self.extent.len() / 2;
        for (line, (values, &(low, high))) in motion.chunks_exact_mut(count.max(1)).zip(self.extent).enumerate() {
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                values.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
        }
        let all: Vec<&[f64]> = shifts.iter().flat_map(|_| points.iter().map(AsRef::as_ref)).collect();
        self.close(&all, motion)
    }

    /// The first of the polynomials' values, as many lines of points as there is room for.
    pub fn expand<P: AsRef<[f64]>>(&self, points: &[P], motion: &mut [f64]) {
        let lines = motion.len() / points.len().max(1);
        let coefficients = &self.coefficients[..lines * self.basis.len()];
        self.basis.values(points, coefficients, motion, &mut SparseWork::default());
    }

    /// Every output as it follows from the motion at some ξ: 2n lines of points.
    pub fn close<P: AsRef<[f64]>>(&self, points: &[P], motion: Vec<f64>) -> Vec<f64> {
        let at = |parameter: usize, point: &P| self.domain.value(parameter, point.as_ref()[parameter]);
        let parameters = (0..self.domain.dimension())
            .flat_map(|parameter| points.iter().map(move |point| at(parameter, point)))
            .collect();
        self.closure.outputs(self.time, points.len(), parameters, motion)
    }
}
