//! Values that a run records, and how it tells that a sample stopped.

use crate::simulate::diagnostics::OpenConstraint;
use crate::simulate::simulator::Simulator;

/// Values that are recorded in each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observed {
    /// The model's outputs.
    Outputs,
    /// Positions, then velocities (2n), then the model's outputs.
    Motion,
    /// Positions, then velocities (2n).
    Coordinates,
    /// Positions, then velocities (2n), then of each switch the least and the largest value since the row before.
    Switches,
}

impl Observed {
    /// Number of values a row and sample.
    pub fn count(self, simulator: &Simulator) -> usize {
        match self {
            Self::Outputs => simulator.program.outputs.len(),
            Self::Motion => 2 * simulator.program.scale.len() + simulator.program.outputs.len(),
            Self::Coordinates => 2 * simulator.program.scale.len(),
            Self::Switches => {
                2 * simulator.program.scale.len() + 2 * simulator.switches().map_or(0, |program| program.switches.len())
            }
        }
    }
}

/// A sample that stopped, and the row in which it did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Number of the sample in the ensemble.
    pub sample: usize,
    /// First row of output that it did not reach.
    pub row: usize,
    /// s
    pub time: f64,
    /// The equation with the largest scaled residual.
    pub equation: crate::assemble::EquationId,
    /// The constraint that cannot be closed there, if one is known.
    pub open: Option<OpenConstraint>,
    /// Whether the sample could continue, but without the invertible Newton matrix that jets need.
    pub singular: bool,
}
