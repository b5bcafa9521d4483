//! Fast vibrations of states, as of a filter that rings, which the start excites and the steps damp: those of the
//! states alone, about the nominal start, with constant positions and velocities.
//!
//! ṡ = A s + …: a pair λ of A with the vectors z and x (zᵀ A = λ zᵀ, A x = λ x) has of ṡ the part zᵀ ṡ/(λ zᵀ x), and as
//! much again is its conjugate.

use nalgebra::{Complex, DMatrix};

use super::modal::eigenvalues;
use super::statics;

/// A vibration of states.
pub struct StateMode {
    /// λ, 1/s, with a positive imaginary part.
    pub value: Complex<f64>,
    /// x, by state.
    pub shape: Vec<Complex<f64>>,
    /// Its amplitude due to the start.
    pub amplitude: f64,
}

/// The vibrations of states whose equations have these matrices before rates and values, with these rates at the start.
pub fn of_states(mass: DMatrix<f64>, damping: DMatrix<f64>, rates: &[f64]) -> Vec<StateMode> {
    let n = rates.len();
    let linear = statics::Linearised {
        motion: vec![0.0; n],
        constraint: Vec::new(),
        mass,
        damping,
        stiffness: DMatrix::zeros(n, n),
        jacobian: Vec::new(),
    };
    let all: Vec<usize> = (0..n).collect();
    let found = eigenvalues(&linear, &all).unwrap_or_default().into_iter();
    let of_pair = |pair: super::modal::Eigenvalue| {
        // Positions of states are nothing.
        let [shape, left] = [&pair.right, &pair.left].map(|vector| vector[n..].to_vec());
        let times = |other: &mut dyn Iterator<Item = Complex<f64>>| -> Complex<f64> {
            left.iter().zip(other).map(|(left, other)| left * other).sum()
        };
        let rate = times(&mut rates.iter().map(|&rate| Complex::new(rate, 0.0)));
        let own = times(&mut shape.iter().copied()) * pair.value;
        let size = |value: Complex<f64>| (value.re * value.re + value.im * value.im).sqrt();
        StateMode { value: pair.value, amplitude: 2.0 * size(rate) / size(own), shape }
    };
    found.filter(|pair| pair.is_pair()).map(of_pair).filter(|mode| mode.amplitude.is_finite()).collect()
}
