//! The overview of a run: methods, errors, tolerances that matter, singular configurations.

use super::marks::BOLD;
use super::table::{Align, Table};
use super::tuning::TUNING;
use super::words::{coordinates, count, digits};
use super::{assemblies, black_box, excitations, statistics, verdicts};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{AnalysisSummary, ContributionSummary, ErrorSummary, EventSummary, EventsFollowed, Summary};
use crate::simulate::is_one_number;

/// The largest width and error of each band.
fn errors(errors: &[ErrorSummary]) -> String {
    let mut table = Table::new([
        ("bounds", Align::Left),
        ("largest width", Align::Right),
        ("error", Align::Right),
        ("of the surrogate", Align::Right),
        ("of the steps", Align::Right),
        ("unit", Align::Left),
    ]);
    for error in errors.iter().take(TUNING.rows_of_errors) {
        let unit = ShownUnit::of(&error.display, &error.unit);
        let shown = |value: f64| format!("{:.2e}", unit.of_si(value));
        let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { shown(value) };
        let name = format!("{}.{}", error.output, error.method);
        let [width, total, surrogate, time] = [error.width, error.error, error.surrogate, error.time].map(number);
        table.row([name, width, total, surrogate, time, unit.text.to_owned()]);
    }
    match errors.len() {
        0 => String::new(),
        n if n > TUNING.rows_of_errors => {
            format!("{}  … and {} more in summary.json\n\n", table.render(2), n - TUNING.rows_of_errors)
        }
        _ => format!("{}\n", table.render(2)),
    }
}

/// Results of an analysis of one configuration, and the kind of an equilibrium.
fn analysis(analysis: &AnalysisSummary) -> String {
    let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { format!("{value:.5e}") };
    let mut table = Table::new([
        ("output", Align::Left),
        ("unit", Align::Left),
        ("nominal", Align::Right),
        ("lower", Align::Right),
        ("upper", Align::Right),
        ("error", Align::Right),
    ]);
    for value in analysis.values.iter().take(TUNING.rows_of_analysis) {
        let unit = ShownUnit::of(&value.display, &value.unit);
        let number = |of: f64| number(unit.of_si(of));
        let bounds = value.bounds.first();
        let [lower, upper] = [bounds.map(|b| b.1), bounds.map(|b| b.2)].map(|end| end.map_or_else(String::new, number));
        let error = bounds
            .map_or_else(String::new, |b| if b.3.is_nan() { number(b.3) } else { format!("{:.1e}", unit.of_si(b.3)) });
        table.row([value.output.clone(), unit.text.to_owned(), number(value.nominal), lower, upper, error]);
    }
    let mut text = if analysis.values.is_empty() { String::new() } else { format!("{}\n", table.render(2)) };
    if let Some(smallest) = analysis.stability {
        let is = match smallest {
            _ if !analysis.indifferent.is_empty() => {
                format!("indifferent: {} may have other values as well", named(&analysis.indifferent))
            }
            smallest if smallest < 0.0 => format!("unstable: it is left like exp({:.3e} t / s)", (-smallest).sqrt()),
            f64::INFINITY => "fixed by constraints alone: nothing can move".to_owned(),
            smallest => format!("stable: the slowest motion about it has {:.3e} rad/s", smallest.sqrt()),
        };
        text += &format!("  the nominal equilibrium is {is}\n\n");
    }
    if let Some(nominal) = analysis.growth {
        let is = match (nominal, analysis.largest_growth.unwrap_or(nominal)) {
            (nominal, _) if nominal.is_nan() => "stability is unknown: eigenvalues were not found".to_owned(),
            (nominal, _) if nominal > 0.0 => format!("unstable: a mode grows like exp({nominal:.3e} t / s)"),
            (_, most) if most > 0.0 => {
                format!("stable nominally, but not over the tolerances: a mode may grow like exp({most:.3e} t / s)")
            }
            (0.0, _) => "on the limit of stability: a mode neither decays nor grows".to_owned(),
            (nominal, _) => format!("stable: the slowest mode decays like exp({nominal:.3e} t / s)"),
        };
        text += &format!("  {is}\n\n");
    }
    text
}

/// The three parameters that contribute most to each output.
fn contributions(contributions: &[ContributionSummary]) -> String {
    let mut text = String::new();
    let varies = |contribution: &&ContributionSummary| contribution.total > 0.0;
    // Shapes are many: the file has them.
    let of_outputs = contributions.chunk_by(|a, b| a.output == b.output);
    for of_output in of_outputs.filter(|own| is_one_number(&own[0].output)) {
        let share = |contribution: &ContributionSummary| {
            format!("{} {:.0} %", contribution.parameter, 100.0 * contribution.total)
        };
        let shares: Vec<String> =
            of_output.iter().filter(varies).take(TUNING.parameters_that_matter).map(share).collect();
        // A single parameter has all of the variance.
        if of_output.len() > 1 && !shares.is_empty() {
            text += &format!("  tolerances that matter for {}: {}\n", of_output[0].output, shares.join(", "));
        }
    }
    if text.is_empty() { text } else { text + "\n" }
}

/// A start that is not unique, singular configurations, and reactions that equilibrium does not determine.
fn singular(summary: &Summary) -> String {
    let mut text = String::new();
    if !summary.shared_start.is_empty() {
        text += &format!(
            "  the model leaves the start open: {} are as near to 0 as joints allow; name them under `initial`\n",
            named(&summary.shared_start)
        );
    }
    let passes = &summary.singular_configurations;
    if !passes.is_empty() {
        let times: Vec<String> =
            passes.iter().take(TUNING.singular_configurations).map(|pass| format!("{:.6}", pass.time)).collect();
        let more = if passes.len() > TUNING.singular_configurations { ", …" } else { "" };
        let passed = count(passes.len(), "singular configuration", "singular configurations");
        text += &format!(
            "  {passed}, at t = {}{more} s: {} depend on other constraints there\n",
            times.join(", "),
            named(&passes[0].constraints)
        );
    }
    for EventSummary { event, samples, met, grazed_at } in summary.events.iter().take(TUNING.singular_configurations) {
        let at = |(name, value): &(String, f64)| {
            let own = summary.parameters.iter().find(|parameter| parameter.name == *name);
            own.map(|own| format!("{name} = {} {}", digits(*value), own.unit))
        };
        let at: Vec<String> = grazed_at.iter().filter_map(at).collect();
        let at = if at.is_empty() { String::new() } else { format!("; it is grazed at {}", at.join(", or ")) };
        text += &format!("  {event} switches in {met} of {samples} samples{at}\n");
    }
    if let Some(EventsFollowed { until, why }) = &summary.events_followed {
        text += &format!("  events are followed to {} s: {why}\n", digits(*until));
    }
    if !summary.undetermined_outputs.is_empty() {
        text += &format!(
            "  not unique: {}. Equilibrium does not determine these reactions, because {} are redundant; \
             their multipliers are set to 0\n",
            named(&summary.undetermined_outputs),
            named(&summary.redundant_constraints)
        );
    }
    text
}

/// The first names, and the number of the others.
fn named(names: &[String]) -> String {
    let more = if names.len() > TUNING.names_in_line {
        format!(" and {} more", names.len() - TUNING.names_in_line)
    } else {
        String::new()
    };
    format!("{}{more}", names[..names.len().min(TUNING.names_in_line)].join(", "))
}

/// The methods that ran, the bounds, and their reliability.
pub fn overview(summary: &Summary) -> String {
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
    let kind = match (&summary.black_box, &summary.analysis) {
        (Some(own), _) => black_box::heading(own),
        (None, Some(own)) if own.kind == "dimensions" => {
            count(summary.parameters.len(), "uncertain dimension", "uncertain dimensions")
        }
        (None, _) => format!(
            "{}, {}, {}",
            coordinates(summary.coordinates, &summary.formulation),
            count(summary.constraints, "constraint", "constraints"),
            count(summary.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
        ),
    };
    let mut text = format!("{BOLD}{}{BOLD:#}: {kind}\n\n{}\n", summary.model, table.render(2));
    text += &assemblies::lines(&summary.assemblies);
    text += &summary.integration.as_ref().map_or_else(String::new, |name| format!("  integrated by {name}\n"));
    match &summary.analysis {
        Some(found) if !found.values.is_empty() => text += &analysis(found),
        found => {
            text += &errors(&summary.errors);
            text += &found.as_ref().map_or_else(String::new, analysis);
        }
    }
    text += &summary.black_box.as_ref().map_or_else(String::new, |own| black_box::lines(own, &summary.errors));
    text += &excitations::lines(summary);
    text += &contributions(&summary.contributions);
    text += &verdicts::tables(summary);
    text += &statistics::statistics(summary);
    for method in summary.methods.iter().filter(|method| method.rank_revealing_solves > 0) {
        let times = match method.rank_revealing_solves {
            1 => "once".to_owned(),
            times => format!("{times} times"),
        };
        text += &format!("  {}: passed a singular configuration {times}\n", method.method);
    }
    text += &singular(summary);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overview::plain;
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
            expanded_outputs: Vec::new(),
            seconds,
        };
        let summary = Summary {
            model: "slider_crank".into(),
            mbint: "0.1.0".into(),
            formulation: "absolute".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            alpha: -0.1,
            duration: 2.0,
            methods: vec![method("nominal", 1, Some(0.0042), 0), method("scan", 900, None, 12)],
            errors: vec![ErrorSummary {
                output: "x3".into(),
                unit: "m".into(),
                display: None,
                method: "scan".into(),
                width: 0.2,
                error: 2e-3,
                surrogate: f64::NAN,
                time: 1.5e-3,
                unresolved_from: None,
            }],
            is_cut: false,
            chosen_formulation: None,
            ..Summary::default()
        };
        let expected = "slider_crank: 7 absolute coordinates, 6 constraints, 1 degree of freedom

  method   simulations    steps  Newton iterations  seconds
  nominal            1     2000               4013    0.004
  scan             900  1800000            3611700        –

  bounds   largest width    error  of the surrogate  of the steps  unit
  x3.scan        2.00e-1  2.00e-3           unknown       1.50e-3  m

  scan: passed a singular configuration 12 times
";
        assert_eq!(plain(&overview(&summary)), expected);
    }
}
