//! What a run costs, before it is spent.

use super::effort::{INSTRUCTION_SECONDS, instructions_of_step};
use super::single::Study;
use crate::model::Stepping;
use crate::simulate::Schedule;

/// Most simulations that run unasked.
const MOST_SIMULATIONS: f64 = 20_000.0;

/// Most time that is spent unasked, s.
const MOST_SECONDS: f64 = 60.0;

/// What a run is expected to take.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{simulations:.0} simulations are asked for, at least {seconds:.0} s on {threads} threads; `bounds: {{ tolerance: 1e-2 }}` \
     takes as many as it needs; or give a lower `order` or fewer `points`, or allow it with --yes, or with \
     `bounds: {{ budget: {{ solves: {simulations:.0} }} }}` in the model"
)]
pub struct Price {
    simulations: f64,
    seconds: f64,
    threads: usize,
}

impl Price {
    /// What the methods' own numbers of samples come to; where a tolerance decides, the budget does.
    pub(super) fn of(studies: &[Study]) -> Self {
        let threads = rayon::current_num_threads();
        let (mut simulations, mut seconds) = (0.0, 0.0);
        for study in studies {
            let of_study = study.planned_simulations();
            let simulation = &study.description.simulation;
            let steps = match simulation.stepping {
                Stepping::Fixed(step) => {
                    let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
                    schedule.steps_before(schedule.rows - 1) as f64
                }
                Stepping::Tolerance(_) => 0.0,
            };
            let of_step = instructions_of_step(&study.simulator);
            simulations += of_study;
            seconds += of_study * steps * of_step * INSTRUCTION_SECONDS / threads as f64;
        }
        Self { simulations, seconds, threads }
    }

    /// Whether it is to be asked for, where a model allows so many simulations.
    pub fn is_costly(&self, allowed: usize) -> bool {
        let much = self.simulations > MOST_SIMULATIONS || self.seconds > MOST_SECONDS;
        much && self.simulations > allowed as f64
    }
}
