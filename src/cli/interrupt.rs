//! Ctrl-C, and the signals of a system that ends a program: while there are results to keep, the first asks a run to
//! keep them and end, and the second ends the program at once; before, as while a model is compiled, the first does.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Failure;
use super::status::Status;
use crate::export::wait_for_folder;
use crate::syntax::harmless;

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

/// Waits while another run writes into a folder, and says so.
///
/// # Errors
/// If an end is asked for meanwhile.
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

/// Says whether there are results to keep.
pub(super) fn keep_results(kept: bool) {
    KEPT.store(kept, Ordering::Relaxed);
}
