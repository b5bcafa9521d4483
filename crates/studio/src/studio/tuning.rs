//! Constants of the room `studio`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// The studio.
    "studio" {
        /// Most uncertain parameters for which coarse bounds are polynomials through the corners of the box.
        few_parameters: usize = 4, moves "coarse bounds in the studio";
        /// Share of a run between two reports of progress.
        share_of_progress: f64 = 0.01, moves "the progress bar in the studio";
        /// Most bytes of a request's head.
        head_bytes: usize = 16 << 10, moves "which requests are refused";
        /// Most headers of a request.
        headers: usize = 64, moves "which requests are refused";
        /// Most bytes of a request's body: a text of the largest model.
        body_bytes: usize = 64 << 20, moves "which requests are refused";
        /// Most bytes that an end reads while it waits for the other to close, so that the answer arrives.
        dropped_bytes: u64 = 1 << 20, moves "which answers arrive";
        /// Approximate number of two-byte numbers of a motion.
        numbers_of_motion: usize = 100_000, moves "motions in the studio";
        /// Most simultaneous connections: a page has six.
        connections: usize = 64, moves "which connections are refused";
        /// Time that a page waits for something new before it asks again.
        patience_of_board: Duration = Duration::from_secs(20), moves "messages of the studio";
        /// Time that coarse bounds may take: later they add nothing to those that the model requests.
        time_of_coarse: Duration = Duration::from_secs(10), moves "coarse bounds in the studio";
        /// Time that the other end may be silent within a request.
        silence: Duration = Duration::from_secs(10), moves "which connections are given up";
        /// Time that an end waits for the other to close, so that the answer arrives.
        linger: Duration = Duration::from_millis(500), moves "which answers arrive";
        /// Pause in typing before a text is read: bounds of half a word are useless.
        quiet: Duration = Duration::from_millis(250), moves "how soon the studio follows its text";
        /// Time between two checks for the end of the studio.
        between_looks_of_desk: Duration = Duration::from_millis(100), moves "how soon the studio follows its text";
        /// Time that an answer of the language server may take.
        patience_of_language: Duration = Duration::from_secs(30),
            moves "which requests to the language server are given up";
        /// Time between two checks of a waiting worker for its end.
        between_looks_of_requests: Duration = Duration::from_millis(50), moves "how soon the studio answers";
        /// Time between two checks of the server for its end.
        between_looks_of_server: Duration = Duration::from_millis(100), moves "how soon the studio ends";
        /// Time between two checks of the files.
        between_looks_at_files: Duration = Duration::from_millis(300), moves "how soon the studio sees a changed file";
    }
}
