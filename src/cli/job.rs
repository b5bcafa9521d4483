//! One job of `mbint run`: a model or a scene, its run, its files and its report.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::console::Console;
use super::kept_run::{KeptRun, context, expected};
use super::profile::Profile;
use super::progress::Progress;
use super::request::{Job, Request, Settings};
use super::resolution::resolution;
use super::verdicts;
use super::{Failure, Status, interrupt, report as page};
use crate::export::{holds_complete_results, remove_comparison, write_results};
use crate::model::Description;
use crate::overview::warnings;
use crate::results::{Bounds, Provenance, Summary};
use crate::simulate::SimulationError;
use crate::store::PartStore;
use crate::study;

/// Outcome of a run.
pub(super) struct Done {
    pub status: Status,
    pub bounds: Bounds,
    pub summary: Summary,
    pub files: Vec<PathBuf>,
    /// Folder of the results; an interrupted run does not replace a complete one.
    pub folder: PathBuf,
    /// Simulations read from the store and added to it, in words.
    pub stored: Option<String>,
}

/// Called for each job with its model's file and its outcome.
pub(super) type Told<'t> = dyn FnMut(&Path, &Job, Result<&Done, &Failure>) + 't;

/// Runs a model and writes its results. The status says whether they are reliable; [`report`] prints why not.
pub(super) fn run_one(job: &Job, request: &Request) -> Result<Done, Failure> {
    let name = &job.model.name;
    let profile = &request.settings.profile;
    profile.iter().for_each(|profile| profile.model(name));
    let done = study::caught("the model's run", || run_and_write(job, request));
    profile.iter().for_each(Profile::end);
    let done = done.unwrap_or_else(|error| Err(Failure::failed(format!("{name}: {error}"))));
    if let Some(junit) = &request.junit {
        let outcome = done.as_ref().map(|done| &done.summary);
        junit.add(name, outcome.map_err(Failure::message));
    }
    done
}

/// A model's bounds, with a progress bar meanwhile. A run that would take too long is refused with [`Failure::wrong`]
/// before it begins.
pub(super) fn bounds(
    model: &Description,
    settings: &Settings,
    store: Option<(&KeptRun, &PartStore)>,
    begun: &(dyn Fn() + Sync),
) -> Result<(Bounds, Summary), Failure> {
    let progress = Progress::new(&model.name, !settings.quiet);
    let set_progress = |fraction| {
        begun();
        progress.set(fraction);
    };
    // Models that `check` refuses are refused with the same status.
    let has_begun = AtomicBool::new(false);
    let there = store.filter(|_| !settings.quiet).map(|(kept, _)| kept.there());
    let options = study::Options {
        methods: settings.methods.clone(),
        threads: settings.threads,
        certify_time: settings.certify_time,
        skip_infeasible: settings.skip_infeasible,
        derivatives: settings.derivatives,
        costly: settings.yes,
        store: store.map(|(_, store)| store),
        disk: &|bytes| {
            if let Some(there) = &there {
                progress.note(&expected(&model.name, there, bytes));
            }
        },
        progress: &set_progress,
        stage: &|stage| {
            has_begun.fetch_or(stage != study::COMPILING, Ordering::Relaxed);
            progress.stage(stage);
            settings.profile.iter().for_each(|profile| profile.stage(stage));
        },
        subsystem: &|index| settings.profile.iter().for_each(|profile| profile.subsystem(index)),
        interrupted: &interrupt::asked,
        ..study::Options::default()
    };
    study::run(model, options).map_err(|error| {
        let message = format!("{}: {error}", model.name);
        match &error {
            study::RunError::Costly(_) | study::RunError::Memory(_) => Failure::wrong(message),
            study::RunError::Simulation(SimulationError::Deferred) => Failure::deferred(),
            _ if !has_begun.load(Ordering::Relaxed) => Failure::wrong(message),
            _ => Failure::failed(message),
        }
        .of(&error)
    })
}

fn run_and_write(job: &Job, request: &Request) -> Result<Done, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", job.model.name));
    // There are results to keep from the first rows on.
    let asked = request.asked();
    let context = || context(&job.files, &asked.set, job.scene.as_deref(), asked.skip_infeasible);
    let store = request.store.as_ref().map(|kept| kept.open(&context())).transpose();
    let store = store.map_err(|error| failed(&error).of(&error))?;
    let kept = request.store.as_ref().zip(store.as_ref());
    let found = bounds(&job.model, &request.settings, kept, &|| interrupt::keep_results(true));
    if let Some((kept, store)) = kept
        && !kept.close(job.number, job.scene.as_deref(), store)
    {
        found.map_or_else(|failure| if failure.is_deferred() { Ok(()) } else { Err(failure) }, |_| Ok(()))?;
        return Err(Failure::deferred());
    }
    let (bounds, mut summary) = found?;
    if summary.is_cut && bounds.times.is_empty() {
        return Err(failed(&"interrupted before there were results"));
    }
    let named = request.named.get(job.number).unwrap_or(&job.path);
    verdicts::add_commands(&mut summary, named, &request.given);
    let written = if request.timings { summary.clone() } else { summary.without_seconds() };
    // An interrupted run waits for nobody.
    let is_free = interrupt::wait_for(&job.folder).is_ok();
    let interrupted = summary.is_cut || interrupt::asked();
    let folder = match !is_free || interrupted && !request.overwrite && holds_complete_results(&job.folder) {
        true => beside(&job.folder),
        false => job.folder.clone(),
    };
    // The comparison of scenes is that of one run.
    if let Some(all) = folder.parent().filter(|_| !job.page && folder == job.folder) {
        interrupt::wait_for(all)?;
        remove_comparison(all).map_err(|error| failed(&error).of(&error))?;
    }
    let provenance = Provenance { model_files: job.files.clone(), request: Some(asked) };
    let stage = |name| request.settings.profile.iter().for_each(|profile| profile.stage(name));
    stage("motion for the report");
    let parts = (request.report && !interrupted)
        .then(|| page::parts(job, &bounds.functions, &summary, request.settings.threads));
    // A partial motion is omitted.
    let parts = parts.filter(|_| !interrupt::asked());
    stage("writing files");
    let files = write_results(&folder, &bounds, &written, &provenance, interrupted, parts.as_ref());
    let files = files.map_err(|error| failed(&error).of(&error))?;
    interrupt::keep_results(false);
    let resolved = || resolution(&bounds, &summary).max(verdicts::status(&summary));
    let within = if summary.beyond_tolerance.is_some() { Status::Unresolved } else { Status::Done };
    let status = if summary.failure.is_some() { Status::Failed } else { resolved().max(within) };
    let stored = kept.map(|(kept, store)| kept.found(store));
    Ok(Done { status, bounds, summary, files, folder, stored })
}

/// The folder for an interrupted run's results next to those of a complete one.
fn beside(folder: &Path) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_owned();
    name.push(".interrupted");
    folder.with_file_name(name)
}

/// Prints the warnings about a run's results.
pub(super) fn report(done: &Done, console: &Console) {
    let name = &done.summary.model;
    if let Some(failure) = &done.summary.failure {
        console.coded_error(done.summary.failure_code, &format!("{name}: {failure}"));
        if done.folder.to_string_lossy().ends_with(".interrupted") {
            let folder = done.folder.display();
            console.warning(&format!(
                "{name}: the older results are kept; the results of this run so far are in {folder} (--overwrite replaces them)"
            ));
        }
        return;
    }
    for warning in warnings(&done.bounds, &done.summary) {
        console.coded_warning(warning.code, &format!("{name}: {}", warning.text));
    }
}
