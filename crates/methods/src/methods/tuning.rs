//! Constants of the room `methods`.

use symdiff::constants::{Constant, tuning};

tuning! {
    /// Bounds of outputs.
    "methods" {
        /// Simulations that one order of a jet counts as in progress reports.
        jet_work: usize = 5, moves "progress bars";
        /// ξ beyond the box by less is of its end.
        beyond_box: f64 = 1e-12, moves "kept surrogates at ends of the box";
        /// Orders of the polynomials in a proof of the motion, by the number of parameters: pieces and coefficients
        /// grow with powers of that number.
        orders_of_motion: [usize; 4] = [14, 12, 12, 8], moves "proven bounds, and time";
        /// Orders of the polynomials in a proof of the scheme, by the number of parameters. (Slider crank, ±1 % of
        /// one: 8, 12 and 16 reach 0.51, 0.71 and 0.72 s in one piece.).
        orders_of_scheme: [usize; 3] = [0, 12, 6], moves "proven bounds, and time";
        /// Errors below this share of an output's range drown in rounding.
        least_tolerance: f64 = 1e-8, moves "which models are refused";
        /// Simulations that one method may ask for.
        most_simulations: f64 = 1e7, moves "which models are refused";
        /// Error relative to the output's range that is aimed at where a degree is to be chosen and no tolerance is
        /// given.
        tolerance: f64 = 1e-3, moves "bounds of models that ask for no tolerance";
        /// Multiple of a polynomial's error at validation samples that it may have for a function with a kink: it is
        /// worst at the kink, and there they need not be.
        between_kinks: f64 = 3.0, moves "which bands are contradicted by values";
        /// Most points of a scan along an axis.
        most_points: usize = 1_000_000, moves "which models are refused";
        /// Points along an axis where a model asks for none, the paper's.
        points: usize = 30, moves "scanned bounds of models that ask for no number";
        /// Most coefficients of a Taylor polynomial.
        most_coefficients: f64 = 1e5, moves "which models are refused";
        /// Highest order of a Taylor polynomial.
        most_taylor_order: usize = 50, moves "which models are refused";
        /// Degree where a model asks for none, the paper's.
        taylor_order: usize = 2, moves "Taylor bounds of models that ask for no order";
        /// An output whose span halved steps make smaller than this share of it is conserved: with a scheme of second
        /// order they remove three quarters of a span that is error alone.
        conserved: f64 = 0.3, moves "errors of bounds";
        /// Corners, at most, that slopes name as further samples.
        corners_of_slopes: usize = 8, moves "errors of bounds";
        /// Width of an output's range, relative to its values, that is rounding.
        rounding_of_width: f64 = 1e-10, moves "errors of bounds, and bounds of outputs that are polynomials";
    }
}

/// Constants of bounds, room by room.
pub fn tuning() -> Vec<Constant> {
    [
        Tuning::constants(),
        crate::methods::chebyshev::tuning::Tuning::constants(),
        crate::methods::chebyshev::adaptive::tuning::Tuning::constants(),
        crate::methods::chebyshev::composition::tuning::Tuning::constants(),
        crate::methods::chebyshev::segments::tuning::Tuning::constants(),
    ]
    .concat()
}
