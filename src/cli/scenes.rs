//! `mbint run` of a model with scenes: one run for each, then files that compare them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::console::{BOLD, Console, count, file_names};
use super::job::{Done, Told, report, run_one};
use super::request::{Job, Request};
use super::{Failure, Status, interrupt};
use crate::export::{SceneBounds, write_scenes};
use crate::grammar::display_unit::ShownUnit;
use crate::overview::{Align, Table};
use crate::results::foremost;
use crate::results::{ErrorSummary, Summary};

/// A model's scenes that are run together.
pub(super) struct Scenes {
    model: String,
    /// Folder that contains a folder for each scene.
    folder: PathBuf,
    /// Names of all scenes of the model, whether they are run or not.
    all: Vec<String>,
    jobs: Vec<(String, Job)>,
}

/// Outcome of a scene's run, and its time, compilation included.
struct Ran<'s> {
    scene: &'s str,
    seconds: f64,
    /// `None` if the run failed.
    done: Option<Done>,
}

impl Scenes {
    pub fn new(model: String, folder: PathBuf, all: Vec<String>, jobs: Vec<(String, Job)>) -> Self {
        Self { model, folder, all, jobs }
    }

    pub fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.jobs.iter().map(|(_, job)| job)
    }

    /// Runs all scenes, or those before an interruption. The others run even if one fails.
    pub fn run(
        &self,
        path: &Path,
        request: &Request,
        console: &mut Console,
        told: &mut Told,
    ) -> Result<Status, Failure> {
        let mut status = Status::Done;
        let mut ran: Vec<Ran> = Vec::new();
        for (scene, job) in &self.jobs {
            let start = Instant::now();
            let done = run_one(job, request);
            told(path, job, done.as_ref());
            let done = match done {
                Ok(done) => {
                    report(&done, console);
                    status = status.max(done.status);
                    Some(done)
                }
                Err(failure) => {
                    status = status.max(console.failure(&failure));
                    None
                }
            };
            ran.push(Ran { scene, seconds: start.elapsed().as_secs_f64(), done });
            if interrupt::asked() {
                break;
            }
        }
        let found: Vec<SceneBounds> = ran
            .iter()
            .filter_map(|ran| Some(SceneBounds { name: ran.scene, bounds: &ran.done.as_ref()?.bounds }))
            .collect();
        // The comparison of scenes is written when all are finished.
        interrupt::wait_for(&self.folder)?;
        let files = if found.is_empty() || status == Status::Deferred {
            Ok(Vec::new())
        } else {
            write_scenes(&self.folder, &self.model, &self.all, &found, request.report)
        };
        let files = files.map_err(|error| Failure::failed(format!("{}: {error}", self.model)).of(&error))?;
        if !request.quiet {
            console.print(&self.overview(&ran, &files))?;
        }
        Ok(status)
    }

    /// Results scene by scene and their files, for people.
    fn overview(&self, ran: &[Ran], files: &[PathBuf]) -> String {
        let not_run = self.jobs.len() - ran.len();
        let mut text = format!("{BOLD}{}{BOLD:#}: {}", self.model, count(self.jobs.len(), "scene", "scenes"));
        if not_run > 0 {
            text += &format!(", {} not run", count(not_run, "of them was", "of them were"));
        }
        let rows = ran.iter().map(|ran| (ran.scene, ran.seconds, ran.done.as_ref().map(|done| &done.summary)));
        text += &format!("\n\n{}\n", table(rows).render(2));
        if !files.is_empty() {
            let written = |scene: &str| ran.iter().any(|ran| ran.scene == scene && ran.done.is_some());
            let folders = self.jobs.iter().filter(|(scene, _)| written(scene)).map(|(_, job)| &job.folder);
            let folders: Vec<String> = folders.map(|folder| format!("{}/", file_names([folder]))).collect();
            let (folder, names) = (self.folder.display(), file_names(files));
            text += &format!("  {folder}: {names}; {}\n", folders.join(", "));
        }
        text
    }
}

/// Coordinates and time of each scene, and the largest width and error of each output's bounds.
fn table<'s>(scenes: impl Iterator<Item = (&'s str, f64, Option<&'s Summary>)>) -> Table<7> {
    let mut table = Table::new([
        ("scene", Align::Left),
        ("coordinates", Align::Right),
        ("seconds", Align::Right),
        ("bounds", Align::Left),
        ("unit", Align::Left),
        ("largest width", Align::Right),
        ("error", Align::Right),
    ]);
    for (scene, seconds, summary) in scenes {
        let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { format!("{value:.2e}") };
        let size = summary.map_or_else(|| "–".to_owned(), |summary| summary.coordinates.to_string());
        let mut first = [scene.to_owned(), size, format!("{seconds:.3}")];
        let foremost = |bands| foremost(bands, |band: &ErrorSummary| band.unresolved_from.is_none());
        let bands = summary.map_or(&[][..], |summary| &summary.errors);
        let mut of_outputs = bands.chunk_by(|a, b| a.output == b.output).filter_map(foremost).peekable();
        let none = of_outputs.peek().is_none();
        for band in of_outputs {
            let name = format!("{}.{}", band.output, band.method);
            let [scene, size, seconds] = std::mem::take(&mut first);
            let unit = ShownUnit::of(&band.display, &band.unit);
            let [width, error] = [band.width, band.error].map(|value| number(unit.of_si(value)));
            table.row([scene, size, seconds, name, unit.text.to_owned(), width, error]);
        }
        if none {
            let [scene, size, seconds] = first;
            let what = if summary.is_some() { "" } else { "not run, or failed" };
            table.row([scene, size, seconds, what.to_owned(), String::new(), String::new(), String::new()]);
        }
    }
    table
}
