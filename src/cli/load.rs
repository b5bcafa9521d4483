//! Models from their files, with all that is wrong with all of them told at once.

use std::path::{Path, PathBuf};

use super::console::Console;
use super::pending::model::{self, Override};
use crate::model::Description;

/// Reads all models. If any is wrong, everything that is wrong with any of them is told and there is no result.
pub(super) fn load_all(models: &[PathBuf], overrides: &[Override], console: &Console) -> Option<Vec<Description>> {
    let read = models.iter().map(|path| load(path, overrides, console)).collect::<Vec<_>>();
    read.into_iter().collect()
}

/// Reads a model, or tells what is wrong with it.
pub(super) fn load(path: &Path, overrides: &[Override], console: &Console) -> Option<Description> {
    model::load(path, overrides).map_err(|diagnostics| console.complain(&diagnostics.render(console.color()))).ok()
}
