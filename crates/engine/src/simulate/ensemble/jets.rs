//! One sample whose state is a polynomial in the uncertain parameters: the scheme in jet arithmetic.
//!
//! Newton solves each step at the box's centre. With the Newton matrix of that solution, J₀, every sweep
//! x ← x − J₀⁻¹ R(x) in jets then makes one more order exact: the step's derivatives with respect to the parameters to
//! any order, without differentiating anything by hand.

use symdiff::{JetMemory, jet::JetSpace};

use super::jet_states::{
    JetBox, accelerate, add_correction, assembled_jet, corrections, sample_states, set_parameters, shift_accelerations,
};
use crate::compile::Tapes;
use crate::simulate::control::Steps;
use crate::simulate::drive::{Observed, RowTile, Stop, TiledRun};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, Stepper};

/// The run of one jet under the scheme.
pub type JetRun<'s> = TiledRun<'s, SchemeJet<'s>>;

/// One jet; its coefficients are the lanes.
#[derive(Debug)]
pub struct SchemeJet<'s> {
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
    /// Whether it stopped.
    is_lost: bool,
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
        let jet = SchemeJet {
            simulator,
            order,
            center,
            memory,
            start,
            recomputes,
            sampling,
            projects: false,
            step_size: f64::NAN,
            is_lost: false,
        };
        Ok(Self::of(simulator, vec![jet]))
    }
}

impl<'s> RowTile<'s> for SchemeJet<'s> {
    type Plan<'p> = Steps<'p>;

    fn plan<'p>(_: &Simulator, steps: Steps<'p>) -> Steps<'p> {
        steps
    }

    fn width(&self) -> usize {
        self.memory.jet(self.simulator.program.layout.time).len()
    }

    fn samples(&self) -> Vec<usize> {
        (0..self.width()).collect()
    }

    /// Where a tolerance controls the steps, rows make their velocities consistent.
    fn begin(&mut self, Steps { controller, .. }: &Steps<'_>, _: Observed) {
        self.projects = controller.is_some() && self.simulator.projects_row_velocities();
    }

    fn reach(&mut self, plan: &Steps<'_>, row: usize, asked: &mut StepInterruption<'s>) -> Vec<Stop> {
        for (h, end) in Instants::of(self.simulator).steps_to(row, plan.schedule) {
            if self.is_lost || asked.ends_now() {
                break;
            }
            if let Err(singular) = self.step(h, end) {
                self.is_lost = true;
                let equation = self.center.worst_equation(0);
                return vec![Stop { sample: 0, row, time: end, equation, open: None, singular }];
            }
            self.sample(end);
        }
        Vec::new()
    }

    fn record(&mut self, observed: Observed, into: &mut [f64]) {
        if self.is_lost {
            return into.fill(f64::NAN);
        }
        let layout = &self.simulator.program.layout;
        let motion = if observed == Observed::Outputs { 0..0 } else { layout.q.start..layout.v.end };
        let (before, outputs) = into.split_at_mut(motion.len() * self.width());
        for (register, jet) in motion.zip(before.chunks_exact_mut(self.width())) {
            jet.copy_from_slice(self.memory.jet(register));
        }
        if !outputs.is_empty() {
            self.observe(outputs);
        }
    }

    /// Those of the centre.
    fn counters(&self) -> Counters {
        self.center.counters()
    }
}

impl SchemeJet<'_> {
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

    /// The outputs (output, coefficient). Their accelerations are those of [`super::row_accelerations`]; where these
    /// have no jet, those of the steps.
    fn observe(&mut self, into: &mut [f64]) {
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
        let lines = into.chunks_exact_mut(self.width());
        for (line, &register) in lines.zip(&self.simulator.program.outputs) {
            line.copy_from_slice(self.memory.jet(register));
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
