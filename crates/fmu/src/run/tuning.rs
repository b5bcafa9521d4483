//! Constants of the room `fmu: run`.

use symdiff::constants::tuning;

tuning! {
    /// Units of FMI that are run.
    "fmu: run" {
        /// Most events of a motion.
        most_events: usize = 100_000, moves "which units are refused";
        /// Most repetitions of one event.
        most_repetitions: usize = 1000, moves "which units are refused";
        /// Halvings of a step in which an indicator changes its sign.
        halvings_of_step: usize = 48, moves "answers of units of model exchange";
        /// Share of a step below which the rest is no separate step.
        no_step: f64 = 1e-12, moves "answers of units of model exchange";
    }
}
