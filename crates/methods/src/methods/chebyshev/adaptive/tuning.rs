//! Constants of the room `methods: chebyshev: adaptive`.

use symdiff::constants::tuning;

tuning! {
    /// Chebyshev bounds within a tolerance.
    "methods: chebyshev: adaptive" {
        /// Rows in which the error at new nodes is examined, which only decides what to add next.
        rows_at_nodes: usize = 16, moves "bounds within a tolerance";
        /// Samples where outputs are least or largest, at most, of few parameters and nodes.
        ends: usize = 16, moves "bounds within a tolerance";
        /// Samples for each parameter where outputs are least or largest, if these are more.
        ends_a_parameter: usize = 2, moves "bounds within a tolerance";
        /// Nodes for each sample where outputs are least or largest, if these are more samples: a polynomial of high
        /// degree has its tips anywhere.
        nodes_an_end: usize = 4, moves "bounds within a tolerance";
        /// Two ends are one if they are nearer to each other than this share of the distance of nodes.
        near_end: f64 = 0.5, moves "bounds within a tolerance";
        /// Indices are added whose expected surplus is at least this share of the largest.
        added: f64 = 0.3, moves "bounds within a tolerance";
        /// Fewest nodes of a sparse grid that are simulated together.
        together: usize = 8, moves "bounds within a tolerance";
        /// Nodes that are there for each that is simulated next, if they are many.
        growth: usize = 8, moves "bounds within a tolerance";
        /// At most one in this many simulations of the budget is reserved for new validation samples.
        kept_free: usize = 2, moves "bounds within a tolerance";
        /// A surrogate that a value contradicts which was simulated elsewhere is refined until its nodes have grown by
        /// this share.
        doubted: usize = 2, moves "bounds within a tolerance";
        /// Rows in which a surrogate is examined between rounds.
        checked_rows: usize = 48, moves "bounds within a tolerance";
    }
}
