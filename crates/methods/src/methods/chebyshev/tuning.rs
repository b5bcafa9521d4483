//! Constants of the room `methods: chebyshev`.

use symdiff::constants::tuning;

tuning! {
    /// Chebyshev bounds.
    "methods: chebyshev" {
        /// For more parameters a sparse grid is not tried where ends that were followed along gradients miss the
        /// tolerance: its nodes and its own search for ends grow with a power of their number.
        most_on_grids: usize = 12, moves "which models sparse grids are tried for";
        /// A combination's range is searched for as that of a polynomial of this degree, and more closely where that
        /// is too low.
        degree_of_combination: u8 = 8, moves "Chebyshev bounds of parameters that act through one number";
        /// Share of a combination's range by which its values near an end may exceed it.
        exceeded: f64 = 1e-6, moves "Chebyshev bounds of parameters that act through one number";
        /// Distance in ξ from an end at which a combination's values are examined.
        beside_end: f64 = 1e-3, moves "Chebyshev bounds of parameters that act through one number";
        /// Halvings that find where a combination has a value, to the last bit.
        halvings_of_combination: usize = 60, moves "Chebyshev bounds of parameters that act through one number";
        /// The least share of a tolerance that is left to the surrogate, whatever the steps take.
        least_share: f64 = 0.25, moves "Chebyshev bounds";
        /// Highest degree that a model can ask for.
        most_order: usize = 200, moves "which models are refused";
        /// Most nodes along an axis that a model can ask for.
        most_nodes: usize = 1000, moves "which models are refused";
        /// Most parameters for which full grids are the default.
        few_parameters: usize = 3, moves "Chebyshev bounds";
        /// Degree where a model asks for none.
        order: usize = 5, moves "Chebyshev bounds";
        /// Most parameters whose corners are examined in addition to the samples.
        most_corners: usize = 10, moves "Chebyshev bounds of outputs that are polynomials";
        /// Most parameters that act together for which ranges are found on a lattice.
        lattice_parameters: usize = 3, moves "Chebyshev bounds";
        /// Fewest intervals of the first lattice along an axis, by the number of its axes.
        least_intervals: [usize; 3] = [16, 8, 6], moves "Chebyshev bounds";
        /// Intervals for each degree of a function that is composed of polynomials, by the number of axes: it is
        /// examined more closely if it asks for it.
        intervals_of_composed: [usize; 3] = [2, 2, 1], moves "Chebyshev bounds";
        /// Intervals for each degree of polynomials, by the number of axes.
        intervals_of_polynomial: [usize; 3] = [4, 4, 2], moves "Chebyshev bounds";
        /// Points for each parameter at which the result of climbs is checked.
        checks_of_climbs: usize = 16, moves "Chebyshev bounds";
        /// Excess of a check over the range, as a share of it, above which the search begins anew.
        beyond_range: f64 = 1e-3, moves "Chebyshev bounds";
        /// A sum of functions may be off by this share of its range at the range's ends.
        sum_off: f64 = 1e-8, moves "Chebyshev bounds";
        /// Outputs that are searched together: each is known at the points of all. Of more, memory and time would grow
        /// with the square of their number.
        outputs_together: usize = 64, moves "Chebyshev bounds";
        /// Degree of the polynomials whose variance is decomposed, by the number of parameters: those of the outputs,
        /// which follow from the coordinates' at any number of points. For more parameters it is the surrogate's own
        /// basis.
        degrees_of_variance: [u8; 3] = [24, 12, 8], moves "which tolerance matters";
        /// Intervals for each degree on which widths without a parameter are found: nothing hangs on these but the
        /// order of the parameters.
        density_of_widths: usize = 4, moves "which tolerance matters";
        /// Most nodes of the polynomials of many parameters that act through few numbers.
        most_nodes_of_combined: usize = 500, moves "which tolerance matters";
        /// Highest degree of the polynomials of many parameters that act through few numbers.
        most_degree_of_combined: u8 = 6, moves "which tolerance matters";
        /// Highest degree in a parameter, by the number of parameters: one costs a node each, many their products.
        highest_degrees: [u8; 3] = [128, 48, 24], moves "bounds within a tolerance";
        /// Highest degree in a parameter, of more parameters.
        highest_of_many: u8 = 16, moves "bounds within a tolerance";
        /// Degree from which on surpluses show how high a degree would have to be.
        telling_degree: u8 = 16, moves "bounds within a tolerance";
        /// Degrees over which surpluses are compared to estimate how high a degree would have to be.
        compared_degrees: u8 = 8, moves "bounds within a tolerance";
        /// A box is split where the expected surplus of a higher degree than is allowed exceeds this multiple of the
        /// largest allowed one.
        split: f64 = 4.0, moves "bounds within a tolerance";
        /// Points spread over a box that are validation samples of a new surrogate, at least.
        least_spread: usize = 4, moves "bounds within a tolerance";
        /// Share of the allowed error that a surplus may be: it is met with its safety.
        met: f64 = 0.5, moves "bounds within a tolerance";
        /// Most nodes of a full grid, or of a sparse one in its place.
        most_nodes_of_full: usize = 100_000, moves "which orders a sparse grid stands for";
    }
}

const _: () = assert!(
    TUNING.least_intervals.len() == TUNING.lattice_parameters
        && TUNING.intervals_of_composed.len() == TUNING.lattice_parameters
        && TUNING.intervals_of_polynomial.len() == TUNING.lattice_parameters
);
