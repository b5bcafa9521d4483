//! Constants of the room `symdiff`.

use crate::constants::tuning;

tuning! {
    /// Expressions, formulas and tapes.
    "symdiff" {
        /// Largest integer exponent of a number of twice the digits that is multiplied out.
        factors_of_double_double: f64 = 1024.0, moves "checks of derivatives, within rounding";
        /// Allowance for a library's error, relative to the value.
        of_library: f64 = 4.0 * f64::EPSILON, moves "widths of enclosures";
        /// Largest integer exponent of a Taylor model that is multiplied out.
        factors_of_model: f64 = 64.0, moves "widths of proven bounds";
        /// Most pieces of a table within a box.
        pieces_of_spline: usize = 64, moves "widths of proven bounds of models with tables";
        /// Largest degree of a recognised polynomial.
        degree_of_polynomial: usize = 12, moves "which integrals are written out";
        /// Most joined conditions in an antiderivative of a function defined piecewise.
        most_conditions: usize = 8, moves "which integrals are written out";
        /// Share of the values at the knots below which a jump there is rounding.
        jump_of_rounding: f64 = 1e-9, moves "ranges of tables";
        /// Number of periods beyond which a range is too far from the first one.
        most_periods: f64 = 1e9, moves "ranges of tables";
        /// Deepest parentheses of an index.
        depth_of_indices: usize = 20, moves "which names with indices are refused";
        /// Deepest nesting of parentheses, signs and powers.
        depth_of_formulas: usize = 100, moves "which formulas are refused";
        /// Most terms of a sum.
        terms_of_sum: i64 = 10_000, moves "which formulas are refused";
        /// Most operations of a formula with a sum: sums within sums multiply.
        operations_of_sums: usize = 50_000, moves "which formulas are refused";
        /// Most statements of a function, except for those of a region: compilers take more than proportionally long
        /// for more.
        statements_of_function: usize = 2000, moves "time in which exported code is compiled";
        /// Nodes for which an empty graph has memory, enough for most mechanisms of few bodies.
        nodes_at_first: usize = 1024, moves "time only";
        /// Number of nodes below which a region is not worth its condition.
        least_region: usize = 4, moves "which instructions are skipped";
        /// Instructions of a stretch within which they are grouped by operation: grouping saves dispatches, a limit
        /// keeps live values within the first-level cache.
        window_of_grouping: usize = 256, moves "time only";
        /// Symbols by which derivatives are taken at once.
        slopes_at_once: usize = 31, moves "time only";
    }
}
