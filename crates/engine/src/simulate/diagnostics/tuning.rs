//! Constants of the room `simulate: diagnostics`.

use symdiff::constants::tuning;

tuning! {
    /// Reasons why a simulation fails or is doubtful.
    "simulate: diagnostics" {
        /// Operations of a term that are written out; deeper ones are omitted.
        deepest_term: usize = 4, moves "how terms that are not finite are written in messages";
        /// Share of a row below which another has no part in it.
        part_of_row: f64 = 1e-6, moves "messages of joints that fix one another";
        /// Share of the coordinates' scales by which the state is moved off a position of its own.
        off_position: f64 = 0.37, moves "messages of joints that fix one another";
        /// Most constraints for which the joints that fix one another are searched for: the search takes their number
        /// to the third power.
        most_constraints: usize = 400, moves "messages of joints that fix one another";
        /// Share of the deepest overlap that is left if nothing has a nearest side any more.
        nothing_left: f64 = 0.02, moves "warnings of contacts that were passed through";
        /// Share of the deepest overlap at which surfaces that passed each other would only have grazed.
        grazes: f64 = 0.9, moves "warnings of contacts that were passed through";
        /// Time over which the change of a gap's rate is taken, s.
        moment_of_rate: f64 = 1e-6, moves "warnings of contacts that overlap at the start";
        /// A contact is in balance with other forces where its gap accelerates by less than this share of its force
        /// over the mass of all bodies.
        overlapping_unbalanced: f64 = 0.5, moves "warnings of contacts that overlap at the start";
        /// Surfaces touch that overlap by no more than this share of the model's length: positions are rounded.
        rounded_gap: f64 = 1e-12, moves "warnings of contacts that overlap at the start";
        /// A residual beyond this is open, for an angle of 1 rad or the length of the model. Schemes that fulfil
        /// velocities drift by less.
        open_residual: f64 = 1e-4, moves "warnings of constraints that are open";
        /// Times at which constraints are compared, to find whether they depend on the time, s.
        tried_times: [f64; 3] = [0.0, 0.317, 1.93], moves "warnings of constraints that are open";
        /// Steps are examined where a pivot has lost this much of the range between its size at the pivot samples
        /// (1e-10) and the smallest that is trusted (1).
        suspect_pivot: f64 = 1e-8, moves "warnings of singular positions";
        /// A constraint whose independence (scaled) is less than this depends on the others. Interpolated positions
        /// are off by (hω)⁴/384, 1e-6 for twenty steps a turn.
        vanishing_independence: f64 = 1e-5, moves "warnings of singular positions";
        /// Divisions of the time between steps by the golden section: to 1e-8 of it.
        golden_sections: usize = 40, moves "warnings of singular positions";
        /// An independence does not vanish in a time in which it would have to fall this many times as steeply as it
        /// does anywhere around.
        steepest_fall: f64 = 4.0, moves "warnings of singular positions";
        /// Most steps that are examined, so that the search is short compared with the run.
        most_examined_steps: usize = 200, moves "warnings of singular positions";
        /// A derivative along a null vector below this share of the whole gradient is zero.
        negligible_derivative: f64 = 1e-7, moves "messages of undetermined starts";
    }
}
