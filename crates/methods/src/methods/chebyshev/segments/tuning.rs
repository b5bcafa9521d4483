//! Constants of the room `methods: chebyshev: segments`.

use symdiff::constants::tuning;

tuning! {
    /// Chebyshev bounds through events.
    "methods: chebyshev: segments" {
        /// A sample at a share of the largest margin weighs as one on the surface over this share and it.
        near_surface: f64 = 0.05, moves "Chebyshev bounds through events";
        /// Highest total degree of a surface by the number of parameters; of more it is the last.
        surface_degrees: [usize; 4] = [8, 5, 3, 2], moves "Chebyshev bounds through events";
        /// Samples for each term of a fit.
        samples_a_term: f64 = 1.5, moves "Chebyshev bounds through events";
        /// Climbs for either end of an output.
        climbs: usize = 3, moves "Chebyshev bounds through events";
        /// Distance along some axis at which climbs in one segment begin, in ξ.
        climbs_apart: f64 = 0.3, moves "Chebyshev bounds through events";
        /// First radius of the trust region, in ξ.
        radius: f64 = 0.15, moves "Chebyshev bounds through events";
        /// First radius of the trust region in the share of the segment, and the largest.
        radius_of_share: f64 = 0.25, moves "Chebyshev bounds through events";
        /// Radius at which a climb ends, in ξ.
        least_radius: f64 = 1e-6, moves "Chebyshev bounds through events";
        /// Radii in ξ and in the share after a move that was none, over those before it.
        shrinks: (f64, f64) = (0.5, 0.25), moves "Chebyshev bounds through events";
        /// Radii in ξ and in the share after a move, over those before it.
        grows: (f64, f64) = (2.0, 1.5), moves "Chebyshev bounds through events";
        /// Shares of a segment to either side of a climb's end, one after the other, through which parabolas are laid.
        shares_of_ridge: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5], moves "Chebyshev bounds through events";
        /// Moves of a climb, at most.
        moves: usize = 120, moves "Chebyshev bounds through events";
        /// Difference by which slopes are taken.
        step_of_slopes: f64 = 1e-6, moves "Chebyshev bounds through events";
        /// Moves back to a surface, at most.
        returns: usize = 4, moves "Chebyshev bounds through events";
        /// Share of a segment by which a surface may be missed.
        missed: f64 = 1e-11, moves "Chebyshev bounds through events";
        /// Distance of a seed beyond the ends of a segment, as a share of it, at most.
        beyond_of_seed: f64 = 1e-6, moves "Chebyshev bounds through events";
        /// A point is moved back inside of a surface by a little more than it is beyond: by this factor.
        moved_back: f64 = 1.001, moves "Chebyshev bounds through events";
        /// The lattice ends inside of a surface by this share of the surface's error.
        on_end: f64 = 1e-3, moves "Chebyshev bounds through events";
        /// Rounds in which samples are added to parts.
        rounds_of_samples: usize = 2, moves "Chebyshev bounds through events";
        /// Layers that are cut off one after the other, at most.
        layers: usize = 3, moves "Chebyshev bounds through events";
        /// Rounds in which points that are far outside of samples are added.
        coverings: usize = 6, moves "Chebyshev bounds through events";
        /// A polynomial suffices whose leave-one-out errors are no more than this share of the values' range.
        enough: f64 = 1e-3, moves "Chebyshev bounds through events";
        /// Values that differ by this share of how large they are anywhere in the motion are the same.
        rounding: f64 = 1e-9, moves "Chebyshev bounds through events";
        /// Total degree with which polynomials of many parameters begin.
        first_degree: usize = 2, moves "Chebyshev bounds through events";
        /// Highest degree in a parameter of polynomials of many parameters.
        highest_degree: u8 = 12, moves "Chebyshev bounds through events";
        /// Most terms of a polynomial of many parameters.
        most_terms: usize = 1000, moves "Chebyshev bounds through events";
        /// Largest ratio of successive coefficients of an axis, if two of them give more.
        slowest_fall: f64 = 0.9, moves "Chebyshev bounds through events";
        /// Degrees that are tried to a tolerance.
        degrees: [usize; 6] = [2, 3, 4, 6, 8, 12], moves "Chebyshev bounds through events";
        /// Parameters from which on terms are added one by one: a full grid of fewer takes less time.
        many_parameters: usize = 3, moves "Chebyshev bounds through events";
        /// Rows of many parameters are bounded again if the polynomials' error is at most this multiple of one that
        /// meets a goal.
        likely: f64 = 2.0, moves "Chebyshev bounds through events";
        /// A layer reaches to this share of the depth of the part that it is cut off from: next to the surface
        /// everything goes with the root of the depth.
        layer: f64 = 1.0 / 150.0, moves "Chebyshev bounds through events";
        /// Least total degree in a part.
        least_degree: usize = 3, moves "Chebyshev bounds through events";
        /// Highest total degree in a part, by the number of parameters; of more it is the last.
        degrees_of_part: [usize; 4] = [8, 5, 3, 2], moves "Chebyshev bounds through events";
        /// Samples for each parameter that show the parts of instants.
        samples_of_parts: usize = 24, moves "Chebyshev bounds through events";
        /// Points spread over the box that give the share of it in which an event occurs.
        points_of_share: usize = 1 << 14, moves "shares of the box";
        /// Factor on the share of a volume that such points are expected to miss.
        missed_share: f64 = 2.0, moves "shares of the box";
        /// Difference by which slopes of surfaces are taken.
        step_of_surfaces: f64 = 1e-6, moves "errors of Chebyshev bounds through events";
        /// An end near a surface is moved with it if it is nearer than this multiple of the surface's error.
        near_end: f64 = 2.0, moves "errors of Chebyshev bounds through events";
        /// Shares of the depth of a part from which on samples give errors of their own.
        depths_of_errors: [f64; 2] = [1.0 / 32.0, 1.0 / 8.0], moves "errors of Chebyshev bounds through events";
        /// Samples count for errors at a point that are at this share of its depth, or deeper.
        shallower: f64 = 0.5, moves "errors of Chebyshev bounds through events";
        /// Degrees by which errors of polynomials are above these.
        degrees_of_errors: usize = 2, moves "errors of bounds through events";
        /// Distance from a corner at which it is compared with its neighbours, in ξ.
        beside_corner: f64 = 1e-3, moves "errors of bounds through events";
        /// Jets are divided where an error is larger than this share of its row's width.
        enough_of_jets: f64 = 0.1, moves "Taylor bounds through events";
        /// A row that is narrower than this share of its output's span counts as so wide there.
        narrow_row: f64 = 0.01, moves "Taylor bounds through events";
        /// Halvings of jets, at most.
        halvings_of_jets: usize = 3, moves "Taylor bounds through events";
        /// Samples for each parameter that give the errors of a half, in addition to its corners.
        samples_of_halves: usize = 12, moves "Taylor bounds through events";
        /// Candidates of each round in which samples are added.
        candidates: usize = 512, moves "Chebyshev bounds through events";
        /// Corners of the box among the candidates for samples.
        corners: usize = 16, moves "Chebyshev bounds through events";
        /// Points next to a surface are inside of it by this share of the depth: a motion that only just grazes cannot
        /// be cut.
        inside_surface: f64 = 1e-6, moves "Chebyshev bounds through events";
        /// Shares of the depth of a part at which it has samples next to the surface: within less than the distance of
        /// others, motions may differ from the polynomials' prediction.
        grazing_shares: [f64; 3] = [1e-4, 1e-6, 1e-8], moves "Chebyshev bounds through events";
        /// Further samples at each of these depths for each dimension of the surface.
        grazing_samples: usize = 8, moves "Chebyshev bounds through events";
        /// Least distance of samples from a surface, as a multiple of its error, within which they may be on its other
        /// side.
        beyond_error: f64 = 2.0, moves "Chebyshev bounds through events";
        /// Halvings of a line on which a level is searched for.
        halvings_of_line: usize = 40, moves "Chebyshev bounds through events";
        /// One in this many samples that a part lacks on the side of a surface without the event is next to the
        /// surface.
        beside_surface: usize = 3, moves "Chebyshev bounds through events";
        /// Largest leverage of a fit at a point outside of the samples: the square of its error there over the samples'
        /// error.
        far_outside: f64 = 2.0, moves "Chebyshev bounds through events";
        /// Points outside of the samples that are added at once.
        covering: usize = 4, moves "Chebyshev bounds through events";
        /// Distance of points that are added outside of the samples, in ξ.
        covering_apart: f64 = 0.2, moves "Chebyshev bounds through events";
        /// Intervals of the lattice along each axis, by the number of parameters; more have corners and points spread
        /// over the box, each joined to the next.
        intervals: [usize; 4] = [32, 12, 6, 4], moves "Chebyshev bounds through events";
        /// Intervals of each edge of the lattice in which it is searched for surfaces that end a part.
        points_of_edge: usize = 8, moves "Chebyshev bounds through events";
        /// Corners of the box from which a range of many parameters is searched.
        corners_of_lattice: usize = 64, moves "Chebyshev bounds through events";
        /// Points for each parameter from which a range of many parameters is searched.
        spread_a_parameter: usize = 32, moves "Chebyshev bounds through events";
        /// Points on a surface, at most, from which a search begins.
        most_on_surface: usize = 96, moves "Chebyshev bounds through events";
        /// Corrections of a point on a surface along its edge.
        corrections: usize = 5, moves "Chebyshev bounds through events";
        /// How far the branch of a segment goes on beyond its ends, as a share of it, at most.
        beyond_branch: f64 = 0.02, moves "Chebyshev bounds through events";
        /// How far it does as a share of the step there, at most: farther a polynomial through nodes says nothing.
        beyond_step: f64 = 0.2, moves "Chebyshev bounds through events";
        /// Where motions are expanded at a time, the branch of a segment goes on beyond it by at most this multiple of
        /// the longest step there.
        beyond_longest: f64 = 2.0, moves "Chebyshev bounds through events";
        /// A part is between two events at a time that is this multiple of their instants' errors from both.
        safety_of_common: f64 = 2.0, moves "Chebyshev bounds through events";
        /// If so much of a segment is predicted, motions at times of other segments are not compared with it.
        shared_segment: f64 = 0.5, moves "errors of Chebyshev bounds through events";
    }
}
