//! Constants of the room `applications: verify`.

use symdiff::constants::tuning;

tuning! {
    /// Verification by manufactured motions.
    "applications: verify" {
        /// Instants at which powers are taken.
        instants_of_power: usize = 64, moves "balances of power";
        /// Instants at which derivatives are checked, as shares of the motion.
        instants_of_derivatives: [f64; 2] = [0.31, 0.77], moves "checks of derivatives";
        /// Differences are over this share of a variable's scale to both sides: their errors are its square, 1e-24, of
        /// the third derivative, and the rounding of 32 digits over it, 1e-20.
        share_of_difference: f64 = 1.0 / (1_u64 << 40) as f64, moves "checks of derivatives";
        /// A step of the Newton matrix is this share of the motion.
        step_of_matrix: f64 = 1.0 / 64.0, moves "checks of derivatives";
        /// Degree of the polynomials that follow the nominal motion.
        following_degree: usize = 8, moves "manufactured motions";
        /// Coefficients below this share of the largest are rounding, which derivatives would amplify.
        rounding_of_coefficients: f64 = 3e-16, moves "manufactured motions";
        /// Rows in which the nominal motion is followed.
        rows_of_nominal: usize = 1 << 10, moves "observed orders";
        /// Most steps a row; if orders do not show with this many, the motion is shortened: fast vibrations take short
        /// steps.
        few_steps: usize = 1 << 9, moves "observed orders";
        /// Share to which a motion is shortened.
        shorter: f64 = 1.0 / 16.0, moves "observed orders";
        /// Times that a motion is shortened, at most.
        shortenings: i32 = 3, moves "observed orders";
        /// Most steps a row along the whole motion, if shortening does not help.
        many_steps: usize = 1 << 11, moves "observed orders";
        /// Nodes in time of a manufactured motion.
        nodes: usize = 96, moves "manufactured motions";
        /// Nodes of the loads: more if functions are steep.
        nodes_of_loads: [usize; 2] = [96, 384], moves "manufactured motions";
        /// Halvings of the part of the run, if polynomials do not follow the motion or its series is not resolved.
        halvings_of_motion: usize = 8, moves "manufactured motions";
        /// Largest distance of polynomials from the nominal motion, as a share of a coordinate's range.
        near_nominal: f64 = 0.02, moves "manufactured motions";
        /// Coordinates that hardly move, by less than this share of their scale, swing by as much: a motion at rest
        /// would show nothing. The smaller ones are used if the first has no smooth motion: a swing may leave a
        /// clearance or the steep part of friction.
        swings: [f64; 3] = [1e-2, 1e-4, 1e-6], moves "manufactured motions";
        /// Constraints are fulfilled if residuals are less than this share of the coordinates' scale.
        closed_constraint: f64 = 1e-12, moves "manufactured motions";
        /// Most corrections that move a node onto the constraints.
        corrections: usize = 40, moves "manufactured motions";
        /// A series is resolved if its last quarter is less than this share of its size.
        resolved_series: f64 = 1e-11, moves "manufactured motions";
        /// A series of loads, which have accelerations in them, is resolved if its last quarter is less than this
        /// share of its size.
        loads_resolved: f64 = 1e-9, moves "manufactured motions";
        /// Intervals between the rows in which errors are taken.
        rows_of_errors: usize = 4, moves "observed orders";
        /// Errors below these shares of a quantity's size are rounding's, whatever the model: of positions,
        /// velocities, accelerations and reactions.
        rounding_of_errors: [f64; 4] = [1e-13, 1e-12, 1e-10, 1e-10], moves "observed orders";
        /// Share of a part that is omitted at both ends: the manufactured motion is near the nominal one, and switches
        /// at other instants.
        margin: f64 = 0.1, moves "which part of a motion is manufactured";
        /// Parts that are tried, the longest first.
        tried_parts: usize = 6, moves "which part of a motion is manufactured";
        /// Parts of a run if no condition is seen to switch: friction at rest is steep in some only.
        parts_without_switch: usize = 8, moves "which part of a motion is manufactured";
        /// Shortest part, in rows of the nominal motion.
        shortest_part: usize = 16, moves "which part of a motion is manufactured";
        /// Times that a part of a run after the first is halved.
        halvings_of_part: usize = 3, moves "which part of a motion is manufactured";
    }
}
