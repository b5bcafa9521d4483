//! Runs models: computes their bounds and writes them to files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::console::{Console, file_names};
use super::job::{Told, report, run_one};
use super::request::{Job, Request};
use super::scenes::Scenes;
use super::{Failure, Status, interrupt, load};
use crate::export::{POINTS, file_stem, prepare_folder};
use crate::methods::Certified;
use crate::model::{Description, shown};
use crate::overview::overview;
use crate::study;

/// Work on a model file.
struct Work {
    path: PathBuf,
    kind: Kind,
}

/// The model itself, or its scenes.
enum Kind {
    Alone(Box<Job>),
    Scenes(Scenes),
}

impl Kind {
    fn jobs(&self) -> Vec<&Job> {
        match self {
            Self::Alone(job) => vec![job.as_ref()],
            Self::Scenes(scenes) => scenes.jobs().collect(),
        }
    }
}

/// Runs every model and writes its results; the errors of some do not end the others.
///
/// # Errors
/// If a model is wrong as a whole; nothing was run then.
pub(super) fn run_all(request: &Request, console: &mut Console, told: &mut Told) -> Result<Status, Failure> {
    let Some(loaded) = load::load_all(&request.models, &request.given, &request.scenes, console)? else {
        return Ok(Status::Wrong);
    };
    let mut status = if loaded.is_complete { Status::Done } else { Status::Failed };
    let work = work(loaded.models, request)?;
    // Every model is checked before the first run, which may take hours.
    for Work { path, kind } in &work {
        for job in kind.jobs() {
            let wrong = |error| match kind {
                Kind::Alone(_) => Failure::wrong(format!("{}: {error}", shown(path))).of(&error),
                Kind::Scenes(_) => Failure::wrong(format!("{}: {}: {error}", shown(path), job.model.name)).of(&error),
            };
            // A panic is reported by the run.
            if let Ok(built) = study::caught("the model", || study::built(&job.model)) {
                built.map_err(wrong)?;
            }
        }
    }
    for job in work.iter().flat_map(|work| work.kind.jobs()) {
        prepare_folder(&job.folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    }

    for (i, work) in work.iter().enumerate() {
        if i > 0 && !request.quiet {
            console.print("\n")?;
        }
        // The other models run even if one fails.
        let done = match &work.kind {
            Kind::Alone(job) => run_and_report(&work.path, job, request, console, told),
            Kind::Scenes(scenes) => scenes.run(&work.path, request, console, told),
        };
        status = status.max(done.unwrap_or_else(|failure| console.failure(&failure)));
        if interrupt::asked() {
            status = Status::Interrupted;
            break;
        }
    }
    if let Some(junit) = &request.junit {
        junit.write()?;
    }
    Ok(status)
}

fn run_and_report(
    path: &Path,
    job: &Job,
    request: &Request,
    console: &mut Console,
    told: &mut Told,
) -> Result<Status, Failure> {
    let done = run_one(job, request);
    told(path, job, done.as_ref());
    let done = done?;
    if !request.quiet {
        let files = format!("  {}: {}\n", done.folder.display(), file_names(&done.files));
        console.print(&(overview(&done.summary) + &files))?;
        if let Some(points) = done.files.iter().find(|file| file.ends_with(POINTS)) {
            let model = path.display();
            console.print(&format!("  ends again: mbint sample {model} --points {}\n", points.display()))?;
        }
        if let Some(stored) = &done.stored {
            console.print(&format!("  {stored}\n"))?;
        }
    }
    report(&done, console);
    Ok(done.status)
}

/// The default folder of a model's results; a scene has a folder of its own in it.
pub(super) fn results_of(name: &str) -> PathBuf {
    name.split('/').fold(PathBuf::from("results"), |folder, part| folder.join(file_stem(part)))
}

/// A model that could be read, with its folder for results, which is ready.
///
/// # Errors
/// If the folder cannot be created.
pub(super) fn with_folder(
    model: Option<Description>,
    output: Option<&PathBuf>,
) -> Result<Option<(Description, PathBuf)>, Failure> {
    let Some(model) = model else { return Ok(None) };
    let folder = output.cloned().unwrap_or_else(|| results_of(&model.name));
    prepare_folder(&folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    Ok(Some((model, folder)))
}

/// Gives every model a folder of its own.
fn work(models: Vec<load::LoadedModel>, request: &Request) -> Result<Vec<Work>, Failure> {
    let several = request.models.len() > 1;
    let mut taken: HashMap<String, PathBuf> = HashMap::new();
    let mut work = Vec::new();
    for (number, load::LoadedModel { path, name, scenes, all, files, texts }) in models.into_iter().enumerate() {
        let stem = file_stem(&name);
        // Some systems do not distinguish upper and lower case.
        if let Some(other) = taken.insert(stem.to_lowercase(), path.clone()) {
            let (first, second) = (other.display(), path.display());
            let message = format!("{first} and {second} would both write the results of `{name}`");
            return Err(Failure::wrong(format!("{message}: run them separately, each with its own --output")));
        }
        let folder = match &request.output {
            Some(folder) if several => folder.join(stem),
            Some(folder) => folder.clone(),
            None => results_of(&name),
        };
        // A single requested scene is run like a model.
        let alone = request.scenes.len() == 1;
        let share = if alone { 1 } else { scenes.len() };
        let beside = path.parent().map(PathBuf::from).unwrap_or_default();
        let mut jobs = scenes.into_iter().map(|(scene, mut model)| {
            if let Some(proof) = request.certify {
                model.bounds.certified = Some(Certified { proof });
            }
            let folder = scene.as_ref().map_or_else(|| folder.clone(), |scene| folder.join(file_stem(scene)));
            let (files, texts, beside) = (files.clone(), texts.clone(), beside.clone());
            let page = alone || scene.is_none();
            let path = path.clone();
            let job = Job { model, path, folder, files, texts, beside, share, page, number, scene: scene.clone() };
            (scene, job)
        });
        let first = jobs.next();
        let scenes: Vec<(String, Job)> = match first {
            Some((scene, job)) if alone || scene.is_none() => {
                work.push(Work { path, kind: Kind::Alone(Box::new(job)) });
                continue;
            }
            first => first.into_iter().chain(jobs).filter_map(|(scene, job)| Some((scene?, job))).collect(),
        };
        work.push(Work { path, kind: Kind::Scenes(Scenes::new(name, folder, all, scenes)) });
    }
    Ok(work)
}
