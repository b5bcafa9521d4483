//! The scheme in jet arithmetic.
//!
//! Newton solves each step at the box's centre. With the Newton matrix of that solution, J₀, every sweep
//! x ← x − J₀⁻¹ R(x) in jets then makes one more order exact: the step's derivatives with respect to the parameters to
//! any order, without differentiating anything by hand.

use symdiff::jet::JetSpace;
use symdiff::{JetMemory, Tile};

use super::jet_states::{JetBox, add_correction, set_parameters};
use crate::compile::{Program, Tapes};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Pace, Stepper};

/// The state of one jet, and its steps.
#[derive(Debug)]
pub(in crate::simulate) struct JetStepper<'s> {
    program: &'s Program,
    pub order: usize,
    /// The box's centre.
    pub center: Stepper<'s>,
    pub memory: JetMemory<'s>,
    /// Step size that a belongs to; NaN before the first step.
    pub step_size: f64,
    /// Whether the step-size stage was run for it.
    is_prepared: bool,
    /// Beginning and unit of the time, if it is a jet.
    pace: Option<Pace>,
}

impl<'s> JetStepper<'s> {
    /// A jet with the state of a consistent start, whose centre is assembled.
    pub fn new(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
        assembled: &Tile,
        start: &JetMemory,
    ) -> Self {
        let program = &simulator.program;
        let mut memory = JetMemory::new(space, program.registers(), program.constants());
        set_parameters(simulator, space, &mut memory, about);
        for register in program.layout.state() {
            memory.jet_mut(register).copy_from_slice(start.jet(register));
        }
        memory.run(program.sample());
        let (order, center) = (space.monomials().order(), Stepper::new(program, assembled));
        Self { program, order, center, memory, step_size: f64::NAN, is_prepared: false, pace: None }
    }

    /// Gives the jet a time of its own: lengths and ends of steps are shares from now on.
    pub fn set_pace(&mut self, pace: &Pace) {
        self.center.set_pace(&Pace { begin: vec![pace.begin[0]], length: vec![pace.length[0]] });
        self.is_prepared = false;
        self.pace = Some(pace.clone());
    }

    /// The jets q, v, a, w, λ.
    pub fn save(&self) -> Vec<f64> {
        self.program.layout.state().flat_map(|register| self.memory.jet(register)).copied().collect()
    }

    /// Goes on from saved jets whose a belongs to steps of length h, and knows no steps before them.
    pub fn restart(&mut self, saved: &[f64], h: f64) {
        let terms = saved.len() / self.program.layout.state().len().max(1);
        for (register, jet) in self.program.layout.state().zip(saved.chunks_exact(terms.max(1))) {
            self.memory.jet_mut(register).copy_from_slice(jet);
        }
        let of_center: Vec<f64> = saved.iter().step_by(terms.max(1)).copied().collect();
        self.center.restart(&of_center, h);
        self.step_size = h;
    }

    /// Positions and velocities, coefficient by coefficient.
    pub fn motion(&self) -> impl Iterator<Item = &f64> {
        let layout = &self.program.layout;
        (layout.q.start..layout.v.end).flat_map(|register| self.memory.jet(register))
    }

    /// Forgets the state, as where a step does not converge.
    pub fn lose(&mut self) {
        self.program.layout.state().for_each(|register| self.memory.jet_mut(register).fill(f64::NAN));
    }

    fn set_time(&mut self, end: f64) {
        let time = self.program.layout.time;
        match &self.pace {
            None => self.memory.set_constant(time, end),
            Some(pace) => pace.set_times(end, self.memory.jet_mut(time)),
        }
    }

    /// One step.
    ///
    /// # Errors
    /// `false` where the centre does not converge; `true` where it converges with the rank-revealing solve only, whose
    /// matrix has no inverse for the sweeps.
    pub fn step(&mut self, h: f64, end: f64) -> Result<(), bool> {
        let program = self.program;
        let layout = &program.layout;
        self.set_step_size(h);
        self.set_time(end);
        self.memory.run(program.step());

        let singular_before = self.center.counters().rank_revealing;
        if !self.center.solve(h, end)[0] {
            return Err(false);
        }
        if self.center.counters().rank_revealing != singular_before {
            return Err(true);
        }
        self.center.tile_mut().run(program.factor());
        for &register in program.factor_registers() {
            self.memory.set_constant(register as usize, self.center.tile().lane(register as usize)[0]);
        }
        for (w, x) in layout.w.clone().zip(layout.iterate.clone()) {
            let prediction = self.memory.jet(w).to_vec();
            self.memory.jet_mut(x).copy_from_slice(&prediction);
            self.memory.jet_mut(x)[0] = self.center.tile().lane(x)[0];
        }
        for &register in &program.redundant {
            self.memory.set_constant(register, 0.0);
        }
        for register in layout.lambda.clone() {
            self.memory.jet_mut(register)[0] = self.center.tile().lane(register)[0];
        }
        for _ in 0..self.order {
            self.memory.run(program.correct());
            let unknowns = layout.iterate.clone().chain(layout.lambda.clone());
            add_correction(&mut self.memory, unknowns, layout.correction.start);
        }
        self.memory.run(program.advance());
        self.center.finish();
        Ok(())
    }

    /// Same as for a tile: see [`Stepper::set_step_size`].
    fn set_step_size(&mut self, h: f64) {
        if self.step_size == h && self.is_prepared {
            return;
        }
        let program = self.program;
        let layout = &program.layout;
        if self.step_size.is_finite() && self.step_size != h {
            let ratio = h / self.step_size;
            for (a, w) in layout.a.clone().zip(layout.w.clone()) {
                let exact = self.memory.jet(w).to_vec();
                self.memory.jet_mut(a).iter_mut().zip(exact).for_each(|(a, w)| *a = w + ratio * (*a - w));
            }
        }
        match &self.pace {
            None => self.memory.set_constant(layout.step, h),
            Some(pace) => pace.set_steps(h, self.memory.jet_mut(layout.step)),
        }
        self.memory.run(program.step_size());
        (self.step_size, self.is_prepared) = (h, true);
    }
}
