//! Remaining margins as functions of nominal values and deviations together.

use std::ops::Range;

use super::axes::Axes;
use super::goal::Goal;
use super::tuning::TUNING;
use super::{DesignError, Question};
use crate::applications::allocate::run_simulations;
use crate::applications::allocate::tuning::TUNING as ALLOCATE;
use crate::methods::{Keep, Method};
use crate::model::Requirement;
use crate::numerics::PointSet;
use crate::study::{Kept, Options, RunError, subsystems};

/// A surrogate of all margins over a region of nominal values and the tolerances about them.
pub struct DesignSurface {
    kept: Kept,
    pub axes: Axes,
    /// By free parameter.
    pub region: Vec<[f64; 2]>,
    /// Margins of each requirement: those at its instants.
    pub instants: Vec<Range<usize>>,
    /// Divisors of the requirements' margins.
    pub scales: Vec<f64>,
    /// Subtracted from each margin, in its unit.
    pub reserves: Vec<f64>,
    pub simulations: usize,
}

impl DesignSurface {
    /// A surrogate over a region, or over the largest part of it about a point that has one.
    ///
    /// # Errors
    /// If none of them has.
    pub fn new(
        question: &Question,
        axes: &Axes,
        region: &[[f64; 2]],
        about: &[f64],
        options: &Options,
    ) -> Result<Self, DesignError> {
        let model = &question.at_instants;
        let mut region = region.to_vec();
        let mut simulations = 0;
        let mut failure = None;
        for _ in 0..TUNING.narrower_regions {
            let over = axes.over(model, &region, question.share.is_some());
            let options = Options { methods: Some(vec![Method::Chebyshev]), store: None, ..*options };
            match subsystems::run(&over, &options, Keep::Margins) {
                Ok((_, summary, kept)) => {
                    simulations += run_simulations(&summary);
                    if let Some(kept) = kept.filter(is_known) {
                        let instants = question.instants.clone();
                        let scales = question.model.requirements.iter().map(scale).collect();
                        let reserves = vec![0.0; instants.len()];
                        return Ok(Self { kept, axes: axes.clone(), region, instants, scales, reserves, simulations });
                    }
                }
                Err(error @ (RunError::Infeasible(_) | RunError::Simulation(_))) => failure = Some(error),
                Err(error) => return Err(error.into()),
            }
            if (options.interrupted)() {
                return Err(DesignError::Interrupted);
            }
            for ([lower, upper], middle) in region.iter_mut().zip(about) {
                *lower = middle - TUNING.narrower_region * (middle - *lower);
                *upper = middle + TUNING.narrower_region * (*upper - middle);
            }
        }
        Err(failure.map_or(DesignError::NoSurrogate, DesignError::Run))
    }

    /// Number of requirements.
    pub fn count(&self) -> usize {
        self.scales.len()
    }

    /// Slacks of each requirement at samples, in shares of its limit, requirement by requirement.
    pub fn slacks(&self, samples: &[Vec<f64>]) -> Vec<f64> {
        let count = samples.len();
        let all = self.at_instants(samples);
        let mut slacks = vec![f64::INFINITY; self.count() * count];
        for (own, instants) in slacks.chunks_exact_mut(count.max(1)).zip(&self.instants) {
            for instant in instants.clone() {
                let of_instant = &all[instant * count..][..count];
                own.iter_mut().zip(of_instant).for_each(|(slack, found)| *slack = slack.min(*found));
            }
        }
        slacks
    }

    /// The same at the instants of all requirements, instant by instant.
    pub fn at_instants(&self, samples: &[Vec<f64>]) -> Vec<f64> {
        let all = self.instants.last().map_or(0, |last| last.end);
        let Some(margins) = self.kept.margins() else {
            return vec![ALLOCATE.unknown_margin; all * samples.len()];
        };
        let mut slacks = margins.values(PointSet::of(samples).points());
        for (requirement, instants) in self.instants.iter().enumerate() {
            let (reserve, scale) = (self.reserves[requirement], self.scales[requirement]);
            for slack in &mut slacks[instants.start * samples.len()..instants.end * samples.len()] {
                *slack = if slack.is_nan() { ALLOCATE.unknown_margin } else { (*slack - reserve) / scale };
            }
        }
        slacks
    }
}

/// The part of the ranges within a share of them to either side of a point.
pub fn about(point: &[f64], ranges: &[[f64; 2]], share: f64) -> Vec<[f64; 2]> {
    let along = |(value, [lower, upper]): (&f64, &[f64; 2])| {
        let half = share * (upper - lower);
        [(value - half).max(*lower), (value + half).min(*upper)]
    };
    point.iter().zip(ranges).map(along).collect()
}

/// Whether every margin has a surrogate that can be relied on.
fn is_known(kept: &Kept) -> bool {
    kept.margins().is_some_and(|margins| (0..margins.count()).all(|own| margins.error(own).is_finite()))
}

/// The limit of which a margin is a share: that by which its percentage is reckoned, else one of its unit.
pub fn scale(requirement: &Requirement) -> f64 {
    let limit = requirement.limits.first().map(|limit| limit.value.abs());
    limit.filter(|limit| *limit > 0.0).unwrap_or(1.0)
}

/// Error of the objective, in shares of limits, if known.
pub fn error(surface: &DesignSurface, goal: Goal) -> f64 {
    let Some(margins) = surface.kept.margins() else { return f64::NAN };
    let of = |own: usize| {
        let largest = surface.instants[own].clone().map(|instant| margins.error(instant)).fold(0.0, f64::max);
        largest / surface.scales[own]
    };
    match goal {
        Goal::Last => of(surface.count() - 1),
        Goal::Margin | Goal::Cost(_) => (0..surface.count()).map(of).fold(0.0, f64::max),
    }
}
