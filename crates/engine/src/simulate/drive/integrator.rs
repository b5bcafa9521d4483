//! Common interface of all ways to integrate, for an ensemble of samples and for one jet in the parameters.

use std::fmt::Debug;
use std::ops::Range;

use super::observed::{Observed, Stop};
use super::reduction::Channel;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::diagnostics::{OpenConstraint, SingularPass, TooDeep};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::step::Counters;

/// An ensemble of samples, or one jet in the parameters, that is integrated in one way. Further questions come before
/// the first row. The coefficients of a jet stand for samples; all of them stop where one does.
pub trait Integrator<'s>: Debug {
    /// Also searches for singular configurations that the first sample passes, and for constraints that open.
    fn watch(&mut self);

    /// Also reduces outputs to one number each.
    fn reduce(&mut self, channels: &'s [Channel]);

    /// Ends at an interruption.
    fn heed(&mut self, interruption: Interruption<'s>);

    /// Whether it ended at an interruption: the rows of the last call are not known, and others do not follow.
    fn is_cut(&self) -> bool;

    /// Advances to `rows`, which follow the rows of the last call (row 0 is the start), and records the `observed`
    /// values: row by row, value by value, sample by sample. With a controller, a sample that exceeds its tolerance
    /// takes shorter steps. Returns the samples that stopped.
    fn advance(&mut self, steps: Steps<'_>, rows: Range<usize>, observed: Observed, into: &mut Vec<f64>) -> Vec<Stop>;

    /// Reduced outputs after the last row, channel by channel, sample by sample; NaN of samples that stopped.
    fn reduced(&mut self) -> Vec<f64>;

    /// Newton iterations and rank-revealing solves so far; none of explicit methods.
    fn counters(&self) -> Counters;

    /// Singular configurations that the first sample has passed, if they are searched for.
    fn singular_passes(&self) -> Vec<SingularPass>;

    /// The error of a redundant constraint that the first sample has left open, if they are searched for.
    fn parted(&self) -> Option<SimulationError>;

    /// The constraint that cannot be closed where a sample stopped: the mechanism locks there. Known for the first
    /// sample of each tile that stops.
    fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint>;

    /// The first row before which a sample's local errors add up to more than the tolerance, fixed steps pass over a
    /// force, or a sample meets an event that others do not.
    fn beyond_tolerance_from(&self) -> Option<usize>;

    /// The first surfaces that a contact does not hold apart any more.
    fn too_deep(&self) -> Option<TooDeep>;

    /// The sample with the largest sum of local errors over the tolerance, and that sum.
    fn largest_error_ratio(&self) -> Option<(usize, f64)>;
}
