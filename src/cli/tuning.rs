//! Constants of the room `cli`.

use std::time::Duration;

use crate::{applications, export, overview, study};
use symdiff::constants::{Constant, tuning};

tuning! {
    /// The command line.
    "cli" {
        /// The highest yield: above it, the tails beyond six standard deviations matter.
        highest_yield: f64 = 0.999_999_9, moves "which yields are refused";
        /// Most threads: more than any machine has on which mbint runs; a larger number is a typing error.
        most_threads: i64 = 1024, moves "which numbers of threads are refused";
        /// Most names that `check` lists in full; otherwise it lists the first few.
        most_named: usize = 12, moves "the lists of `check`";
        /// First names that are listed if there are more.
        first_named: usize = 5, moves "the lists of `check`";
        /// Width of lines of names, characters.
        width_of_names: usize = 100, moves "lists of names";
        /// Most rows that are named if no parameters explain them.
        unexplained_rows: usize = 5, moves "rows that `fit` names";
        /// Most parameters of an output that are printed.
        parameters_of_gradient: usize = 30, moves "the tables of `gradient`";
        /// Parts of the bar; finer than the width of a terminal.
        parts_of_bar: u64 = 10_000, moves "the progress bar";
        /// Most points of a design.
        points_of_design: usize = 1 << 32, moves "which designs are refused";
        /// Most tasks of an array, which every cluster accepts: Slurm's default `MaxArraySize` minus one.
        most_tasks: usize = 1000, moves "job arrays";
        /// Most times that a failed task is requeued.
        most_requeues: usize = 3, moves "job arrays";
        /// Most values of an axis.
        values_of_axis: usize = 10_000, moves "which sweeps are refused";
        /// Most runs of a sweep.
        runs_of_sweep: usize = 100_000, moves "which sweeps are refused";
        /// Time between two lines if there is no terminal.
        between_lines: Duration = Duration::from_secs(10), moves "the progress bar";
        /// Time between two drawings of the bar while nothing is reported, so that the elapsed time advances.
        tick: Duration = Duration::from_millis(250), moves "the progress bar";
        /// Time between two checks of the files.
        between_looks_at_files: Duration = Duration::from_millis(200), moves "how soon a changed file is seen";
    }
}

/// Constants of the whole program, room by room.
pub(super) fn tuning() -> Vec<Constant> {
    [
        study::tuning(),
        applications::tuning(),
        export::tuning::Tuning::constants(),
        overview::tuning::Tuning::constants(),
        mbint_lsp::tuning::Tuning::constants(),
        mbint_studio::tuning::Tuning::constants(),
        Tuning::constants(),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_constant_has_a_unique_name_a_reason_and_an_effect() {
        let constants = tuning();
        let names: BTreeSet<_> = constants.iter().map(|constant| (constant.room, constant.name)).collect();
        assert!(names.len() == constants.len() && constants.len() > 1000);
        for constant in constants {
            let Constant { why, moves, value, name, .. } = constant;
            assert!(why.ends_with('.') && !moves.is_empty() && !value.is_empty(), "{name}: {why}");
        }
    }
}
