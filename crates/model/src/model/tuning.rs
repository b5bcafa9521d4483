//! Constants of the room `model`, and those of all rooms up to it.

use symdiff::constants::{Constant, tuning};

tuning! {
    /// Models.
    "model" {
        /// Most parameters: every name of a formula is searched for among them.
        parameters: usize = 20_000, moves "which models are refused";
        /// Most uncertain parameters: every formula is checked at both ends of each.
        uncertain: usize = 1000, moves "which models are refused";
        /// Uncertain parameters up to which requirements on values are checked at every corner of their box; beyond,
        /// one parameter at a time.
        corners: usize = 5, moves "which models are refused";
        /// Standard deviations of a tolerance whose law does not give them.
        sigmas: f64 = 3.0, moves "statistics";
        /// Relative difference of two times that are taken for one.
        same_time: f64 = 1e-12, moves "which times are refused";
        /// Most points of a trajectory; a table takes more.
        trajectory_points: usize = 1000, moves "which models are refused";
        /// Times of a motion at which limits of excitations are compared.
        times_of_limits: usize = 101, moves "which models are refused";
        /// Share by which rates and means of limits may be beyond them: they are rounded.
        rounding_of_limits: f64 = 1e-9, moves "which models are refused";
        /// Lines of a random excitation that does not give their number: about 12 % from one to the next on a road, and
        /// less where the density is large.
        lines: usize = 100, moves "realisations of random excitations";
        /// Most lines of a random excitation.
        most_lines: usize = 10_000, moves "which models are refused";
        /// Largest seed.
        most_seeds: usize = 1_000_000, moves "which models are refused";
        /// Most steps of a simulation: a shorter step must be a slip.
        steps: f64 = 1e9, moves "which models are refused";
        /// Most rows of output: a shorter output step must be a slip.
        rows: f64 = 1e7, moves "which models are refused";
        /// Most instants at which a state is sampled in a motion.
        instants: f64 = 1e7, moves "which models are refused";
        /// Passes in which units of states are derived from one another.
        unit_passes: usize = 8, moves "units of states";
        /// Elements of a beam that does not give their number.
        beam_elements: usize = 4, moves "bounds of models with beams";
        /// Most elements of a beam.
        most_beam_elements: usize = 200, moves "which models are refused";
        /// Modes that are reported where the model does not give their number.
        modes: usize = 6, moves "results of `analysis: modes`";
        /// Frequencies of a response that does not give their number.
        frequencies: usize = 60, moves "results of responses";
        /// Most frequencies of a response.
        most_frequencies: usize = 2000, moves "which models are refused";
        /// Mass of a moving link of a URDF that has none and cannot be omitted, kg.
        link_mass: f64 = 1e-3, moves "bounds of robots with such links";
        /// Its moments of inertia, kg m².
        link_inertia: f64 = 1e-6, moves "bounds of robots with such links";
        /// Least radius of gyration of a link, squared, m².
        link_radius_squared: f64 = 1e-8, moves "bounds of robots with such links";
        /// Most processes, points of a call, and attempts: more must be a slip.
        most_of_black_box: usize = 10_000, moves "which models are refused";
        /// Seed of samples where none is named.
        seed: usize = 1, moves "samples of statistics";
    }
}

const _: () =
    assert!(TUNING.beam_elements <= TUNING.most_beam_elements && TUNING.frequencies <= TUNING.most_frequencies);

/// Constants of text, grammar, formats of robots, elements and models, room by room.
pub fn tuning() -> Vec<Constant> {
    [
        crate::syntax::tuning::Tuning::constants(),
        crate::grammar::tuning::Tuning::constants(),
        crate::robots::tuning::Tuning::constants(),
        crate::elements::tuning::Tuning::constants(),
        crate::expand::tuning::Tuning::constants(),
        Tuning::constants(),
    ]
    .concat()
}
