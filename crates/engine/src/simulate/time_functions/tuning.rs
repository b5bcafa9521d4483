//! Constants of the room `simulate: time_functions`.

use symdiff::constants::tuning;

tuning! {
    /// Steps that resolve functions of time.
    "simulate: time_functions" {
        /// A step is divided where a function may change by more than this, as a share of its own size.
        too_fast: f64 = 1.0, moves "the steps of runs with functions of time";
        /// Largest change within a part of a divided step.
        resolved: f64 = 0.5, moves "the steps of runs with functions of time";
        /// Jumps are this many steps apart.
        steps_between_jumps: f64 = 4.0, moves "the steps of runs with functions of time";
        /// Steps are not divided further than to this share of the duration for jumps that coincide for some
        /// parameters only.
        coinciding_jumps: f64 = 1e-6, moves "the steps of runs with functions of time";
        /// Steps are not divided further than to this share of the duration for jumps that coincide for all
        /// parameters: a condition and its negative.
        one_jump: f64 = 1e-9, moves "the steps of runs with functions of time";
        /// Most halvings of a step of a mechanism without constraints.
        most_halvings: u32 = 24, moves "the steps of runs with functions of time";
        /// Most halvings of a step of a mechanism with constraints: they are divided by the square of the step, and so
        /// is their rounding.
        most_halvings_with_constraints: u32 = 10, moves "the steps of runs with functions of time";
        /// Pieces that are evaluated to find a function's size.
        pieces_for_size: usize = 400, moves "the steps of runs with functions of time";
        /// Pieces of a step over which a function is enclosed whose rate has no bound.
        parts_of_step: usize = 16, moves "the steps of runs with functions of time";
        /// Cuts of a quarter by which a jump is located.
        most_cuts: usize = 120, moves "the steps of runs with functions of time";
        /// Most parts of the box of parameters that are examined to find how often a step is switched, or how fast a
        /// function is.
        most_parts_of_box: usize = 300, moves "the steps of runs with functions of time";
        /// Most times that a part of the box of parameters is halved to find how often a step is switched.
        deepest_part: u32 = 14, moves "the steps of runs with functions of time";
        /// Functions enclosed over a box before a search is given up: a minute or two.
        most_enclosures: usize = 100_000_000, moves "the steps of runs with functions of time";
        /// Times at which the steps of a whole run are counted.
        counted_times: usize = 61, moves "the steps of runs with functions of time";
        /// Densest of the counted times that are omitted: a pulse says nothing of the rest.
        densest_left_out: usize = 4, moves "the steps of runs with functions of time";
        /// Halvings of the share of a run that belongs to a counted time.
        halvings_of_share: u32 = 40, moves "the steps of runs with functions of time";
        /// A count of steps may be this many times too large: steps are halved, and functions are enclosed over halved
        /// ones.
        uncertain_count: f64 = 8.0, moves "the steps of runs with functions of time";
        /// Largest factor from one step to the next.
        growth_of_steps: f64 = 2.0, moves "the steps of runs with functions of time";
    }
}
