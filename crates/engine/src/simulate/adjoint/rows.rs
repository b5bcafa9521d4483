//! Adjoints of a row of outputs.

use super::cells::{TileInputs, TileKernel};
use super::start::StartAdjoints;
use crate::compile::StartProgram;
use crate::simulate::ensemble::{Needs, corrections};
use crate::simulate::simulator::Simulator;
use symdiff::Tile;

/// A term of a lane in a row.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulate) struct LaneTerm {
    pub lane: usize,
    /// Index among the lane's terms.
    pub index: usize,
    pub output: usize,
    pub weight: f64,
}

/// A row's outputs as functions of its state, and backwards.
#[derive(Debug)]
pub(in crate::simulate) struct RowAdjoints<'s> {
    memory: StartAdjoints<'s>,
    /// Whether positions and velocities are moved onto the constraints.
    closes: bool,
    /// Whether accelerations and multipliers follow from them.
    accelerates: bool,
    inputs: Option<&'s TileInputs>,
    kernel: TileKernel,
}

impl<'s> RowAdjoints<'s> {
    /// Rows at states that steps by the scheme end with: as [`RowAccelerations`](super::super::ensemble) observes them.
    pub fn of_steps(simulator: &'s Simulator, start: &Tile) -> Self {
        let memory = StartAdjoints::new(simulator, &simulator.start, start);
        Self {
            memory,
            closes: false,
            accelerates: simulator.solves_row_accelerations(),
            inputs: None,
            kernel: TileKernel::default(),
        }
    }

    /// Rows of motions that are combined or interpolated: as [`RowClosure`](super::super::ensemble) closes them.
    pub fn closing(simulator: &'s Simulator, program: &'s StartProgram, start: &Tile) -> Self {
        let needs = Needs::of(simulator);
        let memory = StartAdjoints::new(simulator, program, start);
        Self {
            memory,
            closes: needs.closure,
            accelerates: needs.accelerations,
            inputs: None,
            kernel: TileKernel::default(),
        }
    }

    /// The same under functions of the time.
    pub fn under(self, inputs: Option<&'s TileInputs>) -> Self {
        Self { inputs, kernel: inputs.map_or_else(TileKernel::default, TileInputs::kernel), ..self }
    }

    /// Adjoints of the functions so far.
    pub fn kernel(&self) -> &TileKernel {
        &self.kernel
    }

    /// Adjoints of a state (q, v, a, w, λ) of the terms there; the outputs' values are noted in `values` (by lane and
    /// term).
    pub fn pull(&mut self, time: f64, state: &[f64], terms: &[LaneTerm], values: &mut [Vec<f64>]) -> Vec<f64> {
        let (program, layout) = (self.memory.program(), self.memory.layout());
        if let Some(inputs) = self.inputs {
            self.memory.set_inputs(inputs.values(inputs.cell(time)));
        }
        self.memory.set(time, layout.q.start, state);
        let closing = self.closes.then(|| self.memory.close(corrections(1)));
        let assembly = self.memory.assembly();
        if self.accelerates {
            assembly.accelerate();
        }
        assembly.observe();
        for term in terms {
            values[term.lane][term.index] = assembly.tile().lane(program.outputs[term.output])[term.lane];
        }
        for term in terms {
            self.memory.adjoints().lane_mut(program.outputs[term.output])[term.lane] += term.weight;
        }
        self.memory.pull(program.observe());
        if self.accelerates {
            self.memory.pull_acceleration();
        }
        if let Some(closing) = &closing {
            self.memory.pull_closing(closing);
        }
        if let Some(inputs) = self.inputs {
            self.kernel.add(inputs.cell(time), &self.memory.take(layout.inputs.clone()));
        }
        self.memory.take(layout.state())
    }

    /// The adjoints of the parameters, k lines.
    pub fn finish(&mut self) -> Vec<f64> {
        self.memory.finish()
    }
}
