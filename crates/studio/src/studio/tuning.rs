//! Constants of the room `studio`.

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
    }
}
