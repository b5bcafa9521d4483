//! Sensitivities of stacks of dimensions, for people.

use super::table::{Align, Table};
use super::tuning::TUNING;
use super::words::short;
use crate::export::shown_sensitivity;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{OutputStatisticsSummary, Sensitivity, Summary};

/// Characters of the longest bar.
const BAR: f64 = 24.0;

/// A table for each output that is a stack: derivatives with their signs, deviations and shares as bars.
pub fn sensitivities(summary: &Summary) -> String {
    let outputs = summary.statistics.iter().flat_map(|found| &found.summary.outputs);
    outputs.filter(|output| !output.sensitivities.is_empty()).map(|output| of_output(summary, output)).collect()
}

fn of_output(summary: &Summary, output: &OutputStatisticsSummary) -> String {
    let mut table = Table::new([
        ("dimension", Align::Left),
        ("sensitivity", Align::Right),
        ("unit", Align::Left),
        ("by its tolerance", Align::Right),
        ("unit", Align::Left),
        ("share of RSS", Align::Right),
        ("", Align::Left),
    ]);
    let unit = ShownUnit::of(&output.display, &output.unit);
    let acting = || output.sensitivities.iter().filter(|own| own.share > 0.0);
    let most = acting().map(|own| own.deviation.abs()).fold(0.0, f64::max);
    for own in acting().take(TUNING.stack_rows) {
        let Sensitivity { parameter, deviation, share, .. } = own;
        let (derivative, quotient) = shown_sensitivity(output, &summary.parameters, own);
        let bar = "#".repeat((BAR * deviation.abs() / most).ceil() as usize);
        let (deviation, share) = (signed(unit.of_si(*deviation)), format!("{:.1} %", 100.0 * share));
        let (derivative, unit) = (signed(derivative), unit.text.to_owned());
        table.row([parameter.clone(), derivative, quotient, deviation, unit, share, bar]);
    }
    let more = match acting().count() {
        count if count > TUNING.stack_rows => format!("  and {} of less influence\n", count - TUNING.stack_rows),
        _ => String::new(),
    };
    format!("\n  {} follows\n{}{more}\n", output.output, table.render(2))
}

/// A number with its sign; four digits.
fn signed(value: f64) -> String {
    let digits: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    format!("{}{}", if value > 0.0 { "+" } else { "" }, short(digits))
}
