//! Ctrl-C: the first asks a run to keep finished results and end, the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use super::status::Status;

/// Whether Ctrl-C was pressed.
static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C only sets a flag.
pub(super) fn listen() {
    let asked = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(Status::Interrupted.code().into());
        }
    };
    // Without a handler, Ctrl-C ends the program at once.
    let _ = ctrlc::set_handler(asked);
}

/// Whether Ctrl-C was pressed.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
