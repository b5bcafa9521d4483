//! Constants of the room `simulate: modal`.

use symdiff::constants::tuning;

tuning! {
    /// Vibrations about a position.
    "simulate: modal" {
        /// Damping, or a lack of symmetry, below this share is rounding.
        no_damping: f64 = 1e-13, moves "modes, within rounding";
        /// Eigenvalues below this share of the largest frequency are zero.
        still_of_second_order: f64 = 1e-7, moves "modes, within rounding";
        /// Distance of inverse iteration from the eigenvalue, so that its matrix has an inverse.
        beside_eigenvalue: f64 = 1e-9, moves "modes, within rounding";
        /// Share of M's trace that motions without mass get.
        least_mass: f64 = 1e-12, moves "modes, and the stability of equilibria, within rounding";
        /// Rounding of a zero eigenvalue, as a share of the largest one of a block.
        zero_of_block: f64 = 1e-12, moves "modes, within rounding";
        /// Splitting of a double zero: ±√ε.
        still_of_first_order: f64 = 1e-7, moves "modes, within rounding";
        /// Eigenvalues whose imaginary part is below this share are real.
        real_eigenvalue: f64 = 1e-14, moves "modes, within rounding";
        /// Relative error of mean squares of responses.
        accuracy_of_squares: f64 = 1e-10, moves "responses to random excitations";
        /// Parts of a wide band that are integrated alone, before modes and kinks divide them: a decade has five.
        parts_of_band: f64 = 5.0, moves "responses to random excitations";
        /// Least frequency at which a band that begins at zero is divided, as a share of its end.
        least_frequency: f64 = 1e-4, moves "responses to random excitations";
        /// Shapes that are less alike than this may be of other modes: smaller changes of the parameters are made.
        alike_shapes: f64 = 0.8, moves "which samples' modes are followed in small steps";
    }
}
