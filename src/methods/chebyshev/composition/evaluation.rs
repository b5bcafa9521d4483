//! Outputs at points of the box: the coordinates' polynomials, closed.

use super::Row;
use super::errors::Moves;
use crate::numerics::{SparseWork, largest, surrogate_error, truncation};

impl Row<'_> {
    /// Values of the polynomials through outputs' own samples, output by output.
    pub(super) fn own_polynomials(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let coefficients: Vec<f64> =
            outputs.iter().flat_map(|&output| self.own_coefficients(output).to_vec()).collect();
        let mut values = vec![0.0; outputs.len() * points.len()];
        self.surrogate.basis().values(points, &coefficients, &mut values, &mut SparseWork::default());
        values
    }

    pub(super) fn own_coefficients(&self, output: usize) -> &[f64] {
        let count = self.surrogate.basis().len();
        &self.coefficients[(self.extent.len() + output) * count..][..count]
    }

    /// An output's values at the samples.
    pub(super) fn own_samples(&self, output: usize) -> &[f64] {
        let count = self.surrogate.samples().len();
        &self.at_samples[output * count..][..count]
    }

    /// The largest errors of the independent coordinates' polynomials, and of their velocities': those at validation samples, or what the
    /// polynomials lack.
    pub(super) fn coordinate_errors(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<(usize, f64)> {
        let expanded = self.expanded(points);
        let values = |line: usize| line * points.len()..(line + 1) * points.len();
        let basis = self.surrogate.basis();
        self.of_independent(|line| {
            let tail = truncation(basis, &self.coefficients[line * basis.len()..][..basis.len()]);
            largest([surrogate_error(&expanded[values(line)], &motion[values(line)]), tail])
        })
    }

    /// Lines of the independent coordinates and their velocities, pairwise, each with its error.
    pub(super) fn of_independent(&self, error: impl Fn(usize) -> f64) -> Vec<(usize, f64)> {
        let n = self.extent.len() / 2;
        let lines = self.closure.independent().iter().flat_map(|&i| [i, n + i]);
        lines.map(|line| (line, error(line))).collect()
    }

    /// Every output at some ξ as it follows from the motion there: 2n lines of points.
    pub fn evaluate_motion(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        let motion = motion[..self.extent.len() * points.len()].to_vec();
        self.close(points, motion)
    }

    /// Every output at some ξ, output by output.
    pub fn evaluate(&self, points: &[Vec<f64>]) -> Vec<f64> {
        self.evaluate_moved(points, &[Moves::default()])
    }

    /// Every output with the motion moved in some ways, output by output, way by way, point by point.
    pub(super) fn evaluate_moved(&self, points: &[Vec<f64>], ways: &[Moves]) -> Vec<f64> {
        let n = self.extent.len() / 2;
        let needs_velocities = self.closure.needs_velocities() || ways.iter().any(|moves| !moves.ahead.is_empty());
        let mut expanded = vec![0.0; if needs_velocities { 2 * n } else { n } * points.len()];
        self.expand(points, &mut expanded);
        let count = ways.len() * points.len();
        let mut motion = vec![0.0; self.extent.len() * count];
        for (line, values) in expanded.chunks_exact(points.len().max(1)).enumerate() {
            for (place, moves) in ways.iter().enumerate() {
                let by: f64 = moves.by.iter().filter(|moved| moved.0 == line).map(|moved| moved.1).sum();
                let into = &mut motion[line * count + place * points.len()..][..points.len()];
                into.iter_mut().zip(values).for_each(|(into, value)| *into = value + by);
                for &(_, time) in moves.ahead.iter().filter(|ahead| ahead.0 == line) {
                    let velocities = &expanded[(n + line) * points.len()..][..points.len()];
                    into.iter_mut().zip(velocities).for_each(|(into, velocity)| *into += time * velocity);
                }
            }
        }
        // Dependent coordinates are only a guess, and are kept within what the samples have.
        for (line, (values, &(low, high))) in motion.chunks_exact_mut(count.max(1)).zip(&self.extent).enumerate() {
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                values.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
        }
        let all: Vec<Vec<f64>> = ways.iter().flat_map(|_| points.iter().cloned()).collect();
        self.close(&all, motion)
    }

    /// The polynomials' values: 2n lines of points.
    pub(super) fn expanded(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let mut motion = vec![0.0; self.extent.len() * points.len()];
        self.expand(points, &mut motion);
        motion
    }

    /// The first of them, as many lines as there is room for.
    fn expand(&self, points: &[Vec<f64>], motion: &mut [f64]) {
        let lines = motion.len() / points.len().max(1);
        let coefficients = &self.coefficients[..lines * self.surrogate.basis().len()];
        self.surrogate.basis().values(points, coefficients, motion, &mut SparseWork::default());
    }

    fn close(&self, points: &[Vec<f64>], motion: Vec<f64>) -> Vec<f64> {
        let parameters = (0..self.domain.dimension())
            .flat_map(|parameter| points.iter().map(move |xi| self.domain.value(parameter, xi[parameter])))
            .collect();
        self.closure.outputs(self.time, points.len(), parameters, motion)
    }
}
