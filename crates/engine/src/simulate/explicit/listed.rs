//! Steps of the explicit method that end at given times.

use symdiff::Tile;

use super::runge_kutta::{RungeKutta, end_of_stages};
use crate::simulate::adjoint::{Stepping, TileInputs};
use crate::simulate::drive::MotionSteps as _;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// A tile of samples that takes the steps of a list.
#[derive(Debug)]
pub(in crate::simulate) struct ExplicitSteps<'s> {
    simulator: &'s Simulator,
    motion: RowClosure<'s>,
    run: RungeKutta,
    /// Times at which steps end, s, and the steps that end at events.
    pub(super) ends: Vec<f64>,
    at_events: Vec<usize>,
    pub(super) inputs: Option<&'s TileInputs>,
}

impl<'s> ExplicitSteps<'s> {
    /// Steps from an assembled tile.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(
        simulator: &'s Simulator,
        start: &Tile,
        ends: Vec<f64>,
        at_events: Vec<usize>,
        inputs: Option<&'s TileInputs>,
    ) -> Result<Self, SimulationError> {
        let mut motion = RowClosure::new(simulator, start)?;
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let run = RungeKutta::start(&mut motion, 0.0, state);
        Ok(Self { simulator, motion, run, ends, at_events, inputs })
    }

    /// When a step begins, s.
    pub(super) fn begin(&self, step: usize) -> f64 {
        step.checked_sub(1).map_or(0.0, |before| self.ends[before])
    }

    /// When its stages end, s.
    pub(super) fn inner(&self, step: usize) -> f64 {
        end_of_stages(self.begin(step), self.ends[step], self.at_events.contains(&step))
    }
}

impl Stepping for ExplicitSteps<'_> {
    fn state(&self) -> &[f64] {
        &self.run.state
    }

    fn restore(&mut self, step: usize, state: &[f64]) {
        let begin = self.begin(step);
        self.run = RungeKutta::start(&mut self.motion, begin, state.to_vec());
    }

    fn advance(&mut self, step: usize) -> Option<Vec<f64>> {
        let end = self.ends[step];
        if let Some(inputs) = self.inputs {
            self.motion.set_inputs(inputs.values(inputs.cell(end)));
            let before = step.checked_sub(1).map(|before| self.ends[before]);
            if inputs.begins(end, before) {
                let state = std::mem::take(&mut self.run.state);
                self.run = RungeKutta::start(&mut self.motion, before.unwrap_or(0.0), state);
            }
        }
        if self.at_events.contains(&step) {
            self.run.attempt_to_event(&mut self.motion, end);
        } else {
            self.run.attempt(&mut self.motion, end);
            self.run.finish(&mut self.motion, end);
        }
        let unchanged = Instants::of(self.simulator).contain(end).then(|| self.run.next.clone());
        self.run.accept(&mut self.motion, end);
        unchanged
    }
}
