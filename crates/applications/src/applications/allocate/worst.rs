//! Worst cases: the least margin over a box, and how it changes with the box.

use super::surface::Surface;
use super::tuning::TUNING;
use crate::numerics::{ExtremeSearch, Extremes, Linear, PointSet, Power};

/// Margins that requirements leave under tolerances.
pub trait Slack {
    /// Remaining margin of each requirement with these multiples of the tolerances.
    fn left(&mut self, multiples: &[f64]) -> Vec<f64>;

    /// Whether known worst cases show already that a margin is exceeded.
    fn is_known_to_fail(&self, multiples: &[f64]) -> bool;

    /// Remaining margin, linearised in a power of the multiples.
    fn linearised(&mut self, multiples: &[f64]) -> Vec<Linear>;

    /// The power.
    fn power(&self) -> Power;

    /// Derivatives of a requirement's remaining margin with respect to the multiples, at its least value.
    fn slopes_at_least(&mut self, multiples: &[f64], requirement: usize) -> Vec<f64>;

    /// Correction subtracted from each margin, in its unit.
    fn reserves(&mut self) -> &mut [f64];

    /// Whether a search has to end now.
    fn is_interrupted(&self) -> bool;

    /// Sets the share that may fail, if one may.
    fn allow(&mut self, _: f64) {}

    /// Share of each tolerance in the consumed margin of a requirement.
    fn shares(&mut self, multiples: &[f64], requirement: usize) -> Vec<f64> {
        let slopes = self.slopes_at_least(multiples, requirement);
        let taken: Vec<f64> = slopes.iter().zip(multiples).map(|(slope, multiple)| (slope * multiple).abs()).collect();
        let all: f64 = taken.iter().sum();
        // If the worst case lies inside of the box, no tolerance takes anything.
        taken.into_iter().map(|own| if all > 0.0 { own / all } else { 0.0 }).collect()
    }

    /// Least remaining margin of all requirements.
    fn least(&mut self, multiples: &[f64]) -> f64 {
        self.left(multiples).into_iter().fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
    }
}

/// The worst case of every requirement.
pub struct Worst<'s> {
    pub surface: Surface<'s>,
    interrupted: &'s (dyn Fn() -> bool + Sync),
    search: ExtremeSearch,
    before: Vec<Extremes>,
    /// ξ of the worst cases so far, by requirement.
    known: Vec<Vec<Vec<f64>>>,
}

impl<'s> Worst<'s> {
    pub fn new(surface: Surface<'s>, interrupted: &'s (dyn Fn() -> bool + Sync)) -> Self {
        let search = ExtremeSearch::new(surface.items.len());
        let known = vec![Vec::new(); surface.count];
        Self { surface, interrupted, search, before: Vec::new(), known }
    }

    /// Derivatives of a requirement's slack at ξ with respect to the multiples, and its value.
    fn slopes(&self, multiples: &[f64], requirement: usize, xi: &[f64]) -> (f64, Vec<f64>) {
        let mut samples = vec![self.surface.sample(multiples, xi)];
        for axis in 0..multiples.len() {
            for sign in [1.0, -1.0] {
                let mut moved = multiples.to_vec();
                moved[axis] *= 1.0 + sign * TUNING.step_of_difference;
                samples.push(self.surface.sample(&moved, xi));
            }
        }
        let slacks = self.surface.slacks(PointSet::of(&samples).points());
        let own = &slacks[requirement * samples.len()..][..samples.len()];
        let slope =
            |axis: usize| (own[2 * axis + 1] - own[2 * axis + 2]) / (2.0 * TUNING.step_of_difference * multiples[axis]);
        (own[0], (0..multiples.len()).map(slope).collect())
    }
}

impl Slack for Worst<'_> {
    fn is_interrupted(&self) -> bool {
        (self.interrupted)()
    }

    fn left(&mut self, multiples: &[f64]) -> Vec<f64> {
        let count = self.surface.count;
        let surface = &self.surface;
        let evaluate = |points: &[Vec<f64>]| surface.slacks_at(multiples, points.iter().map(Vec::as_slice));
        let places: Vec<Vec<f64>> = self.known.iter().flatten().cloned().collect();
        let found = self.search.extremes(count, &self.before, &places, &evaluate);
        for (known, found) in self.known.iter_mut().zip(&found) {
            let is_near =
                |other: &Vec<f64>| other.iter().zip(&found.lowest).all(|(a, b)| (a - b).abs() < TUNING.same_place);
            if !known.iter().any(is_near) {
                known.push(found.lowest.clone());
            }
        }
        let left = found.iter().map(|found| found.range.lower).collect();
        self.before = found;
        left
    }

    fn is_known_to_fail(&self, multiples: &[f64]) -> bool {
        let places: Vec<&[f64]> = self.known.iter().flatten().map(Vec::as_slice).collect();
        self.surface.slacks_at(multiples, places.into_iter()).iter().any(|slack| *slack < 0.0)
    }

    fn linearised(&mut self, multiples: &[f64]) -> Vec<Linear> {
        let of = |(requirement, known): (usize, &Vec<Vec<f64>>)| -> Vec<Linear> {
            let linear = |xi: &Vec<f64>| {
                let (value, slopes) = self.slopes(multiples, requirement, xi);
                Linear { value, slopes }
            };
            known.iter().map(linear).collect()
        };
        self.known.iter().enumerate().flat_map(of).collect()
    }

    fn power(&self) -> Power {
        Power::First
    }

    fn slopes_at_least(&mut self, multiples: &[f64], requirement: usize) -> Vec<f64> {
        self.left(multiples);
        self.slopes(multiples, requirement, &self.before[requirement].lowest).1
    }

    fn reserves(&mut self) -> &mut [f64] {
        &mut self.surface.reserves
    }
}
