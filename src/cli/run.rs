//! `mbint run`: computes bounds of models and writes them to files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::args::RunArgs;
use super::console::Console;
use super::overview::{excluded, overview, unreliable};
use super::progress::Progress;
use super::scenes::Scenes;
use super::{Failure, Status, interrupt, load};
use crate::assemble;
use crate::export::{file_stem, prepare_folder, write_results};
use crate::methods::Certified;
use crate::model::{Description, Override, shown};
use crate::results::{Bounds, Method, OutputBounds, Summary};
use crate::study;

/// The arguments of a run, checked.
pub(super) struct Request {
    models: Vec<PathBuf>,
    overrides: Vec<Override>,
    /// Empty for all scenes.
    scenes: Vec<String>,
    /// `None` for the model's own methods.
    methods: Option<Vec<Method>>,
    certify: bool,
    output: Option<PathBuf>,
    threads: Option<usize>,
    pub quiet: bool,
    timings: bool,
    certify_time: bool,
    skip_infeasible: bool,
}

/// A model, or a scene of it, with the folder for its results.
pub(super) struct Job {
    pub model: Description,
    pub folder: PathBuf,
}

/// The model, or its scenes.
enum Work {
    Alone(Box<Job>),
    Scenes(Scenes),
}

impl Work {
    fn jobs(&self) -> Vec<&Job> {
        match self {
            Self::Alone(job) => vec![job.as_ref()],
            Self::Scenes(scenes) => scenes.jobs().collect(),
        }
    }
}

/// Outcome of a run.
pub(super) struct Done {
    pub status: Status,
    pub bounds: Bounds,
    pub summary: Summary,
    pub files: Vec<PathBuf>,
}

pub(super) fn run(args: RunArgs, console: &mut Console) -> Result<Status, Failure> {
    let request = Request::check(args)?;
    let Some(models) = load::load_all(&request.models, &request.overrides, &request.scenes, console)? else {
        return Ok(Status::Wrong);
    };
    let work = work(models, &request)?;
    // Every model is checked before the first run, which may take hours.
    for (work, path) in work.iter().zip(&request.models) {
        for job in work.jobs() {
            let wrong = |error| match work {
                Work::Alone(_) => Failure::Wrong(format!("{}: {error}", shown(path))),
                Work::Scenes(_) => Failure::Wrong(format!("{}: {}: {error}", shown(path), job.model.name)),
            };
            assemble::build(&job.model).map_err(wrong)?;
        }
    }
    for job in work.iter().flat_map(Work::jobs) {
        prepare_folder(&job.folder).map_err(|error| Failure::Wrong(error.to_string()))?;
    }

    interrupt::listen();
    let mut status = Status::Done;
    for (i, work) in work.iter().enumerate() {
        if i > 0 && !request.quiet {
            console.print("\n")?;
        }
        // The other models run even if one fails.
        let done = match work {
            Work::Alone(job) => run_and_report(job, &request, console),
            Work::Scenes(scenes) => scenes.run(&request, console),
        };
        match done {
            Ok(done) => status = status.max(done),
            Err(Failure::Failed(message)) => {
                console.error(&message);
                status = status.max(Status::Failed);
            }
            Err(wrong) => return Err(wrong),
        }
        if interrupt::asked() {
            return Ok(Status::Interrupted);
        }
    }
    Ok(status)
}

fn run_and_report(job: &Job, request: &Request, console: &mut Console) -> Result<Status, Failure> {
    let done = run_one(job, request)?;
    if !request.quiet {
        console.print(&overview(&done.summary, &job.folder, &done.files))?;
    }
    report(&done, console);
    Ok(done.status)
}

/// Runs a model and writes its results. The status says whether they are reliable; [`report`] prints why not.
pub(super) fn run_one(job: &Job, request: &Request) -> Result<Done, Failure> {
    let name = &job.model.name;
    let failed = |error: &dyn std::fmt::Display| Failure::Failed(format!("{name}: {error}"));
    let progress = Progress::new(name, !request.quiet);
    let set_progress = |fraction| progress.set(fraction);
    let options = study::Options {
        methods: request.methods.clone(),
        threads: request.threads,
        certify_time: request.certify_time,
        skip_infeasible: request.skip_infeasible,
        progress: &set_progress,
        interrupted: &interrupt::asked,
    };
    let (bounds, summary) = study::run(&job.model, options).map_err(|error| failed(&error))?;
    drop(progress);

    let written = if request.timings { summary.clone() } else { summary.without_seconds() };
    let files = write_results(&job.folder, &bounds, &written).map_err(|error| failed(&error))?;
    let status = if summary.failure.is_some() { Status::Failed } else { resolution(&bounds) };
    Ok(Done { status, bounds, summary, files })
}

/// Prints what is wrong with a run's results.
pub(super) fn report(done: &Done, console: &Console) {
    let name = &done.summary.model;
    if let Some(failure) = &done.summary.failure {
        console.error(&format!("{name}: {failure}"));
        return;
    }
    if let Some(message) = unreliable(&done.summary) {
        console.warning(&format!("{name}: {message}"));
    }
    if let Some(message) = excluded(&done.bounds, &done.summary) {
        console.warning(&format!("{name}: {message}"));
    }
}

/// Whether some method gives reliable bounds of every output at every time.
fn resolution(bounds: &Bounds) -> Status {
    // One reliable method is enough.
    let answered = |output: &OutputBounds| {
        let resolved = |row: usize| output.bands.iter().any(|band| !band.error.unresolved[row]);
        output.bands.is_empty() || (0..bounds.times.len()).all(resolved)
    };
    if bounds.outputs.iter().all(answered) { Status::Done } else { Status::Unresolved }
}

impl Request {
    fn check(args: RunArgs) -> Result<Self, Failure> {
        set_once(&args.set)?;
        let mut scenes = args.scene;
        scenes.sort_unstable();
        scenes.dedup();
        let mut methods = args.method;
        methods.sort_unstable();
        methods.dedup();
        Ok(Self {
            models: args.models,
            overrides: args.set,
            scenes,
            methods: if methods.is_empty() { None } else { Some(methods) },
            certify: args.certify,
            output: args.output,
            threads: args.threads.map(usize::from),
            quiet: args.quiet,
            timings: args.timings,
            certify_time: args.certify_time,
            skip_infeasible: args.skip_infeasible,
        })
    }
}

/// Checks that every parameter is set at most once.
///
/// # Errors
/// For the first that is set twice.
pub(super) fn set_once(overrides: &[Override]) -> Result<(), Failure> {
    let twice = |&(i, setting): &(usize, &Override)| overrides[..i].iter().any(|earlier| earlier.name == setting.name);
    match overrides.iter().enumerate().find(twice) {
        Some((_, setting)) => Err(Failure::Wrong(format!("parameter `{}` is set twice", setting.name))),
        None => Ok(()),
    }
}

/// The default folder of a model's results; a scene has a folder of its own in it.
pub(super) fn results_of(name: &str) -> PathBuf {
    name.split('/').fold(PathBuf::from("results"), |folder, part| folder.join(file_stem(part)))
}

/// Gives every model a folder of its own.
fn work(models: Vec<load::Model>, request: &Request) -> Result<Vec<Work>, Failure> {
    let several = models.len() > 1;
    let mut taken: HashMap<String, &Path> = HashMap::new();
    let mut work = Vec::new();
    for (load::Model { name, scenes }, path) in models.into_iter().zip(&request.models) {
        let stem = file_stem(&name);
        // Some systems do not distinguish upper and lower case.
        if let Some(other) = taken.insert(stem.to_lowercase(), path) {
            let (first, second) = (other.display(), path.display());
            let message = format!("{first} and {second} would both write the results of `{name}`");
            return Err(Failure::Wrong(format!("{message}: run them separately, each with its own --output")));
        }
        let folder = match &request.output {
            Some(folder) if several => folder.join(stem),
            Some(folder) => folder.clone(),
            None => results_of(&name),
        };
        let mut jobs = scenes.into_iter().map(|(scene, mut model)| {
            if request.certify {
                model.bounds.certified = Some(Certified);
            }
            let folder = scene.as_ref().map_or_else(|| folder.clone(), |scene| folder.join(file_stem(scene)));
            (scene, Job { model, folder })
        });
        // A single requested scene is run like a model.
        let alone = request.scenes.len() == 1;
        let first = jobs.next();
        let scenes: Vec<(String, Job)> = match first {
            Some((scene, job)) if alone || scene.is_none() => {
                work.push(Work::Alone(Box::new(job)));
                continue;
            }
            first => first.into_iter().chain(jobs).filter_map(|(scene, job)| Some((scene?, job))).collect(),
        };
        work.push(Work::Scenes(Scenes::new(name, folder, scenes)));
    }
    Ok(work)
}
