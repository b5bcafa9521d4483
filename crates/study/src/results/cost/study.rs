//! The study as data, and the choice from it.

use super::method::CostMethod;
use crate::compile::Scheme;
use crate::model::Stepping;

/// A work-precision study of one model. Errors are relative to each output's scale: the widest that the reference's
/// band gets over the run (of an output without a band: how far its nominal course reaches).
#[derive(Clone, Debug)]
pub struct CostStudy {
    /// The model's name.
    pub model: String,
    /// The error that is wanted, at most.
    pub tolerance: f64,
    /// Time that it was given, s.
    pub budget: f64,
    /// Time that it took until its reference was there, s.
    pub reference_seconds: f64,
    /// Time that it took, s.
    pub seconds: f64,
    /// Reference for the errors.
    pub reference: CostReference,
    /// Bounding methods, in the order in which they were run.
    pub bounds: Vec<CostPoint>,
    /// Schemes on the nominal trajectory, likewise.
    pub trajectories: Vec<CostPoint>,
    /// Omitted settings, with reasons.
    pub left_out: Vec<String>,
}

impl CostStudy {
    /// Whether nothing is uncertain, so that there is nothing to bound.
    pub fn is_deterministic(&self) -> bool {
        self.reference.method.curve().is_none()
    }

    /// Whether there was time for a reference to measure errors by.
    pub fn has_reference(&self) -> bool {
        self.reference.trajectory_error.is_finite()
    }

    /// Points among which a user can choose: bounds or, without uncertain parameters, methods that a model can ask for.
    fn choices(&self) -> impl Iterator<Item = &CostPoint> {
        let own = |point: &&CostPoint| {
            point.method.integrator().is_some() || matches!(point.method, CostMethod::Scheme(Scheme::Hht { .. }))
        };
        let trajectories = self.trajectories.iter().filter(own).filter(|_| self.is_deterministic());
        self.bounds.iter().chain(trajectories).filter(|point| point.failure.is_none())
    }

    /// The reference's own error in the candidates.
    pub fn own_error(&self) -> f64 {
        if self.is_deterministic() { self.reference.trajectory_error } else { self.reference.bounds_error }
    }

    /// The cheapest setting that is neither too wide nor too narrow by more than the tolerance, the reference's own
    /// error counted in.
    pub fn cheapest(&self) -> Option<&CostPoint> {
        let own = self.own_error();
        let good = self.choices().filter(|point| point.deviation.largest() + own <= self.tolerance);
        good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// The most accurate setting, the cheaper of equals.
    pub fn nearest(&self) -> Option<&CostPoint> {
        let key = |point: &CostPoint| (point.deviation.largest(), point.seconds);
        let finite = self.choices().filter(|point| point.deviation.largest().is_finite());
        finite.min_by(|a, b| {
            let ((error, seconds), (other, others)) = (key(a), key(b));
            error.total_cmp(&other).then(seconds.total_cmp(&others))
        })
    }
}

/// Reference for the errors: runs with three step sizes, extrapolated.
#[derive(Clone, Debug, PartialEq)]
pub struct CostReference {
    /// Method of its bounds.
    pub method: CostMethod,
    /// Its degree.
    pub order: usize,
    /// From fine to coarse.
    pub steps: [Stepping; 3],
    /// Its own error in the bounds, estimated.
    pub bounds_error: f64,
    /// Its own error in the nominal trajectory, estimated.
    pub trajectory_error: f64,
    /// Contributions to `bounds_error`: source and size.
    pub parts: Vec<(String, f64)>,
}

/// A setting, its error and its price.
#[derive(Clone, Debug, PartialEq)]
pub struct CostPoint {
    /// Order, points and steps vary within a curve.
    pub method: CostMethod,
    /// Degree of a polynomial in the parameters.
    pub order: Option<usize>,
    /// Points of a scan, a parameter.
    pub points: Option<usize>,
    /// Step size, s, or the tolerance of step-size control.
    pub step: Stepping,
    /// Simulations.
    pub simulations: usize,
    /// Steps of each.
    pub steps: usize,
    /// The best of a few runs, s; compiling the model is not in it.
    pub seconds: f64,
    /// Deviation of the bounds; infinite if they are unknown.
    pub deviation: Deviation,
    /// Whether the error is smaller than the reference's own, and therefore not known.
    pub limited: bool,
    /// Whether nothing of its kind is both as cheap and as accurate.
    pub front: bool,
    /// Why it has no result.
    pub failure: Option<String>,
}

/// A setting's largest error over all outputs and rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deviation {
    /// Deviation of bounds.
    Bounds {
        /// Distance by which they lie outside of the reference's.
        over_width: f64,
        /// Distance to the true ends, inside.
        under_coverage: f64,
    },
    /// Deviation of a trajectory.
    Trajectory(f64),
}

/// The points' methods, in the order in which they first appear.
pub fn cost_curves(points: &[CostPoint]) -> Vec<CostMethod> {
    let mut methods: Vec<CostMethod> = Vec::new();
    for point in points {
        if !methods.contains(&point.method) {
            methods.push(point.method);
        }
    }
    methods
}

impl CostPoint {
    /// (error, seconds) with the reference's `own` error for points below it: no better is known.
    pub fn place(&self, own: f64) -> (f64, f64) {
        (self.deviation.largest().max(own), self.seconds)
    }

    /// Point of a setting that has not been run, or that failed.
    pub fn without_result(method: CostMethod, step: Stepping) -> Self {
        let deviation = match method.curve() {
            None => Deviation::Trajectory(f64::INFINITY),
            Some(_) => Deviation::Bounds { over_width: f64::INFINITY, under_coverage: f64::INFINITY },
        };
        Self {
            method,
            order: None,
            points: None,
            step,
            simulations: 0,
            steps: 0,
            seconds: f64::INFINITY,
            deviation,
            limited: false,
            front: false,
            failure: None,
        }
    }
}

impl Deviation {
    /// Distance by which bounds lie outside; for a trajectory, its error.
    pub fn over_width(self) -> f64 {
        match self {
            Self::Bounds { over_width, .. } => over_width,
            Self::Trajectory(error) => error,
        }
    }

    /// The larger.
    pub fn largest(self) -> f64 {
        match self {
            Self::Bounds { over_width, under_coverage } => over_width.max(under_coverage),
            Self::Trajectory(error) => error,
        }
    }

    /// Whether it is more that bounds leave out than that they are too wide.
    pub fn is_narrow(self) -> bool {
        matches!(self, Self::Bounds { over_width, under_coverage } if under_coverage > over_width)
    }
}

#[cfg(test)]
mod tests {
    use super::super::example::*;
    use super::*;

    #[test]
    fn the_cheapest_is_within_the_tolerance_in_both_directions() {
        let mut study = sample();
        // The tight one is within it only if the reference is exact.
        assert_eq!(study.cheapest().unwrap().method, COMPOSED);
        study.reference.bounds_error = 0.0;
        assert_eq!(study.cheapest().unwrap().method, TIGHT);
        study.tolerance = 1e-4;
        assert_eq!(study.cheapest(), None);
        assert_eq!(study.nearest().unwrap().method, COMPOSED);
    }

    #[test]
    fn study_without_bounds_compares_only_the_schemes() {
        let hht = CostMethod::Scheme(Scheme::Hht { alpha: -0.1 });
        let mut study = study(vec![]);
        // Bounds that the budget did not allow are another matter.
        assert_eq!((study.cheapest(), study.nearest()), (None, None));
        study.reference.method = hht;
        assert_eq!(study.cheapest().unwrap().method, hht);
    }
}
