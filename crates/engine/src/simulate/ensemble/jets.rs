//! One sample whose state is a polynomial in the uncertain parameters: the scheme in jet arithmetic.
//!
//! Newton solves each step at the box's centre. With the Newton matrix of that solution, J₀, every sweep
//! x ← x − J₀⁻¹ R(x) in jets then makes one more order exact: the step's derivatives with respect to the parameters to
//! any order, without differentiating anything by hand.

use symdiff::{JetMemory, jet::JetSpace};

use super::jet_states::{
    JetBox, accelerate, add_correction, assembled_jet, corrections, sample_states, set_parameters, shift_accelerations,
};
use super::observed::Stop;
use crate::compile::Tapes;
use crate::simulate::control::Schedule;
use crate::simulate::error::SimulationError;
use crate::simulate::integrator::JetIntegrator;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, Stepper};

/// The run of one jet.
#[derive(Debug)]
pub struct JetRun<'s> {
    simulator: &'s Simulator,
    order: usize,
    /// The box's centre.
    center: Stepper<'s>,
    memory: JetMemory<'s>,
    /// The start's, which solves for the accelerations of rows, and after instants at which states change.
    start: JetMemory<'s>,
    /// Whether rows have accelerations of their own.
    recomputes: bool,
    /// Where states of the centre change at instants.
    sampling: Option<Sampling<'s>>,
    /// Whether rows make their velocities consistent.
    projects: bool,
    step_size: f64,
    interruption: Interruption<'s>,
    is_cut: bool,
}

impl<'s> JetRun<'s> {
    /// Assembles the jet around `center`; the parameters' half widths are its first derivatives.
    ///
    /// # Errors
    /// Where the centre cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        about: JetBox<'_>,
        first_step: f64,
    ) -> Result<Self, SimulationError> {
        let (assembled, start) = assembled_jet(simulator, space, about, first_step)?;
        let order = space.monomials().order();
        let program = &simulator.program;
        let mut memory = JetMemory::new(space, program.registers(), program.constants());
        set_parameters(simulator, space, &mut memory, about);
        for register in program.layout.state() {
            memory.jet_mut(register).copy_from_slice(start.jet(register));
        }
        memory.run(program.sample());
        let recomputes = simulator.solves_row_accelerations() || simulator.projects_row_velocities();
        let center = Stepper::new(program, &assembled);
        let sampling = Sampling::new(simulator, &assembled);
        Ok(Self {
            simulator,
            order,
            center,
            memory,
            start,
            recomputes,
            sampling,
            projects: false,
            step_size: f64::NAN,
            interruption: Interruption::default(),
            is_cut: false,
        })
    }

    /// For steps that are controlled by a tolerance: rows make their velocities consistent.
    #[must_use]
    pub fn controlled(mut self) -> Self {
        self.projects = self.simulator.projects_row_velocities();
        self
    }

    /// As `advance`, and records positions and velocities (2n) in place of outputs.
    pub fn advance_motion(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        into: &mut Vec<f64>,
    ) -> Option<Stop> {
        let layout = &self.simulator.program.layout;
        into.clear();
        for row in rows {
            if let Some(stop) = self.advance_to(schedule, row) {
                return Some(stop);
            }
            for register in layout.q.clone().chain(layout.v.clone()) {
                into.extend_from_slice(self.memory.jet(register));
            }
        }
        None
    }

    /// Advances to a row from the one before; where the run stopped, if it did.
    fn advance_to(&mut self, schedule: &Schedule, row: usize) -> Option<Stop> {
        let instants = Instants::of(self.simulator);
        for (h, end) in schedule.steps_to(row).flat_map(|(h, end)| instants.divide(h, end)) {
            self.is_cut |= self.interruption.is_asked();
            if self.is_cut {
                return None;
            }
            if let Err(singular) = self.step(h, end) {
                let equation = self.center.worst_equation(0);
                return Some(Stop { sample: 0, row, time: end, equation, open: None, singular });
            }
            self.sample(end);
        }
        None
    }

    /// Lets the states change that do so at this time.
    fn sample(&mut self, time: f64) {
        let Some(sampling) = &mut self.sampling else { return };
        if !sampling.end(&mut self.center, time) {
            return;
        }
        let Self { simulator, start, memory, center, order, .. } = self;
        let layout = &simulator.program.layout;
        let constant = |memory: &mut JetMemory, register: usize| {
            memory.jet_mut(register)[0] = center.tile().lane(register)[0];
        };
        for register in layout.state().chain([layout.time]) {
            start.jet_mut(register).copy_from_slice(memory.jet(register));
        }
        sample_states(&simulator.start, start, time);
        // The centre's converge where those of the step are far.
        layout.w.clone().chain(layout.lambda.clone()).for_each(|register| constant(start, register));
        accelerate(simulator, start, *order);
        shift_accelerations(simulator, start, *order, time, simulator.program.coefficients.shift() * self.step_size);
        for register in layout.v.start..layout.lambda.end {
            memory.jet_mut(register).copy_from_slice(start.jet(register));
            constant(memory, register);
        }
    }

    /// Appends the outputs. Their accelerations are those of [`super::row_accelerations`]; where these have no jet,
    /// those of the steps.
    fn observe(&mut self, into: &mut Vec<f64>) {
        let layout = &self.simulator.program.layout;
        let unknowns = layout.v.start..layout.lambda.end;
        let own: Vec<Vec<f64>> = match &mut self.start {
            _ if !self.recomputes => Vec::new(),
            start => {
                for register in layout.state().chain([layout.time]) {
                    start.jet_mut(register).copy_from_slice(self.memory.jet(register));
                }
                if self.projects {
                    for _ in 0..corrections(self.order) {
                        start.run(self.simulator.start.projection());
                        add_correction(start, layout.v.clone(), layout.correction.start);
                    }
                }
                if self.simulator.solves_row_accelerations() {
                    accelerate(self.simulator, start, self.order);
                }
                let finite = |register: usize| start.jet(register).iter().all(|coefficient| coefficient.is_finite());
                let solved = unknowns.clone().all(finite);
                let own =
                    unknowns.clone().filter(|_| solved).map(|register| self.memory.jet(register).to_vec()).collect();
                for register in unknowns.clone().filter(|_| solved) {
                    self.memory.jet_mut(register).copy_from_slice(start.jet(register));
                }
                own
            }
        };
        self.memory.run(self.simulator.program.observe());
        for &register in &self.simulator.program.outputs {
            into.extend_from_slice(self.memory.jet(register));
        }
        for (register, own) in unknowns.zip(&own) {
            self.memory.jet_mut(register).copy_from_slice(own);
        }
    }

    /// One step.
    ///
    /// # Errors
    /// `false` where the centre does not converge; `true` where it converges with the rank-revealing solve only, whose
    /// matrix has no inverse for the sweeps.
    fn step(&mut self, h: f64, end: f64) -> Result<(), bool> {
        let program = &self.simulator.program;
        let layout = &program.layout;
        self.set_step_size(h);
        self.memory.set_constant(layout.time, end);
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

    /// As for a tile: see [`Stepper::set_step_size`].
    fn set_step_size(&mut self, h: f64) {
        if self.step_size == h {
            return;
        }
        let program = &self.simulator.program;
        let layout = &program.layout;
        if self.step_size.is_finite() {
            let ratio = h / self.step_size;
            for (a, w) in layout.a.clone().zip(layout.w.clone()) {
                let exact = self.memory.jet(w).to_vec();
                self.memory.jet_mut(a).iter_mut().zip(exact).for_each(|(a, w)| *a = w + ratio * (*a - w));
            }
        }
        self.memory.set_constant(layout.step, h);
        self.memory.run(program.step_size());
        self.step_size = h;
    }
}

impl<'s> JetIntegrator<'s> for JetRun<'s> {
    fn heed(&mut self, interruption: Interruption<'s>) {
        self.interruption = interruption;
    }

    fn is_cut(&self) -> bool {
        self.is_cut
    }

    fn advance(&mut self, schedule: &Schedule, rows: std::ops::Range<usize>, into: &mut Vec<f64>) -> Option<Stop> {
        into.clear();
        for row in rows {
            if let Some(stop) = self.advance_to(schedule, row) {
                return Some(stop);
            }
            self.observe(into);
        }
        None
    }

    /// Those of the centre.
    fn counters(&self) -> Counters {
        self.center.counters()
    }
}
