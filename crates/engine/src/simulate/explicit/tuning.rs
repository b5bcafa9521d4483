//! Constants of the room `simulate: explicit`.

use symdiff::constants::tuning;

tuning! {
    /// Explicit integration.
    "simulate: explicit" {
        /// Corrections that close a step's end: each squares its distance from the constraints.
        closing_corrections: usize = 2, moves "gradients of explicit runs, within rounding";
        /// Largest change of functions of the positions in a step, as a share of their range: rows of a long step see
        /// some of it.
        most_passed: f64 = 0.75, moves "the steps of explicit runs";
        /// A position that moves by less than this share of the farthest movement of its kind counts as if it moved by
        /// that share.
        least_movement: f64 = 1e-3, moves "the steps of explicit runs";
        /// A coordinate that moves by less than this share of its typical size is at rest.
        at_rest: f64 = 1e-9, moves "the steps of explicit runs";
        /// Samples whose states are advanced together.
        run_width: usize = 32, moves "time only";
        /// Points of a step at which outputs are taken that are reduced to one number: between them they are cubics.
        places_of_reduced: usize = 16, moves "reduced outputs of explicit runs, also through events";
        /// Stages of a step that ends at an event end before it by this share of the step. Those as late as its end are
        /// less accurate than it, and would be on either side of the event by chance.
        before_event: f64 = 1e-4, moves "bounds of motions with events";
        /// Smallest step, as a share of the duration.
        smallest_step: f64 = 1e-12, moves "the steps of explicit runs";
        /// A switch is located to this share of the duration.
        located: f64 = 1e-10, moves "the steps of explicit runs";
        /// A step that ends within this share of itself beyond a switch ends there.
        at_the_end: f64 = 1e-6, moves "the steps of explicit runs";
        /// Where h times the largest eigenvalue is more than this, stability limits the step.
        largest_stable: f64 = 6.1, moves "which runs count as stiff";
        /// Steps limited by stability, with at most a few others between, at which a run is stiff.
        stiff_steps: usize = 15, moves "which runs count as stiff";
        /// Most other steps between those that stability limits.
        others_between: usize = 6, moves "which runs count as stiff";
        /// Safety of the step size.
        safety: f64 = 0.9, moves "the steps of explicit runs, also through events";
        /// Least factor from one step to the next.
        least_factor: f64 = 0.2, moves "the steps of explicit runs, also through events";
        /// Least error over the allowance that counts.
        least_ratio: f64 = 1e-12, moves "the steps of explicit runs, also through events";
        /// Largest factor from one step to the next.
        largest_factor: f64 = 6.0, moves "the steps of explicit runs, also through events";
    }
}
