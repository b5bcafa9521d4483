//! A box with its sparse grid: the expected surpluses of its indices, and when it is to be split.

use std::borrow::Cow;

use rayon::prelude::*;
use rustc_hash::FxHashMap;
use symdiff::math;

use super::tuning::TUNING;
use crate::methods::kept::KeptRow;
use crate::methods::result::Estimate;
use crate::methods::validation::{HeldOut, ValidationTable};
use crate::numerics::{Course, ParameterBox, Range, SparseGrid, expected, step_validation};

/// Highest degree in a parameter for k of them; then a box is split.
pub(super) fn highest(k: usize) -> u8 {
    k.checked_sub(1).and_then(|index| TUNING.highest_degrees.get(index)).copied().unwrap_or(TUNING.highest_of_many)
}

/// A surplus for each index.
pub(super) type Surpluses = FxHashMap<Vec<u8>, f64>;

/// A box with its surrogate.
pub(super) struct SubBox<'r> {
    pub domain: ParameterBox,
    pub grid: SparseGrid,
    /// Values at the grid's nodes, in groups: the number of nodes, then values row by row, line by line, node by node.
    /// Lines are those of the motion, the outputs, and for each coordinate that turns the time at which its course is
    /// there (NaN if that is unknown).
    pub nodes: Vec<(usize, Vec<f64>)>,
    /// Number of these lines.
    pub lines: usize,
    /// Hierarchical surplus of each index of the grid: the error of the surrogate before the index was added.
    pub surplus: Surpluses,
    /// Courses of coordinates that turn, by coordinate; none, or one for each.
    pub courses: Vec<Option<Course>>,
    /// ξ of the validation samples,
    pub points: Cow<'r, [Vec<f64>]>,
    /// and their values.
    pub direct: Cow<'r, ValidationTable>,
    /// Number of points among them that are spread over a box.
    pub spread: usize,
    /// Whether some of them were chosen for the surrogate as it is.
    pub challenged: bool,
    /// Largest error at those over the one that is allowed.
    pub error: f64,
    /// Estimates of all rows, by row and output, and the rows that are stored, once nothing is to be added.
    pub estimates: Option<(Vec<Estimate>, Vec<KeptRow>)>,
}

impl SubBox<'_> {
    /// The validation samples.
    pub fn held_out(&self) -> HeldOut<'_> {
        HeldOut { points: &self.points, direct: &self.direct }
    }

    /// Highest degree along each axis.
    pub fn degrees(&self) -> Vec<u8> {
        let mut degrees = vec![0; self.grid.dimension()];
        for index in 0..self.grid.len() {
            degrees.iter_mut().zip(self.grid.levels(index)).for_each(|(most, &level)| *most = level.max(*most));
        }
        degrees
    }

    /// Points spread over the box that are to be validation samples besides those that are: in each direction that
    /// matters two more than the degree, at least a few, and no more than there are nodes.
    pub fn spread_wanted(&self) -> usize {
        let degrees = self.degrees().into_iter().filter(|&degree| degree > 0);
        let wanted: usize = degrees.map(|degree| usize::from(degree) + 2).sum();
        wanted.saturating_sub(self.spread).min(self.grid.len()).max(TUNING.least_spread)
    }

    /// Validation samples that are those of one half of the box only, which is cut across an axis, on the side of this
    /// sign: ξ there, and values.
    pub fn validation_in_half(&self, axis: usize, side: f64) -> (Vec<Vec<f64>>, ValidationTable) {
        let common = step_validation(self.grid.dimension()).len();
        let indices: Vec<usize> =
            (common..self.points.len()).filter(|&index| side * self.points[index][axis] > 0.0).collect();
        let in_half = |&index: &usize| {
            let mut xi = self.points[index].clone();
            xi[axis] = 2.0 * xi[axis] - side;
            xi
        };
        (indices.iter().map(in_half).collect(), self.direct.pick(&indices))
    }

    /// Rows that all nodes have reached.
    pub fn rows(&self) -> usize {
        self.nodes.iter().map(|(count, values)| values.len() / (self.lines * count)).min().unwrap_or(0)
    }

    /// Adds nodes, given their motions and outputs: row by row, line by line, node by node.
    pub fn add(&mut self, count: usize, values: Vec<f64>) {
        let turning = self.courses.iter().flatten().count();
        let with_times = |row: &[f64]| {
            let mut row = row.to_vec();
            for (coordinate, course) in self.courses.iter().enumerate() {
                let Some(course) = course else { continue };
                let positions = &row[coordinate * count..][..count];
                let phase = course.over(Range::of(positions));
                let time = |&position: &f64| phase.as_ref().map_or(f64::NAN, |phase| phase.time(position));
                let times: Vec<f64> = positions.iter().map(time).collect();
                row.extend(times);
            }
            row
        };
        let values = match turning {
            0 => values,
            _ => values.par_chunks((self.lines - turning) * count).map(with_times).collect::<Vec<_>>().concat(),
        };
        self.nodes.push((count, values));
    }

    /// Values at all nodes: row by row, line by line, node by node.
    pub fn values(&self, rows: impl ExactSizeIterator<Item = usize>) -> Vec<f64> {
        let nodes: usize = self.nodes.iter().map(|(count, _)| count).sum();
        let mut all = Vec::with_capacity(rows.len() * self.lines * nodes);
        for line in rows.flat_map(|row| row * self.lines..(row + 1) * self.lines) {
            for (count, values) in &self.nodes {
                all.extend_from_slice(&values[line * count..][..*count]);
            }
        }
        all
    }

    /// Indices to be added next, generation by generation, at least `wanted` as far as there are any: of each
    /// generation those whose expected surplus is at least a share of the largest. Surpluses of an earlier generation
    /// are believed to be the expected ones.
    ///
    /// Where no surplus is expected that matters, but the error is too large, indices are expected to be as large as
    /// those two degrees lower: a response without even or without odd terms has zero for every other surplus, and the
    /// truncation of a sparse set is estimated so too (`numerics::truncation`).
    pub fn next(&self, share: f64, wanted: usize) -> Vec<Vec<Vec<u8>>> {
        let (mut grid, mut surplus) = (self.grid.clone(), self.surplus.clone());
        let mut generations: Vec<Vec<Vec<u8>>> = Vec::new();
        let mut count = 0;
        while count < wanted {
            let mut added = by_expectation(&surplus, grid.candidates(), generations.is_empty());
            let most = added.first().map_or(0.0, |(_, expected)| *expected);
            added.retain(|(_, expected)| *expected >= share * most);
            if added.is_empty() {
                break;
            }
            if !generations.is_empty() {
                added.truncate(wanted - count);
            }
            count += added.len();
            added.iter().for_each(|(levels, _)| grid.add(levels));
            generations.push(added.iter().map(|(levels, _)| levels.clone()).collect());
            surplus.extend(added);
        }
        generations
    }

    /// The axis along which the box is to be split: where its degree is as high as is allowed, and a higher one has a
    /// much larger expected surplus than whatever else can be added; or where surpluses fall so slowly that it will be.
    pub fn axis_to_split(&self) -> Option<usize> {
        let highest = highest(self.grid.dimension());
        let beyond = |levels: &Vec<u8>| {
            let axis = levels.iter().position(|&level| level == highest)?;
            let mut higher = levels.clone();
            higher[axis] += 1;
            Some((axis, extrapolated(&self.surplus, &higher, 1)))
        };
        let most = self.surplus.keys().filter_map(beyond).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let candidates = by_expectation(&self.surplus, self.grid.candidates(), true);
        let allowed = candidates.first().map_or(0.0, |(_, expected)| *expected);
        match most {
            Some((axis, beyond)) if candidates.is_empty() || beyond > TUNING.split * allowed => Some(axis),
            _ => (0..self.grid.dimension()).find(|&axis| self.falls_slowly(axis, highest)),
        }
    }

    /// Whether surpluses along an axis fall so slowly that the highest degree will not do. One parameter's are not
    /// asked: a degree costs but a node.
    fn falls_slowly(&self, axis: usize, highest: u8) -> bool {
        let k = self.grid.dimension();
        let at = |degree: u8| {
            let mut levels = vec![0; k];
            levels[axis] = degree;
            self.surplus.get(&levels).copied()
        };
        let reached = (0..=highest).take_while(|&degree| at(degree).is_some()).last().unwrap_or(0);
        if k < 2 || reached < TUNING.telling_degree {
            return false;
        }
        // Odd or even degrees may be missing.
        let pair = |degree: u8| at(degree).unwrap_or(0.0).max(at(degree - 1).unwrap_or(0.0));
        let (now, before) = (pair(reached), pair(reached - TUNING.compared_degrees));
        let missing = f64::from(TUNING.compared_degrees) * math::ln(now / TUNING.met) / math::ln(before / now);
        now > TUNING.met && (now >= before || f64::from(reached) + missing > f64::from(highest))
    }
}

/// Indices with their expected surpluses, the largest first. Where none matters and `in_pairs`, those that are expected
/// if every other degree may be missing.
fn by_expectation(surplus: &Surpluses, indices: Vec<Vec<u8>>, in_pairs: bool) -> Vec<(Vec<u8>, f64)> {
    let expect = |back: u8| {
        let expected = |levels: &Vec<u8>| (levels.clone(), extrapolated(surplus, levels, back));
        let mut expected: Vec<(Vec<u8>, f64)> = indices.iter().map(expected).collect();
        // Equal expectations in lexicographic order.
        expected.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        expected
    };
    let expected = expect(1);
    let matters = |expected: &[(Vec<u8>, f64)]| expected.first().is_some_and(|(_, expected)| *expected > TUNING.met);
    if !in_pairs || matters(&expected) {
        return expected;
    }
    Some(expect(2)).filter(|in_pairs| matters(in_pairs)).unwrap_or(expected)
}

/// The expected surplus of an index, from the largest of the `back` degrees before it along each axis.
fn extrapolated(surplus: &Surpluses, levels: &[u8], back: u8) -> f64 {
    let k = levels.len();
    let weight = |axis: usize| {
        let mut first = vec![0; k];
        first[axis] = 1;
        surplus.get(&first).copied()
    };
    let total: f64 = (0..k).filter_map(weight).sum();
    let share = |axis: usize| weight(axis).map_or(1.0, |weight| if total > 0.0 { weight / total } else { 1.0 });
    expected(levels, back, share, |before| surplus.get(before).copied())
}
