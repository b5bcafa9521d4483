//! Ctrl-C: the first asks a run to keep what is finished and end, the second ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of what was interrupted: 128 and SIGINT's number, as in a shell.
pub(super) const STATUS: u8 = 130;

/// Whether the user does not want to wait any more.
static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C only leaves word.
pub(super) fn listen() {
    let asked = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(STATUS.into());
        }
    };
    // Where there is no way to listen, Ctrl-C ends the run as it ends any program.
    let _ = ctrlc::set_handler(asked);
}

/// Whether Ctrl-C was pressed.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
