//! `mbint gradient`: derivatives of outputs over time, of reduced outputs and of margins by all uncertain parameters.

use super::args::GradientArgs;
use super::console::{BOLD, Console, file_names};
use super::question::{answer, ask};
use super::run::with_folder;
use super::tuning::TUNING;
use super::{Failure, Status, interrupt, load};
use crate::export::{by_influence, shown_derivative, write_gradients};
use crate::overview::short;
use crate::overview::{Align, Table};
use crate::results::{DerivativesAt, Gradients, ReducedGradients};
use crate::study::{self, GradientError, RunError};

pub(super) fn gradient(args: GradientArgs, console: &mut Console) -> Result<Status, Failure> {
    let given = args.set.given()?;
    let model = load::load(&args.model, &given, args.run.scene.as_ref(), console)?;
    let Some((model, folder)) = with_folder(model, args.output.as_ref())? else { return Ok(Status::Wrong) };
    let found = ask(&model.name, &args.run, true, |options| study::gradient(&model, options).map_err(Box::new));
    let found = match found {
        Err(error) if error.is_interruption() => return Ok(Status::Interrupted),
        found => found.map_err(|error| {
            let message = format!("{}: {error}", model.name);
            match &*error {
                GradientError::NoParameter | GradientError::NoOutput | GradientError::None(_) => {
                    Failure::wrong(message)
                }
                GradientError::Run(RunError::Costly(_) | RunError::Memory(_) | RunError::Refused(_)) => {
                    Failure::wrong(message)
                }
                GradientError::Run(_) | GradientError::Lost { .. } => Failure::failed(message),
            }
            .of(&*error)
        })?,
    };
    let outputs = found.outputs.iter().enumerate();
    let outputs = outputs.map(|(number, output)| output.at(&found.times, row(&found, number, args.at)));
    let shown: Vec<DerivativesAt> = outputs.chain(found.reduced.iter().map(ReducedGradients::at)).collect();
    interrupt::wait_for(&folder)?;
    let files = write_gradients(&folder, &found, &shown);
    let files = files.map_err(|error| Failure::failed(format!("{}: {error}", model.name)).of(&error))?;
    if let Some(from) = found.unreliable_from {
        console.warning(&format!(
            "{}: derivatives are not reliable from t = {} s on: a contact or a kink of the equations lies within a step, and the motion cannot be followed from one such event to the next",
            found.model,
            short(from)
        ));
    }
    answer(&found, args.format, args.run.quiet, console, || {
        overview(&found, &shown) + &format!("  {}: {}\n", folder.display(), file_names(files.iter()))
    })?;
    Ok(Status::Done)
}

/// The row at which an output's derivatives are shown.
fn row(found: &Gradients, output: usize, at: Option<f64>) -> usize {
    let Some(at) = at else { return found.outputs[output].most_sensitive(&found.parameters) };
    let distance = |row: &usize| (found.times[*row] - at).abs();
    (0..found.times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// Prints the derivatives for people, a table for each number.
fn overview(found: &Gradients, shown: &[DerivativesAt<'_>]) -> String {
    let mut text = format!("{BOLD}{}{BOLD:#}: derivatives at the nominal values\n", found.model);
    for own in shown {
        let value = format!("{} {}", short(own.unit.of_si(own.value)), own.unit.text);
        let margin = if own.is_margin { "margin of " } else { "" };
        let at = own.time.map_or_else(String::new, |time| format!(" at t = {} s", short(time)));
        text += &format!("\n  {margin}{} = {}{at}\n", own.name, value.trim_end());
        let influences = by_influence(&found.parameters, own.by_parameters);
        let mut table = Table::new([
            ("parameter", Align::Left),
            ("derivative", Align::Right),
            ("unit", Align::Left),
            ("over half of the interval", Align::Right),
            ("unit", Align::Left),
        ]);
        for &(parameter, by, influence) in influences.iter().take(TUNING.parameters_of_gradient) {
            let parameter = &found.parameters[parameter];
            let (by, of_both) = shown_derivative(own.unit, parameter, by);
            let influence = short(own.unit.of_si(influence));
            table.row([parameter.name.clone(), short(by), of_both, influence, own.unit.text.to_owned()]);
        }
        text += &table.render(2);
        if influences.len() > TUNING.parameters_of_gradient {
            text += &format!("  and {} of less influence\n", influences.len() - TUNING.parameters_of_gradient);
        }
    }
    text
}
