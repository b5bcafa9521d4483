//! A jet over a schedule whose steps pass over its rows.

use symdiff::jet::JetSpace;

use super::run::reach;
use super::runge_kutta::{Motion, RungeKutta};
use crate::assemble::EquationId;
use crate::simulate::control::Schedule;
use crate::simulate::ensemble::{JetBox, JetClosure, Stop};
use crate::simulate::error::SimulationError;
use crate::simulate::integrator::JetIntegrator;
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

impl Motion for JetClosure<'_> {
    fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]) {
        JetClosure::rate(self, time, state, into);
    }

    fn close(&mut self, time: f64, state: &mut [f64]) {
        JetClosure::close(self, time, state);
    }

    fn sample(&mut self, time: f64, state: &mut [f64]) -> bool {
        JetClosure::sample(self, time, state)
    }
}

/// The run of one jet.
#[derive(Debug)]
pub struct ExplicitJets<'s> {
    simulator: &'s Simulator,
    motion: JetClosure<'s>,
    run: RungeKutta,
    steps: usize,
    coordinates: usize,
    interruption: Interruption<'s>,
    is_cut: bool,
}

impl<'s> ExplicitJets<'s> {
    /// Assembles the jet around `center`; the parameters' half widths are its first derivatives.
    ///
    /// # Errors
    /// Where the centre cannot be assembled.
    pub fn start(simulator: &'s Simulator, space: &'s JetSpace, about: JetBox<'_>) -> Result<Self, SimulationError> {
        let start = simulator.assemble(1, 0.0, |_| about.center.iter().copied().collect())?;
        let mut motion = JetClosure::new(simulator, space, about, &start)?;
        let state = motion.start(simulator, space, about)?;
        let run = RungeKutta::start(&mut motion, 0.0, state);
        Ok(Self {
            simulator,
            motion,
            run,
            steps: 0,
            coordinates: simulator.system.q.len(),
            interruption: Interruption::default(),
            is_cut: false,
        })
    }
}

impl<'s> JetIntegrator<'s> for ExplicitJets<'s> {
    fn heed(&mut self, interruption: Interruption<'s>) {
        self.interruption = interruption;
    }

    fn is_cut(&self) -> bool {
        self.is_cut
    }

    fn advance(&mut self, schedule: &Schedule, rows: std::ops::Range<usize>, into: &mut Vec<f64>) -> Option<Stop> {
        into.clear();
        let ends = schedule.ending_at(Instants::of(self.simulator)).ends();
        let mut state = vec![0.0; self.run.state.len()];
        for row in rows {
            let time = schedule.time(row);
            let (interruption, is_cut) = (self.interruption, &mut self.is_cut);
            let mut stepped = |_: &mut RungeKutta, _: &mut JetClosure, _| {
                *is_cut |= interruption.is_asked();
                !*is_cut
            };
            reach(&mut self.run, &mut self.motion, &mut self.steps, &ends, time, &mut state, &mut stepped);
            if self.is_cut {
                return None;
            }
            if let Some(index) = state.iter().position(|value| !value.is_finite()) {
                let index = index * 2 * self.coordinates / state.len() % self.coordinates.max(1);
                let equation = EquationId::new(index);
                return Some(Stop { sample: 0, row, time, equation, open: None, singular: true });
            }
            self.motion.close(time, &mut state);
            self.motion.observe(into);
        }
        None
    }
}
