//! Constants of the room `certificate`.

use symdiff::constants::tuning;

tuning! {
    /// Proofs, and their checker.
    "certificate" {
        /// Most cells of a grid through all ends of pieces.
        most_parts: usize = 10_000_000, moves "which certificates are checked";
        /// Most boxes that a range of a polynomial is divided into.
        most_boxes: usize = 100_000, moves "which certificates are checked";
        /// Factor by which B⁻¹ and B may enlarge a distance before B is turned.
        skew: f64 = 100.0, moves "widths of proven bounds";
        /// Distance whose growth does not matter.
        no_growth: f64 = 1e-11, moves "widths of proven bounds";
        /// Most attempts to find a box that is mapped into itself.
        attempts_of_krawczyk: usize = 12, moves "which steps are proven, and widths of proven bounds";
        /// Factor by which the next box is larger than the image of the last one.
        inflation_of_krawczyk: f64 = 1.25, moves "which steps are proven, and widths of proven bounds";
        /// Most candidates for a solution of linear inequalities.
        attempts_of_majorant: usize = 100, moves "which cells are proven, and widths of proven bounds";
        /// Factor by which the next candidate is larger than the image of the last one.
        inflation_of_majorant: f64 = 1.05, moves "which cells are proven, and widths of proven bounds";
        /// Added to candidates, so that zeros stay above their rounded images.
        least_candidate: f64 = 1e-280, moves "which cells are proven, and widths of proven bounds";
        /// Largest ‖I − C J‖ that is left when an inverse is refined: its square is below rounding.
        refined_inverse: f64 = 1e-9, moves "which steps are proven, and widths of proven bounds";
        /// Refinements before an inverse is given up; each squares ‖I − C J‖.
        max_refinements: usize = 8, moves "which steps are proven, and widths of proven bounds";
        /// Parts of half a cell in which ranges are found term by term.
        parts_of_cell: i32 = 32, moves "widths of proven bounds";
    }
}
