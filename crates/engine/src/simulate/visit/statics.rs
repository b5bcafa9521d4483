//! The equilibrium of a sample: its outputs at rest, and its smallest eigenvalue.

use super::Visit;
use crate::numerics::Sample;
use crate::simulate::drive::{Accumulator, Channel};
use crate::simulate::error::SimulationError;
use crate::simulate::simulator::Simulator;

impl Simulator {
    pub(super) fn visit_equilibrium(&self, sample: &Sample, channels: &[Channel]) -> Result<Visit, SimulationError> {
        let Some(equilibrium) = &self.equilibrium else { return Ok(Visit::default()) };
        let state = self.equilibrium_of(equilibrium, sample)?;
        let mut values = equilibrium.at(&state, sample).outputs();
        // The last is the smallest eigenvalue, but where there are states.
        if let Some(last) = values.last_mut().filter(|_| !self.system.has_states()) {
            *last = equilibrium.stability(&state, sample).smallest;
        }
        self.derived.iter().for_each(|derived| derived.set(sample, &mut values));
        let mut reduction = Accumulator::new(channels, values.len(), 1);
        reduction.push(0.0, values.clone(), &[true]);
        Ok(Visit { values, reduced: reduction.finish(), ..Visit::default() })
    }
}
