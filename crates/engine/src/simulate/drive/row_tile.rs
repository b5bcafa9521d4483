//! Lanes that advance together from row to row.

use std::fmt::Debug;

use super::observed::{Observed, Stop};
use super::reduction::Channel;
use crate::simulate::control::Steps;
use crate::simulate::diagnostics::{SingularPass, TooDeep};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// Lanes that advance together: samples, or the coefficients of one jet.
pub trait RowTile<'s>: Debug + Send {
    /// Part of a schedule that all tiles of a run share.
    type Plan<'p>: Sync;

    /// The plan of a schedule.
    fn plan<'p>(simulator: &Simulator, steps: Steps<'p>) -> Self::Plan<'p>;

    /// Number of lanes.
    fn width(&self) -> usize;

    /// Numbers of the samples in the first lanes. Lanes beyond them repeat the last one.
    fn samples(&self) -> Vec<usize>;

    /// Prepares some rows, before the first one.
    fn begin(&mut self, _plan: &Self::Plan<'_>, _observed: Observed) {}

    /// Takes the steps to a row, which follows the row of the last call (row 0 is the start). Returns the lanes that
    /// stopped, as samples of the tile. Where it is to end, it ends between two steps.
    fn reach(&mut self, plan: &Self::Plan<'_>, row: usize, asked: &mut StepInterruption<'s>) -> Vec<Stop>;

    /// Records the observed values (line, lane) of the row that was reached.
    fn record(&mut self, observed: Observed, into: &mut [f64]);

    /// Also searches for singular configurations that the first lane passes, and for constraints that open.
    fn watch(&mut self, _simulator: &'s Simulator) {}

    /// Also reduces the outputs to one number for each channel.
    fn reduce(&mut self, _channels: &'s [Channel], _outputs: usize) {}

    /// Reduced outputs after the last row, channel by channel, lane by lane; NaN of lanes that stopped.
    fn reduced(&mut self) -> Vec<f64> {
        Vec::new()
    }

    /// Newton iterations and rank-revealing solves so far; none of explicit methods.
    fn counters(&self) -> Counters {
        Counters::default()
    }

    /// Singular configurations that the first lane has passed, if they are searched for.
    fn singular_passes(&self) -> Vec<SingularPass> {
        Vec::new()
    }

    /// The error of a redundant constraint that the first lane has left open, if they are searched for.
    fn parted(&self) -> Option<SimulationError> {
        None
    }

    /// The first lane that stopped in a step, and its registers at the step's beginning.
    fn stopped(&self) -> Option<(usize, &[f64])> {
        None
    }

    /// The first row that cannot be trusted: see [`Integrator`](super::Integrator::beyond_tolerance_from).
    fn beyond_tolerance_from(&self) -> Option<usize> {
        None
    }

    /// The first surfaces that a contact does not hold apart any more.
    fn too_deep(&self) -> Option<TooDeep> {
        None
    }

    /// Each lane's sum of local errors over the tolerance, if there is one.
    fn error_ratios(&self) -> &[f64] {
        &[]
    }
}
