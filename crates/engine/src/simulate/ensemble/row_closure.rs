//! Rows of output from positions and velocities that are no step's own: combined from several runs, or interpolated.
//!
//! They miss the constraints by as much as they miss the motion. Positions are moved onto the constraints by the
//! smallest change, velocities by impulses of the constraints, both of the order of that error, whatever coordinates
//! are independent there. Accelerations and multipliers follow from the equations, and with them the outputs.

use symdiff::{JetMemory, Tile, jet::JetSpace};

use super::jet_states::{JetBox, add_correction, assembled_jet, corrections, sample_states, solve_accelerations};
use crate::compile::{StartProgram, Tapes};
use crate::simulate::drive::{Motion, RowState};
use crate::simulate::error::SimulationError;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

/// Properties of a mechanism that decide how rows are closed.
#[derive(Clone, Copy, Debug)]
pub struct Needs {
    /// Whether constraints are to be met.
    pub closure: bool,
    /// Whether outputs depend on accelerations or multipliers.
    pub accelerations: bool,
    /// Whether one correction solves for the accelerations: forces do not depend on multipliers, and no constraint is
    /// redundant.
    pub linear: bool,
}

impl Needs {
    pub fn of(simulator: &Simulator) -> Self {
        let system = &simulator.system;
        let symbols = system.graph.symbols_of(&system.force);
        let depends = system.lambda.iter().any(|multiplier| symbols.binary_search(multiplier).is_ok());
        Self {
            closure: !system.lambda.is_empty(),
            accelerations: system.observes_accelerations(),
            linear: !depends && simulator.mobility.redundant.is_empty() && system.active_condition.is_none(),
        }
    }
}

/// Closes the rows of a tile of samples.
#[derive(Debug)]
pub(in crate::simulate) struct RowClosure<'s> {
    program: &'s StartProgram,
    assembly: Assembly<'s>,
    needs: Needs,
}

impl<'s> RowClosure<'s> {
    /// Closure of the samples of an assembled tile.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(simulator: &'s Simulator, start: &Tile) -> Result<Self, SimulationError> {
        let program = simulator.free_closure()?;
        let layout = &program.layout;
        let parameters = layout.parameters.start;
        let parameter = |parameter: usize, lane: usize| start.lane(parameters + parameter)[lane];
        let mut assembly = Assembly::new(program, &simulator.system, start.width(), parameter);
        for register in layout.state() {
            assembly.tile_mut().lane_mut(register).copy_from_slice(start.lane(register));
        }
        Ok(Self { program, assembly, needs: Needs::of(simulator) })
    }

    /// q, v, a, w, λ of the state whose rates were evaluated last, line by line; a is unknown.
    pub fn unknowns(&self) -> &[f64] {
        self.tile().block(self.program.layout.state())
    }

    /// The memory, with the state that was closed last.
    pub fn tile(&self) -> &Tile {
        self.assembly.tile()
    }

    /// Sets the inputs.
    pub fn set_inputs(&mut self, values: &[f64]) {
        self.program.layout.set_inputs(self.assembly.tile_mut(), values);
    }

    /// The lanes' times, s.
    pub fn times_mut(&mut self) -> &mut [f64] {
        self.assembly.tile_mut().lane_mut(self.program.layout.time)
    }

    /// Makes a motion (2n lines, q and v, lane by lane) consistent at the lanes' [times](Self::times_mut).
    pub fn close_at_times(&mut self, motion: &mut [f64]) {
        let layout = &self.program.layout;
        let width = self.assembly.tile().width();
        let registers = layout.q.start * width..layout.v.end * width;
        self.assembly.tile_mut().values_mut()[registers.clone()].copy_from_slice(motion);
        if !self.needs.closure {
            return;
        }
        let settled = self.assembly.correct_until_settled(self.program.position(), layout.q.start);
        // Values that cannot be closed stay as they are.
        let n = layout.q.len();
        for (register, given) in layout.q.clone().zip(motion[..n * width].chunks_exact(width)) {
            let found = self.assembly.tile_mut().lane_mut(register);
            for lane in (0..width).filter(|&lane| !settled[lane] || !found[lane].is_finite()).collect::<Vec<_>>() {
                found[lane] = given[lane];
            }
        }
        self.assembly.project_velocities();
        motion.copy_from_slice(&self.assembly.tile().values()[registers]);
    }

    /// Rates (v, w; 2n lines) of a state (q, v), which need not be consistent, at the lanes'
    /// [times](Self::times_mut).
    pub fn rate_at_times(&mut self, state: &[f64], into: &mut [f64]) {
        let layout = &self.program.layout;
        let width = self.assembly.tile().width();
        let tile = self.assembly.tile_mut();
        tile.block_mut(layout.q.start..layout.v.end).copy_from_slice(state);
        if self.needs.linear {
            tile.run(self.program.acceleration());
            let (known, corrections) = tile.values_mut().split_at_mut(layout.correction.start * width);
            let unknowns = &mut known[layout.w.start * width..layout.lambda.end * width];
            unknowns.iter_mut().zip(corrections).for_each(|(value, correction)| *value += *correction);
        } else {
            self.assembly.accelerate();
        }
        let n = layout.q.len() * width;
        into[..n].copy_from_slice(&state[n..]);
        into[n..].copy_from_slice(self.assembly.tile().block(layout.w.clone()));
    }

    /// Forgets accelerations and multipliers, from which the next are corrected.
    pub fn forget(&mut self) {
        let layout = &self.program.layout;
        for register in layout.w.start..layout.lambda.end {
            self.assembly.tile_mut().lane_mut(register).fill(0.0);
        }
    }
}

impl Motion for RowClosure<'_> {
    fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]) {
        self.times_mut().fill(time);
        self.rate_at_times(state, into);
    }

    fn close(&mut self, time: f64, motion: &mut [f64]) {
        self.times_mut().fill(time);
        self.close_at_times(motion);
    }

    fn sample(&mut self, time: f64, state: &mut [f64]) -> bool {
        if !self.program.sampled.iter().any(|sampled| sampled.is_due(time)) {
            return false;
        }
        let layout = &self.program.layout;
        let width = self.assembly.tile().width();
        let registers = layout.q.start * width..layout.v.end * width;
        self.assembly.tile_mut().values_mut()[registers.clone()].copy_from_slice(state);
        self.assembly.tile_mut().lane_mut(layout.time).fill(time);
        self.assembly.accelerate();
        self.assembly.sample();
        state.copy_from_slice(&self.assembly.tile().values()[registers]);
        true
    }
}

impl RowState for RowClosure<'_> {
    const IS_JET: bool = false;

    fn width(&self) -> usize {
        self.assembly.tile().width()
    }

    fn observe(&mut self, into: &mut [f64]) {
        if self.needs.accelerations {
            self.assembly.accelerate();
        }
        self.assembly.tile_mut().run(self.program.observe());
        let width = self.assembly.tile().width();
        for (line, &register) in into.chunks_exact_mut(width).zip(&self.program.outputs) {
            line.copy_from_slice(self.assembly.tile().lane(register));
        }
    }
}

/// Closes the rows of a jet.
#[derive(Debug)]
pub(in crate::simulate) struct JetClosure<'s> {
    program: &'s StartProgram,
    memory: JetMemory<'s>,
    order: usize,
    needs: Needs,
}

impl<'s> JetClosure<'s> {
    /// Closure of a jet about `center`, whose state starts at that of an assembled tile of one lane.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
        start: &Tile,
    ) -> Result<Self, SimulationError> {
        let program = simulator.free_closure()?;
        let mut memory = JetMemory::new(space, program.registers(), program.constants());
        for (variable, register) in program.layout.parameters.clone().enumerate() {
            space.variable(variable, about.center[variable], about.half_width[variable], memory.jet_mut(register));
        }
        for register in program.layout.state() {
            memory.set_constant(register, start.lane(register)[0]);
        }
        memory.run(program.sample());
        Ok(Self { program, memory, order: space.monomials().order(), needs: Needs::of(simulator) })
    }

    /// A consistent start: q and v.
    ///
    /// # Errors
    /// Where the centre cannot be assembled.
    pub fn start(
        &mut self,
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
    ) -> Result<Vec<f64>, SimulationError> {
        let (_, start) = assembled_jet(simulator, space, about, 0.0)?;
        let layout = &self.program.layout;
        for register in layout.state() {
            self.memory.jet_mut(register).copy_from_slice(start.jet(register));
        }
        Ok((layout.q.start..layout.v.end).flat_map(|register| start.jet(register).to_vec()).collect())
    }

    /// q, v, a, w, λ of the state whose rates were evaluated last, jet by jet; a is unknown.
    pub fn unknowns(&self) -> Vec<f64> {
        self.program.layout.state().flat_map(|register| self.memory.jet(register)).copied().collect()
    }

    /// The memory, with the state that was closed last.
    pub fn memory(&self) -> &JetMemory<'s> {
        &self.memory
    }

    /// The jet in a register of the state, the parameters or the time.
    pub fn jet(&self, register: usize) -> &[f64] {
        self.memory.jet(register)
    }

    /// The time, s.
    pub fn time_mut(&mut self) -> &mut [f64] {
        self.memory.jet_mut(self.program.layout.time)
    }

    /// Rates (v, w; 2n jets) of a state (q, v) at the jet's own [time](Self::time_mut).
    pub fn rate_at_time(&mut self, state: &[f64], into: &mut [f64]) {
        let layout = &self.program.layout;
        let terms = state.len() / (2 * layout.q.len());
        for (register, jet) in (layout.q.start..layout.v.end).zip(state.chunks_exact(terms)) {
            self.memory.jet_mut(register).copy_from_slice(jet);
        }
        if self.needs.linear {
            self.memory.run(self.program.acceleration());
            add_correction(&mut self.memory, layout.w.start..layout.lambda.end, layout.correction.start);
        } else {
            solve_accelerations(self.program, &mut self.memory, self.order);
        }
        let (speeds, accelerations) = into.split_at_mut(state.len() / 2);
        speeds.copy_from_slice(&state[state.len() / 2..]);
        for (register, jet) in layout.w.clone().zip(accelerations.chunks_exact_mut(terms)) {
            jet.copy_from_slice(self.memory.jet(register));
        }
    }

    /// Makes a motion (2n jets, q and v) consistent at the jet's own [time](Self::time_mut).
    pub fn close_at_time(&mut self, motion: &mut [f64]) {
        let layout = &self.program.layout;
        let unknowns = layout.q.start..layout.v.end;
        let terms = motion.len() / unknowns.len();
        for (register, jet) in unknowns.clone().zip(motion.chunks_exact(terms)) {
            self.memory.jet_mut(register).copy_from_slice(jet);
        }
        if !self.needs.closure {
            return;
        }
        for _ in 0..corrections(self.order) {
            self.memory.run(self.program.position());
            add_correction(&mut self.memory, layout.q.clone(), layout.correction.start);
        }
        for _ in 0..corrections(self.order) {
            self.memory.run(self.program.projection());
            add_correction(&mut self.memory, layout.v.clone(), layout.correction.start);
        }
        for (register, jet) in unknowns.zip(motion.chunks_exact_mut(terms)) {
            jet.copy_from_slice(self.memory.jet(register));
        }
    }
}

impl Motion for JetClosure<'_> {
    fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]) {
        self.memory.set_constant(self.program.layout.time, time);
        self.rate_at_time(state, into);
    }

    fn close(&mut self, time: f64, motion: &mut [f64]) {
        self.memory.set_constant(self.program.layout.time, time);
        self.close_at_time(motion);
    }

    fn sample(&mut self, time: f64, state: &mut [f64]) -> bool {
        if !self.program.sampled.iter().any(|sampled| sampled.is_due(time)) {
            return false;
        }
        let layout = &self.program.layout;
        let registers = layout.q.start..layout.v.end;
        let terms = state.len() / registers.len();
        for (register, jet) in registers.clone().zip(state.chunks_exact(terms)) {
            self.memory.jet_mut(register).copy_from_slice(jet);
        }
        self.memory.set_constant(layout.time, time);
        solve_accelerations(self.program, &mut self.memory, self.order);
        sample_states(self.program, &mut self.memory, time);
        for (register, jet) in registers.zip(state.chunks_exact_mut(terms)) {
            jet.copy_from_slice(self.memory.jet(register));
        }
        true
    }
}

impl RowState for JetClosure<'_> {
    const IS_JET: bool = true;

    fn width(&self) -> usize {
        self.memory.jet(self.program.layout.time).len()
    }

    fn observe(&mut self, into: &mut [f64]) {
        if self.needs.accelerations {
            solve_accelerations(self.program, &mut self.memory, self.order);
        }
        self.memory.run(self.program.observe());
        let width = self.width();
        for (line, &register) in into.chunks_exact_mut(width).zip(&self.program.outputs) {
            line.copy_from_slice(self.memory.jet(register));
        }
    }
}
