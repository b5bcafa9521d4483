//! Models from their files, with all that is wrong with all of them told at once.

use std::path::{Path, PathBuf};

use super::console::Console;
use crate::model::Description;
use crate::model::{self, Override};

/// Reads all models. If any is wrong, everything that is wrong with any of them is told and there is no result.
pub(super) fn load_all(models: &[PathBuf], overrides: &[Override], console: &Console) -> Option<Vec<Description>> {
    let read = models.iter().map(|path| load(path, overrides, console)).collect::<Vec<_>>();
    read.into_iter().collect()
}

/// Reads a model, and tells what is wrong or doubtful about it.
pub(super) fn load(path: &Path, overrides: &[Override], console: &Console) -> Option<Description> {
    let reading = model::read(path, overrides);
    if !reading.diagnostics.is_empty() {
        console.complain(&reading.diagnostics.render(console.color()));
    }
    reading.description
}
