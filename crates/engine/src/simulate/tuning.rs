//! Constants of the room `simulate`.

use symdiff::constants::{Constant, tuning};

tuning! {
    /// Simulations of many samples at once.
    "simulate" {
        /// Weight of an angle as dependent coordinate against a position. Angles are preferred as independent: they
        /// grow without bound, so that they determine the configuration over whole turns.
        angles_stay: f64 = 0.3, moves "which coordinates are independent, within rounding";
        /// Most lanes whose loops are closed at once.
        closure_width: usize = 32, moves "time only";
        /// Results that a message lists at most.
        derived_listed: usize = 8, moves "which results a message lists";
        /// Steps that the force on a mode is extrapolated from, to find jumps of it.
        jump_points: usize = 4, moves "reports of vibrations that begin after the start";
        /// Least difference of a jump from the extrapolated force, as a multiple of the largest difference of the steps
        /// before.
        jump_factor: f64 = 10.0, moves "reports of vibrations that begin after the start";
        /// Steps before a suspected jump with whose differences it is compared.
        jump_steps: usize = 6, moves "reports of vibrations that begin after the start";
        /// Steps of a tile between two questions: a question takes some nanoseconds, a step of a large mechanism a
        /// millisecond.
        steps_between_questions: usize = 8, moves "how soon an interrupted run ends";
        /// Largest mechanism whose modes are computed, in coordinates.
        most_coordinates: usize = 400, moves "which fast vibrations are reported";
        /// Most modes that are followed over the whole motion: the fastest.
        most_watched: usize = 40, moves "which fast vibrations are reported";
        /// Modes are examined if their frequency times the step is above this.
        slowest_watched: f64 = 0.2, moves "which fast vibrations are reported";
        /// Eigenvalues of Φ_qᵀ Φ_q below this share of the largest belong to motions that the constraints allow.
        allowed_motion: f64 = 1e-12, moves "which fast vibrations are reported";
        /// Samples that are assembled together where nothing else is asked.
        assembled_at_once: usize = 8, moves "time only";
        /// Steps from the nominal parameters to those of a sample that is far from them.
        continuation_steps: usize = 16, moves "which samples are assembled, and which equilibria are found";
        /// Degree of the motions' polynomials, by the number of parameters.
        switch_degrees: [usize; 3] = [12, 6, 4], moves "which unmet switches are found";
        /// Samples for each parameter in a search for unmet switches, of more parameters than polynomials are made
        /// for.
        switch_samples: usize = 24, moves "which unmet switches are found";
        /// Intervals of the first look over the box, by the number of parameters.
        switch_intervals: [usize; 3] = [32, 10, 6], moves "which unmet switches are found";
        /// Intervals of the first look over the time between two rows.
        intervals_of_time: usize = 4, moves "which unmet switches are found";
        /// A switch is examined more closely where its least distance from zero is less than this share of its range.
        switch_near: f64 = 0.25, moves "which unmet switches are found";
        /// Values of a switch below this share of its largest value are zero.
        switch_zero: f64 = 1e-9, moves "which unmet switches are found";
        /// Rows within which the same sign at another sample is the same event.
        switch_rows: usize = 2, moves "which unmet switches are found";
        /// Reciprocal of the share of all rows within which the same sign at another sample is the same event.
        switch_share_of_rows: usize = 20, moves "which unmet switches are found";
        /// Most points with a sign of a switch that are simulated because they are the first ones.
        most_first: usize = 6, moves "which unmet switches are found";
        /// Most points with a sign of a switch that are simulated because they go furthest.
        most_furthest: usize = 6, moves "which unmet switches are found";
        /// Points at which switches are evaluated at once.
        switch_width: usize = 32, moves "time only";
        /// Rows that the search for a switch simulates at once.
        switch_block: usize = 64, moves "time only";
        /// Largest ratio of penetration depths for which a validation sample counts as evidence: one that only grazes
        /// a post says little of those that hit it.
        as_deep: f64 = 2.0, moves "which unmet switches are found";
        /// A sign that samples have by less than this share of the other is searched for further on.
        shallow_switch: f64 = 0.1, moves "which unmet switches are found";
    }
}

/// Constants of simulations, room by room.
pub fn tuning() -> Vec<Constant> {
    [
        Tuning::constants(),
        crate::simulate::adjoint::tuning::Tuning::constants(),
        crate::simulate::control::tuning::Tuning::constants(),
        crate::simulate::diagnostics::tuning::Tuning::constants(),
        crate::simulate::drive::tuning::Tuning::constants(),
        crate::simulate::drive::reduction::tuning::Tuning::constants(),
        crate::simulate::enclosure::tuning::Tuning::constants(),
        crate::simulate::enclosure::motion::tuning::Tuning::constants(),
        crate::simulate::ensemble::tuning::Tuning::constants(),
        crate::simulate::events::tuning::Tuning::constants(),
        crate::simulate::explicit::tuning::Tuning::constants(),
        crate::simulate::features::tuning::Tuning::constants(),
        crate::simulate::modal::tuning::Tuning::constants(),
        crate::simulate::start::tuning::Tuning::constants(),
        crate::simulate::statics::tuning::Tuning::constants(),
        crate::simulate::step::tuning::Tuning::constants(),
        crate::simulate::time_functions::tuning::Tuning::constants(),
        crate::simulate::visit::tuning::Tuning::constants(),
    ]
    .concat()
}
