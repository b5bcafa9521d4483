//! Cost of a run, before it is spent: `work` counts simulations, `effort` instructions of each, `memory` the size of
//! the results, and `allowance` ends a run that takes much longer than was estimated.

mod allowance;
mod effort;
mod memory;
pub mod tuning;
mod work;

use super::problem::Study;
use crate::model::Stepping;
use crate::simulate::Schedule;
use crate::study::price::tuning::TUNING;
use work::{decided_simulations, planned_simulations, planned_values};

pub use allowance::Allowance;
pub use effort::instructions_of_step;
pub use memory::Memory;
pub use work::{stored_bytes, total_work};

/// Expected cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{simulations:.0} simulations are asked for, which take {} or more on {threads} {}; `bounds: {{ tolerance: 1e-2 }}` \
     takes as many as it needs; or give a lower `order` or fewer `points`, or allow it with --yes (in Rust \
     `allow_costly`, in Python `costly=True`), or with `bounds: {{ budget: {{ solves: {simulations:.0} }} }}` in the model",
    in_words(.seconds), if .threads == &1 { "thread" } else { "threads" }
)]
pub struct Price {
    simulations: f64,
    seconds: f64,
    /// Time with all simulations that the budget allows if a tolerance determines their number, s.
    at_most: f64,
    threads: usize,
}

impl Price {
    /// Cost of the methods' own numbers of samples; of the budget, if a tolerance determines the number.
    pub(in crate::study) fn of(studies: &[Study]) -> Self {
        let threads = rayon::current_num_threads();
        let (mut simulations, mut seconds, mut at_most) = (0.0, 0.0, 0.0);
        for study in studies {
            let of_study = planned_simulations(study);
            let simulation = &study.description.simulation;
            let steps = match simulation.stepping {
                Stepping::Fixed(step) => {
                    let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
                    schedule.steps_before(schedule.rows - 1) as f64
                }
                // At least one between two rows.
                Stepping::Tolerance(_) => (simulation.duration / simulation.output_step).ceil(),
            };
            let of_step = instructions_of_step(&study.simulator);
            simulations += of_study;
            let of_sample = steps * of_step * TUNING.instruction_seconds;
            let planned = (of_study * of_sample + planned_values(study) * TUNING.value_seconds) / threads as f64;
            seconds += planned;
            at_most += planned + decided_simulations(study) * of_sample / threads as f64;
        }
        Self { simulations, seconds, at_most, threads }
    }

    /// An estimate of `seconds` seconds.
    #[cfg(test)]
    pub(super) fn of_seconds(seconds: f64) -> Self {
        Self { simulations: 1.0, seconds, at_most: seconds, threads: 1 }
    }

    /// Estimate if a tolerance takes all that the budget allows, s.
    pub(super) fn at_most(&self) -> f64 {
        self.at_most
    }

    /// Whether the run needs the user's consent, if the model allows `allowed` simulations.
    pub fn is_costly(&self, allowed: usize) -> bool {
        let much = self.simulations > TUNING.simulations || self.seconds > TUNING.seconds;
        much && self.simulations > allowed as f64
    }
}

/// A time with two digits or more, in the unit that people would give it in.
fn in_words(&seconds: &f64) -> String {
    const UNITS: [(f64, &str); 5] = [(1e-3, "ms"), (1.0, "s"), (60.0, "min"), (3600.0, "h"), (86_400.0, "days")];
    if seconds < 1e-3 {
        return "1 ms".to_owned();
    }
    // Two of a unit at least, so that no digit is lost.
    let index = UNITS.iter().rposition(|(unit, _)| seconds >= 2.0 * unit).unwrap_or(0);
    let (unit, name) = UNITS[index];
    let number = seconds / unit;
    if number < 10.0 { format!("{number:.1} {name}") } else { format!("{number:.0} {name}") }
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn times_are_written_in_everyday_units() {
        for (seconds, words) in [
            (0.0, "1 ms"),
            (0.34, "340 ms"),
            (1.5, "1500 ms"),
            (4.26, "4.3 s"),
            (61.0, "61 s"),
            (600.0, "10 min"),
            (2e4, "5.6 h"),
            (1e6, "12 days"),
        ] {
            assert_eq!(in_words(&seconds), words);
        }
    }
}
