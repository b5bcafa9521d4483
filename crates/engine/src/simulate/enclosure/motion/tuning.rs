//! Constants of the room `simulate: enclosure: motion`.

use symdiff::constants::tuning;

tuning! {
    /// Enclosures of motions in continuous time.
    "simulate: enclosure: motion" {
        /// Most iterations; each makes one more power of τ right.
        max_iterations: usize = 40, moves "widths of proven bounds, and time";
        /// Change of the accelerations, relative to their size, that ends the iteration.
        converged_accelerations: f64 = 2e-16, moves "widths of proven bounds, and time";
        /// Change from which on the iteration ends where it no longer shrinks: rounding.
        near_convergence: f64 = 1e-9, moves "widths of proven bounds, and time";
        /// Defect of the accelerations, relative to their size, above which a cell is halved.
        large_defect: f64 = 1e-12, moves "widths of proven bounds, and time";
        /// Defect of the accelerations, relative to their size, above which a knot must be in the cell, if the
        /// equations have any.
        harmful_defect: f64 = 1e-9, moves "widths of proven bounds, and time";
        /// Last terms in τ of the accelerations, relative to their size, above which cells may be very short.
        stiff_tail: f64 = 1e-9, moves "widths of proven bounds, and time";
        /// Last terms in τ, relative to the accelerations, below which they do not matter.
        small_defect: f64 = 1e-13, moves "widths of proven bounds, and time";
        /// Factor by which errors make the distance larger over a cell, above which the cell is halved.
        large_gain: f64 = 1.05, moves "widths of proven bounds, and time";
        /// Factor by which errors make the distance larger over a cell, below which the next cell is twice as long.
        small_gain: f64 = 1.01, moves "widths of proven bounds, and time";
        /// A cell of half the length is worth its proof where its gain is smaller by this factor: one of two such
        /// cells has at most half.
        helpful_halving: f64 = 0.3, moves "widths of proven bounds, and time";
        /// Half the length of the first cell that is tried, s.
        first_half: f64 = 1.0 / 64.0, moves "widths of proven bounds, and time";
        /// Half the length of the longest cell, s.
        longest_half: f64 = 0.25, moves "widths of proven bounds, and time";
        /// Half the length below which a cell is not halved, s; below the first one it is where its polynomials in
        /// time are far from the motion.
        shortest_halves: [f64; 2] = [1.0 / 32768.0, 1.0 / 1_048_576.0], moves "widths of proven bounds, and time";
        /// Bound of positions' remainders, relative to their scale, above which smaller boxes cost less than shorter
        /// cells.
        large_remainder: f64 = 1e-5, moves "widths of proven bounds, and time";
        /// Last terms in ξ, relative to the size of the velocities, above which the box is too wide for the order.
        large_tail: f64 = 1e-8, moves "widths of proven bounds, and time";
        /// Most tubes about an approximation that are tried for a proof.
        most_tubes: usize = 4, moves "widths of proven bounds, and time";
        /// Factor from the bound that one tube gave to the next tube. Much more than is needed here, for a checker
        /// whose bounds are larger; distances are far too small for it to matter to the derivatives.
        wider_tube: f64 = 4.0, moves "widths of proven bounds, and time";
    }
}
