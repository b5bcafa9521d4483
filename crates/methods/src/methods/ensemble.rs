//! Outputs over time as functions of the uncertain parameters: the quantities that methods bound.
//!
//! A method asks an [`Ensemble`] for samples, a jet or an enclosure. It knows neither the mechanism behind it nor its
//! steps, nor which other methods run.

use std::ops::Range as Rows;

use serde::{Deserialize, Serialize};
use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use super::closure::Closure;
use super::followed::FollowedEnds;
use super::proof::{EnclosedRow, EnclosureEnd, Proof};
use super::tuning::TUNING;
use crate::certificate::Certified;
use crate::multibody::{ConstraintId, EquationId};
use crate::numerics::{CutMotions, EMPTY, ParameterBox, Range, Sample, ScanBounds, ScanGrid, SegmentMotions};

/// Why an ensemble has no result at all, in its own terms.
pub type EnsembleError = Box<dyn std::error::Error + Send + Sync>;

/// A method ended at an interruption, and knows nothing.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

/// Simulations that one order of a jet counts as in progress reports.
pub const JET_WORK: usize = TUNING.jet_work;

/// Values stored of a simulation in each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Observed {
    /// The outputs.
    Outputs,
    /// Coordinates (n), their velocities (n), then the outputs.
    Motion,
}

/// How long samples are simulated together of which one stops early.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Until {
    /// Until the first stops: without it the others are of no use.
    FirstStop,
    /// To the end: the others are of use without it.
    End,
}

/// How samples are simulated.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Stored values.
    pub observed: Observed,
    /// End of the simulation.
    pub until: Until,
    /// Whether half of the rows are of no use: an interruption is an error.
    pub whole: bool,
}

/// Why a sample stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum StopCause {
    /// A step did not converge; the equation with the largest residual.
    NotConverged {
        /// Equation with the largest residual.
        equation: EquationId,
    },
    /// A constraint cannot be fulfilled beyond this position.
    Locked {
        /// The constraint.
        constraint: ConstraintId,
        /// Residual that remains.
        residual: f64,
    },
    /// The sample goes on, but its jet does not: the Newton matrix is singular.
    SingularJet,
    /// A program that stands for a mechanism has no answer.
    NoAnswer {
        /// Why, for people.
        why: String,
    },
}

/// Where a sample stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// Number of the sample.
    pub sample: usize,
    /// First row that it did not reach.
    pub row: usize,
    /// s
    pub time: f64,
    /// Why.
    pub cause: StopCause,
}

impl Stop {
    /// Whether it is no sample that stopped, but a jet.
    pub fn is_of_jet(&self) -> bool {
        self.cause == StopCause::SingularJet
    }
}

/// Effort of simulations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Newton iterations.
    pub iterations: u64,
    /// Steps solved by the dense rank-revealing factorisation.
    pub rank_revealing: u64,
}

impl std::ops::AddAssign for Effort {
    fn add_assign(&mut self, other: Self) {
        self.iterations += other.iterations;
        self.rank_revealing += other.rank_revealing;
    }
}

/// Surfaces that overlap more deeply than their contact allows, or pass through one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TooDeep {
    /// Name of the contact.
    pub contact: String,
    /// When, s.
    pub time: f64,
    /// How deep, m; `None` if they pass through one another within a step.
    pub depth: Option<f64>,
    /// How deep the contact may be, m.
    pub deepest: f64,
}

impl TooDeep {
    /// The first in time.
    pub fn first<'f>(found: impl IntoIterator<Item = &'f Self>) -> Option<Self> {
        found.into_iter().min_by(|a, b| a.time.total_cmp(&b.time)).cloned()
    }
}

/// Outcome of samples that were simulated together.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Simulated {
    /// Their effort.
    pub effort: Effort,
    /// The sample with the largest error ratio (sum of its local errors over the tolerance), and that ratio.
    pub worst_ratio: Option<(Sample, f64)>,
    /// The first row before which such a sum is more than 1.
    pub beyond_tolerance_from: Option<usize>,
    /// The first surfaces that a contact does not hold apart any more.
    pub too_deep: Option<TooDeep>,
    /// The first sample that stopped, with its parameters.
    pub stop: Option<(Stop, Sample)>,
    /// Numbers of all samples that stopped.
    pub stopped: Vec<usize>,
    /// Reductions of outputs, channel by channel, sample by sample; empty if outputs are not reduced, and in a sum.
    pub reduced: Vec<f64>,
    /// Rows at the end that are not known.
    pub missing: usize,
}

impl Simulated {
    /// Counts the rows from this one on as missing after an interruption.
    pub fn end_at(&mut self, row: usize, ensemble: &dyn Ensemble) {
        if ensemble.is_interrupted() {
            self.missing = self.missing.max(ensemble.rows() - row);
        }
    }

    /// Adds a shard whose first sample has the number `first`.
    pub fn add(&mut self, first: usize, shard: Self) {
        self.effort += shard.effort;
        let stop = shard.stop.map(|(stop, sample)| (Stop { sample: first + stop.sample, ..stop }, sample));
        self.stop = self.stop.take().into_iter().chain(stop).min_by_key(|(stop, _)| (stop.row, stop.sample));
        self.stopped.extend(shard.stopped.into_iter().map(|sample| first + sample));
        self.missing = self.missing.max(shard.missing);
        let beyond = self.beyond_tolerance_from.into_iter().chain(shard.beyond_tolerance_from);
        self.beyond_tolerance_from = beyond.min();
        self.too_deep = TooDeep::first(self.too_deep.iter().chain(&shard.too_deep));
        let ratios = self.worst_ratio.take().into_iter().chain(shard.worst_ratio);
        self.worst_ratio = ratios.reduce(|a, b| if b.1 > a.1 { b } else { a });
    }
}

/// Times, and motions at them.
pub type DenseMotions = (Vec<f64>, Vec<f64>);

/// Continuous functions of one or more parameters through which alone these act.
pub struct Combination<'e> {
    /// The parameters, by number.
    pub parameters: Vec<usize>,
    /// A function of their values,
    pub first: OfParameters<'e>,
    /// and one that is a function of the first.
    pub last: OfParameters<'e>,
}

/// A number from values of some parameters.
pub type OfParameters<'e> = Box<dyn Fn(&[f64]) -> f64 + Sync + 'e>;

/// Outputs over time as functions of the uncertain parameters.
pub trait Ensemble: Sync {
    /// The box of the uncertain parameters.
    fn domain(&self) -> &ParameterBox;

    /// Number of outputs.
    fn outputs(&self) -> usize;

    /// Number of rows.
    fn rows(&self) -> usize;

    /// Time of a row, s.
    fn time(&self, row: usize) -> f64;

    /// Width below which an output's range is rounding.
    fn rounding(&self, output: usize) -> f64;

    /// Whether an output's formula has kinks.
    fn has_kink(&self, output: usize) -> bool;

    /// Whether an output is the largest or the least of some coordinates, or made of both: coordinates that are far off
    /// where they do not count leave it as it is.
    fn is_extreme(&self, _output: usize) -> bool {
        false
    }

    /// Whether an output's formula jumps.
    fn jumps(&self, output: usize) -> bool;

    /// Functions of parameters through which alone these act, no parameter in two of them; none if that is
    /// not known.
    fn combinations(&self) -> Vec<Combination<'_>> {
        Vec::new()
    }

    /// Range of an output in a row that has been simulated so far, by whatever asked for it; empty if it is not noted.
    fn seen(&self, _row: usize, _output: usize) -> Range {
        EMPTY
    }

    /// Ends of the outputs over the whole box that were followed along gradients, if there are any.
    fn followed(&self) -> Option<&FollowedEnds> {
        None
    }

    /// Whether the results so far are enough.
    fn is_interrupted(&self) -> bool;

    /// An error at an interruption, for whatever is of no use before it is done.
    ///
    /// # Errors
    /// [`Interrupted`].
    fn go_on(&self) -> Result<(), EnsembleError> {
        if self.is_interrupted() { Err(Interrupted.into()) } else { Ok(()) }
    }

    /// Simulates samples block by block; `reduce` gets the rows of a block and their values (row, line, sample). Ends
    /// as `sampling` says, or at an interruption.
    ///
    /// # Errors
    /// If a sample cannot be assembled; [`Interrupted`] where half of the rows are of no use.
    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError>;

    /// Motions of samples at times that are dense enough to interpolate between them: the times, and positions and
    /// velocities (2n lines) in each, line by line, sample by sample. `None` if steps are too coarse for that.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    fn dense_motions(&self, samples: &[Sample]) -> Result<Option<DenseMotions>, EnsembleError> {
        let _ = samples;
        Ok(None)
    }

    /// Motions of samples, cut at the events that they meet; `None` if motions are not cut.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    fn segments(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
        let _ = samples;
        Ok(None)
    }

    /// Taylor coefficients, about some ξ and in scaled parameters, of the motion that is cut at its events. They are
    /// returned instead of samples' values, after the index of the word; `None` if motions are not cut.
    ///
    /// # Errors
    /// If the sample cannot be assembled.
    fn segment_jets(&self, space: &JetSpace, xi: &[f64]) -> Result<Option<(usize, SegmentMotions)>, EnsembleError> {
        let _ = (space, xi);
        Ok(None)
    }

    /// Simulates all samples of a scan's grid to the end, and bounds the outputs over them.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    fn scan(&self, grid: &ScanGrid) -> Result<(ScanBounds, Simulated), EnsembleError> {
        scan(self, grid, |samples, sampling, reduce| self.simulate(samples, sampling, reduce))
    }

    /// Taylor coefficients of the outputs about the middle of the box, in scaled parameters; `reduce` gets the rows of
    /// a block and their coefficients (row, output, monomial).
    ///
    /// # Errors
    /// If the middle of the box cannot be assembled.
    fn jets(&self, space: &JetSpace, reduce: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError>;

    /// Obstacle to this proof, if there is one.
    fn obstacle_to_enclosure(&self, proof: Proof) -> Option<String>;

    /// Encloses the outputs over a piece of the box; `row` gets one row after the other.
    fn enclose(&self, proof: Proof, space: &ModelSpace, piece: &ParameterBox, row: &mut EnclosedRow) -> EnclosureEnd;

    /// A certificate with the equations, without any piece yet; `None` without equations.
    fn certified(&self) -> Option<Certified> {
        None
    }

    /// Scale of every coordinate (n).
    fn scales(&self) -> &[f64];

    /// Coordinates that are best taken as independent at a motion (2n values) of these parameters.
    fn independent(&self, parameters: &[f64], motion: &[f64], time: f64) -> Vec<usize>;

    /// The loop closure over a choice of independent coordinates.
    ///
    /// # Errors
    /// If it cannot be compiled.
    fn closure(&self, independent: Vec<usize>) -> Result<Box<dyn Closure + '_>, EnsembleError>;
}

/// Bounds of the outputs over a scan's grid, by simulations of its shards. A part of the grid bounds nothing: after an
/// interruption all rows are missing.
///
/// # Errors
/// The simulations' own.
pub fn scan<E>(
    ensemble: &(impl Ensemble + ?Sized),
    grid: &ScanGrid,
    mut simulate: impl FnMut(&[Sample], Sampling, &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, E>,
) -> Result<(ScanBounds, Simulated), E> {
    let mut bounds = ScanBounds::new(ensemble.rows(), ensemble.outputs(), grid.points());
    let mut total = Simulated::default();
    for first in grid.shards() {
        if ensemble.is_interrupted() {
            total.missing = ensemble.rows();
            break;
        }
        let samples = grid.samples(first, ensemble.domain());
        total.add(first, scan_shard(&mut bounds, first, &samples, &mut simulate)?);
    }
    Ok((bounds, total))
}

/// Adds consecutive samples of a scan's grid, from number `first` on, to its bounds.
///
/// # Errors
/// The simulation's own.
pub fn scan_shard<E>(
    bounds: &mut ScanBounds,
    first: usize,
    samples: &[Sample],
    mut simulate: impl FnMut(&[Sample], Sampling, &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, E>,
) -> Result<Simulated, E> {
    let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
    simulate(samples, sampling, &mut |rows, values| bounds.observe(rows, first, samples.len(), values))
}

/// Number of values that a row has for each sample.
pub fn lines(ensemble: &dyn Ensemble, observed: Observed) -> usize {
    match observed {
        Observed::Outputs => ensemble.outputs(),
        Observed::Motion => 2 * ensemble.scales().len() + ensemble.outputs(),
    }
}
