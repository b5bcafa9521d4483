//! Adjoints of a consistent state: of solutions by Newton's corrections, and of the start.
//!
//! A correction x ← x + c(x, y) that has settled is a fixed point. Its tape is followed backwards at that point, as
//! often as a jet of first order takes it forwards: x̄ ← x̄ + c_xᵀ x̄, ȳ ← ȳ + c_yᵀ x̄. Where one correction solves for
//! x, nothing is left of x̄ after the first, and ȳ = −R_yᵀ J⁻ᵀ x̄ with the factors of the tape. Where the result
//! depends on the point that corrections begin at, as a closed position does on the open one, they are followed from
//! point to point.

use std::ops::Range;

use symdiff::{Adjoints, Tape, Tile};

use super::tuning::TUNING;
use crate::compile::{Layout, StartProgram, Tapes};
use crate::simulate::ensemble::corrections;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

/// Memory of a start's tapes with its adjoints.
#[derive(Debug)]
pub(in crate::simulate) struct StartAdjoints<'s> {
    program: &'s StartProgram,
    assembly: Assembly<'s>,
    adjoints: Adjoints,
}

impl<'s> StartAdjoints<'s> {
    /// Adjoints of a program of a mechanism, with the parameters of an assembled tile.
    pub fn new(simulator: &'s Simulator, program: &'s StartProgram, start: &Tile) -> Self {
        let parameters = program.layout.parameters.start;
        let parameter = |parameter: usize, lane: usize| start.lane(parameters + parameter)[lane];
        let assembly = Assembly::new(program, &simulator.system, start.width(), parameter);
        let adjoints = Adjoints::new(assembly.tile());
        Self { program, assembly, adjoints }
    }

    /// The registers of the state.
    pub fn layout(&self) -> &'s Layout {
        &self.program.layout
    }

    /// The tapes.
    pub fn program(&self) -> &'s StartProgram {
        self.program
    }

    /// The memory.
    pub fn assembly(&mut self) -> &mut Assembly<'s> {
        &mut self.assembly
    }

    /// Values of consecutive registers.
    pub fn values(&self, registers: Range<usize>) -> &[f64] {
        self.assembly.tile().block(registers)
    }

    /// Sets values of registers from this one on, and the time.
    pub fn set(&mut self, time: f64, first: usize, values: &[f64]) {
        self.set_values(first, values);
        self.assembly.tile_mut().lane_mut(self.program.layout.time).fill(time);
    }

    /// Sets the inputs.
    pub fn set_inputs(&mut self, values: &[f64]) {
        self.program.layout.set_inputs(self.assembly.tile_mut(), values);
    }

    fn set_values(&mut self, first: usize, values: &[f64]) {
        let tile = self.assembly.tile_mut();
        let start = first * tile.width();
        tile.values_mut()[start..start + values.len()].copy_from_slice(values);
    }

    /// The adjoints.
    pub fn adjoints(&mut self) -> &mut Adjoints {
        &mut self.adjoints
    }

    /// The adjoints of consecutive registers, which are zero from now on.
    pub fn take(&mut self, registers: Range<usize>) -> Vec<f64> {
        let adjoints = self.adjoints.block_mut(registers);
        let taken = adjoints.to_vec();
        adjoints.fill(0.0);
        taken
    }

    /// Adds to the adjoints of registers from this one on.
    pub fn add(&mut self, first: usize, adjoints: &[f64]) {
        let count = adjoints.len() / self.assembly.tile().width();
        let own = self.adjoints.block_mut(first..first + count);
        own.iter_mut().zip(adjoints).for_each(|(own, adjoint)| *own += adjoint);
    }

    /// Pulls adjoints through a tape.
    pub fn pull(&mut self, tape: &Tape) {
        self.adjoints.pull(tape, self.assembly.tile_mut());
    }

    /// Pulls adjoints through corrections of the values from register `first` on, which have settled.
    pub fn pull_corrections(&mut self, tape: &Tape, first: usize, count: usize, times: usize) {
        let correction = self.program.layout.correction.start;
        for _ in 0..times {
            let seeds = self.adjoints.block(first..first + count).to_vec();
            self.adjoints.block_mut(correction..correction + count).copy_from_slice(&seeds);
            self.pull(tape);
        }
    }

    /// Solves for accelerations and multipliers by one correction, which is all where forces are linear in them.
    /// [`pull_solved`](Self::pull_solved) follows it backwards.
    pub fn solve_acceleration(&mut self) {
        let Self { program, assembly, adjoints } = self;
        let (layout, tile) = (&program.layout, assembly.tile_mut());
        adjoints.record(program.acceleration(), tile);
        let width = tile.width();
        let (known, corrections) = tile.values_mut().split_at_mut(layout.correction.start * width);
        let unknowns = &mut known[layout.w.start * width..layout.lambda.end * width];
        unknowns.iter_mut().zip(corrections).for_each(|(value, correction)| *value += *correction);
    }

    /// Pulls adjoints through the accelerations and multipliers that were solved for last, to positions and velocities.
    /// The tile holds the state from before, and has run no other tape since.
    pub fn pull_solved(&mut self) {
        let layout = self.layout();
        let unknowns = layout.w.start..layout.lambda.end;
        let seeds = self.take(unknowns.clone());
        self.add(layout.correction.start, &seeds);
        self.adjoints.pull_last(self.program.acceleration(), self.assembly.tile_mut());
        self.take(unknowns);
    }

    /// Pulls adjoints through accelerations and multipliers, which the tile holds, to positions and velocities.
    pub fn pull_acceleration(&mut self) {
        let unknowns = self.program.layout.w.start..self.program.layout.lambda.end;
        self.pull_corrections(self.program.acceleration(), unknowns.start, unknowns.len(), corrections(1));
        self.take(unknowns);
    }

    /// Moves the motion in the tile onto the constraints by `times` corrections, and records the way.
    pub fn close(&mut self, times: usize) -> Closing {
        let (program, layout) = (self.program, self.layout());
        let positions = self.correct(program.position(), &layout.q, times);
        let velocities = self.correct(program.projection(), &layout.v, times);
        Closing { positions, velocities }
    }

    /// Pulls adjoints through the closure of a motion, to the one that was not closed.
    pub fn pull_closing(&mut self, closing: &Closing) {
        let (program, layout) = (self.program, self.layout());
        self.pull_way(program.projection(), layout.v.start, &closing.velocities);
        self.pull_way(program.position(), layout.q.start, &closing.positions);
    }

    /// Corrects values. Returns those before each correction.
    fn correct(&mut self, tape: &Tape, unknowns: &Range<usize>, times: usize) -> Vec<Vec<f64>> {
        let correction = self.program.layout.correction.start;
        let step = |_| {
            let before = self.values(unknowns.clone()).to_vec();
            self.assembly.tile_mut().run(tape);
            let changes = self.values(correction..correction + unknowns.len());
            let after: Vec<f64> = before.iter().zip(changes).map(|(value, change)| value + change).collect();
            self.set_values(unknowns.start, &after);
            before
        };
        (0..times).map(step).collect()
    }

    /// Back through corrections, given the values before each.
    fn pull_way(&mut self, tape: &Tape, first: usize, way: &[Vec<f64>]) {
        for before in way.iter().rev() {
            self.set_values(first, before);
            self.pull_corrections(tape, first, before.len() / self.assembly.tile().width(), 1);
        }
    }

    /// Pulls adjoints through a = w(t + shift), as [`Assembly::shift_accelerations`] makes it of the state in the tile.
    fn pull_shift(&mut self, time: f64, shift: f64) {
        let layout = self.layout();
        let [q, v, w] = [&layout.q, &layout.v, &layout.w].map(Range::clone);
        let state = self.values(layout.state()).to_vec();
        let by_shifted = self.take(layout.a.clone());
        let others = self.take(layout.state());
        let [speeds, accelerations, algorithmic] = [&v, &w, &layout.a].map(|block| self.values(block.clone()).to_vec());
        let moved: Vec<f64> = speeds.iter().zip(&accelerations).map(|(v, w)| shift * (v + 0.5 * shift * w)).collect();
        let tile = self.assembly.tile_mut();
        let width = tile.width();
        let mut change = |first: usize, changes: &mut dyn Iterator<Item = f64>| {
            tile.values_mut()[first * width..].iter_mut().zip(changes).for_each(|(value, change)| *value += change);
        };
        change(q.start, &mut moved.into_iter());
        change(v.start, &mut accelerations.iter().map(|w| shift * w));
        self.set(time + shift, w.start, &algorithmic);
        self.assembly.accelerate();
        self.add(w.start, &by_shifted);
        self.pull_acceleration();
        let (by_q, by_v) = (self.take(q.clone()), self.take(v.clone()));
        self.set(time, layout.q.start, &state);
        self.add(layout.q.start, &others);
        self.add(q.start, &by_q);
        let by_speed: Vec<f64> = by_v.iter().zip(&by_q).map(|(v, q)| v + shift * q).collect();
        let by_acceleration: Vec<f64> = by_v.iter().zip(&by_q).map(|(v, q)| shift * (v + 0.5 * shift * q)).collect();
        self.add(v.start, &by_speed);
        self.add(w.start, &by_acceleration);
    }

    /// A state (q, v, a, w, λ) with accelerations and multipliers that follow from its positions and velocities.
    pub fn solve_anew(&mut self, time: f64, state: &[f64], shift: f64) -> Vec<f64> {
        let layout = self.layout();
        self.set(time, layout.q.start, state);
        self.assembly.accelerate();
        self.assembly.shift_accelerations(shift);
        self.values(layout.state()).to_vec()
    }

    /// Pulls adjoints through accelerations that follow from the positions and velocities of a state (q, v, a, w, λ),
    /// and a. Their adjoints, and their shares of those of positions and velocities, are in the adjoints.
    pub fn pull_anew(&mut self, time: f64, state: &[f64], shift: f64) {
        self.set(time, self.layout().q.start, state);
        self.pull_shift(time, shift);
        self.pull_acceleration();
    }

    /// Pulls adjoints through the new values of states that change at a time, to the state before (all but a: q, v and
    /// w, λ).
    pub fn pull_sampling(&mut self, time: f64) {
        let program = self.program;
        let due = || program.sampled.iter().filter(|sampled| sampled.is_due(time));
        for sampled in due() {
            let taken = self.take(sampled.state..sampled.state + 1);
            self.add(sampled.value, &taken);
        }
        self.pull(program.sampling());
    }

    /// Pulls adjoints through the start, given its state (q, v, a, w, λ) and the shift of a, if steps have one. It
    /// leaves the adjoints of the positions that it begins with, and those of parameters.
    pub fn pull_start(&mut self, state: &[f64], shift: Option<f64>) {
        let (program, layout) = (self.program, self.layout());
        match shift {
            Some(shift) => self.pull_anew(0.0, state, shift),
            None => self.set(0.0, layout.q.start, state),
        }
        if !program.sampled.is_empty() {
            self.assembly.tile_mut().run(program.given());
            self.assembly.accelerate();
            self.pull_sampling(0.0);
            self.pull_acceleration();
        }
        let times = corrections(1) + if program.open.is_any() { TUNING.open_corrections } else { 0 };
        self.pull_corrections(program.velocity(), layout.v.start, layout.v.len(), times);
        self.pull(program.given());
        self.take(layout.v.clone());
        self.pull_corrections(program.position(), layout.q.start, layout.q.len(), times);
        self.pull(program.given());
    }

    /// The adjoints of the parameters, k lines.
    pub fn finish(&mut self) -> Vec<f64> {
        self.pull(self.program.sample());
        self.take(self.program.layout.parameters.clone())
    }
}

/// Positions and velocities before each of the corrections that closed a motion.
#[derive(Debug, Default)]
pub(in crate::simulate) struct Closing {
    positions: Vec<Vec<f64>>,
    velocities: Vec<Vec<f64>>,
}
