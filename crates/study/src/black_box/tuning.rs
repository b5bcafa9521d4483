//! Constants of the room `study: black_box`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// Programs that answer instead of a mechanism.
    "study: black_box" {
        /// Bytes that a program may write in a call in addition to its answers.
        chatter_bytes: u64 = 1 << 20, moves "which programs are ended because they write too much";
        /// Bytes that a number may take, including the characters around it.
        number_bytes: u64 = 64, moves "which programs are ended because they write too much";
        /// Bytes of standard error that are stored.
        words_bytes: usize = 4096, moves "messages of programs that fail";
        /// Times that differ by less than this share of the time between rows are the same.
        same_time: f64 = 1e-6, moves "which answers of programs are accepted";
        /// Characters of a text that is shown.
        shown_characters: usize = 300, moves "messages of programs that fail";
        /// Time between two questions whether to go on.
        glance: Duration = Duration::from_millis(20), moves "how soon a run of a program ends";
        /// Time that a process has to end by itself once its input has ended.
        grace: Duration = Duration::from_secs(2), moves "how soon a run of a program ends";
    }
}
