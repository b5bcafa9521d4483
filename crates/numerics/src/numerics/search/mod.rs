//! Least and largest values of functions of many parameters, searched for by evaluating them: where a grid would be too
//! large, and nothing but values is known.
//!
//! All functions are evaluated at the same points, and every value counts for every function. A design that is the same
//! each time (middle, middles of faces, corners by Walsh functions, a low-discrepancy sequence) and the extremes of a
//! neighbouring problem give each function, above and below, its starts. A climb probes along every axis, just inwards
//! if it stands on a face: by the parabola through three values, or the sign of a slope, each axis has its target. The
//! climb moves to the best value on the way to all of them at once, and ends where that promises nothing. Probes of all
//! climbs are one batch.
//!
//! Ends found are attained. That nothing lies beyond it is not proven: of many local extremes, as of the sine of a sum
//! that turns more than once, one close to the best may be taken for it.

mod climb;
mod evaluations;
#[cfg(test)]
mod tests;
pub(crate) mod tuning;

use rustc_hash::FxHashSet;

use super::extremes::ValuesAt;
use super::range::Range;
use climb::{Climb, target};
use evaluations::{Evaluations, Goal, bits};
use tuning::TUNING;

/// A function's least and largest value found, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// Unknown if any value was NaN.
    pub range: Range,
    /// ξ of the least value.
    pub lowest: Vec<f64>,
    /// ξ of the largest value.
    pub highest: Vec<f64>,
    /// ξ of local extremes apart from those: as the function changes, one may become the best.
    others: Vec<Vec<f64>>,
}

/// Searches functions of k parameters ξ ∈ [−1, 1]^k.
#[derive(Clone, Debug)]
pub struct ExtremeSearch {
    dimension: usize,
    design: Vec<Vec<f64>>,
}

impl Extremes {
    /// Known from elsewhere.
    pub fn at(range: Range, [lowest, highest]: [Vec<f64>; 2]) -> Self {
        Self { range, lowest, highest, others: Vec::new() }
    }
}

impl ExtremeSearch {
    /// A climb ends where a round neither promises nor brings this share of the range.
    pub const TOLERANCE: f64 = TUNING.tolerance;

    /// Prepares the design.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, design: design(dimension) }
    }

    /// Extremes of `outputs` functions. `evaluate` is called with many points a few times. `neighbours` are the
    /// extremes of similar functions, one for each, or none; `places` are points where some function is known to be
    /// large or small.
    pub fn extremes(
        &self,
        outputs: usize,
        neighbours: &[Extremes],
        places: &[Vec<f64>],
        evaluate: &ValuesAt,
    ) -> Vec<Extremes> {
        let mut seen = Evaluations { values: vec![Vec::new(); outputs], ..Evaluations::default() };
        let known =
            neighbours.iter().flat_map(|known| [&known.lowest, &known.highest].into_iter().chain(&known.others));
        let known = known.cloned();
        let spared = if neighbours.is_empty() { 0 } else { (TUNING.scattered.0 - TUNING.scattered.1) * self.dimension };
        let design = &self.design[..self.design.len() - spared];
        seen.look(design.iter().chain(places).cloned().chain(known).collect(), evaluate);
        let goals = || (0..outputs).flat_map(|output| [1.0, -1.0].map(|sign| Goal { output, sign }));
        let separable = goals().map(|goal| self.separable_maximum(&seen, goal)).collect();
        seen.look(separable, evaluate);

        let mut climbs: Vec<Climb> = goals()
            .flat_map(|goal| {
                let neighbour = neighbours.get(goal.output);
                let place = neighbour.map(|n| if goal.sign > 0.0 { &n.highest } else { &n.lowest });
                let starts = seen.starts(goal, place.map(|place| seen.indices[&bits(place)]));
                starts.into_iter().map(move |at| Climb::new(goal, at, self.dimension))
            })
            .collect();
        // Points where climbs stood, and further local extremes of a neighbour.
        let mut ends: Vec<(Goal, usize)> = goals()
            .flat_map(|goal| {
                let others = neighbours.get(goal.output).into_iter().flat_map(|known| &known.others);
                others.map(|place| (goal, seen.indices[&bits(place)])).collect::<Vec<_>>()
            })
            .collect();
        for _ in 0..TUNING.rounds {
            for stage in [Climb::probe, Climb::stride, Climb::refine] {
                let wanted: Vec<Vec<Vec<f64>>> = climbs.iter_mut().map(|climb| stage(climb, &seen)).collect();
                let places = seen.look(wanted.iter().flatten().cloned().collect(), evaluate);
                let mut places = places.as_slice();
                for (climb, wanted) in climbs.iter_mut().zip(&wanted) {
                    let (own, rest) = places.split_at(wanted.len());
                    climb.last.clear();
                    climb.last.extend_from_slice(own);
                    places = rest;
                }
            }
            climbs.iter_mut().for_each(|climb| climb.settle(&seen));
            ends.extend(climbs.iter().map(|climb| (climb.goal, climb.at)));
            let mut taken = FxHashSet::default();
            climbs.retain(|climb| !climb.arrived && taken.insert((climb.goal.output, climb.goal.sign > 0.0, climb.at)));
            if climbs.is_empty() {
                break;
            }
        }
        (0..outputs).map(|output| seen.extremes(output, &ends)).collect()
    }

    /// The point at which the function would be largest if it were a sum of parabolas through the middle and the faces'
    /// middles.
    fn separable_maximum(&self, seen: &Evaluations, goal: Goal) -> Vec<f64> {
        let value = |place| seen.value(goal, place);
        (0..self.dimension)
            .map(|axis| target(0.0, value(0), (-1.0, value(2 * axis + 1)), (1.0, value(2 * axis + 2))).0)
            .collect()
    }
}

/// The middle; the middles of faces, by axis, lower first; corners with signs by Walsh functions; a Kronecker sequence.
fn design(dimension: usize) -> Vec<Vec<f64>> {
    let face = |axis, xi| (0..dimension).map(move |other| if other == axis { xi } else { 0.0 }).collect();
    let faces = (0..dimension).flat_map(|axis| [face(axis, -1.0), face(axis, 1.0)]);
    let walsh = |row: usize| {
        (1..=dimension)
            .map(move |column| if (row & column).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 })
            .collect()
    };
    let corners = (0..(dimension + 1).next_power_of_two()).map(walsh);
    // The root of φ^(k+1) = φ + 1: steps φ^−1, φ^−2, … that are as irrational as they can be together.
    let golden = (0..64).fold(2.0_f64, |phi, _| symdiff::math::pow(1.0 + phi, 1.0 / (dimension as f64 + 1.0)));
    let scattered = (1..=TUNING.scattered.0 * dimension).map(|n| {
        let coordinate = |axis| 2.0 * (0.5 + n as f64 * golden.powi(-(axis as i32) - 1)).fract() - 1.0;
        (0..dimension).map(coordinate).collect()
    });
    [vec![0.0; dimension]].into_iter().chain(faces).chain(corners).chain(scattered).collect()
}
