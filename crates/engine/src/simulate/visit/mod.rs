//! Analyses without time steps: every configuration that is asked for is found by itself.
//!
//! - `statics`: the equilibrium of a sample;
//! - `kinematics`: positions, velocities and accelerations that follow from motors, row by row;
//! - `formulas`: formulas of parameters alone;
//! - `modes`: the small vibrations of a sample;
//! - `jets`: the same as polynomials in the parameters;
//! - `rows`: the same reductions of rows that something else has found.

mod formulas;
mod jets;
mod kinematics;
mod modes;
mod rows;
mod statics;
pub(crate) mod tuning;

pub use rows::reduced_rows;

use super::control::Steps;
use super::diagnostics::SingularPass;
use super::drive::{Channel, Stop};
use super::error::SimulationError;
use super::interruption::Interruption;
use super::simulator::Simulator;
use crate::model::Analysis;
use crate::numerics::Sample;

/// Result of a sample.
#[derive(Debug, Default)]
pub struct Visit {
    /// The outputs, row by row, as far as it came.
    pub values: Vec<f64>,
    /// The stop, if there was one; it is no sample's number yet.
    pub stop: Option<Stop>,
    /// Singular configurations on the way that were passed smoothly.
    pub singular: Vec<SingularPass>,
    /// Reduced outputs, channel by channel; NaN where it stopped.
    pub reduced: Vec<f64>,
}

impl Simulator {
    /// Goes to every configuration of a sample, in the rows of a schedule. Only a motion takes its steps, and its
    /// tolerance; kinematics does where outputs are reduced to one number by channels.
    ///
    /// # Errors
    /// If it cannot be assembled, or has no equilibrium; [`SimulationError::Interrupted`] at an interruption.
    pub fn visit(
        &self,
        sample: &Sample,
        steps: Steps<'_>,
        channels: &[Channel],
        interruption: Interruption<'_>,
    ) -> Result<Visit, SimulationError> {
        if interruption.is_asked() {
            return Err(SimulationError::Interrupted);
        }
        if let Some(vibrations) = &self.vibrations {
            return self.visit_modes(vibrations, sample, steps, channels, interruption);
        }
        match self.system.analysis {
            Analysis::Kinematics => self.visit_kinematics(sample, steps.schedule, channels, interruption),
            Analysis::Dimensions => Ok(self.visit_formulas(sample, channels)),
            _ => self.visit_equilibrium(sample, channels),
        }
    }
}
