//! `mbint verify`: orders of a model's own manufactured motions.

use super::args::VerifyArgs;
use super::console::{BOLD, Console, count};
use super::question::{answer, ask};
use super::{Failure, Status, load};
use crate::applications::{self, VerifyError};
use crate::export::{Suite, write_junit, write_verification};
use crate::overview::short;
use crate::overview::{Align, Table};
use crate::results::{
    Convergence, DerivativeCheck, EffectBalance, Exchange, FormulationVerification, PowerBalance, Verification,
};
use crate::study::RunError;

pub(super) fn verify(args: &VerifyArgs, console: &mut Console) -> Result<Status, Failure> {
    let given = args.set.given()?;
    let Some(model) = load::load(&args.model, &given, args.run.scene.as_ref(), console)? else {
        return Ok(Status::Wrong);
    };
    let found = ask(&model.name, &args.run, true, |options| applications::verify(&model, options));
    let found = match found {
        Err(VerifyError::Interrupted) => return Ok(Status::Interrupted),
        found => found.map_err(|error| {
            let message = format!("{}: {error}", model.name);
            match &error {
                VerifyError::NoSteps(_) | VerifyError::Run(RunError::Refused(_)) => Failure::wrong(message),
                _ => Failure::failed(message),
            }
            .of(&error)
        })?,
    };
    answer(&found, args.format, args.run.quiet, console, || overview(&found))?;
    if let Some(path) = &args.junit {
        let written = write_junit(path, &[Suite::of_verification(&found)]);
        written.map_err(|error| Failure::failed(&error).of(&error))?;
    }
    if let Some(path) = &args.html {
        write_verification(path, &found).map_err(|error| Failure::failed(&error).of(&error))?;
    }
    Ok(if found.is_verified() { Status::Done } else { Status::NotMet })
}

/// Prints the verdict, and a table for each formulation.
fn overview(found: &Verification) -> String {
    let verdict = if found.is_verified() { "verified" } else { "not verified" };
    let mut text = format!("{BOLD}{}{BOLD:#}: {verdict}\n", found.model);
    found.formulations.iter().for_each(|own| text += &formulation(own));
    text
}

fn formulation(own: &FormulationVerification) -> String {
    let mut text = format!(
        "\n  {} coordinates: {}, {}",
        own.formulation,
        count(own.coordinates, "coordinate", "coordinates"),
        count(own.constraints, "constraint", "constraints")
    );
    if !own.redundant.is_empty() {
        text += &format!(", redundant: {}", own.redundant.join(", "));
    }
    if !own.singular_at_start.is_empty() {
        text += &format!(", singular at the start: {}", own.singular_at_start.join(", "));
    }
    if let Some(why) = &own.failure {
        return text + &format!("\n  not verified: {why}\n");
    }
    text += &format!("; a motion of {} s", short(own.duration));
    if own.begin > 0.0 {
        text += &format!(" from t = {} s on", short(own.begin));
    }
    text += "\n";
    let mut table = Table::new([
        ("scheme", Align::Left),
        ("of", Align::Left),
        ("order", Align::Right),
        ("theory", Align::Right),
        ("error", Align::Right),
        ("step, s", Align::Right),
        ("", Align::Left),
    ]);
    for scheme in &own.schemes {
        for (index, convergence) in scheme.convergence.iter().enumerate() {
            let name = if index == 0 { scheme.scheme.clone() } else { String::new() };
            table.row(row(name, convergence));
        }
        if let Some(why) = &scheme.failure {
            let none = String::new;
            table.row([scheme.scheme.clone(), none(), none(), none(), none(), none(), why.clone()]);
        }
    }
    text += &table.render(2);
    text += &differentiated(&own.derivatives);
    if let Some(balance) = &own.balance {
        text += &balanced(balance);
    }
    text
}

/// The largest difference of all derivatives, and those that are wrong.
fn differentiated(checks: &[DerivativeCheck]) -> String {
    let Some(worst) = checks.iter().max_by(|a, b| a.difference.total_cmp(&b.difference)) else {
        return String::new();
    };
    let count: usize = checks.iter().map(|check| check.derivatives).sum();
    let of = |check: &DerivativeCheck| format!("{}, {} by {}", short(check.difference), check.of, check.by);
    let mut text = format!("  derivatives: {count}, of differences with twice the digits at most {} off\n", of(worst));
    for check in checks.iter().filter(|check| !check.is_verified()) {
        text += &format!("  not the derivative: off by {}\n", of(check));
    }
    text
}

/// The balance of power, with a table of effects.
fn balanced(balance: &PowerBalance) -> String {
    let verdict = if balance.is_verified() { "" } else { "  not balanced" };
    let mut text = format!("  power: balanced to {} of {} W{verdict}\n", short(balance.defect), short(balance.size));
    if balance.effects.is_empty() {
        return text;
    }
    let mut table = Table::new([
        ("effect", Align::Left),
        ("kind", Align::Left),
        ("energy", Align::Left),
        ("power, W", Align::Right),
        ("puts in", Align::Right),
        ("takes", Align::Right),
    ]);
    balance.effects.iter().for_each(|effect| table.row(of_effect(effect)));
    text += &table.render(2);
    text
}

fn of_effect(own: &EffectBalance) -> [String; 6] {
    let exchange = own.exchange();
    let (puts_in, takes) = match exchange {
        Exchange::None | Exchange::Conserves => (0.0, 0.0),
        Exchange::Dissipates => (0.0, own.taken),
        Exchange::Drives => (own.put_in, own.taken),
    };
    let (effect, kind) = (own.effect.clone(), own.kind.clone());
    [effect, kind, exchange.name().to_owned(), short(own.power), short(puts_in), short(takes)]
}

fn row(scheme: String, own: &Convergence) -> [String; 7] {
    let (step, error) = own.errors.last().copied().unwrap_or((f64::NAN, f64::NAN));
    let verdict = if own.is_verified { String::new() } else { "not as in theory".to_owned() };
    [
        scheme,
        own.quantity.name().to_owned(),
        own.shown_order(),
        format!("{:.0}", own.theory),
        short(error),
        short(step),
        verdict,
    ]
}
