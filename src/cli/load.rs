//! Models read from their files; the errors of all files are reported at once.

use std::path::{Path, PathBuf};

use super::Failure;
use super::console::Console;
use crate::model::{self, Description, Override, Reading};
use crate::study;

/// The models that could be read.
pub(super) struct Loaded {
    pub models: Vec<Model>,
    /// Whether these are all: reading may fail by an error of this program.
    pub is_complete: bool,
}

/// A model to be run, alone or as scenes.
pub(super) struct Model {
    /// Its file.
    pub path: PathBuf,
    /// Its name, which is also that of its folder.
    pub name: String,
    /// Its scenes with their names; one without a name if the model has none.
    pub scenes: Vec<(Option<String>, Description)>,
}

/// Reads all models and chooses their scenes: those of these names, or all. If any model has errors, the errors of all models
/// are reported and there is no result.
///
/// # Errors
/// For a name that is no scene of a model.
pub(super) fn load_all(
    models: &[PathBuf],
    overrides: &[Override],
    scenes: &[String],
    console: &Console,
) -> Result<Option<Loaded>, Failure> {
    let mut is_complete = true;
    let mut readings: Vec<(&PathBuf, Option<Reading>)> = Vec::new();
    for path in models {
        match study::caught("reading", || read(path, overrides, console)) {
            Ok(reading) => readings.push((path, reading)),
            Err(error) => {
                is_complete = false;
                console.error(&format!("{}: {error}", model::shown(path)));
            }
        }
    }
    let chosen = |(path, reading): (&PathBuf, Reading)| {
        let name = reading.description.as_ref().map_or_else(String::new, |description| description.name.clone());
        let scenes =
            reading.chosen(scenes).map_err(|error| Failure::Wrong(format!("{}: {error}", model::shown(path))))?;
        Ok(Model { path: path.clone(), name, scenes })
    };
    let readings = readings.into_iter().map(|(path, reading)| Some((path, reading?)));
    let Some(readings) = readings.collect::<Option<Vec<_>>>() else { return Ok(None) };
    let models = readings.into_iter().map(chosen).collect::<Result<_, _>>()?;
    Ok(Some(Loaded { models, is_complete }))
}

/// Reads a model, or a scene of it, and reports its errors and warnings.
///
/// # Errors
/// For a name that is no scene of it.
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

/// Reads a file and reports its errors and warnings; `None` if it has errors.
fn read(path: &Path, overrides: &[Override], console: &Console) -> Option<Reading> {
    let reading = model::read(path, overrides);
    console.diagnostics(&reading.diagnostics);
    reading.description.is_some().then_some(reading)
}
