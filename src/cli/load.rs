//! Models from their files, with all that is wrong with all of them told at once.

use std::path::{Path, PathBuf};

use super::Failure;
use super::console::Console;
use crate::model::{self, Description, Override, Reading};

/// A model that is to be run: by itself, or as scenes.
pub(super) struct Model {
    /// Its name, which its folder has too.
    pub name: String,
    /// Its scenes' names, with what they are; one without a name where the model has none.
    pub scenes: Vec<(Option<String>, Description)>,
}

/// Reads all models and chooses their scenes: those of these names, or all. If any model is wrong, everything that is wrong with
/// any of them is told and there is no result.
///
/// # Errors
/// For a name that a model has no scene of.
pub(super) fn load_all(
    models: &[PathBuf],
    overrides: &[Override],
    scenes: &[String],
    console: &Console,
) -> Result<Option<Vec<Model>>, Failure> {
    let read: Vec<Option<Reading>> = models.iter().map(|path| read(path, overrides, console)).collect();
    let chosen = |(path, reading): (&PathBuf, Reading)| {
        let name = reading.description.as_ref().map_or_else(String::new, |description| description.name.clone());
        let scenes =
            reading.chosen(scenes).map_err(|error| Failure::Wrong(format!("{}: {error}", model::shown(path))))?;
        Ok(Model { name, scenes })
    };
    match read.into_iter().collect::<Option<Vec<Reading>>>() {
        Some(readings) => models.iter().zip(readings).map(chosen).collect::<Result<_, _>>().map(Some),
        None => Ok(None),
    }
}

/// Reads a model, or a scene of it; tells what is wrong or doubtful about it.
///
/// # Errors
/// For a name that it has no scene of.
pub(super) fn load(
    path: &Path,
    overrides: &[Override],
    scene: Option<&String>,
    console: &Console,
) -> Result<Option<Description>, Failure> {
    let Some(reading) = read(path, overrides, console) else { return Ok(None) };
    let Some(scene) = scene else { return Ok(reading.description) };
    let chosen = reading.chosen(std::slice::from_ref(scene));
    let chosen = chosen.map_err(|error| Failure::Wrong(format!("{}: {error}", model::shown(path))))?;
    Ok(chosen.into_iter().map(|(_, description)| description).next())
}

/// What a file gives, unless it is wrong; what is wrong or doubtful is told.
fn read(path: &Path, overrides: &[Override], console: &Console) -> Option<Reading> {
    let reading = model::read(path, overrides);
    if !reading.diagnostics.is_empty() {
        console.complain(&reading.diagnostics.render(console.color()));
    }
    reading.description.is_some().then_some(reading)
}
