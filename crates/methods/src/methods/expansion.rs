//! A row's expanded motion, and the outputs that follow from it through the loop closure.

use super::closure::Closure;
use super::tuning::TUNING;
use crate::numerics::{ParameterBox, Phase, Points, SparseBasis, SparseWork};

/// Moves of motions, which show their effects on outputs.
#[derive(Clone, Debug, Default)]
pub(super) struct Moves {
    /// Lines, each by how much.
    pub by: Vec<(usize, f64)>,
    /// Coordinates, each along its velocity for so much time, s.
    pub ahead: Vec<(usize, f64)>,
}

impl Moves {
    /// The sum of moves, each times its weight.
    pub fn sum<'m>(moves: impl Iterator<Item = (&'m Self, f64)>) -> Self {
        let mut sum = Self::default();
        for (moves, weight) in moves.filter(|(_, weight)| *weight != 0.0) {
            let scaled = |&(line, amount): &(usize, f64)| (line, weight * amount);
            sum.by.extend(moves.by.iter().map(scaled));
            sum.ahead.extend(moves.ahead.iter().map(scaled));
        }
        sum
    }
}

/// Polynomials of the 2n lines of a motion in one row over a box.
#[derive(Clone, Copy)]
pub(super) struct Expansion<'r> {
    pub basis: &'r SparseBasis,
    pub domain: &'r ParameterBox,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
    /// Coefficients of each of the 2n lines; further ones are ignored.
    pub coefficients: &'r [f64],
    /// Least and largest of each of the 2n lines over the samples.
    pub extent: &'r [(f64, f64)],
    /// Coordinates that are expanded as the times at which their courses are there, and their velocities as rates of
    /// those.
    pub phases: &'r [(usize, Phase<'r>)],
}

impl Expansion<'_> {
    /// Every output at some ξ with the motion moved in some ways, output by output, way by way, point by point.
    pub fn evaluate_moved(&self, points: Points, ways: &[Moves]) -> Vec<f64> {
        let n = self.extent.len() / 2;
        let needs_velocities = self.closure.needs_velocities() || ways.iter().any(|moves| !moves.ahead.is_empty());
        let mut expanded = vec![0.0; if needs_velocities { 2 * n } else { n } * points.len()];
        self.expand(points, &mut expanded);
        let count = ways.len() * points.len();
        let mut motion = vec![0.0; self.extent.len() * count];
        for (line, values) in expanded.chunks_exact(points.len().max(1)).enumerate() {
            for (index, moves) in ways.iter().enumerate() {
                let by: f64 = moves.by.iter().filter(|moved| moved.0 == line).map(|moved| moved.1).sum();
                let into = &mut motion[line * count + index * points.len()..][..points.len()];
                into.iter_mut().zip(values).for_each(|(into, value)| *into = value + by);
                for &(_, time) in moves.ahead.iter().filter(|ahead| ahead.0 == line) {
                    let velocities = &expanded[(n + line) * points.len()..][..points.len()];
                    into.iter_mut().zip(velocities).for_each(|(into, velocity)| *into += time * velocity);
                }
            }
        }
        // Dependent coordinates are only a guess, and are limited to the range of the samples.
        for (line, (values, &(low, high))) in motion.chunks_exact_mut(count.max(1)).zip(self.extent).enumerate() {
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                values.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
        }
        self.close(points, ways.len(), motion)
    }

    /// The first lines of the motion, as far as `motion` has room for them.
    pub fn expand(&self, points: Points, motion: &mut [f64]) {
        let lines = motion.len() / points.len().max(1);
        let coefficients = &self.coefficients[..lines * self.basis.len()];
        self.basis.values(points, coefficients, motion, &mut SparseWork::default());
        let n = self.extent.len() / 2;
        for (coordinate, phase) in self.phases {
            for point in 0..points.len() {
                let (value, rate) = phase.at(motion[coordinate * points.len() + point]);
                motion[coordinate * points.len() + point] = value;
                if let Some(velocity) = motion.get_mut((n + coordinate) * points.len() + point) {
                    *velocity *= rate;
                }
            }
        }
    }

    /// Every output as it follows from `ways` motions at some ξ: 2n lines of points, way by way.
    pub fn close(&self, points: Points, ways: usize, motion: Vec<f64>) -> Vec<f64> {
        // Coordinates go on beyond the box, and so do parameters: with those of its end, outputs would have a kink.
        let values = self.domain.continued(points, TUNING.beyond_box);
        let parameters = match ways {
            1 => values,
            _ => values.chunks_exact(points.len().max(1)).flat_map(|line| line.repeat(ways)).collect(),
        };
        self.closure.outputs(self.time, ways * points.len(), parameters, motion)
    }
}
