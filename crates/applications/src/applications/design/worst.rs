//! Slacks in the worst case, as a function of the nominal values.

use super::surface::DesignSurface;
use super::tuning::TUNING;
use crate::numerics::{ExtremeSearch, Extremes, Linear, best_step};

/// Slacks of the requirements about a point, over the samples that count.
pub trait Assessed {
    /// The least slack of each requirement, then further objectives.
    fn slacks(&mut self, point: &[f64]) -> Vec<f64>;

    /// Number of slacks.
    fn count(&self) -> usize;

    /// Whether the last point showed a case that was not known: a step from the point before may be better now.
    fn has_learnt(&self) -> bool;

    /// Slacks that are least there, or were about points before, with their derivatives with respect to the point and
    /// the requirement's number.
    fn linearised(&mut self, point: &[f64]) -> Vec<(usize, Linear)>;

    /// The best step from a point within a box, by goals and limits that are linear in it.
    fn step(&self, _: &[f64], goals: &[Linear], limits: &[Linear], [least, most]: [&[f64]; 2]) -> Vec<f64> {
        best_step(goals, limits, least, most)
    }

    /// A point nearby that violates less, if one can be had without another step.
    fn restored(&mut self, point: Vec<f64>) -> Vec<f64> {
        point
    }
}

/// Slacks over every case within the tolerances.
pub struct WorstOfDesign<'s> {
    surface: &'s DesignSurface,
    search: ExtremeSearch,
    before: Vec<Extremes>,
    /// ξ of the worst cases so far, by requirement, the latest last.
    known: Vec<Vec<Vec<f64>>>,
    has_learnt: bool,
}

impl<'s> WorstOfDesign<'s> {
    pub fn new(surface: &'s DesignSurface) -> Self {
        let known = vec![Vec::new(); surface.count()];
        Self {
            surface,
            search: ExtremeSearch::new(surface.axes.uncertain()),
            before: Vec::new(),
            known,
            has_learnt: false,
        }
    }
}

impl Assessed for WorstOfDesign<'_> {
    fn slacks(&mut self, point: &[f64]) -> Vec<f64> {
        let surface = self.surface;
        if surface.axes.uncertain() == 0 {
            self.known.iter_mut().for_each(|known| *known = vec![Vec::new()]);
            return surface.slacks(&[surface.axes.sample(point, &[])]);
        }
        let evaluate = |points: &[Vec<f64>]| {
            let samples: Vec<Vec<f64>> = points.iter().map(|xi| surface.axes.sample(point, xi)).collect();
            surface.slacks(&samples)
        };
        let places: Vec<Vec<f64>> = self.known.iter().flatten().cloned().collect();
        let found = self.search.extremes(surface.count(), &self.before, &places, &evaluate);
        self.has_learnt = false;
        for (known, found) in self.known.iter_mut().zip(&found) {
            let is_near =
                |other: &Vec<f64>| other.iter().zip(&found.lowest).all(|(a, b)| (a - b).abs() < TUNING.same_case);
            self.has_learnt |= !known.iter().any(is_near);
            known.retain(|other| !is_near(other));
            known.push(found.lowest.clone());
            let spare = known.len().saturating_sub(TUNING.remembered);
            known.drain(..spare);
        }
        let slacks = found.iter().map(|found| found.range.lower).collect();
        self.before = found;
        slacks
    }

    fn count(&self) -> usize {
        self.surface.count()
    }

    fn has_learnt(&self) -> bool {
        self.has_learnt
    }

    fn linearised(&mut self, point: &[f64]) -> Vec<(usize, Linear)> {
        let all: Vec<(usize, &Vec<f64>)> =
            self.known.iter().enumerate().flat_map(|(own, known)| known.iter().map(move |xi| (own, xi))).collect();
        let points = around(self.surface, point);
        let samples: Vec<Vec<f64>> =
            all.iter().flat_map(|(_, xi)| points.iter().map(|own| self.surface.axes.sample(own, xi))).collect();
        let slacks = self.surface.at_instants(&samples);
        let linear = |(index, (requirement, _)): (usize, &(usize, &Vec<f64>))| {
            let of_instant = |instant: usize| {
                let own = &slacks[instant * samples.len() + index * points.len()..][..points.len()];
                (*requirement, quotients(own, &points))
            };
            self.surface.instants[*requirement].clone().map(of_instant).collect::<Vec<_>>()
        };
        all.iter().enumerate().flat_map(linear).collect()
    }
}

/// The point itself, and a pair of neighbours along each axis.
pub fn around(surface: &DesignSurface, point: &[f64]) -> Vec<Vec<f64>> {
    let mut points = vec![point.to_vec()];
    for (axis, [lower, upper]) in surface.region.iter().enumerate() {
        for sign in [-1.0, 1.0] {
            let mut moved = point.to_vec();
            moved[axis] = (moved[axis] + sign * TUNING.step_of_difference * (upper - lower)).clamp(*lower, *upper);
            points.push(moved);
        }
    }
    points
}

/// Value and derivatives from values at those points.
pub fn quotients(values: &[f64], points: &[Vec<f64>]) -> Linear {
    let slope = |axis: usize| {
        let [below, above] = [1 + 2 * axis, 2 + 2 * axis];
        let moved = points[above][axis] - points[below][axis];
        // A tolerance with a single grade has no neighbours.
        if moved > 0.0 { (values[above] - values[below]) / moved } else { 0.0 }
    };
    Linear { value: values[0], slopes: (0..points[0].len()).map(slope).collect() }
}
