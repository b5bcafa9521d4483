//! `mbint allocate`: the loosest, or cheapest, tolerances that meet all requirements.

use super::args::AllocateArgs;
use super::console::{BOLD, Console, count, file_names};
use super::question::ask;
use super::run::with_folder;
use super::{Failure, Status, interrupt, load};
use crate::applications::{self, AllocateError, AllocateOptions};
use crate::export::{OVERLAY, rounded, shown_unit, write_allocation};
use crate::grammar::display_unit::ShownUnit;
use crate::overview::{Align, Table};
use crate::overview::{requirements, short, yields};
use crate::results::{AllocatedTolerance, Allocation, Criterion, ToleranceZone};
use crate::study::RunError;

pub(super) fn allocate(args: AllocateArgs, console: &mut Console) -> Result<Status, Failure> {
    let given = args.set.given()?;
    let model = load::load(&args.model, &given, args.run.scene.as_ref(), console)?;
    let Some((model, folder)) = with_folder(model, args.output.as_ref())? else { return Ok(Status::Wrong) };
    // An interruption preserves confirmed results of a study.
    interrupt::keep_results(true);
    let asked = AllocateOptions { share: args.share, widest: args.widest };
    let found = ask(&model.name, &args.run, args.yes, |options| applications::allocate(&model, asked, options));
    let found = match found {
        Ok(found) => found,
        Err(AllocateError::Run(_)) if interrupt::asked() => {
            console.error(&format!("{}: interrupted before tolerances were confirmed", model.name));
            return Ok(Status::Interrupted);
        }
        Err(error) => {
            let message = format!("{}: {error}", model.name);
            return Err(match &error {
                AllocateError::Unsuitable(_) | AllocateError::Run(RunError::Costly(_) | RunError::Memory(_)) => {
                    Failure::wrong(message)
                }
                AllocateError::Run(_) => Failure::failed(message),
            }
            .of(&error));
        }
    };
    interrupt::wait_for(&folder)?;
    let files = write_allocation(&folder, &found);
    let files = files.map_err(|error| Failure::failed(format!("{}: {error}", model.name)).of(&error))?;
    if !args.run.quiet {
        let mut text = overview(&found);
        text += &format!("  {}: {}\n", folder.display(), file_names(files.iter()));
        if found.not_met.is_empty() {
            let model = args.model.display();
            text += &format!("  mbint run {model} --with {}\n", folder.join(OVERLAY).display());
        }
        console.print(&text)?;
    }
    for own in &found.not_met {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let message = format!(
            "{}: `{}` cannot be met: with the tightest tolerances it is missed by {} {} (± {:.1e})",
            found.model,
            own.requirement,
            short(-unit.of_si(own.margin)),
            unit.text,
            unit.of_si(own.error)
        );
        console.error(&message);
    }
    Ok(match (found.not_met.is_empty(), found.is_confirmed) {
        _ if interrupt::asked() => {
            console.error(&format!("{}: interrupted: these tolerances hold, and cheaper ones may exist", found.model));
            Status::Interrupted
        }
        (false, _) => Status::NotMet,
        (true, true) => Status::Done,
        (true, false) => {
            console.warning(&format!("{}: a study at the result does not confirm it", found.model));
            Status::Unresolved
        }
    })
}

/// Prints the result for people.
fn overview(found: &Allocation) -> String {
    let criterion = match found.criterion {
        Criterion::WorstCase => "every case".to_owned(),
        Criterion::Share(share) => format!("a yield of {} %", rounded(100.0 * share)),
    };
    let off = found.surrogate_error;
    let off = off.map(|error| format!("; the surrogate's margins are off by {error:.1e} of the nominal ones at most"));
    let mut text = format!(
        "{BOLD}{}{BOLD:#}: {}, for {criterion}\n  {} for the surrogate, {} to confirm{}\n\n",
        found.model,
        count(found.tolerances.len(), "tolerance", "tolerances"),
        count(found.simulations, "simulation", "simulations"),
        found.confirming,
        off.unwrap_or_default(),
    );
    text += &tolerances(found);
    if !found.is_exhaustive {
        text += "  there are too many grades to try all: cheaper ones may exist\n";
    }
    if found.tolerances.iter().any(|own| own.at_widest && own.grade.is_none()) {
        text += "  *: as loose as the search allows; --widest extends it\n";
    }
    text += "\n";
    if !found.requirements.is_empty() && found.criterion == Criterion::WorstCase {
        text += &format!("{}\n", requirements(&found.requirements));
    }
    text += &yields(&found.yields);
    if !found.yields.is_empty() {
        text += "\n";
    }
    text
}

fn tolerances(found: &Allocation) -> String {
    let mut table = Table::new([
        ("parameter", Align::Left),
        ("tolerance", Align::Right),
        ("allocated", Align::Right),
        ("unit", Align::Left),
        ("grade", Align::Left),
        ("cost", Align::Right),
        ("then", Align::Right),
        ("share", Align::Right),
        ("then", Align::Right),
    ]);
    let cost = |cost: Option<f64>| cost.map_or_else(String::new, short);
    let percent = |share: f64| if share.is_nan() { String::new() } else { format!("{:.0} %", 100.0 * share) };
    for own in &found.tolerances {
        let (_, unit) = shown_unit(own);
        let star = if own.at_widest && own.grade.is_none() { "*" } else { "" };
        let after = if own.is_free { format!("{}{star}", zone(own, own.after)) } else { "stays".to_owned() };
        table.row([
            own.parameter.clone(),
            zone(own, own.before),
            after,
            unit.to_owned(),
            own.grade.clone().unwrap_or_default(),
            cost(own.cost_before),
            cost(own.cost_after),
            percent(own.share_before),
            percent(own.share_after),
        ]);
    }
    let costs = found.costs();
    if costs[1].is_some() {
        let empty = String::new;
        let [before, after] = costs.map(cost);
        table.row(["in all".to_owned(), empty(), empty(), empty(), empty(), before, after, empty(), empty()]);
    }
    format!("{}  shares are of `{}`\n", table.render(2), found.tightest)
}

/// `± 0.3`, or `+0.3 -0.1`.
fn zone(own: &AllocatedTolerance, ToleranceZone { above, below }: ToleranceZone) -> String {
    let (scale, _) = shown_unit(own);
    let digits = |value: f64| short(scale * value);
    if (above - below).abs() <= 1e-9 * above.max(below) {
        return format!("± {}", digits(above));
    }
    format!("+{} -{}", digits(above), digits(below))
}
