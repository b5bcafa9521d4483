//! `mbint fit`: parameters that agree with measured values.

use super::args::FitArgs;
use super::console::{BOLD, Console, count, file_names};
use super::question::{answer, ask};
use super::run::with_folder;
use super::tuning::TUNING;
use super::{Failure, Status, interrupt, load};
use crate::applications::{self, FitError, Measurements};
use crate::export::{FIT_OVERLAY, rounded, write_fit};
use crate::grammar::display_unit::ShownUnit;
use crate::model::{is_standard_input, shown};
use crate::overview::short;
use crate::overview::{Align, Table};
use crate::results::{ConsistentSet, Fit, Unexplained};
use crate::study::RunError;

pub(super) fn fit(args: FitArgs, console: &mut Console) -> Result<Status, Failure> {
    let given = args.set.given()?;
    load::input_once(&[args.model.clone(), args.data.clone()])?;
    let model = load::load(&args.model, &given, args.run.scene.as_ref(), console)?;
    let Some(model) = model else { return Ok(Status::Wrong) };
    let table = match is_standard_input(&args.data) {
        true => std::io::read_to_string(std::io::stdin()),
        false => std::fs::read_to_string(&args.data),
    };
    let of_data = |error: &dyn std::fmt::Display| Failure::wrong(format!("{}: {error}", shown(&args.data)));
    let table = table.map_err(|error| of_data(&error))?;
    let measurements = Measurements::read(&table, &model, &args.noise).map_err(|error| of_data(&error).of(&error))?;
    let Some((model, folder)) = with_folder(Some(model), args.output.as_ref())? else { return Ok(Status::Wrong) };
    let found = ask(&model.name, &args.run, args.yes, |options| applications::fit(&model, &measurements, options));
    let found = match found {
        Ok(found) => found,
        Err(_) if interrupt::asked() => return Ok(Status::Interrupted),
        Err(error) => {
            let message = format!("{}: {error}", model.name);
            return Err(match &error {
                FitError::NoParameter | FitError::Run(RunError::Costly(_) | RunError::Memory(_)) => {
                    Failure::wrong(message)
                }
                _ => Failure::failed(message),
            }
            .of(&error));
        }
    };
    interrupt::wait_for(&folder)?;
    let files = write_fit(&folder, &found);
    let files = files.map_err(|error| Failure::failed(format!("{}: {error}", model.name)).of(&error))?;
    answer(&found, args.format, args.run.quiet, console, || {
        let mut text = overview(&found);
        text += &format!("  {}: {}\n", folder.display(), file_names(files.iter()));
        if found.set.is_some() {
            text += &format!("  mbint run {} --with {}\n", args.model.display(), folder.join(FIT_OVERLAY).display());
        }
        text
    })?;
    Ok(match (&found.set, &found.unexplained) {
        (_, Some(unexplained)) => {
            console.error(&contradiction(&found, unexplained));
            Status::NotMet
        }
        (Some(set), None) if set.volumes[0] == 0.0 => {
            console.warning(&format!(
                "{}: no parameters are known to agree with all rows: errors of the model are as large as the noise",
                found.model
            ));
            Status::Unresolved
        }
        _ => Status::Done,
    })
}

/// Prints the result for people.
fn overview(found: &Fit) -> String {
    let outputs: Vec<&str> = found.outputs.iter().map(|output| output.name.as_str()).collect();
    let mut text = format!(
        "{BOLD}{}{BOLD:#}: {} of {}, {}\n  residuals of least squares: {} of the noise bounds (root mean square)\n",
        found.model,
        count(found.rows.len(), "measured value", "measured values"),
        outputs.join(", "),
        count(found.simulations, "simulation", "simulations"),
        short(found.residual),
    );
    text += &errors(found);
    text += &parameters(found);
    if let Some(set) = &found.set {
        text += &consistent(found, set);
    }
    if found.parameters.len() > Fit::MOST_PARAMETERS {
        text += &format!("  the consistent set is paved for up to {} parameters\n", Fit::MOST_PARAMETERS);
    }
    text
}

/// The largest error of the model, and the number of unknown rows.
fn errors(found: &Fit) -> String {
    let known = found.rows.iter().filter(|row| row.error.is_finite());
    let largest = known.clone().map(|row| row.error / row.noise).fold(0.0, f64::max);
    let lost = found.rows.len() - known.count();
    let text = format!("  errors of simulation and surrogate: {largest:.1e} of the noise bounds at most\n");
    match lost {
        0 => text + "\n",
        _ => text + &format!("  {} without a reliable value of the model: not used\n\n", count(lost, "row", "rows")),
    }
}

fn parameters(found: &Fit) -> String {
    let mut table = Table::new([
        ("parameter", Align::Left),
        ("model", Align::Right),
        ("", Align::Right),
        ("least squares", Align::Right),
        ("± std. dev.", Align::Right),
        ("consistent", Align::Right),
        ("", Align::Right),
        ("unit", Align::Left),
    ]);
    for own in &found.parameters {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let shown = |value: f64| short(unit.of_si(value));
        let deviation = if own.deviation.is_finite() { shown(own.deviation) } else { "open".to_owned() };
        let [lower, upper] = own.hull.map_or_else(|| ["none".to_owned(), String::new()], |hull| hull.map(shown));
        let [from, to] = own.prior.map(shown);
        table.row([own.name.clone(), from, to, shown(own.estimate), deviation, lower, upper, unit.text.to_owned()]);
    }
    table.render(2)
}

fn consistent(found: &Fit, set: &ConsistentSet) -> String {
    let [inner, outer] = set.volumes;
    let mut text = format!(
        "  consistent: {:.4e} to {:.4e} of the model's box by volume ({:.1} % apart), {} boxes\n",
        inner,
        outer,
        100.0 * (outer - inner) / outer,
        set.boxes[0] + set.boxes[1]
    );
    if let (Some(axis), true) = (set.axes.first(), found.parameters.len() > 1) {
        let terms = axis.direction.iter().zip(&found.parameters).filter(|(own, _)| own.abs() > 0.05);
        let terms: Vec<String> = terms.map(|(own, parameter)| format!("{own:+.2} {}", parameter.name)).collect();
        text += &format!(
            "  most open: {} (in half intervals), {:.2} % of an interval\n",
            terms.join(" "),
            50.0 * axis.extent
        );
    }
    if !set.at_limits.is_empty() {
        text += &format!("  as far as the model's interval: {}; a wider one may show more\n", set.at_limits.join(", "));
    }
    text
}

/// Rows that no parameters explain.
fn contradiction(found: &Fit, unexplained: &Unexplained) -> String {
    let named = |row: usize| {
        let row = &found.rows[row];
        let output = &found.outputs[row.output];
        format!("line {} ({} at t = {} s)", row.line, output.name, rounded(row.time))
    };
    let mut text = format!(
        "{}: no parameters within the intervals agree with all rows; some would if the noise were {} times as large",
        found.model,
        short(unexplained.factor)
    );
    for &(row, excess) in unexplained.alone.iter().take(TUNING.unexplained_rows) {
        let output = &found.outputs[found.rows[row].output];
        let unit = ShownUnit::of(&output.display, &output.unit);
        text += &format!(
            "\n  {} alone: missed by {} {} beyond its noise",
            named(row),
            short(unit.of_si(excess)),
            unit.text
        );
    }
    if unexplained.alone.len() > TUNING.unexplained_rows {
        text += &format!("\n  and {} more", unexplained.alone.len() - TUNING.unexplained_rows);
    }
    if let Some((row, factor)) = unexplained.worst {
        text += &match factor <= 1.0 {
            true => format!("\n  without {} the others agree", named(row)),
            false => {
                format!("\n  without {} noise {} times as large is enough for the others", named(row), short(factor))
            }
        };
    }
    text
}
