//! Ctrl-C, and the signals of a system that ends a program: while there are results to keep, the first signal asks a
//! run to keep them and end, and the second ends the program at once; before, for example while a model is compiled,
//! the first does.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Failure;
use super::status::Status;
use crate::export::wait_for_folder;
use crate::syntax::harmless;

/// Whether the end was requested.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether there are results to keep.
static KEPT: AtomicBool = AtomicBool::new(false);

/// Handles Ctrl-C, SIGTERM and SIGHUP from now on as described above.
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

/// Whether the end was requested.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Waits while another run writes into a folder, and prints that.
///
/// # Errors
/// If the end is requested meanwhile.
pub(super) fn wait_for(folder: &Path) -> Result<(), Failure> {
    let mut is_told = false;
    let mut waits = || {
        if !std::mem::replace(&mut is_told, true) {
            eprintln!("waiting for another run that writes into {}", harmless(&folder.display().to_string()));
        }
        !asked()
    };
    wait_for_folder(folder, &mut waits).map_err(|error| Failure::failed(&error).of(&error))
}

/// Sets whether there are results to keep.
pub(super) fn keep_results(kept: bool) {
    KEPT.store(kept, Ordering::Relaxed);
}
