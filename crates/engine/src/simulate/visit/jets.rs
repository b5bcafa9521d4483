//! Configurations as polynomials in the parameters.

use symdiff::JetMemory;
use symdiff::jet::JetSpace;

use crate::compile::{StartProgram, Tapes};
use crate::model::Analysis;
use crate::numerics::Sample;
use crate::simulate::drive::Stop;
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::simulator::Simulator;

impl Simulator {
    /// The outputs' coefficients about `center`, row by row, output by output; the parameters' half widths are their
    /// first derivatives. Returns where it stopped, if it did.
    ///
    /// # Errors
    /// Where the centre cannot be assembled, or has no equilibrium, and at an interruption.
    pub fn visit_jets(
        &self,
        space: &JetSpace,
        center: &Sample,
        half_width: &[f64],
        times: &[f64],
        interruption: Interruption<'_>,
        row: &mut dyn FnMut(&[f64]),
    ) -> Result<Option<Stop>, SimulationError> {
        match self.system.analysis {
            // Modes have no jets.
            Analysis::Modes(_) => {
                let unknown = vec![f64::NAN; self.system.outputs.len() * space.len()];
                times.iter().for_each(|_| row(&unknown));
                Ok(None)
            }
            Analysis::Dimensions => {
                self.jets_of_formulas(space, center, half_width, row);
                Ok(None)
            }
            Analysis::Kinematics => self.kinematic_jets(space, center, half_width, times, interruption, row),
            _ => {
                self.jets_at_equilibrium(space, center, half_width, row)?;
                Ok(None)
            }
        }
    }

    fn jets_at_equilibrium(
        &self,
        space: &JetSpace,
        center: &Sample,
        half_width: &[f64],
        row: &mut dyn FnMut(&[f64]),
    ) -> Result<(), SimulationError> {
        let unknown = vec![f64::NAN; self.system.outputs.len() * space.len()];
        let Some(equilibrium) = &self.equilibrium else { return Ok(()) };
        let state = self.equilibrium_of(equilibrium, center)?;
        let mut values = match equilibrium.jet(space, center, half_width, &state) {
            Some(memory) => equilibrium.output_jets(&memory),
            None => unknown,
        };
        // The smallest eigenvalue may be one or another: it has no jet.
        let own = if self.system.has_states() { 0 } else { space.len() };
        let last = values.len() - own;
        values[last..].fill(f64::NAN);
        row(&values);
        Ok(())
    }

    fn kinematic_jets(
        &self,
        space: &JetSpace,
        center: &Sample,
        half_width: &[f64],
        times: &[f64],
        interruption: Interruption<'_>,
        row: &mut dyn FnMut(&[f64]),
    ) -> Result<Option<Stop>, SimulationError> {
        let (start, layout) = (&self.start, &self.start.layout);
        let mut memory = JetMemory::new(space, start.registers(), start.constants());
        for (variable, register) in layout.parameters.clone().enumerate() {
            space.variable(variable, center[variable], half_width[variable], memory.jet_mut(register));
        }
        memory.run(start.sample());
        let order = space.monomials().order();
        let mut values = Vec::new();
        let way = self.walk(center, times, interruption, &mut |assembly| {
            for register in layout.state().chain([layout.time]) {
                memory.set_constant(register, assembly.tile().lane(register)[0]);
            }
            consistent(start, &mut memory, order);
            memory.run(start.observe());
            values.clear();
            start.outputs.iter().for_each(|&register| values.extend_from_slice(memory.jet(register)));
            row(&values);
        })?;
        Ok(way.stop)
    }
}

/// Every correction in jets doubles the number of orders that are exact; the constant terms are.
fn consistent(start: &StartProgram, memory: &mut JetMemory, order: usize) {
    let layout = &start.layout;
    let stages = [
        (start.position(), layout.q.start, layout.q.len()),
        (start.velocity(), layout.v.start, layout.v.len()),
        (start.acceleration(), layout.w.start, layout.w.len() + layout.lambda.len()),
    ];
    for (tape, first, count) in stages {
        for _ in 0..(order + 1).ilog2() + 2 {
            memory.run(tape);
            for index in 0..count {
                let change = memory.jet(layout.correction.start + index).to_vec();
                memory.jet_mut(first + index).iter_mut().zip(change).for_each(|(value, change)| *value += change);
            }
        }
    }
}
