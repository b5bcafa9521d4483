//! Analyses without time steps: every configuration that is asked for is found by itself.
//!
//! - `statics`: the equilibrium of a sample;
//! - `kinematics`: positions, velocities and accelerations that follow from motors, row by row;
//! - `jets`: the same as polynomials in the parameters.

mod jets;
mod kinematics;
mod statics;

use super::ensemble::Stop;
use super::error::SimulationError;
use super::simulator::Simulator;
use crate::assemble::{OutputInfo, System};
use crate::model::Analysis;
use crate::numerics::Sample;

/// What was found of a sample.
#[derive(Debug, Default)]
pub struct Visit {
    /// The outputs, row by row, as far as it came.
    pub values: Vec<f64>,
    /// Where it stopped, if it did; it is no sample's number yet.
    pub stop: Option<Stop>,
}

impl Simulator {
    /// Goes to every configuration of a sample at these times, s.
    ///
    /// # Errors
    /// Where it cannot be assembled, or has no equilibrium.
    pub fn visit(&self, sample: &Sample, times: &[f64]) -> Result<Visit, SimulationError> {
        match self.system.analysis {
            Analysis::Kinematics => self.visit_kinematics(sample, times),
            _ => self.visit_equilibrium(sample),
        }
    }
}

/// The name of the smallest eigenvalue among the outputs.
const STABILITY: &str = "stability";

/// What an analysis tells besides the model's outputs: their names and units.
pub(super) fn further_outputs(system: &mut System) {
    if system.analysis == Analysis::Statics {
        let taken = |name: &str| system.outputs.iter().any(|output| output.name == name);
        let mut name = STABILITY.to_owned();
        while taken(&name) {
            name.push('_');
        }
        let expr = system.graph.constant(0.0);
        system.outputs.push(OutputInfo { name, unit: "1/s^2".to_owned(), dimension: None, expr });
    }
}
