//! Constants of the room `export`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// Files of results.
    "export" {
        /// Most parameters that have a layer of their own.
        most_layers: usize = 6, moves "layers of plots of contributions";
        /// A smaller gain of a design is not told, on its page and on the terminal.
        shown_gain: f64 = 5e-4, moves "the gains that a design tells";
        /// Most bodies and points of which the names are written.
        most_names: usize = 150, moves "names in drawings";
        /// Cosine of the angle between faces above which the edge between them is not drawn.
        smooth_edge: f64 = 0.9, moves "edges in drawings";
        /// Distance below which two points of an outline are one, px.
        same_point: f64 = 1.0, moves "outlines in drawings";
        /// Rows that a series has at most; longer series have the extremes of several rows in one.
        rows_of_series: usize = 400, moves "courses in figures";
        /// The part of an axis' range to which numbers are written.
        resolution_of_numbers: f64 = 1e-4, moves "courses in figures";
        /// An axis with more decades than this has no ticks within them.
        many_decades: i32 = 8, moves "ticks of figures";
        /// Least width of a hatched part, px.
        narrowest_hatched: f64 = 6.0, moves "hatched parts of figures";
        /// How far beyond the panel points are kept, in heights of the panel.
        beyond_panel: f64 = 2.0, moves "courses in figures";
        /// How far a point may be from the line that is drawn without it, px.
        tolerance_of_path: f64 = 0.05, moves "courses in figures";
        /// Size from which on a number is too long: prefixes of areas and volumes are far apart.
        long_number: f64 = 1e5, moves "units of figures";
        /// Digits of deviations on the page of a fit.
        digits_of_deviations: i32 = 4, moves "pages of fits";
        /// Most triangles of all meshes of a drawing; those beyond are left out.
        most_triangles: usize = 12_000, moves "meshes in drawings";
        /// Largest file of results that is read, bytes.
        largest_file: u64 = 1 << 30, moves "which folders of results are read";
        /// Motion, deviations and ranges of axes that are smaller than this, relative to the size of outputs, are
        /// rounding noise.
        rounding_of_motion: f64 = 1e-12, moves "plots of outputs that hardly move";
        /// Most parameters of an output whose derivatives are shown: those with the largest influence in any row.
        most_derivatives: usize = 12, moves "derivatives in reports";
        /// Samples whose parameters are made at a time.
        samples_at_once: usize = 4096, moves "memory of files of samples";
        /// A stated error that grew by more than this counts as moved: it would hide all else.
        grown_error: f64 = 2.0, moves "which differences a snapshot tells";
        /// Times that are shown of a run.
        times_of_snapshot: usize = 10, moves "tables of snapshots";
        /// Digits that are shown of an output's span.
        digits_of_span: i32 = 5, moves "tables of snapshots";
        /// Digits that are shown of a value, at most: a span may be rounding errors alone.
        most_digits_of_value: i32 = 13, moves "tables of snapshots";
        /// Straight pieces of a whole turn.
        pieces_of_turn: usize = 72, moves "solids in reports";
        /// Longest stem of a file's name, bytes; file systems take 255, with the extension and a number.
        longest_name: usize = 120, moves "names of files";
        /// Most bars of a plot; parameters of less influence are left out.
        most_bars: usize = 24, moves "bars of tornado plots";
        /// Digits of numbers on the page.
        digits_of_verification: usize = 4, moves "pages of verifications";
        /// Time between two tries to lock a folder.
        between_tries: Duration = Duration::from_millis(100), moves "how soon a folder that is in use is taken";
    }
}
