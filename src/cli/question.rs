//! One question to one model: a study with its progress, and the answer for people or for programs.

use serde::Serialize;

use super::args::{Format, OneRunArgs};
use super::console::{Console, to_json};
use super::progress::Progress;
use super::{Failure, interrupt};
use crate::study;

/// Asks with the options of a command, and shows the progress unless it is quiet. `costly` is whether it may take long.
pub(super) fn ask<T>(model: &str, run: &OneRunArgs, costly: bool, question: impl FnOnce(&study::Options) -> T) -> T {
    let progress = Progress::new(model, !run.quiet);
    question(&study::Options {
        threads: run.threads.number(),
        costly,
        stage: &|stage| progress.stage(stage),
        interrupted: &interrupt::asked,
        ..study::Options::default()
    })
}

/// Prints an answer: as JSON, or as text unless the command is quiet.
pub(super) fn answer(
    found: &impl Serialize,
    format: Format,
    quiet: bool,
    console: &mut Console,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    match format {
        Format::Json => console.print(&to_json(found)?),
        Format::Text if quiet => Ok(()),
        Format::Text => console.print(&text()),
    }
}
