//! `mbint sample`: outputs over time at chosen points, in a file for other programs.

mod points;

use std::path::{Path, PathBuf};

pub(super) use self::points::Points;
use super::args::{FileFormat, SampleArgs, Threads};
use super::console::{BOLD, Console, count};
use super::kept_run::{KeptRun, context, expected};
use super::load::Given;
use super::progress::Progress;
use super::{Failure, Status, interrupt, load};
use crate::export::{ExportError, write_samples};
use crate::numerics::Sample;
use crate::results::{SampleFormat, SampleTable};
use crate::simulate::SimulationError;
use crate::store::Missing;
use crate::study::{self, ChosenSamples, RunError};

/// The samples and their destination.
pub(super) struct Sampling<'s> {
    pub model: &'s Path,
    pub given: &'s Given,
    pub scenes: &'s [String],
    pub points: &'s Points,
    /// `None` if nothing is to be written.
    pub output: Option<(&'s Path, SampleFormat)>,
    pub threads: Threads,
    pub quiet: bool,
    pub store: Option<&'s KeptRun>,
}

pub(super) fn sample(args: SampleArgs, console: &mut Console) -> Result<Status, Failure> {
    let points = Points::asked(&args.points)?;
    let Some(points) = points else {
        let message = "give points: `--points FILE`, or `--design sobol:1000` or `lhs:1000`";
        return Err(Failure::wrong(message.to_owned()));
    };
    let (path, format) = target(args.output, args.format);
    let store = args.store.map(|folder| KeptRun::new(folder, Missing::Simulate));
    let scenes: Vec<String> = args.run.scene.into_iter().collect();
    let given = args.set.given()?;
    let sampling = Sampling {
        model: &args.model,
        given: &given,
        scenes: &scenes,
        points: &points,
        output: Some((&path, format)),
        threads: args.run.threads,
        quiet: args.run.quiet,
        store: store.as_ref(),
    };
    sampling.run(console)
}

/// The file of the samples, and its format, which follows from its name unless it is given.
pub(super) fn target(output: Option<PathBuf>, format: Option<FileFormat>) -> (PathBuf, SampleFormat) {
    let is_csv = |path: &PathBuf| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let format = match format {
        Some(FileFormat::Csv) => SampleFormat::Csv,
        Some(FileFormat::Npz) => SampleFormat::Npz,
        None if output.as_ref().is_some_and(is_csv) => SampleFormat::Csv,
        // A table can be processed in a pipe.
        None if output.as_deref() == Some(Path::new("-")) => SampleFormat::Csv,
        None => SampleFormat::Npz,
    };
    let name = if format == SampleFormat::Csv { "samples.csv" } else { "samples.npz" };
    (output.unwrap_or_else(|| PathBuf::from(name)), format)
}

/// Reasons why there are no samples.
enum Ended {
    Run(RunError),
    Export(ExportError),
}

impl From<RunError> for Ended {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}

impl From<ExportError> for Ended {
    fn from(error: ExportError) -> Self {
        Self::Export(error)
    }
}

impl Sampling<'_> {
    /// Simulates missing samples and writes the file; leaves long tasks to shards if the study asks for it.
    ///
    /// # Errors
    /// If the model, the points or the file are wrong, or a simulation fails.
    pub fn run(&self, console: &mut Console) -> Result<Status, Failure> {
        let shown = self.model.display();
        let loaded = load::load_all(&[self.model.to_owned()], self.given, self.scenes, console)?;
        let Some(model) = loaded.and_then(|loaded| loaded.models.into_iter().next()) else { return Ok(Status::Wrong) };
        if model.scenes.len() > 1 {
            let message = format!("{shown}: the model has scenes; choose one by --scene: {}", model.all.join(", "));
            return Err(Failure::wrong(message));
        }
        let Some((scene, description)) = model.scenes.into_iter().next() else { return Ok(Status::Wrong) };
        if description.outputs.is_empty() {
            return Err(Failure::wrong(format!("{shown}: the model has no outputs over time")));
        }
        let (parameters, domain) = study::uncertain(&description);
        let parameters: Vec<(String, String)> = parameters.into_iter().map(|own| (own.name, own.unit)).collect();
        let points =
            self.points.of(&parameters, &domain).map_err(|error| Failure::wrong(format!("{shown}: {error}")))?;
        let name = &description.name;
        let set: Vec<String> = self.given.overrides.iter().map(|setting| setting.text.clone()).collect();
        let context = context(&model.files, &set, scene.as_deref(), false);
        let store = self.store.map(|kept| kept.open(&context)).transpose();
        let store = store.map_err(|error| Failure::failed(format!("{name}: {error}")).of(&error))?;
        let progress = Progress::new(name, !self.quiet);
        let there = self.store.filter(|_| !self.quiet).map(KeptRun::there);
        let options = study::Options {
            threads: self.threads.number(),
            store: store.as_ref(),
            disk: &|bytes| {
                if let Some(there) = &there {
                    progress.note(&expected(name, there, bytes));
                }
            },
            progress: &|fraction| progress.set(fraction),
            stage: &|stage| progress.stage(stage),
            interrupted: &interrupt::asked,
            ..study::Options::default()
        };
        let chosen = ChosenSamples {
            count: points.count(),
            at: &|places| points.at(places).into_iter().map(Sample::from).collect(),
        };
        let output = self.output;
        let mut ended = None;
        let done = study::sample(&description, &options, chosen, |trajectories| {
            let last = trajectories.times.last().copied().unwrap_or(0.0);
            ended = trajectories.ended.as_ref().map(|error| (error.to_string(), last));
            let table = SampleTable {
                count: points.count(),
                parameters: parameters.clone(),
                points: &|places| points.at(places),
                outputs: trajectories.outputs.clone(),
                times: trajectories.times.clone(),
            };
            let mut sampled = None;
            if let Some((path, format)) = output {
                write_samples::<Ended>(path, format, &table, |keep| {
                    sampled = trajectories.each(|values| keep(values).map_err(Ended::from))?;
                    Ok(sampled.is_some())
                })?;
            } else {
                sampled = trajectories.each(|_| Ok::<(), Ended>(()))?;
            }
            Ok::<_, Ended>(sampled)
        });
        drop(progress);
        if let (Some(kept), Some(store)) = (self.store, &store) {
            kept.close(0, scene.as_deref(), store);
        }
        let sampled = match done {
            Ok(sampled) => sampled,
            Err(Ended::Run(RunError::Simulation(SimulationError::Deferred))) => return Ok(Status::Deferred),
            Err(Ended::Run(error)) => return Err(Failure::failed(format!("{name}: {error}")).of(&error)),
            Err(Ended::Export(error)) => return Err(Failure::failed(format!("{name}: {error}")).of(&error)),
        };
        let Some(study::Sampled { closed, stopped }) = sampled else { return Ok(Status::Interrupted) };
        if closed + stopped > 0 {
            let message = format!(
                "{name}: of {}, {closed} cannot be assembled and {stopped} stopped before the end; their values are NaN from there on",
                count(points.count(), "sample", "samples")
            );
            console.warning(&message);
        }
        if let Some((error, last)) = &ended {
            let duration = description.simulation.duration;
            console.warning(&format!("{name}: {error}: there are no rows after t = {last} s of {duration} s"));
        }
        let is_file = |(path, _): &(&Path, SampleFormat)| *path != Path::new("-");
        if let Some((path, _)) = self.output.filter(is_file).filter(|_| !self.quiet) {
            let samples = count(points.count(), "sample", "samples");
            console.print(&format!("{BOLD}{name}{BOLD:#}: {samples} in {}\n", path.display()))?;
            if !description.reduced.is_empty() {
                let names: Vec<&str> = description.reduced.iter().map(|reduced| reduced.name.as_str()).collect();
                console
                    .print(&format!("  not sampled, because they follow from the values: {}\n", names.join(", ")))?;
            }
            if let Some((kept, store)) = self.store.zip(store.as_ref()) {
                console.print(&format!("  {}\n", kept.found(store)))?;
            }
        }
        Ok(if ended.is_some() { Status::Failed } else { Status::Done })
    }
}
