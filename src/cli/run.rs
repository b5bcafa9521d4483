//! `mbint run`: bounds of models, written to files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::args::RunArgs;
use super::console::{BOLD, Console, count, file_names};
use super::progress::Progress;
use super::scenes::Scenes;
use super::table::{Align, Table};
use super::{Failure, Status, interrupt, load};
use crate::assemble;
use crate::export::{file_stem, prepare_folder, write_results};
use crate::methods::Certified;
use crate::model::Description;
use crate::model::{Override, shown};
use crate::results::{Bounds, Method, OutputBounds};
use crate::results::{ContributionSummary, ErrorSummary, ParameterSummary, Summary};
use crate::study;

/// What a run needs, checked.
pub(super) struct Request {
    models: Vec<PathBuf>,
    overrides: Vec<Override>,
    /// Empty: all that there are.
    scenes: Vec<String>,
    /// Absent: those that the model asks for.
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

/// What is run of a model.
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

/// What a run came to.
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
    // All that can be wrong is found before the first run, which may take hours.
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
        // A model that fails does not take the others with it.
        let done = match work {
            Work::Alone(job) => run_and_tell(job, &request, console),
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

fn run_and_tell(job: &Job, request: &Request, console: &mut Console) -> Result<Status, Failure> {
    let done = run_one(job, request)?;
    if !request.quiet {
        console.print(&overview(&done.summary, &job.folder, &done.files))?;
    }
    complain(&done, console);
    Ok(done.status)
}

/// Runs a model and writes its results; what of them is wrong is in the status, and told by [`complain`].
pub(super) fn run_one(job: &Job, request: &Request) -> Result<Done, Failure> {
    let name = &job.model.name;
    let failed = |error: &dyn std::fmt::Display| Failure::Failed(format!("{name}: {error}"));
    let progress = Progress::new(name, !request.quiet);
    let report = |fraction| progress.set(fraction);
    let options = study::Options {
        methods: request.methods.clone(),
        threads: request.threads,
        certify_time: request.certify_time,
        skip_infeasible: request.skip_infeasible,
        progress: &report,
        interrupted: &interrupt::asked,
    };
    let (bounds, summary) = study::run(&job.model, options).map_err(|error| failed(&error))?;
    drop(progress);

    let written = if request.timings { summary.clone() } else { summary.without_seconds() };
    let files = write_results(&job.folder, &bounds, &written).map_err(|error| failed(&error))?;
    let status = if summary.failure.is_some() { Status::Failed } else { resolution(&bounds) };
    Ok(Done { status, bounds, summary, files })
}

/// Tells what is wrong with a run's results.
pub(super) fn complain(done: &Done, console: &Console) {
    let name = &done.summary.model;
    if let Some(failure) = &done.summary.failure {
        console.error(&format!("{name}: {failure}"));
        return;
    }
    if let Some(message) = unresolved(&done.summary) {
        console.warning(&format!("{name}: {message}"));
    }
    if let Some(message) = left_out(&done.bounds, &done.summary) {
        console.warning(&format!("{name}: {message}"));
    }
}

/// Whether every output is resolved by some method at every time.
fn resolution(bounds: &Bounds) -> Status {
    // A method that is lost where another is not leaves an answer.
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

/// Every parameter is set once at most.
pub(super) fn set_once(overrides: &[Override]) -> Result<(), Failure> {
    let twice = |&(i, setting): &(usize, &Override)| overrides[..i].iter().any(|earlier| earlier.name == setting.name);
    match overrides.iter().enumerate().find(twice) {
        Some((_, setting)) => Err(Failure::Wrong(format!("parameter `{}` is set twice", setting.name))),
        None => Ok(()),
    }
}

/// Where a model's results are by default; a scene's, in a folder of its own there.
pub(super) fn results_of(name: &str) -> PathBuf {
    name.split('/').fold(PathBuf::from("results"), |folder, part| folder.join(file_stem(part)))
}

/// Gives every model its folder; no two the same.
fn work(models: Vec<load::Model>, request: &Request) -> Result<Vec<Work>, Failure> {
    let several = models.len() > 1;
    let mut taken: HashMap<String, &Path> = HashMap::new();
    let mut work = Vec::new();
    for (load::Model { name, scenes }, path) in models.into_iter().zip(&request.models) {
        let stem = file_stem(&name);
        // Folders that differ only in upper and lower case are one on some systems.
        if let Some(other) = taken.insert(stem.to_lowercase(), path) {
            let (first, second) = (other.display(), path.display());
            let message = format!("{first} and {second} would both write the results of `{name}`");
            return Err(Failure::Wrong(format!("{message}: run them one by one, each with its own --output")));
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
        // A scene that is asked for alone is run as a model is.
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

/// How wide each band is and how far it may be from the truth.
fn errors(errors: &[ErrorSummary]) -> String {
    /// What still fits a screen.
    const MOST: usize = 24;
    let mut table = Table::new([
        ("bounds", Align::Left),
        ("largest width", Align::Right),
        ("error", Align::Right),
        ("of the surrogate", Align::Right),
        ("of the steps", Align::Right),
    ]);
    for error in errors.iter().take(MOST) {
        let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { format!("{value:.2e}") };
        let name = format!("{}.{}", error.output, error.method);
        table.row([name, number(error.width), number(error.error), number(error.surrogate), number(error.time)]);
    }
    match errors.len() {
        0 => String::new(),
        n if n > MOST => format!("{}  … and {} more in summary.json\n\n", table.render(2), n - MOST),
        _ => format!("{}\n", table.render(2)),
    }
}

/// The three parameters that contribute most to each output.
fn contributions(contributions: &[ContributionSummary]) -> String {
    const MOST: usize = 3;
    let mut text = String::new();
    let varies = |contribution: &&ContributionSummary| contribution.total > 0.0;
    for of_output in contributions.chunk_by(|a, b| a.output == b.output) {
        let share = |contribution: &ContributionSummary| {
            format!("{} {:.0} %", contribution.parameter, 100.0 * contribution.total)
        };
        let shares: Vec<String> = of_output.iter().filter(varies).take(MOST).map(share).collect();
        // One parameter alone is no news.
        if of_output.len() > 1 && !shares.is_empty() {
            text += &format!("  tolerances that matter for {}: {}\n", of_output[0].output, shares.join(", "));
        }
    }
    if text.is_empty() { text } else { text + "\n" }
}

/// Which bounds cannot be relied on, and from when.
fn unresolved(summary: &Summary) -> Option<String> {
    const MOST: usize = 4;
    let mut bands: Vec<(f64, String)> = summary
        .errors
        .iter()
        .filter_map(|error| Some((error.unresolved_from?, format!("{}.{}", error.output, error.method))))
        .collect();
    let total = bands.len();
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    bands.truncate(MOST);
    let named = |(place, (time, band)): (usize, &(f64, String))| {
        format!("of `{band}`{} from {time} s", if place == 0 { " are unreliable" } else { "" })
    };
    let named: Vec<String> = bands.iter().enumerate().map(named).collect();
    let more = if total > MOST { format!(" and {} more", total - MOST) } else { String::new() };
    let help = "raise the order, shorten the step, or set `bounds: { tolerance: … }`";
    (total > 0).then(|| format!("bounds {}{more}: {help}", named.join(", ")))
}

/// Singular configurations, and outputs that no equilibrium determines.
fn singular(summary: &Summary) -> String {
    const MOST: usize = 4;
    let mut text = String::new();
    let passes = &summary.singular_configurations;
    if !passes.is_empty() {
        let times: Vec<String> = passes.iter().take(MOST).map(|pass| format!("{:.6}", pass.time)).collect();
        let more = if passes.len() > MOST { ", …" } else { "" };
        let passed = count(passes.len(), "singular configuration", "singular configurations");
        text += &format!(
            "  passes {passed}, at t = {}{more} s: others imply {} there\n",
            times.join(", "),
            named(&passes[0].constraints)
        );
    }
    if !summary.undetermined_outputs.is_empty() {
        text += &format!(
            "  not unique: {}. Equilibrium does not determine these reactions, since others imply {}, whose own are taken as 0\n",
            named(&summary.undetermined_outputs),
            named(&summary.redundant_constraints)
        );
    }
    text
}

/// Some names, and how many there are more.
fn named(names: &[String]) -> String {
    const MOST: usize = 6;
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    format!("{}{more}", names[..names.len().min(MOST)].join(", "))
}

/// Which part of the box is bounded, where it is not all of it.
fn left_out(bounds: &Bounds, summary: &Summary) -> Option<String> {
    let least = bounds.covered.iter().copied().fold(1.0, f64::min);
    if least == 1.0 {
        return None;
    }
    let hull = |(place, parameter): (usize, &ParameterSummary)| {
        let ends = summary.pieces.iter().map(|piece| (piece.lower[place], piece.upper[place]));
        let (lower, upper) = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let narrower = lower > parameter.lower || upper < parameter.upper;
        narrower.then(|| format!(", with {} from {lower} to {upper}", parameter.name))
    };
    let hulls: String = summary.parameters.iter().enumerate().filter_map(hull).collect();
    let pieces = count(summary.pieces.len(), "piece", "pieces");
    let times = bounds.times.iter().zip(&bounds.covered);
    let ended: Vec<&f64> =
        times.filter(|(_, share)| **share < bounds.covered[0]).map(|(time, _)| time).take(1).collect();
    let first = 100.0 * bounds.covered[0];
    let later = ended
        .first()
        .map_or(String::new(), |time| format!(", and of less from {time} s, {:.3} % at last", 100.0 * least));
    Some(format!("the bounds are of {first:.3} % of the box ({pieces}{hulls}){later}: see the column `covered`"))
}

/// What was done, and where it is, for people.
fn overview(summary: &Summary, folder: &Path, files: &[PathBuf]) -> String {
    let mut table = Table::new([
        ("method", Align::Left),
        ("simulations", Align::Right),
        ("steps", Align::Right),
        ("Newton iterations", Align::Right),
        ("seconds", Align::Right),
    ]);
    for method in &summary.methods {
        table.row([
            method.method.clone(),
            method.simulations.to_string(),
            method.steps.to_string(),
            method.newton_iterations.to_string(),
            method.seconds.map_or_else(|| "–".to_owned(), |seconds| format!("{seconds:.3}")),
        ]);
    }
    let mut text = format!(
        "{BOLD}{}{BOLD:#}: {}, {}, {}\n\n{}\n",
        summary.model,
        count(summary.coordinates, "coordinate", "coordinates"),
        count(summary.constraints, "constraint", "constraints"),
        count(summary.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
        table.render(2),
    );
    text += &errors(&summary.errors);
    text += &contributions(&summary.contributions);
    for method in summary.methods.iter().filter(|method| method.rank_revealing_solves > 0) {
        let steps = count(method.rank_revealing_solves as usize, "step", "steps");
        text += &format!("  {}: {steps} through a singular matrix, by the rank-revealing solve\n", method.method);
    }
    text += &singular(summary);
    text += &format!("  {}: {}\n", folder.display(), file_names(files.iter()));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::MethodSummary;

    #[test]
    fn the_overview_is_aligned() {
        let method = |method: &str, simulations, seconds, rank_revealing_solves| MethodSummary {
            method: method.into(),
            simulations,
            steps: 2000 * simulations,
            newton_iterations: 4013 * simulations as u64,
            rank_revealing_solves,
            order: None,
            boxes: None,
            seconds,
        };
        let summary = Summary {
            model: "slider_crank".into(),
            mbint: "0.1.0".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            redundant_constraints: vec![],
            undetermined_outputs: vec![],
            singular_at_start: vec![],
            singular_configurations: vec![],
            alpha: -0.1,
            duration: 2.0,
            parameters: vec![],
            methods: vec![method("nominal", 1, Some(0.0042), 0), method("scan", 900, None, 12)],
            errors: vec![ErrorSummary {
                output: "x3".into(),
                method: "scan".into(),
                width: 0.2,
                error: 2e-3,
                surrogate: f64::NAN,
                time: 1.5e-3,
                unresolved_from: None,
            }],
            contributions: vec![],
            pieces: vec![],
            not_simulated: vec![],
            subsystems: vec![],
            failure: None,
        };
        let files = ["bounds.csv", "x3.svg"].map(|name| Path::new("results/slider_crank").join(name));
        let text = overview(&summary, Path::new("results/slider_crank"), &files);
        let plain = anstream::adapter::strip_str(&text).to_string();
        insta::assert_snapshot!(plain, @r"
        slider_crank: 7 coordinates, 6 constraints, 1 degree of freedom

          method   simulations    steps  Newton iterations  seconds
          nominal            1     2000               4013    0.004
          scan             900  1800000            3611700        –

          bounds   largest width    error  of the surrogate  of the steps
          x3.scan        2.00e-1  2.00e-3           unknown       1.50e-3

          scan: 12 steps through a singular matrix, by the rank-revealing solve
          results/slider_crank: bounds.csv, x3.svg
        ");
    }
}
