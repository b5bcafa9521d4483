//! Outputs at points of the box: the coordinates' polynomials, closed.

use rustc_hash::FxHashMap;

use super::Row;
use super::tuning::TUNING;
use crate::methods::chebyshev::polynomials::Polynomials;
use crate::methods::expansion::{Expansion, Moves};
use crate::methods::kept::KeptRow;
use crate::numerics::{Extent, PointSet, Range, largest, surrogate_error, to_brinks, truncation};

impl Row<'_> {
    /// Values of the polynomials through outputs' own samples, output by output.
    pub(super) fn own_polynomials(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let first = self.extent.len() * self.surrogate.basis().len();
        Polynomials { surrogate: self.surrogate, coefficients: &self.coefficients[first..] }.values(outputs, points)
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

    /// The range of an output over its samples, and where its ends are.
    pub(super) fn extent_of_samples(&self, output: usize) -> Extent {
        let values = self.own_samples(output);
        let best = |sign: f64| {
            let better = |a: usize, b: usize| if sign * values[b] > sign * values[a] { b } else { a };
            (1..values.len()).fold(0, better)
        };
        let ends = [best(-1.0), best(1.0)];
        let range = Range { lower: values[ends[0]], upper: values[ends[1]] };
        Extent::at(range, 0.0, ends.map(|sample| self.surrogate.samples()[sample].clone()))
    }

    /// The largest errors of the independent coordinates' polynomials, and of their velocities': those at validation
    /// samples, or of truncation; zero for velocities that are not expanded, since no output needs them.
    pub(super) fn coordinate_errors(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<(usize, f64)> {
        let expanded = self.expanded(points);
        let values = |line: usize| line * points.len()..(line + 1) * points.len();
        let basis = self.surrogate.basis();
        self.of_independent(|line| {
            if line >= self.extent.len() / 2 && !self.velocities {
                return 0.0;
            }
            let tail = truncation(basis, &self.coefficients[line * basis.len()..][..basis.len()]);
            let phase = self.phases.iter().find(|phase| phase.0 == line % (self.extent.len() / 2));
            let tail = phase.map_or(tail, |(_, phase)| phase.steepest() * tail);
            largest([surrogate_error(&expanded[values(line)], &motion[values(line)]), tail])
        })
    }

    /// Lines of the independent coordinates and their velocities, pairwise, each with its error.
    pub(super) fn of_independent(&self, error: impl Fn(usize) -> f64) -> Vec<(usize, f64)> {
        let n = self.extent.len() / 2;
        let lines = self.closure.independent().iter().flat_map(|&i| [i, n + i]);
        lines.map(|line| (line, error(line))).collect()
    }

    fn expansion(&self) -> Expansion<'_> {
        Expansion {
            basis: self.surrogate.basis(),
            domain: self.domain,
            closure: self.closure,
            time: self.time,
            coefficients: &self.coefficients,
            extent: &self.extent,
            phases: &self.phases,
        }
    }

    /// Every output at some ξ as it follows from the motion there, 2n lines of points. Behind it are the simulated
    /// outputs, which count where there are no coordinates.
    pub fn evaluate_motion(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        if self.extent.is_empty() {
            return motion[..self.ensemble.outputs() * points.len()].to_vec();
        }
        let motion = motion[..self.extent.len() * points.len()].to_vec();
        self.expansion().close(PointSet::of(points).points(), 1, motion)
    }

    /// Every output at some ξ, output by output.
    pub fn evaluate(&self, points: &[Vec<f64>]) -> Vec<f64> {
        self.evaluate_moved(points, &[Moves::default()])
    }

    /// The same; without coordinates, the values of the outputs' own polynomials.
    pub fn predict(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let every: Vec<usize> = (0..self.ensemble.outputs()).collect();
        self.predict_some(&every, points)
    }

    /// [`predict`](Self::predict) for some of the outputs.
    pub fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        if self.extent.is_empty() {
            return self.own_polynomials(outputs, points);
        }
        self.evaluate_some(outputs, points, &[Moves::default()])
    }

    /// Every output with the motion moved in some ways, output by output, way by way, point by point.
    pub(super) fn evaluate_moved(&self, points: &[Vec<f64>], ways: &[Moves]) -> Vec<f64> {
        self.expansion().evaluate_moved(PointSet::of(points).points(), ways)
    }

    /// Some outputs with the motion moved in some ways, output by output, way by way, point by point. All outputs
    /// follow together from a motion, a few points at a time: memory grows with the outputs asked for, not with all
    /// outputs times all points.
    pub fn evaluate_some(&self, outputs: &[usize], points: &[Vec<f64>], ways: &[Moves]) -> Vec<f64> {
        let together =
            (TUNING.values_at_once / (self.ensemble.outputs() * ways.len()).max(1)).max(TUNING.least_at_once);
        let (count, ways_count) = (points.len(), ways.len());
        let mut found = vec![0.0; outputs.len() * ways_count * count];
        for (part, some) in points.chunks(together).enumerate() {
            let values = self.evaluate_moved(some, ways);
            for (index, output) in outputs.iter().enumerate() {
                for way in 0..ways_count {
                    let into = &mut found[(index * ways_count + way) * count + part * together..][..some.len()];
                    into.copy_from_slice(&values[(output * ways_count + way) * some.len()..][..some.len()]);
                }
            }
        }
        found
    }

    /// Some outputs at the two ends of their own ranges, with the motion moved in some ways: output by output, way by
    /// way. Where the ends of several are the same, as at corners, the motion there is closed once.
    pub(super) fn at_own_ends(&self, outputs: &[usize], found: &[Extent], ways: &[Moves]) -> Vec<[f64; 2]> {
        let mut known: FxHashMap<Vec<u64>, usize> = FxHashMap::default();
        let mut points: Vec<Vec<f64>> = Vec::new();
        // Index and end of the extents at each point.
        let mut wanted: Vec<Vec<(usize, usize)>> = Vec::new();
        for (index, extent) in found.iter().enumerate() {
            for (end, at) in extent.places.iter().enumerate() {
                let number = *known.entry(at.iter().map(|xi| xi.to_bits()).collect()).or_insert_with(|| {
                    points.push(at.clone());
                    wanted.push(Vec::new());
                    points.len() - 1
                });
                wanted[number].push((index, end));
            }
        }
        let together =
            (TUNING.values_at_once / (self.ensemble.outputs() * ways.len()).max(1)).max(TUNING.least_at_once);
        let mut ends = vec![[0.0; 2]; outputs.len() * ways.len()];
        for (points, wanted) in points.chunks(together).zip(wanted.chunks(together)) {
            let values = self.evaluate_moved(points, ways);
            for (point, wanted) in wanted.iter().enumerate() {
                for &(index, end) in wanted {
                    for way in 0..ways.len() {
                        ends[index * ways.len() + way][end] =
                            values[(outputs[index] * ways.len() + way) * points.len() + point];
                    }
                }
            }
        }
        ends
    }

    /// Moves ends of the ranges of outputs that jump to the brinks, with the motion moved.
    pub(super) fn to_brinks(&self, outputs: &[usize], found: &mut [Extent], way: &Moves) {
        let jumping: Vec<usize> = (0..outputs.len()).filter(|&index| self.ensemble.jumps(outputs[index])).collect();
        if jumping.is_empty() {
            return;
        }
        let wanted: Vec<usize> = jumping.iter().map(|&index| outputs[index]).collect();
        let mut extents: Vec<Extent> = jumping.iter().map(|&index| found[index].clone()).collect();
        to_brinks(&mut extents, &|points: &[Vec<f64>]| self.evaluate_some(&wanted, points, std::slice::from_ref(way)));
        jumping.into_iter().zip(extents).for_each(|(index, extent)| found[index] = extent);
    }

    /// The polynomials' values: 2n lines of points.
    pub(super) fn expanded(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let mut motion = vec![0.0; self.extent.len() * points.len()];
        self.expansion().expand(PointSet::of(points).points(), &mut motion);
        motion
    }

    /// Parts of it that are stored after the run; `own`: whether each output is the polynomial through its own samples.
    pub fn kept(&self, own: Vec<bool>) -> KeptRow {
        KeptRow {
            time: self.time,
            independent: self.closure.independent().to_vec(),
            coefficients: self.coefficients.clone(),
            extent: self.extent.clone(),
            own,
        }
    }
}
