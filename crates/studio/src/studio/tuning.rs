//! Constants of the room `studio`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// The studio.
    "studio" {
        /// Most uncertain parameters for which coarse bounds are polynomials through the corners of the box.
        few_parameters: usize = 4, moves "coarse bounds in the studio";
        /// Progress is told by this share.
        share_of_progress: f64 = 0.01, moves "the progress bar in the studio";
        /// Most bytes of a request's head.
        head_bytes: usize = 16 << 10, moves "which requests are refused";
        /// Most headers of a request.
        headers: usize = 64, moves "which requests are refused";
        /// Most bytes of a request's body: a text of the largest model.
        body_bytes: usize = 64 << 20, moves "which requests are refused";
        /// Most bytes that an end takes while it waits for the other to close, so that the answer arrives.
        dropped_bytes: u64 = 1 << 20, moves "which answers arrive";
        /// Numbers of two bytes that a motion comes to, about.
        numbers_of_motion: usize = 100_000, moves "motions in the studio";
        /// Most connections at a time: a page has six.
        connections: usize = 64, moves "which connections are refused";
        /// Time that a page waits for something new before it asks again.
        patience_of_board: Duration = Duration::from_secs(20), moves "messages of the studio";
        /// Time that coarse bounds may take: later they are no news beside those that the model asks for.
        time_of_coarse: Duration = Duration::from_secs(10), moves "coarse bounds in the studio";
        /// Time that the other end may be silent within a request.
        silence: Duration = Duration::from_secs(10), moves "which connections are given up";
        /// Time that an end waits for the other to close, so that the answer arrives.
        linger: Duration = Duration::from_millis(500), moves "which answers arrive";
        /// Time that nothing is typed before a text is read: bounds of half a word are nobody's.
        quiet: Duration = Duration::from_millis(250), moves "how soon the studio follows its text";
        /// Time between two questions whether the studio has ended.
        between_looks_of_desk: Duration = Duration::from_millis(100), moves "how soon the studio follows its text";
        /// Time that an answer of the language server may take.
        patience_of_language: Duration = Duration::from_secs(30),
            moves "which requests to the language server are given up";
        /// Time between two questions of a waiting worker whether it is to end.
        between_looks_of_requests: Duration = Duration::from_millis(50), moves "how soon the studio answers";
        /// Time between two questions of the server whether to end.
        between_looks_of_server: Duration = Duration::from_millis(100), moves "how soon the studio ends";
        /// Time between two looks at the files.
        between_looks_at_files: Duration = Duration::from_millis(300), moves "how soon the studio sees a changed file";
    }
}
