//! Constants of the room `simulate: features`.

use symdiff::constants::tuning;

tuning! {
    /// Short features of functions that steps must not pass over.
    "simulate: features" {
        /// Operations of a function, counted as if nothing were shared; those of long chains of bodies are omitted.
        most_operations: usize = 2000, moves "the steps of runs with forces that are functions of positions";
        /// Positions over which a function's whole range is taken.
        far: f64 = 1e6, moves "the steps of runs with forces that are functions of positions";
        /// A function that changes by less than this, relative to its values, is constant.
        constant_function: f64 = 1e-9, moves "the steps of runs with forces that are functions of positions";
        /// A function may go this share of its whole range beyond its values at the ends of a fixed step.
        beyond_ends: f64 = 0.25, moves "the steps of runs with forces that are functions of positions";
        /// Two functions may change by this share of their whole ranges in a fixed step: together they may be a bump.
        edge_of_bump: f64 = 0.75, moves "the steps of runs with forces that are functions of positions";
        /// Halvings of a step's path where its enclosure shows a feature. Positions of bodies that move together are
        /// far apart in an enclosure of both, and near one another on the path.
        halvings_of_path: u32 = 6, moves "the steps of runs with forces that are functions of positions";
    }
}
