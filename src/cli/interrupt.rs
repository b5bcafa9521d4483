//! Ctrl-C, and the signals of a system that ends a program: while there are results to keep, the first asks a run to
//! keep them and end, and the second ends the program at once; before, as while a model is compiled, the first does.

use std::sync::atomic::{AtomicBool, Ordering};

use super::status::Status;

/// Whether an end was asked for.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether there are results to keep.
static KEPT: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C, SIGTERM and SIGHUP do as this module says.
pub(super) fn listen() {
    let asked = || {
        let again = ASKED.swap(true, Ordering::Relaxed);
        if again || !KEPT.load(Ordering::Relaxed) {
            if !again {
                eprintln!("interrupted before there were results");
            }
            std::process::exit(Status::Interrupted.code().into());
        }
    };
    // Without a handler, they end the program at once.
    let _ = ctrlc::set_handler(asked);
}

/// Whether an end was asked for.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Says whether there are results to keep.
pub(super) fn keep_results(kept: bool) {
    KEPT.store(kept, Ordering::Relaxed);
}
