//! `mbint sweep`: reduced outputs' bounds for values of one or two parameters.

use super::args::{SweepArgs, overlaid};
use super::console::{BOLD, Console, count, file_names};
use super::job;
use super::load::Given;
use super::request::Settings;
use super::run::results_of;
use super::tuning::TUNING;
use super::{Failure, Status, interrupt, load, verdicts};
use crate::api::Axis;
use crate::export::{Sweep, SweepAxis, SweepPoint, prepare_folder, write_sweep};
use crate::grammar::display_unit::ShownUnit;
use crate::model::Override;
use crate::overview::{Align, Table};
use crate::overview::{band, short};

/// A parameter over a range: `l1=0.1..0.2:11`, optionally followed by a unit and a tolerance. `None` if the text has no
/// range.
fn axis(text: &str) -> Result<Option<Axis>, Failure> {
    let Some((name, range)) = text.split_once('=') else { return Ok(None) };
    let Some((lower, rest)) = range.split_once("..") else { return Ok(None) };
    let wrong = || Failure::wrong(format!("`{text}` is not of the form `NAME=FROM..TO:VALUES`, as `l1=0.1..0.2:11`"));
    let (upper, rest) = rest.split_once(':').ok_or_else(wrong)?;
    let digits = rest.trim_start().find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.trim_start().len());
    let (values, behind) = rest.trim_start().split_at(digits);
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(wrong);
    let (lower, upper) = (number(lower)?, number(upper)?);
    let values: usize = values.parse().map_err(|_| wrong())?;
    if !(2..=TUNING.values_of_axis).contains(&values) {
        return Err(Failure::wrong(format!("`{text}`: from 2 to {} values can be swept", TUNING.values_of_axis)));
    }
    let last = (values - 1) as f64;
    // Weights, so that the ends are exact.
    let at = |index: usize| (lower * (last - index as f64) + upper * index as f64) / last;
    Ok(Some(Axis::new(name.trim(), &(0..values).map(at).collect::<Vec<f64>>()).with(behind.trim())))
}

pub(super) fn sweep(args: SweepArgs, console: &mut Console) -> Result<Status, Failure> {
    let (mut axes, mut others) = (Vec::new(), Vec::new());
    for text in &args.set {
        match axis(text)? {
            Some(axis) => axes.push(axis),
            None => others.push(setting(text)?),
        }
    }
    if !(1..=2).contains(&axes.len()) {
        let message = "one parameter or two are swept: give `--set NAME=FROM..TO:VALUES` for each";
        return Err(Failure::wrong(message.to_owned()));
    }
    if let [first, second] = &axes[..]
        && first.name() == second.name()
    {
        return Err(Failure::wrong(format!("parameter `{}` is swept twice", first.name())));
    }
    let mut others = overlaid(&args.with, &others)?;
    others.retain(|own| axes.iter().all(|axis| axis.name() != own.name));
    let runs: usize = axes.iter().map(Axis::count).product();
    if runs > TUNING.runs_of_sweep {
        return Err(Failure::wrong(format!("{runs} runs are more than the {} of a sweep", TUNING.runs_of_sweep)));
    }
    let settings = Settings { threads: args.run.threads.number(), yes: args.yes, quiet: true, ..Settings::default() };
    console.without_repetition();
    let mut status = Status::Done;
    let mut points = Vec::with_capacity(runs);
    let mut name = String::new();
    for values in Axis::combinations(&axes) {
        let mut given = Given { overrides: others.clone(), root: args.files.root.clone(), witness: None };
        for (parameter, value) in Axis::settings(&axes, &values) {
            given.overrides.push(setting(&format!("{parameter}={value}"))?);
        }
        let scenes: Vec<String> = args.run.scene.iter().cloned().collect();
        let loaded = load::load_all(std::slice::from_ref(&args.model), &given, &scenes, console)?;
        let Some(model) = loaded.and_then(|loaded| loaded.models.into_iter().next()) else { return Ok(Status::Wrong) };
        let Some((_, description)) = model.scenes.into_iter().next() else { return Ok(Status::Wrong) };
        if description.reduced.is_empty() && description.requirements.is_empty() {
            let message = "a sweep is of reduced outputs or requirements, and the model has none: add e.g. `stroke: { range: slider.x }` to `outputs`";
            return Err(Failure::wrong(format!("{}: {message}", args.model.display())));
        }
        name.clone_from(&description.name);
        let point = match job::bounds(&description, &settings, None, &|| ()) {
            Ok((_, summary)) => {
                status = status.max(verdicts::status(&summary));
                SweepPoint { values, summary: Some(summary) }
            }
            Err(failure) if failure.status() == Status::Failed => {
                let message = failure.message();
                status = status.max(Status::Failed);
                console.warning(&format!(
                    "{}: {message}",
                    given.overrides.iter().map(|own| own.text.as_str()).collect::<Vec<_>>().join(", ")
                ));
                SweepPoint { values, summary: None }
            }
            Err(wrong) => return Err(wrong),
        };
        points.push(point);
        if interrupt::asked() {
            status = Status::Interrupted;
            break;
        }
    }
    let sweep = Sweep { model: name.clone(), axes: axes.iter().map(Axis::heading).collect(), points };
    let folder = args.output.clone().unwrap_or_else(|| results_of(&name));
    prepare_folder(&folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    interrupt::wait_for(&folder)?;
    let files = write_sweep(&folder, &sweep).map_err(|error| Failure::failed(format!("{name}: {error}")).of(&error))?;
    if !args.run.quiet {
        let simulations = sweep.simulations();
        let head = format!(
            "{BOLD}{name}{BOLD:#}: {}, {}\n\n",
            count(sweep.points.len(), "run", "runs"),
            count(simulations, "simulation", "simulations")
        );
        console.print(&format!("{head}{}\n  {}: {}\n", table(&sweep), folder.display(), file_names(files.iter())))?;
    }
    Ok(status)
}

fn setting(text: &str) -> Result<Override, Failure> {
    Override::parse(text).map_err(|diagnostics| Failure::wrong(format!("--set {text}: {diagnostics}")).of(&diagnostics))
}

/// Lower and upper bounds of each reduced output, and margins of requirements.
fn table(sweep: &Sweep) -> String {
    let mut table = Table::new([
        ("at", Align::Left),
        ("of", Align::Left),
        ("from", Align::Right),
        ("to", Align::Right),
        ("unit", Align::Left),
        ("verdict", Align::Left),
    ]);
    for point in &sweep.points {
        let at = |(axis, value): (&SweepAxis, &f64)| {
            format!("{}={} {}", axis.name, short(*value), axis.unit).trim_end().to_owned()
        };
        let mut at = sweep.axes.iter().zip(&point.values).map(at).collect::<Vec<_>>().join(", ");
        let Some(summary) = &point.summary else {
            table.row([at, "failed".to_owned(), String::new(), String::new(), String::new(), String::new()]);
            continue;
        };
        for own in &summary.reduced {
            let unit = ShownUnit::of(&own.display, &own.unit);
            let ends = band(own).map_or([f64::NAN; 2], |band| [band.lower, band.upper]);
            let [lower, upper] = ends.map(|end| short(unit.of_si(end)));
            table.row([std::mem::take(&mut at), own.name.clone(), lower, upper, unit.text.to_owned(), String::new()]);
        }
        for own in &summary.requirements {
            let (unit, verdict) = (ShownUnit::of(&own.display, &own.unit), own.verdict.name().to_owned());
            let (what, margin) = (format!("margin of {}", own.name), short(unit.of_si(own.margin)));
            table.row([std::mem::take(&mut at), what, margin, String::new(), unit.text.to_owned(), verdict]);
        }
    }
    table.render(2)
}
