//! `mbint design`: nominal values that are best with their tolerances.

use super::args::DesignArgs;
use super::console::{BOLD, Console, count, file_names};
use super::question::{answer, ask};
use super::run::with_folder;
use super::{Failure, Status, interrupt, load};
use crate::applications::{self, DesignError, DesignOptions};
use crate::export::tuning::TUNING as EXPORT;
use crate::export::{DESIGN_OVERLAY, rounded, shown_unit, write_design};
use crate::grammar::display_unit::ShownUnit;
use crate::overview::{Align, Table};
use crate::overview::{requirements, short};
use crate::results::{Allocation, Criterion, DesignPoint, DesignStudy, DesignTrade, ToleranceZone};
use crate::study::RunError;

pub(super) fn design(args: DesignArgs, console: &mut Console) -> Result<Status, Failure> {
    let given = args.set.given()?;
    let model = load::load(&args.model, &given, args.run.scene.as_ref(), console)?;
    let Some((model, folder)) = with_folder(model, args.output.as_ref())? else { return Ok(Status::Wrong) };
    let found = ask(&model.name, &args.run, args.yes, |options| {
        applications::design(&model, DesignOptions { share: args.share }, options)
    });
    let found = match found {
        Ok(found) => found,
        Err(_) if interrupt::asked() => return Ok(Status::Interrupted),
        Err(error) => {
            let message = format!("{}: {error}", model.name);
            return Err(match &error {
                DesignError::Unsuitable(_) | DesignError::Run(RunError::Costly(_) | RunError::Memory(_)) => {
                    Failure::wrong(message)
                }
                _ => Failure::failed(message),
            }
            .of(&error));
        }
    };
    interrupt::wait_for(&folder)?;
    let files = write_design(&folder, &found);
    let files = files.map_err(|error| Failure::failed(format!("{}: {error}", model.name)).of(&error))?;
    answer(&found, args.format, args.run.quiet, console, || {
        let mut text = overview(&found);
        text += &format!("  {}: {}\n", folder.display(), file_names(files.iter()));
        text + &format!("  mbint run {} --with {}\n", args.model.display(), folder.join(DESIGN_OVERLAY).display())
    })?;
    Ok(verdict(&found, console))
}

/// Prints the requirements that the best point does not meet.
fn verdict(found: &DesignStudy, console: &mut Console) -> Status {
    let Some(best) = found.best().filter(|best| !best.is_feasible) else { return Status::Done };
    for own in &found.not_met {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let message = format!(
            "{}: no values within the ranges meet `{}`: the nearest miss it by {} {} (± {:.1e})",
            found.model,
            own.requirement,
            short(-unit.of_si(own.margin)),
            unit.text,
            unit.of_si(own.error)
        );
        console.error(&message);
    }
    match (found.not_met.iter().any(|own| own.margin < -own.error), found.criterion, best.share) {
        (_, Criterion::Share(wanted), Some(share)) => {
            let percent = |share: f64| rounded((1e6 * share).floor() / 1e4);
            let message = format!(
                "{}: no values within the ranges give a yield of {} %: the nearest give {} %",
                found.model,
                percent(wanted),
                percent(share)
            );
            console.error(&message);
            Status::NotMet
        }
        (true, ..) => Status::NotMet,
        (false, ..) => Status::Unresolved,
    }
}

/// Prints the result for people.
fn overview(found: &DesignStudy) -> String {
    let criterion = match found.criterion {
        Criterion::WorstCase => "in every case".to_owned(),
        Criterion::Share(share) => format!("for {} % of the production", rounded(100.0 * share)),
    };
    let mut text = format!(
        "{BOLD}{}{BOLD:#}: {}, {criterion}\n  {} for surrogates, {} to confirm\n\n",
        found.model,
        found.objective.text,
        count(found.simulations, "simulation", "simulations"),
        found.confirming,
    );
    text += &points(found);
    if let Some(gain) = found.gain().filter(|gain| gain.abs() >= EXPORT.shown_gain) {
        let (value, words) = match found.is_priced() {
            true => ("cost", ["less", "more"]),
            false => ("worst case", ["better", "worse"]),
        };
        text += &format!(
            "  {value} {:.1} % {} than at the optimum without tolerances\n",
            100.0 * gain.abs(),
            words[usize::from(gain < 0.0)]
        );
    }
    let narrow = found.parameters.iter().filter(|own| own.searched != own.range);
    for own in narrow {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let [lower, upper] = own.searched.map(|end| short(unit.of_si(end)));
        text += &format!("  {} was searched from {lower} to {upper} {}\n", own.name, unit.text);
    }
    let at_limits: Vec<&str> = found.best().iter().flat_map(|best| &best.at_limits).map(String::as_str).collect();
    if !at_limits.is_empty() {
        text += &format!("  at an end of its range: {}\n", at_limits.join(", "));
    }
    text += "\n";
    if let Some(best) = found.best().filter(|best| !best.requirements.is_empty()) {
        text += &format!("{}\n", requirements(&best.requirements));
    }
    if !found.front.is_empty() {
        text += &front(found);
        return text;
    }
    if let Some([Some(before), Some(after)]) = found.allocation.as_ref().map(Allocation::costs) {
        text += &format!(
            "  tolerances there cost {}; the cheapest that meet the requirements cost {}\n",
            short(before),
            short(after)
        );
    }
    text
}

/// A table with a column for each of at most five things, after a name and a unit.
struct Columns<'t, T> {
    table: Table<7>,
    things: &'t [&'t T],
}

impl<'t, T> Columns<'t, T> {
    fn new(title: &'static str, headings: &[&'static str], things: &'t [&'t T]) -> Self {
        let heading = |index: usize| (headings.get(index).copied().unwrap_or(""), Align::Right);
        let first = [(title, Align::Left), ("unit", Align::Left)];
        let headings = std::array::from_fn(|index| first.get(index).copied().unwrap_or_else(|| heading(index - 2)));
        Self { table: Table::new(headings), things }
    }

    fn row(&mut self, name: &str, unit: &str, cell: &dyn Fn(&T) -> String) {
        let mut cells = [name, unit, "", "", "", "", ""].map(str::to_owned);
        cells[2..].iter_mut().zip(self.things).for_each(|(own, thing)| *own = cell(thing));
        self.table.row(cells);
    }
}

/// A column for each point: values, then the objective.
fn points(found: &DesignStudy) -> String {
    let model = found.model_point.as_ref().map(|point| ("model", point));
    let nominal = found.nominal_point.as_ref().map(|point| ("no tolerances", point));
    let optima = ["optimum", "second", "third"].into_iter().zip(&found.optima);
    let columns: Vec<(&str, &DesignPoint)> = model.into_iter().chain(nominal).chain(optima).collect();
    let (headings, points): (Vec<&str>, Vec<&DesignPoint>) = columns.into_iter().unzip();
    let mut table = Columns::new("", &headings, &points);
    let mut row = |name: &str, unit: &str, cell: &dyn Fn(&DesignPoint) -> String| table.row(name, unit, cell);
    for (index, own) in found.parameters.iter().enumerate() {
        let unit = ShownUnit::of(&own.display, &own.unit);
        row(&own.name, unit.text, &|point| short(unit.of_si(point.values[index])));
    }
    if found.is_priced() {
        row("cost", "", &|point| short(point.worst));
        row("requirements", "", &|point| if point.is_feasible { "hold" } else { "not met" }.to_owned());
        return table.table.render(2);
    }
    let unit = ShownUnit::of(&found.objective.display, &found.objective.unit);
    let is_margin = found.objective.text == "margin";
    let unit = if is_margin { ShownUnit { text: "%", si: 0.01 } } else { unit };
    let worst = match found.criterion {
        Criterion::WorstCase => "worst case".to_owned(),
        Criterion::Share(share) => format!("{} % within", rounded(100.0 * share)),
    };
    row("nominal", unit.text, &|point| short(unit.of_si(point.nominal)));
    row(&worst, unit.text, &|point| short(unit.of_si(point.worst)));
    row("± error", unit.text, &|point| format!("{:.1e}", unit.of_si(point.error)));
    if points.iter().any(|point| !point.requirements.is_empty()) {
        row("requirements", "", &|point| if point.is_feasible { "hold" } else { "not met" }.to_owned());
    }
    table.table.render(2)
}

/// A column for each margin, with the cheapest nominal values and tolerances for it.
fn front(found: &DesignStudy) -> String {
    let front: Vec<&DesignTrade> = found.front.iter().collect();
    let mut table = Columns::new("cost against", &vec!["margin"; front.len()], &front);
    let mut row = |name: &str, unit: &str, cell: &dyn Fn(&DesignTrade) -> String| table.row(name, unit, cell);
    row("margin", "%", &|own| short(100.0 * own.margin));
    row("cost", "", &|own| short(own.cost));
    for (index, own) in found.parameters.iter().enumerate() {
        let unit = ShownUnit::of(&own.display, &own.unit);
        row(&own.name, unit.text, &|own| short(unit.of_si(own.values[index])));
    }
    let changed = found.front.first().map_or(&[][..], |own| &own.tolerances).iter().enumerate();
    for (index, own) in changed.filter(|(_, own)| own.is_free) {
        let (scale, unit) = shown_unit(own);
        row(&format!("{} ±", own.parameter), unit, &|own| {
            let ToleranceZone { above, below } = own.tolerances[index].after;
            match above == below {
                true => short(scale * above),
                false => format!("+{} -{}", short(scale * above), short(scale * below)),
            }
        });
    }
    table.table.render(2)
}
