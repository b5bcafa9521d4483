//! Values that a run records, and the stop of a sample.

use crate::assemble::EquationId;
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
    pub equation: EquationId,
    /// The constraint that cannot be closed there, if one is known.
    pub open: Option<OpenConstraint>,
    /// Whether the sample could continue, but without the invertible Newton matrix that jets need.
    pub singular: bool,
}

/// Stops of the first `count` lanes whose state (q and v, 2n lines, lane by lane) is not finite in a row.
pub(in crate::simulate) fn lost_lanes(
    alive: &mut [bool],
    count: usize,
    state: &[f64],
    row: usize,
    time: f64,
) -> Vec<Stop> {
    let (width, mut stops) = (alive.len(), Vec::new());
    for (lane, alive) in alive.iter_mut().enumerate() {
        let lost = state.iter().skip(lane).step_by(width).position(|value| !value.is_finite());
        let Some(line) = lost else { continue };
        if std::mem::replace(alive, false) && lane < count {
            let equation = EquationId::new(line % (state.len() / width / 2).max(1));
            stops.push(Stop { sample: lane, row, time, equation, open: None, singular: false });
        }
    }
    stops
}

/// Values (line, lane) of lanes that stopped become NaN.
pub(in crate::simulate) fn forget_lost(alive: &[bool], values: &mut [f64]) {
    for lane in (0..alive.len()).filter(|&lane| !alive[lane]) {
        values.iter_mut().skip(lane).step_by(alive.len()).for_each(|value| *value = f64::NAN);
    }
}
