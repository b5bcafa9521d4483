//! Formulas of parameters, without a mechanism: one row, and no equation to solve.

use symdiff::JetMemory;
use symdiff::jet::JetSpace;

use super::{Visit, reduced_rows};
use crate::compile::Tapes;
use crate::numerics::Sample;
use crate::simulate::drive::Channel;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

impl Simulator {
    /// The outputs of a sample, which are their own reductions.
    pub(super) fn visit_formulas(&self, sample: &Sample, channels: &[Channel]) -> Visit {
        let mut assembly = Assembly::new(&self.start, &self.system, 1, |k, _| sample[k]);
        assembly.observe();
        let outputs = self.start.outputs.iter().map(|&register| assembly.tile().lane(register)[0]);
        let values: Vec<f64> = outputs.collect();
        let reduced = if channels.is_empty() { Vec::new() } else { reduced_rows(channels, &[0.0], &values) };
        Visit { values, reduced, ..Visit::default() }
    }

    /// Their coefficients about `center`.
    pub(super) fn jets_of_formulas(
        &self,
        space: &JetSpace,
        center: &Sample,
        half_width: &[f64],
        row: &mut dyn FnMut(&[f64]),
    ) {
        let start = &self.start;
        let mut memory = JetMemory::new(space, start.registers(), start.constants());
        for (variable, register) in start.layout.parameters.clone().enumerate() {
            space.variable(variable, center[variable], half_width[variable], memory.jet_mut(register));
        }
        memory.set_constant(start.layout.time, 0.0);
        memory.run(start.sample());
        memory.run(start.observe());
        let jets: Vec<f64> = start.outputs.iter().flat_map(|&register| memory.jet(register)).copied().collect();
        row(&jets);
    }
}
