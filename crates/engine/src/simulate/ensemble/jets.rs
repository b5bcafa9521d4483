//! One sample whose state is a polynomial in the uncertain parameters, under the scheme.

use symdiff::{JetMemory, jet::JetSpace};

use super::jet_states::{
    JetBox, accelerate, add_correction, assembled_jet, corrections, sample_states, shift_accelerations,
};
use super::jet_stepper::JetStepper;
use crate::simulate::control::Steps;
use crate::simulate::drive::{Observed, RowTile, Stop, TiledRun};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// The run of one jet under the scheme.
pub type JetRun<'s> = TiledRun<'s, SchemeJet<'s>>;

/// One jet; its coefficients are the lanes.
#[derive(Debug)]
pub struct SchemeJet<'s> {
    simulator: &'s Simulator,
    stepper: JetStepper<'s>,
    /// The start's, which solves for the accelerations of rows, and after instants at which states change.
    start: JetMemory<'s>,
    /// Whether rows have accelerations of their own.
    recomputes: bool,
    /// Sampling of the centre, if its states change at instants.
    sampling: Option<Sampling<'s>>,
    /// Whether rows make their velocities consistent.
    projects: bool,
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
        let stepper = JetStepper::new(simulator, space, about, &assembled, &start);
        let recomputes = simulator.solves_row_accelerations() || simulator.projects_row_velocities();
        let sampling = Sampling::new(simulator, &assembled);
        let jet = SchemeJet { simulator, stepper, start, recomputes, sampling, projects: false, is_lost: false };
        Ok(Self::of(simulator, vec![jet]))
    }
}

impl<'s> RowTile<'s> for SchemeJet<'s> {
    type Plan<'p> = Steps<'p>;

    fn plan<'p>(_: &Simulator, steps: Steps<'p>) -> Steps<'p> {
        steps
    }

    fn width(&self) -> usize {
        self.stepper.memory.jet(self.simulator.program.layout.time).len()
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
            if let Err(singular) = self.stepper.step(h, end) {
                self.is_lost = true;
                let equation = self.stepper.center.worst_equation(0);
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
            jet.copy_from_slice(self.stepper.memory.jet(register));
        }
        if !outputs.is_empty() {
            self.observe(outputs);
        }
    }

    /// Counters of the centre.
    fn counters(&self) -> Counters {
        self.stepper.center.counters()
    }
}

impl SchemeJet<'_> {
    /// Lets the states change that do so at this time.
    fn sample(&mut self, time: f64) {
        let Some(sampling) = &mut self.sampling else { return };
        if !sampling.end(&mut self.stepper.center, time) {
            return;
        }
        let Self { simulator, start, stepper, .. } = self;
        let JetStepper { memory, center, order, step_size, .. } = stepper;
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
        shift_accelerations(simulator, start, *order, time, simulator.program.coefficients.shift() * *step_size);
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
                    start.jet_mut(register).copy_from_slice(self.stepper.memory.jet(register));
                }
                if self.projects {
                    for _ in 0..corrections(self.stepper.order) {
                        start.run(self.simulator.start.projection());
                        add_correction(start, layout.v.clone(), layout.correction.start);
                    }
                }
                if self.simulator.solves_row_accelerations() {
                    accelerate(self.simulator, start, self.stepper.order);
                }
                let finite = |register: usize| start.jet(register).iter().all(|coefficient| coefficient.is_finite());
                let solved = unknowns.clone().all(finite);
                let own = unknowns
                    .clone()
                    .filter(|_| solved)
                    .map(|register| self.stepper.memory.jet(register).to_vec())
                    .collect();
                for register in unknowns.clone().filter(|_| solved) {
                    self.stepper.memory.jet_mut(register).copy_from_slice(start.jet(register));
                }
                own
            }
        };
        self.stepper.memory.run(self.simulator.program.observe());
        let lines = into.chunks_exact_mut(self.width());
        for (line, &register) in lines.zip(&self.simulator.program.outputs) {
            line.copy_from_slice(self.stepper.memory.jet(register));
        }
        for (register, own) in unknowns.zip(&own) {
            self.stepper.memory.jet_mut(register).copy_from_slice(own);
        }
    }
}
