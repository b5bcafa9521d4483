//! Constants of the room `export`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// Files of results.
    "export" {
        /// Most parameters with a layer of their own.
        most_layers: usize = 6, moves "layers of plots of contributions";
        /// Gain of a design below which its page and the terminal do not report it.
        shown_gain: f64 = 5e-4, moves "the gains that a design tells";
        /// Most bodies and points whose names are written.
        most_names: usize = 150, moves "names in drawings";
        /// Cosine of the angle between faces above which the edge between them is not drawn.
        smooth_edge: f64 = 0.9, moves "edges in drawings";
        /// Distance below which two points of an outline coincide, px.
        same_point: f64 = 1.0, moves "outlines in drawings";
        /// Most rows of a series; longer series merge the extremes of several rows.
        rows_of_series: usize = 400, moves "courses in figures";
        /// Resolution of numbers, relative to the range of their axis.
        resolution_of_numbers: f64 = 1e-4, moves "courses in figures";
        /// Number of decades above which an axis has no ticks within them.
        many_decades: i32 = 8, moves "ticks of figures";
        /// Least width of a hatched part, px.
        narrowest_hatched: f64 = 6.0, moves "hatched parts of figures";
        /// Distance beyond the panel at which points are cut off, in heights of the panel.
        beyond_panel: f64 = 2.0, moves "courses in figures";
        /// Largest distance of an omitted point from the drawn line, px.
        tolerance_of_path: f64 = 0.05, moves "courses in figures";
        /// Size from which a number is too long: prefixes of areas and volumes are far apart.
        long_number: f64 = 1e5, moves "units of figures";
        /// Digits of deviations on the page of a fit.
        digits_of_deviations: i32 = 4, moves "pages of fits";
        /// Most triangles of all meshes of a drawing; the rest is omitted.
        most_triangles: usize = 12_000, moves "meshes in drawings";
        /// Largest file of results that is read, bytes.
        largest_file: u64 = 1 << 30, moves "which folders of results are read";
        /// Motion, deviations and ranges of axes below this value, relative to the size of outputs, are rounding noise.
        rounding_of_motion: f64 = 1e-12, moves "plots of outputs that hardly move";
        /// Most parameters of an output whose derivatives are shown: those with the largest influence in any row.
        most_derivatives: usize = 12, moves "derivatives in reports";
        /// Samples whose parameters are drawn at a time.
        samples_at_once: usize = 4096, moves "memory of files of samples";
        /// Factor of growth above which a stated error counts as moved: it would hide all else.
        grown_error: f64 = 2.0, moves "which differences a snapshot tells";
        /// Times of a run that are shown.
        times_of_snapshot: usize = 10, moves "tables of snapshots";
        /// Digits shown of an output's span.
        digits_of_span: i32 = 5, moves "tables of snapshots";
        /// Most digits shown of a value: a span may consist of rounding errors alone.
        most_digits_of_value: i32 = 13, moves "tables of snapshots";
        /// Straight pieces of a whole turn.
        pieces_of_turn: usize = 72, moves "solids in reports";
        /// Longest stem of a file's name, bytes; file systems take 255, with the extension and a number.
        longest_name: usize = 120, moves "names of files";
        /// Most bars of a plot; parameters of less influence are omitted.
        most_bars: usize = 24, moves "bars of tornado plots";
        /// Digits of numbers on the page.
        digits_of_verification: usize = 4, moves "pages of verifications";
        /// Time between two tries to lock a folder.
        between_tries: Duration = Duration::from_millis(100), moves "how soon a folder that is in use is taken";
    }
}
