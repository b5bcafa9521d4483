//! Constants of the room `assemble`.

use symdiff::constants::tuning;

tuning! {
    /// The equations of motion.
    "assemble" {
        /// Links of a tree, on average, from which M is omitted: it has an entry for every pair of them.
        links_without_mass_matrix: usize = 48, moves "instructions of long chains";
        /// Entries of a rotation nearer than this to 0 or ±1 are so but for rounding.
        rotation_rounding: f64 = 1e-15, moves "expressions of turned joints";
        /// Largest residual of a constraint that nothing can change, rad or relative to the model's size: rounding
        /// only.
        closed: f64 = 1e-9, moves "which models are refused";
        /// Most bodies of a mechanism of which other cuts than that of the shallowest trees are examined.
        bodies_with_cuts: usize = 50, moves "cuts of loops, and so the last digits";
        /// Part of its length across another axis below which an axis is parallel to it.
        parallel: f64 = 1e-6, moves "coordinates of joints";
        /// Multiplications of one link where links are eliminated one by one, about.
        link_multiplications: usize = 1000, moves "choice of coordinates, and so the last digits";
    }
}
