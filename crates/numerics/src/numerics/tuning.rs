//! Constants of the room `numerics`.

use symdiff::constants::{Constant, tuning};

tuning! {
    /// Polynomials, searches and errors.
    "numerics" {
        /// Second differences may grow by this factor from one sample to the next if the response is smooth.
        growth: f64 = 1.5, moves "scanned bounds";
        /// Largest further factor, by which second differences before them grow.
        most_growth: f64 = 8.0, moves "scanned bounds";
        /// The slope at the first of a row of samples is known to this share of their second difference, or better;
        /// and so is the second difference of three.
        unsure: f64 = 0.25, moves "scanned bounds";
        /// A bound is good when it is this close to an attained value, relative to the width of the attained range.
        bernstein_tolerance: f64 = 1e-3, moves "interval ranges of polynomials";
        /// Approximate number of averages after which the bound is taken as it stands.
        bernstein_work: usize = 1 << 22, moves "interval ranges of polynomials";
        /// Fewest times that a box may be split, however many numbers are averaged.
        bernstein_splits: usize = 64, moves "interval ranges of polynomials";
        /// Distances from an end at which a jump is searched for: from 2 downwards, each a quarter of the one before.
        distances: i32 = 26, moves "ranges beside jumps";
        /// A drop by this share of the range's width may be a jump.
        drop: f64 = 1e-3, moves "ranges beside jumps";
        /// Halvings after which two numbers in [−1, 1] have no other between them.
        halvings_of_brink: usize = 64, moves "ranges beside jumps";
        /// Most rounds over all multipliers of constraints in a search for the cheapest sizes.
        rounds_of_cheapest: usize = 400, moves "tolerances that are found";
        /// Change of the multipliers at which they have settled.
        settled_multipliers: f64 = 1e-10, moves "tolerances that are found";
        /// Halvings of the logarithm of a multiplier.
        halvings_of_multiplier: usize = 80, moves "tolerances that are found";
        /// Least multiplier that is searched for, as a share of the first guess.
        smallest_multiplier: f64 = 1e-12, moves "tolerances that are found";
        /// Multiple of the multiplier at which the constraint alone makes all sizes as small as they may be, up to
        /// which the search goes.
        largest_multiplier: f64 = 1e6, moves "tolerances that are found";
        /// Least rate on the way, as a share of the mean over the samples: where the course all but rests, values do
        /// not determine times.
        slowest_course: f64 = 0.05, moves "bounds of coordinates that turn";
        /// Fewest rows of a course's way.
        fewest_rows: usize = 4, moves "bounds of coordinates that turn";
        /// Rows that are taken on either side of a course's way, if it has fewer itself.
        fewest_rows_beside: usize = 32, moves "bounds of coordinates that turn";
        /// Times within a piece of a course at which it has to rise.
        looks: usize = 4, moves "bounds of coordinates that turn";
        /// Rows that a piece is made through, at either side, and its terms: a value and a rate of each.
        rows_beside: usize = 2, moves "bounds of coordinates that turn";
        /// The last step of the search for a time, as a share of the piece.
        close_time: f64 = 1e-7, moves "bounds of coordinates that turn";
        /// Most steps of the search for the time at which a course has a value.
        steps_to_time: usize = 64, moves "bounds of coordinates that turn";
        /// Share of the rate over all higher degrees that the rate at the highest has at least.
        caution: f64 = 0.7, moves "errors of bounds";
        /// Rate of decay above which coefficients count as not falling at all.
        slowest_decay: f64 = 0.99, moves "errors of bounds";
        /// A validation sample whose value lies within this share of the band's width from its end carries that end.
        carries: f64 = 0.25, moves "errors of bounds";
        /// Factor by which the estimates of the steps' error may be wrong.
        safety_of_steps: f64 = 1.25, moves "errors of bounds, of reduced outputs, of statistics and of ends over functions of time";
        /// Factor by which the estimates of the surrogate's error may be wrong.
        safety_of_surrogate: f64 = 2.0, moves "errors of bounds";
        /// Share of a neighbour's error below which no error falls.
        of_neighbour: f64 = 0.5, moves "errors of bounds";
        /// Share of the largest error so far below which no error falls.
        of_largest: f64 = 0.02, moves "errors of bounds";
        /// A surrogate's error, its safety included, beyond this share of the width means that it does not follow the
        /// response.
        lost: f64 = 0.5, moves "errors of bounds";
        /// The whole error beyond this share of the output's span means that a bound does not follow the response.
        far_off: f64 = 0.25, moves "errors of bounds";
        /// A surrogate's error below this share of the output's span is negligible, however narrow the band is there.
        small_error: f64 = 1e-3, moves "errors of bounds";
        /// Factor by which an error that is large relative to the band may be wrong.
        doubt: f64 = 2.0, moves "errors of bounds";
        /// A simulated value that lies outside of a band by less than this share of its own size does so by rounding.
        rounding_of_values: f64 = 1e-12, moves "errors of bounds";
        /// First distance of neighbours in the search near a known extreme, at most.
        near_extreme: f64 = 0.1, moves "ranges, within their error";
        /// An end is found when a step changes less than this share of the range's width.
        settled_end: f64 = 1e-10, moves "ranges, within their error";
        /// An end is also found when a step changes less than this share of a difference that does not matter.
        settled_of_least: f64 = 1.0 / 64.0, moves "ranges, within their error";
        /// The best point is the peak if the quadratic's peak is no further from it than this.
        stays: f64 = 1e-9, moves "ranges, within their error";
        /// Neighbours that are nearer than this do not distinguish a peak from the best point.
        finest: f64 = 1e-5, moves "ranges, within their error";
        /// Most steps of the search for an end of a range.
        steps_to_end: usize = 16, moves "ranges, within their error";
        /// A lattice is too coarse along an axis if a value differs by more than this share of the range from the
        /// prediction of its neighbours: fewer than eight points to a wave.
        coarse: f64 = 0.03, moves "ranges, within their error";
        /// Excess of a check over the range, as a share of it, above which the lattice is made finer.
        beyond_range: f64 = 1e-4, moves "ranges, within their error";
        /// Points of a lattice for each point of its check.
        lattice_points_a_check: usize = 4, moves "ranges, within their error";
        /// Fewest points of the check of a lattice.
        least_checks: usize = 8, moves "ranges, within their error";
        /// Local extremes that are refined at once for each end.
        candidates: usize = 6, moves "ranges, within their error";
        /// Times that more local extremes are refined, if one that is left may reach beyond the best.
        more_candidates: usize = 10, moves "ranges, within their error";
        /// Share of the range's width by which one that is left may reach beyond the best: a range that is full of
        /// turns has many alike.
        left_candidate: f64 = 1e-5, moves "ranges, within their error";
        /// Most points of a lattice, by the number of parameters.
        lattice_points: [usize; 3] = [4097, 16_641, 17_576], moves "ranges, within their error";
        /// Most points of lattices that are stored for further functions.
        kept_points: usize = 1 << 18, moves "time and memory";
        /// Most terms of a polynomial that is fitted to values and derivatives: the work grows with their cube.
        most_terms: usize = 1000, moves "surrogates of many parameters";
        /// Equations for each term, at least: with two, the missing terms went into products by tens of their size.
        equations_a_term: usize = 4, moves "surrogates of many parameters";
        /// Weight of a derivative relative to that of a value: terms of second degree have derivatives of at most 4.
        weight_of_derivative: f64 = 0.5, moves "surrogates of many parameters";
        /// Added to the diagonal of the normal equations, as a share of its largest entry: terms that samples do not
        /// distinguish share the response.
        ridge: f64 = 1e-10, moves "surrogates of many parameters";
        /// Most sweeps over the axes in a search for a local maximum.
        sweeps: usize = 30, moves "surrogates of many parameters";
        /// Rows of the polynomial that gives values between rows.
        rows_of_interpolation: usize = 6, moves "values between rows, and their errors";
        /// Rows of the coarser polynomial that gives its error.
        rows_of_coarser: usize = 4, moves "values between rows, and their errors";
        /// Rows of the polynomials on either side of a time, which differ next to an impact.
        rows_of_side: usize = 3, moves "fits of motions that switch";
        /// Nearer than this share of a row's distance is in the row.
        in_row: f64 = 1e-9, moves "values between rows, and their errors";
        /// Least spacing over that in the middle of the box.
        at_face: f64 = 0.3, moves "ranges, within their error";
        /// Diagonal entries of R below this share of the largest are zero.
        zero_diagonal: f64 = 1e-10, moves "fits, within rounding";
        /// A sample with this leverage or more is met by any fit, which says nothing of a fit without it.
        most_leverage: f64 = 1.0 - 1e-9, moves "fits, within rounding";
        /// Highest level of nested nodes, which is a degree.
        max_level: u8 = 128, moves "which degrees sparse grids can have";
        /// Cost of a violated limit, in multiples of the goals' change over the box.
        penalty: f64 = 1e4, moves "nominal values that are found";
        /// Pivots by the largest coefficient, for each row and column; those after them are by Bland's rule, which
        /// never circles.
        pivots_by_largest: usize = 20, moves "nominal values that are found";
        /// Most pivots of a linear program, for each row and column.
        most_pivots: usize = 200, moves "nominal values that are found";
        /// Coefficients of a linear program below this are rounding.
        rounding_of_coefficients: f64 = 1e-11, moves "nominal values that are found";
        /// Orders below this are not that of the scheme at all.
        least_order: f64 = 1.5, moves "errors of time steps";
        /// Below this order nothing converges, and the difference of two steps does not show their error.
        no_order: f64 = 0.25, moves "errors of time steps";
        /// Factor on the largest difference, where the order is not that of the scheme.
        of_differences: f64 = 1.5, moves "errors of time steps";
        /// Factor by which the next neighbours of a peak's best point are nearer.
        nearer: f64 = 0.25, moves "ranges, within their error";
        /// Factor by which neighbours that look beyond a peak are further away.
        further: f64 = 2.0, moves "ranges, within their error";
        /// Largest distance of neighbours that look beyond a peak, in ξ.
        furthest: f64 = 0.5, moves "ranges, within their error";
        /// Most axes for which a peak is searched for on all faces of the box.
        most_faces: usize = 3, moves "ranges, within their error";
        /// Most changes of faces for each axis in the search for a peak.
        changes_of_faces: usize = 8, moves "ranges, within their error";
        /// First shift of a direction that bends upwards, as a share of the bends.
        shift: f64 = 1e-3, moves "ranges, within their error";
        /// A step that gains less than this share of all gain gains nothing.
        settled_gain: f64 = 1e-12, moves "ranges, within their error";
        /// Intervals of the grid on which a polynomial is ranged, for each degree.
        density: usize = 16, moves "tight ranges of polynomials, within their error";
        /// Fewest intervals for one, two and three parameters: they make the margins of low degrees small too, as far
        /// as it costs little. For more parameters there is no grid.
        min_intervals: [usize; 3] = [512, 128, 64], moves "tight ranges of polynomials, within their error";
        /// Most points of a grid: three parameters of degree 6.
        max_grid_points: usize = 1 << 20, moves "tight ranges of polynomials, within their error";
        /// Most intervals of an integral.
        most_intervals: usize = 4000, moves "accuracy of integrals";
        /// Rows of which less than this share is left are dependent.
        dependent_row: f64 = 1e-9, moves "which constraints count as dependent";
        /// Most axes of which all combinations of middle and ends are simulated.
        few_axes: usize = 3, moves "validation samples";
        /// Corners that are simulated as validation samples, of more axes.
        most_corners: usize = 16, moves "validation samples";
        /// Points inside the box at which a surrogate is compared with simulations that it was not made from.
        held_out: usize = 8, moves "validation samples";
        /// Most samples that are simulated at once.
        largest_shard: usize = 16384, moves "memory of scans";
        /// Fewest samples of a shard, but for the last.
        least_shard: usize = 2048, moves "memory of scans";
        /// Points at which functions are tried to be sums of functions of fewer parameters.
        tried_points: usize = 4, moves "which parameters act together";
        /// A difference below this share of the values' range counts as zero, rounding aside.
        no_difference: f64 = 1e-10, moves "which parameters act together";
        /// Rounding of a difference, as a share of the largest value.
        rounding_of_difference: f64 = 256.0 * f64::EPSILON, moves "which parameters act together";
        /// Lower degrees along an axis are too few to show how fast coefficients fall.
        least_degree: usize = 6, moves "which degrees tell how fast coefficients fall";
        /// Shares of a sum that is one may round to more.
        rounding_of_shares: f64 = 1e-9, moves "which indices a grid has, within rounding";
        /// Bins have equal factors in bands that are wider than this factor.
        wide_bin: f64 = 10.0, moves "lines of random excitations";
        /// Points a bin at which the density is summed up, to divide the band.
        points_a_bin: usize = 64, moves "lines of random excitations";
        /// Relative error of variances of bins.
        accuracy_of_bins: f64 = 1e-10, moves "lines of random excitations";
        /// Most coefficients of the tensor in which the tight range is sought; beyond, the range is taken term by
        /// term, and how much too wide it is is unknown.
        max_tensor: usize = 1 << 16, moves "tight ranges of Taylor polynomials";
        /// Rows before and after the examined one.
        rows_of_shift: usize = 4, moves "errors of time steps of oscillations";
        /// Variance of the velocity over the rows near one, relative to its mean square, from which on a shift in time
        /// can be distinguished from an offset.
        turns: f64 = 0.25, moves "errors of time steps of oscillations";
    }
}

/// Constants of numerical methods, room by room.
pub fn tuning() -> Vec<Constant> {
    [
        Tuning::constants(),
        crate::numerics::functions_of_time::tuning::Tuning::constants(),
        crate::numerics::paving::tuning::Tuning::constants(),
        crate::numerics::search::tuning::Tuning::constants(),
        crate::numerics::statistics::tuning::Tuning::constants(),
    ]
    .concat()
}
