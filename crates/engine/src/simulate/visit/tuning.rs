//! Constants of the room `simulate: visit`.

use symdiff::constants::tuning;

tuning! {
    /// Motions of mechanisms that are positioned instead of integrated.
    "simulate: visit" {
        /// Corrections of a coordinate, in its scale, that do not leave the branch.
        near_correction: f64 = 0.05, moves "which samples are followed in small steps";
        /// Largest second correction, as a share of the first: above it, another root is nearer than four corrections.
        contracting: f64 = 0.25, moves "which samples are followed in small steps";
        /// First corrections below this, in the scales, say nothing of roots.
        negligible_correction: f64 = 1e-9, moves "which samples are followed in small steps";
        /// Times that the way to a row is halved at most.
        halvings_of_way: u32 = 16, moves "which samples are followed in small steps";
        /// Steps from the nominal parameters to those of a sample whose modes are not like the nominal ones.
        continuation_steps: usize = 8, moves "which samples' modes are followed";
    }
}
