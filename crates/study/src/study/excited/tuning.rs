//! Constants of the room `study: excited`.

use symdiff::constants::tuning;

tuning! {
    /// Ends over functions of time.
    "study: excited" {
        /// Times that a step of a climb that is worse is halved.
        halvings: i32 = 4, moves "ends over functions of time";
        /// Least gain of a step, as a share of the gain that the first one promised.
        worth_of_step: f64 = 1e-4, moves "ends over functions of time";
        /// If the end of a simulation differs from that promised by its gradient by this share of the promised change,
        /// the output is not linear.
        bent: f64 = 1e-3, moves "ends over functions of time";
        /// Outputs and rows whose kernels are in memory at once.
        kernels_at_once: usize = 128, moves "memory of searches over functions of time";
        /// Rows in which an output's end is followed first; those between learn from them.
        followed_rows: usize = 8, moves "ends over functions of time";
        /// Most steps of a climb over functions of time.
        steps_of_climb: usize = 24, moves "ends over functions of time";
        /// Most steps of a climb from the function of a neighbouring row.
        steps_of_learnt: usize = 8, moves "ends over functions of time";
        /// How often ends are climbed to from elsewhere.
        rounds: usize = 3, moves "ends over functions of time";
        /// Rows in which the steps' error of ends that are not followed is measured.
        checked_rows: usize = 16, moves "errors of ends over functions of time";
        /// Error of steps over the change by halved ones if a function jumps: by the scheme, a jump takes a step.
        first_order: f64 = 2.0, moves "errors of ends over functions of time";
        /// Iterations of Newton's method: each squares the error.
        newton_rounds: usize = 3, moves "ends over functions of time";
    }
}
