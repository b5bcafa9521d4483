//! Models read from their files; the errors of all files are reported at once.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::Failure;
use super::console::Console;
use crate::model::{self, Changes, Description, Override, Reading, Witness};
use crate::results::ModelFile;
use crate::study;
use crate::syntax::Coded;

/// Settings of the command line for models, in addition to their files.
#[derive(Clone, Default)]
pub(super) struct Given {
    /// Values of parameters.
    pub overrides: Vec<Override>,
    /// Folder whose files models may name, in addition to those of their own folders.
    pub root: Option<PathBuf>,
    /// Functions of the excitations over time.
    pub witness: Option<Witness>,
}

/// The models that could be read.
pub(super) struct Loaded {
    pub models: Vec<LoadedModel>,
    /// Whether these are all models: reading may fail by an error of this program.
    pub is_complete: bool,
}

/// A model to be run, alone or as scenes.
pub(super) struct LoadedModel {
    /// Its file.
    pub path: PathBuf,
    /// Its name, which is also that of its folder.
    pub name: String,
    /// Its scenes with their names; one without a name if the model has none.
    pub scenes: Vec<(Option<String>, Description)>,
    /// Names of all its scenes.
    pub all: Vec<String>,
    /// The files that it was read from.
    pub files: Vec<ModelFile>,
    /// Names and texts of these.
    pub texts: Rc<[(String, String)]>,
}

/// Reads all models and chooses their scenes: those of these names, or all. If any model has errors, the errors of all
/// models are reported and there is no result.
///
/// # Errors
/// For a name that is not a scene of a model.
pub(super) fn load_all(
    models: &[PathBuf],
    given: &Given,
    scenes: &[String],
    console: &Console,
) -> Result<Option<Loaded>, Failure> {
    input_once(models)?;
    let mut is_complete = true;
    let mut readings: Vec<(&PathBuf, Option<Reading>)> = Vec::new();
    for path in models {
        match study::caught("reading", || read(path, given, console)) {
            Ok(reading) => readings.push((path, reading)),
            Err(error) => {
                is_complete = false;
                console.error(&format!("{}: {error}", model::shown(path)));
            }
        }
    }
    let chosen = |(path, reading): (&PathBuf, Reading)| {
        let (files, texts) = study::sources(&reading);
        let all = reading.scenes.iter().map(|scene| scene.name.clone()).collect();
        let name = reading.description.as_ref().map_or_else(String::new, |description| description.name.clone());
        let scenes = reading
            .chosen(scenes)
            .map_err(|error| Failure::wrong(format!("{}: {error}", model::shown(path))).of(&error))?;
        Ok(LoadedModel { path: path.clone(), name, scenes, all, files, texts: texts.into() })
    };
    let readings = readings.into_iter().map(|(path, reading)| Some((path, reading?)));
    let Some(readings) = readings.collect::<Option<Vec<_>>>() else { return Ok(None) };
    let models = readings.into_iter().map(chosen).collect::<Result<_, _>>()?;
    Ok(Some(Loaded { models, is_complete }))
}

/// Reads a model, or a scene of it, and reports its errors and warnings.
///
/// # Errors
/// For a name that is not a scene of it.
pub(super) fn load(
    path: &Path,
    given: &Given,
    scene: Option<&String>,
    console: &Console,
) -> Result<Option<Description>, Failure> {
    let Some(reading) = read(path, given, console) else { return Ok(None) };
    let Some(scene) = scene else { return Ok(reading.description) };
    let chosen = reading.chosen(std::slice::from_ref(scene));
    let chosen = chosen.map_err(|error| Failure::wrong(format!("{}: {error}", model::shown(path))).of(&error))?;
    Ok(chosen.into_iter().map(|(_, description)| description).next())
}

/// Checks that standard input is read at most once.
///
/// # Errors
/// If it is named more often.
pub(super) fn input_once(models: &[PathBuf]) -> Result<(), Failure> {
    match models.iter().filter(|path| model::is_standard_input(path)).count() {
        0 | 1 => Ok(()),
        _ => Err(Failure::wrong("`-` is named twice, but standard input can be read once only")),
    }
}

/// Reads a file and reports its errors and warnings; `None` if it has errors.
fn read(path: &Path, given: &Given, console: &Console) -> Option<Reading> {
    let mut reading = model::read_rooted(path, Changes::of(&given.overrides), given.root.as_deref());
    console.diagnostics(&reading.diagnostics);
    if let Some(witness) = &given.witness {
        let scenes = reading.scenes.iter_mut().map(|scene| &mut scene.description);
        let replayed = scenes.chain(&mut reading.description).try_for_each(|model| witness.replay(model));
        if let Err(error) = replayed {
            let message = format!("{}: the witness is not one of this model: {error}", model::shown(path));
            console.coded_error(error.code(), &message);
            return None;
        }
    }
    reading.description.is_some().then_some(reading)
}
