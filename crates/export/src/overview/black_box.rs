//! A program that answers instead of a mechanism, for people.

use super::tuning::TUNING;
use super::words::count;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{BlackBoxSummary, ErrorSummary, NoiseSummary};
use crate::syntax::harmless;

/// The program, at the head of an overview.
pub fn heading(own: &BlackBoxSummary) -> String {
    format!("a black box, `{}`", harmless(&own.command.join(" ")))
}

/// Reliability of a program's answers; `errors` are those of all bands.
pub fn lines(own: &BlackBoxSummary, errors: &[ErrorSummary]) -> String {
    let steps = match &own.refined_by {
        Some(parameter) => format!("the error of its own steps was found by finer `{parameter}`"),
        None => "the error of its own steps is not included (`refine` says how to find it)".to_owned(),
    };
    let noise = |own: &NoiseSummary| {
        let unit = ShownUnit::of(&own.display, &own.unit);
        format!("{} {:.2e} {}", own.output, unit.of_si(own.noise), unit.text).trim_end().to_owned()
    };
    let noise = match own.noise.iter().map(noise).collect::<Vec<_>>() {
        noise if noise.is_empty() => "the same answers".to_owned(),
        noise => format!("noise of {}", noise.join(", ")),
    };
    let abrupt = |error: &&ErrorSummary| error.width > 0.0 && error.surrogate > TUNING.abrupt * error.width;
    let jumps: String = errors.iter().filter(abrupt).map(|error| {
        let share = 100.0 * error.surrogate / error.width;
        format!(
            "  {}.{}: held-out answers are off by {share:.0} % of the width: the response jumps between samples, or has noise\n",
            error.output, error.method
        )
    }).collect();
    format!("  black box: {steps}; {} asked twice: {noise}\n{jumps}\n", count(own.repeated, "point", "points"))
}
