//! One job of `mbint run`: a model or a scene, its run, its files and what is reported of it.

use std::path::{Path, PathBuf};

use super::args::RunArgs;
use super::console::Console;
use super::overview::{damped, excluded, unreliable};
use super::progress::Progress;
use super::{Failure, Status, interrupt};
use crate::export::{holds_complete_results, write_results};
use crate::model::{Description, Override};
use crate::results::{Bounds, Method, OutputBounds, Summary};
use crate::study;

/// The arguments of a run, checked.
pub(super) struct Request {
    pub models: Vec<PathBuf>,
    pub overrides: Vec<Override>,
    /// Empty for all scenes.
    pub scenes: Vec<String>,
    /// `None` for the model's own methods.
    methods: Option<Vec<Method>>,
    pub certify: bool,
    pub output: Option<PathBuf>,
    threads: Option<usize>,
    pub quiet: bool,
    timings: bool,
    overwrite: bool,
    yes: bool,
    certify_time: bool,
    skip_infeasible: bool,
}

/// A model, or a scene of it, with the folder for its results.
pub(super) struct Job {
    pub model: Description,
    pub folder: PathBuf,
}

/// Outcome of a run.
pub(super) struct Done {
    pub status: Status,
    pub bounds: Bounds,
    pub summary: Summary,
    pub files: Vec<PathBuf>,
    /// Where they are; an interrupted run does not replace a complete one.
    pub folder: PathBuf,
}

impl Request {
    pub fn check(args: RunArgs) -> Result<Self, Failure> {
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
            overwrite: args.overwrite,
            yes: args.yes,
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

/// Runs a model and writes its results. The status says whether they are reliable; [`report`] prints why not.
pub(super) fn run_one(job: &Job, request: &Request) -> Result<Done, Failure> {
    let name = &job.model.name;
    let done = study::caught("the model's run", || run_and_write(job, request));
    done.unwrap_or_else(|error| Err(Failure::Failed(format!("{name}: {error}"))))
}

fn run_and_write(job: &Job, request: &Request) -> Result<Done, Failure> {
    let name = &job.model.name;
    let failed = |error: &dyn std::fmt::Display| Failure::Failed(format!("{name}: {error}"));
    let progress = Progress::new(name, !request.quiet);
    // From the first rows on there is something to keep.
    let set_progress = |fraction| {
        interrupt::keep_results(true);
        progress.set(fraction);
    };
    let options = study::Options {
        methods: request.methods.clone(),
        threads: request.threads,
        certify_time: request.certify_time,
        skip_infeasible: request.skip_infeasible,
        costly: request.yes,
        progress: &set_progress,
        interrupted: &interrupt::asked,
    };
    let (bounds, summary) = study::run(&job.model, options).map_err(|error| match error {
        study::RunError::Costly(_) => Failure::Wrong(format!("{name}: {error}")),
        error => failed(&error),
    })?;
    drop(progress);

    let written = if request.timings { summary.clone() } else { summary.without_seconds() };
    let interrupted = interrupt::asked();
    let folder = match interrupted && !request.overwrite && holds_complete_results(&job.folder) {
        true => beside(&job.folder),
        false => job.folder.clone(),
    };
    let files = write_results(&folder, &bounds, &written, interrupted).map_err(|error| failed(&error))?;
    interrupt::keep_results(false);
    let status = if summary.failure.is_some() { Status::Failed } else { resolution(&bounds) };
    Ok(Done { status, bounds, summary, files, folder })
}

/// The folder for an interrupted run's results beside those of a complete one.
fn beside(folder: &Path) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_owned();
    name.push(".interrupted");
    folder.with_file_name(name)
}

/// Prints what is wrong with a run's results.
pub(super) fn report(done: &Done, console: &Console) {
    let name = &done.summary.model;
    if let Some(failure) = &done.summary.failure {
        console.error(&format!("{name}: {failure}"));
        if done.folder.to_string_lossy().ends_with(".interrupted") {
            let folder = done.folder.display();
            console.warning(&format!(
                "{name}: the older results are complete and are kept; what there is of this run is in {folder} (--overwrite replaces them)"
            ));
        }
        return;
    }
    if let Some(message) = unreliable(&done.summary) {
        console.warning(&format!("{name}: {message}"));
    }
    if let Some(message) = damped(&done.summary) {
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
