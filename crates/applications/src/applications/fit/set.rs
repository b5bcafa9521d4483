//! The consistent set: pavings along axes that follow the set as it shrinks.

use nalgebra::{DMatrix, DVector};

use super::local::{Local, SkewAxes};
use super::projections::projections;
use super::readings::{Finer, SurrogateRun};
use super::tuning::TUNING;
use super::{FitError, Measurements};
use crate::model::Description;
use crate::numerics::{ParameterBox, Paving, PavingLimits, pave};
use crate::results::{ConsistentSet, FitAxis, SkewPaving};
use crate::study::Options;

/// Pavings by which the set is approached.
const APPROACH: PavingLimits = PavingLimits { undecided: 0.3, boxes: 1 << 12, numbers: 1 << 23 };
/// The last one.
const LAST: PavingLimits = PavingLimits { undecided: 0.02, boxes: 1 << 18, numbers: 1 << 25 };

/// The end of the approach.
pub struct FoundSet {
    /// `None` if it is empty.
    pub set: Option<Set>,
    /// Simulations of narrower boxes.
    pub simulations: usize,
    /// Errors by measured row in the last round, SI; if the set is not empty.
    pub errors: Option<Vec<f64>>,
}

/// A set that is not empty.
pub struct Set {
    pub frame: SkewAxes,
    pub paving: Paving,
}

/// Approaches the set from the model's box, in which `first` has surrogates. Rows that are flagged narrow it by their
/// stated errors, but do not make it empty.
///
/// # Errors
/// If a narrower box cannot be run.
pub fn found(
    description: &Description,
    measurements: &Measurements,
    prior: &ParameterBox,
    first: &SurrogateRun,
    options: &Options,
) -> Result<FoundSet, FitError> {
    let approach = Approach::begun(description, prior, first, options);
    let mut has_flagged = false;
    let found = approached(approach, measurements, &mut has_flagged)?;
    if found.set.is_some() || !has_flagged {
        return Ok(found);
    }
    let approach = Approach { strict: true, ..Approach::begun(description, prior, first, options) };
    let again = approached(approach, measurements, &mut has_flagged)?;
    Ok(FoundSet { simulations: again.simulations + found.simulations, ..again })
}

fn approached(
    mut approach: Approach,
    measurements: &Measurements,
    has_flagged: &mut bool,
) -> Result<FoundSet, FitError> {
    let few = measurements.thinned(TUNING.first_values);
    let mut used = &few;
    let options = approach.options;
    for _ in 0..TUNING.rounds {
        (options.stage)("consistent parameters");
        *has_flagged |= approach.run().readings(used)?.has_flagged();
        let local = approach.local(used, TUNING.coarse)?;
        let paving = pave(&local.tubes, APPROACH, options.interrupted);
        if (options.interrupted)() {
            return Err(FitError::Interrupted);
        }
        if paving.volumes()[1] == 0.0 {
            return Ok(FoundSet { set: None, simulations: approach.simulations, errors: None });
        }
        let next = fitted(&approach.frame, &paving);
        let shrinks = volume(&next) < TUNING.shrunk * volume(&approach.frame);
        if shrinks {
            approach.frame = next;
        }
        let is_all = std::ptr::eq(used, measurements);
        if approach.improved(local.roughness(used), shrinks, is_all)? || shrinks {
            continue;
        }
        if is_all {
            break;
        }
        used = measurements;
    }
    let (mut local, mut paving) = approach.last(measurements)?;
    while apart(&paving) > TUNING.volumes_apart && approach.refined()? {
        (local, paving) = approach.last(measurements)?;
    }
    let is_empty = paving.volumes()[1] == 0.0;
    let Approach { frame, simulations, .. } = approach;
    Ok(FoundSet { set: (!is_empty).then_some(Set { frame, paving }), simulations, errors: Some(local.errors) })
}

/// Difference of a paving's volumes as a share of the outer one.
fn apart(paving: &Paving) -> f64 {
    let [inner, outer] = paving.volumes();
    if outer > 0.0 { 1.0 - inner / outer } else { 0.0 }
}

/// A set that is approached.
struct Approach<'a> {
    description: &'a Description,
    prior: &'a ParameterBox,
    options: &'a Options<'a>,
    first: &'a SurrogateRun,
    /// The run over a narrower box, if there is one.
    narrower: Option<SurrogateRun>,
    /// Whether rows that are flagged count as unknown.
    strict: bool,
    frame: SkewAxes,
    runs: usize,
    finer: Finer,
    /// Error in the round before the last run, in multiples of the noise.
    before: f64,
    simulations: usize,
}

impl<'a> Approach<'a> {
    fn begun(
        description: &'a Description,
        prior: &'a ParameterBox,
        first: &'a SurrogateRun,
        options: &'a Options<'a>,
    ) -> Self {
        let frame = SkewAxes::whole(prior.dimension());
        let before = f64::INFINITY;
        let finer = Finer::default();
        let (narrower, strict) = (None, false);
        Self { description, prior, options, first, narrower, strict, frame, runs: 1, finer, before, simulations: 0 }
    }

    fn run(&self) -> &SurrogateRun {
        self.narrower.as_ref().unwrap_or(self.first)
    }

    fn local(&self, measurements: &Measurements, fine: f64) -> Result<Local, FitError> {
        let readings = self.run().readings(measurements)?.strict(self.strict);
        Local::new(&readings, &self.frame, self.prior, measurements, fine)
    }

    /// Better surrogates, where their error counts and they are worth it: over the box around a frame that has shrunk,
    /// or of a higher order. Orders are raised only if all rows are used (`is_all`), since a few more rows make the
    /// set smaller at no cost. Returns whether there are some.
    fn improved(&mut self, roughness: f64, shrinks: bool, is_all: bool) -> Result<bool, FitError> {
        let domain = self.frame.domain(self.prior);
        let is_narrower = is_narrower(&domain, &self.run().domain);
        if roughness <= TUNING.rough_surrogate || self.runs == TUNING.most_runs || (shrinks && !is_narrower) {
            return Ok(false);
        }
        if !is_narrower {
            // The last run was of no use, or the box cannot be made smaller.
            let is_worth_it = is_all && roughness <= TUNING.better_surrogate * self.before && self.run().is_rough();
            if !is_worth_it || self.finer.orders == TUNING.raised {
                return Ok(false);
            }
            self.finer.orders += 1;
        }
        self.before = roughness;
        self.rerun(&domain)
    }

    /// A finer run over the frame's box: of a higher order if the surrogate has the larger error, else of shorter
    /// steps. Returns whether there is one.
    fn refined(&mut self) -> Result<bool, FitError> {
        let finer = if self.run().is_rough() { &mut self.finer.orders } else { &mut self.finer.steps };
        if *finer == TUNING.raised || self.runs == TUNING.most_runs {
            return Ok(false);
        }
        *finer += 1;
        self.rerun(&self.frame.domain(self.prior))
    }

    /// The last paving with the polynomials that it is of.
    fn last(&self, measurements: &Measurements) -> Result<(Local, Paving), FitError> {
        let local = self.local(measurements, TUNING.fine)?;
        let paving = pave(&local.tubes, LAST, self.options.interrupted);
        if (self.options.interrupted)() { Err(FitError::Interrupted) } else { Ok((local, paving)) }
    }

    /// Runs over a box, in place of the run before. Returns whether it has a surrogate.
    fn rerun(&mut self, domain: &ParameterBox) -> Result<bool, FitError> {
        match SurrogateRun::new(self.description, domain, self.finer, self.options) {
            Ok(run) => {
                self.runs += 1;
                self.simulations += run.simulations;
                self.narrower = Some(run);
                Ok(true)
            }
            // All that is known so far remains true.
            Err(FitError::NoSurrogate) => {
                self.runs = TUNING.most_runs;
                Ok(false)
            }
            Err(error) => Err(error),
        }
    }
}

/// Whether a box is much narrower than another along some axis.
fn is_narrower(domain: &ParameterBox, than: &ParameterBox) -> bool {
    (0..domain.dimension()).any(|axis| domain.half_width(axis) < TUNING.shrunk * than.half_width(axis))
}

fn volume(frame: &SkewAxes) -> f64 {
    frame.axes.clone().lu().determinant().abs()
}

/// All boxes of a paving with their weights: lower and upper ends.
fn outer(paving: &Paving) -> impl Iterator<Item = (&[f64], &[f64])> {
    paving.inside.iter().chain(paving.undecided.iter())
}

/// Mean and covariance of a paving in η.
fn moments(paving: &Paving, k: usize) -> (DVector<f64>, DMatrix<f64>) {
    let (mut weight, mut mean, mut square) = (0.0, DVector::zeros(k), DMatrix::zeros(k, k));
    for (lower, upper) in outer(paving) {
        let middle = DVector::from_fn(k, |axis, _| 0.5 * (lower[axis] + upper[axis]));
        let half = DVector::from_fn(k, |axis, _| 0.5 * (upper[axis] - lower[axis]));
        let own: f64 = half.product();
        weight += own;
        mean += own * &middle;
        square += own * (&middle * middle.transpose());
        (0..k).for_each(|axis| square[(axis, axis)] += own * half[axis] * half[axis] / 3.0);
    }
    mean /= weight;
    let covariance = square / weight - &mean * mean.transpose();
    (mean, covariance)
}

/// Extent of boxes along directions, columns of k × m in η: lower and upper ends.
fn extents<'b>(boxes: impl Iterator<Item = (&'b [f64], &'b [f64])>, directions: &DMatrix<f64>) -> Vec<[f64; 2]> {
    let mut extents = vec![[f64::INFINITY, f64::NEG_INFINITY]; directions.ncols()];
    for (lower, upper) in boxes {
        for (extent, direction) in extents.iter_mut().zip(directions.column_iter()) {
            let (mut least, mut most) = (0.0, 0.0);
            for (axis, own) in direction.iter().enumerate() {
                let ends = [own * lower[axis], own * upper[axis]];
                least += ends[0].min(ends[1]);
                most += ends[0].max(ends[1]);
            }
            (extent[0], extent[1]) = (extent[0].min(least), extent[1].max(most));
        }
    }
    extents
}

/// Principal axes of a paving in ξ, as columns, and its extent along each from the frame's center.
fn principal(frame: &SkewAxes, paving: &Paving) -> (DMatrix<f64>, Vec<[f64; 2]>) {
    let (_, covariance) = moments(paving, frame.center.len());
    let directions = (&frame.axes * covariance * frame.axes.transpose()).symmetric_eigen().eigenvectors;
    // v · ξ = v · center + (axesᵀ v) · η
    let extents = extents(outer(paving), &(frame.axes.transpose() * &directions));
    (directions, extents)
}

/// Axes along the principal ones of a paving, as long as it is.
fn fitted(frame: &SkewAxes, paving: &Paving) -> SkewAxes {
    let (directions, extents) = principal(frame, paving);
    let (mut center, mut axes) = (frame.center.clone(), directions.clone());
    for (index, [lower, upper]) in extents.into_iter().enumerate() {
        center += directions.column(index) * (0.5 * (lower + upper));
        axes.column_mut(index).scale_mut(0.5 * (upper - lower).max(f64::EPSILON));
    }
    SkewAxes { center, axes }
}

impl Set {
    /// Hull of the outer paving in ξ, by parameter.
    pub fn hull(&self) -> Vec<[f64; 2]> {
        self.in_xi(extents(outer(&self.paving), &self.frame.axes.transpose()))
    }

    /// The same for the boxes of the inner one, if there are some.
    pub fn inner_hull(&self) -> Option<Vec<[f64; 2]>> {
        let inside = &self.paving.inside;
        (!inside.is_empty()).then(|| self.in_xi(extents(inside.iter(), &self.frame.axes.transpose())))
    }

    fn in_xi(&self, extents: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        let within = |extent: [f64; 2], center: f64| extent.map(|end| (center + end).clamp(-1.0, 1.0));
        extents.into_iter().zip(self.frame.center.iter()).map(|own| within(own.0, *own.1)).collect()
    }

    /// Centroid in ξ.
    pub fn middle(&self) -> Vec<f64> {
        let (mean, _) = moments(&self.paving, self.frame.center.len());
        self.frame.xi(mean.as_slice()).into_iter().map(|xi| xi.clamp(-1.0, 1.0)).collect()
    }

    /// As results have it, given its hull.
    pub fn described(&self, prior: &ParameterBox, names: &[String], hull: &[[f64; 2]]) -> ConsistentSet {
        let k = prior.dimension();
        let (directions, extents) = principal(&self.frame, &self.paving);
        let axis = |index: usize| {
            let direction: Vec<f64> = directions.column(index).iter().copied().collect();
            let largest = direction.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            let sign = if largest < 0.0 { -1.0 } else { 1.0 };
            let direction = direction.into_iter().map(|own| sign * own).collect();
            FitAxis { direction, extent: extents[index][1] - extents[index][0] }
        };
        let mut axes: Vec<FitAxis> = (0..k).map(axis).collect();
        axes.sort_by(|a, b| b.extent.total_cmp(&a.extent));
        let volume = volume(&self.frame);
        let touches = |axis: &usize| hull[*axis][0] <= -1.0 + 1e-6 || hull[*axis][1] >= 1.0 - 1e-6;
        let inverse = self.frame.axes.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(k, k));
        ConsistentSet {
            volumes: self.paving.volumes().map(|own| own * volume),
            boxes: [self.paving.inside.len(), self.paving.undecided.len()],
            axes,
            projections: projections(&self.frame, &self.paving, hull, prior),
            at_limits: (0..k).filter(touches).map(|axis| names[axis].clone()).collect(),
            paving: SkewPaving {
                center: self.frame.center.iter().copied().collect(),
                inverse: inverse.transpose().iter().copied().collect(),
                boxes: self.paving.clone(),
            },
        }
    }
}
