//! `mbint snapshot`: bounds as small text files next to the models, and the changes since they were recorded.

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::args::SnapshotArgs;
use super::console::{BOLD, Console, count};
use super::job;
use super::request::Settings;
use super::{Failure, Status, interrupt, load};
use crate::export::{Moved, Snapshot, file_stem, moved, snapshot_file, snapshot_table, write_snapshot};
use crate::model::{Description, shown};
use crate::overview::{Align, Table};
use crate::study;

/// A model or a scene, and the file of its snapshot.
struct Job {
    model: Description,
    /// The model's file.
    path: PathBuf,
    folder: PathBuf,
    /// Name of the snapshot's file in the folder.
    file: String,
}

pub(super) fn snapshot(args: SnapshotArgs, console: &mut Console) -> Result<Status, Failure> {
    let Some(loaded) = load::load_all(&args.models, &args.set.given()?, &args.scene, console)? else {
        return Ok(Status::Wrong);
    };
    let mut status = if loaded.is_complete { Status::Done } else { Status::Failed };
    let settings = Settings { threads: args.threads.number(), yes: args.yes, quiet: args.quiet, ..Settings::default() };
    let jobs = jobs(loaded.models, &args)?;
    for job in &jobs {
        let run = || if args.check { job.check(&settings, console) } else { job.record(&settings, console) };
        // The other models run even if one fails.
        let done = study::caught("the model's run", run)
            .unwrap_or_else(|error| Err(Failure::failed(format!("{}: {error}", job.model.name))));
        status = status.max(done.unwrap_or_else(|failure| console.failure(&failure)));
        if interrupt::asked() {
            return Ok(Status::Interrupted);
        }
    }
    Ok(status)
}

/// Gives every model and scene a file of its own.
fn jobs(models: Vec<load::LoadedModel>, args: &SnapshotArgs) -> Result<Vec<Job>, Failure> {
    let mut taken: HashMap<PathBuf, PathBuf> = HashMap::new();
    let mut jobs = Vec::new();
    for load::LoadedModel { path, scenes, .. } in models {
        let beside = path.parent().unwrap_or(Path::new(""));
        let folder = args.output.clone().unwrap_or_else(|| beside.to_owned());
        for (_, model) in scenes {
            // A scene's model is called `door/windy`.
            let file = format!("{}.snap", file_stem(&model.name.replace('/', ".")));
            // Some systems do not distinguish upper and lower case.
            if let Some(other) = taken.insert(folder.join(file.to_lowercase()), path.clone()) {
                let (first, second) = (shown(&other), shown(&path));
                return Err(Failure::wrong(format!(
                    "{first} and {second} have the same snapshot, {}: record them separately, each with its own --output",
                    folder.join(file).display()
                )));
            }
            jobs.push(Job { model, path: path.clone(), folder: folder.clone(), file });
        }
    }
    Ok(jobs)
}

impl Job {
    fn place(&self) -> PathBuf {
        self.folder.join(&self.file)
    }

    /// The present table of the snapshot.
    fn table(&self, settings: &Settings) -> Result<String, Failure> {
        let (bounds, summary) = job::bounds(&self.model, settings, None, &|| ())?;
        match summary.failure {
            Some(failure) => Err(Failure::failed(format!("{}: {failure}", self.model.name))),
            None => Ok(snapshot_table(&bounds)),
        }
    }

    fn record(&self, settings: &Settings, console: &mut Console) -> Result<Status, Failure> {
        let table = self.table(settings)?;
        let file = self.path.file_name().unwrap_or_default().to_string_lossy();
        let scene = self.model.name.split_once('/').map_or(String::new(), |(_, scene)| format!(", scene {scene}"));
        let text = snapshot_file(&format!("{file}{scene}"), &table);
        let place = self.place();
        let (name, shown) = (&self.model.name, place.display());
        let is_as_before = std::fs::read_to_string(&place).is_ok_and(|before| before == text);
        if !is_as_before {
            // A model's name alone has no folder.
            let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
            let written = write_snapshot(folder, &self.file, &text);
            written.map_err(|error| Failure::failed(format!("{name}: {error}")).of(&error))?;
        }
        if !settings.quiet {
            let what = if is_as_before { "as recorded in" } else { "recorded in" };
            console.print(&format!("{BOLD}{name}{BOLD:#}: {what} {shown}\n"))?;
        }
        Ok(Status::Done)
    }

    fn check(&self, settings: &Settings, console: &mut Console) -> Result<Status, Failure> {
        let (name, place) = (&self.model.name, self.place());
        let wrong = |error: &dyn std::fmt::Display| Failure::wrong(format!("{}: {error}", shown(&place)));
        let beside = self.path.parent() == Some(&self.folder);
        let elsewhere = if beside { String::new() } else { format!(" --output {}", shown(&self.folder)) };
        let again = || format!("`mbint snapshot {}{elsewhere}`", shown(&self.path));
        let text = match std::fs::read_to_string(&place) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                console.error(&format!("{name}: there is no snapshot {}; {} records it", shown(&place), again()));
                return Ok(Status::NotMet);
            }
            Err(error) => return Err(wrong(&error)),
        };
        let before = Snapshot::read(&text).map_err(|error| wrong(&error))?;
        let after = Snapshot::read(&self.table(settings)?)
            .map_err(|error| Failure::failed(format!("{name}: the snapshot cannot be read back: {error}")))?;
        let found = moved(&before, &after);
        let curves = count(after.curves(), "curve", "curves");
        if found.is_empty() {
            if !settings.quiet {
                console.print(&format!("ok {BOLD}{name}{BOLD:#}: {curves} as recorded\n"))?;
            }
            return Ok(Status::Done);
        }
        if !settings.quiet {
            console.print(&format!(
                "{BOLD}{name}{BOLD:#}: not as recorded in {}\n\n{}\n",
                shown(&place),
                moves(&found)
            ))?;
        }
        let what = count(found.len(), "curve has moved", "curves have moved");
        console.error(&format!("{name}: {what} beyond the stated errors; if that is right, {} records it", again()));
        Ok(Status::NotMet)
    }
}

/// Table of moved curves, with the times of their largest changes; empty if none moved.
pub(super) fn moves(found: &[Moved]) -> String {
    if found.is_empty() {
        return String::new();
    }
    let mut table = Table::new([
        ("output", Align::Left),
        ("time", Align::Right),
        ("before", Align::Right),
        ("after", Align::Right),
        ("allowed", Align::Right),
        ("unit", Align::Left),
        ("times", Align::Right),
    ]);
    for moved in found {
        let time = if moved.time.is_empty() { "–".to_owned() } else { format!("{} s", moved.time) };
        let allowed = moved.allowed.map_or_else(|| "–".to_owned(), |allowed| format!("{allowed:.1e}"));
        let times = moved.times.map_or_else(|| "–".to_owned(), |(moved, of)| format!("{moved} of {of}"));
        let [before, after] = [&moved.before, &moved.after].map(Clone::clone);
        table.row([moved.what.clone(), time, before, after, allowed, moved.unit.clone(), times]);
    }
    table.render(2)
}
