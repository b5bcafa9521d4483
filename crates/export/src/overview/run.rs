//! The overview of a run for people: methods, errors, tolerances that matter, singular configurations, files.

use std::path::{Path, PathBuf};

use super::black_box;
use super::console::{BOLD, coordinates, count, file_names};
use super::structure::digits;
use super::table::{Align, Table};
use super::verdicts;
use crate::export::rounded as rounded_number;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{
    AnalysisSummary, Bounds, ContributionSummary, ErrorSummary, EventSummary, EventsFollowed, ParameterSummary,
    Summary, TooDeep,
};
use crate::simulate::is_one_number;

/// The largest width and error of each band.
fn errors(errors: &[ErrorSummary]) -> String {
    /// Rows that fit a screen.
    const MOST: usize = 24;
    let mut table = Table::new([
        ("bounds", Align::Left),
        ("largest width", Align::Right),
        ("error", Align::Right),
        ("of the surrogate", Align::Right),
        ("of the steps", Align::Right),
        ("unit", Align::Left),
    ]);
    for error in errors.iter().take(MOST) {
        let unit = ShownUnit::of(&error.display, &error.unit);
        let shown = |value: f64| format!("{:.2e}", unit.of_si(value));
        let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { shown(value) };
        let name = format!("{}.{}", error.output, error.method);
        let [width, total, surrogate, time] = [error.width, error.error, error.surrogate, error.time].map(number);
        table.row([name, width, total, surrogate, time, unit.text.to_owned()]);
    }
    match errors.len() {
        0 => String::new(),
        n if n > MOST => format!("{}  … and {} more in summary.json\n\n", table.render(2), n - MOST),
        _ => format!("{}\n", table.render(2)),
    }
}

/// What an analysis of one configuration found, and what an equilibrium is.
fn analysis(analysis: &AnalysisSummary) -> String {
    /// Rows that fit a screen.
    const MOST: usize = 30;
    let number = |value: f64| if value.is_nan() { "unknown".to_owned() } else { format!("{value:.5e}") };
    let mut table = Table::new([
        ("output", Align::Left),
        ("unit", Align::Left),
        ("nominal", Align::Right),
        ("lower", Align::Right),
        ("upper", Align::Right),
        ("error", Align::Right),
    ]);
    for value in analysis.values.iter().take(MOST) {
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
            f64::INFINITY => "held by constraints alone: nothing can move".to_owned(),
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
            (nominal, _) => format!("stable: what decays slowest does so like exp({nominal:.3e} t / s)"),
        };
        text += &format!("  {is}\n\n");
    }
    text
}

/// The three parameters that contribute most to each output.
fn contributions(contributions: &[ContributionSummary]) -> String {
    const MOST: usize = 3;
    let mut text = String::new();
    let varies = |contribution: &&ContributionSummary| contribution.total > 0.0;
    // Shapes are many: the file has them.
    let of_outputs = contributions.chunk_by(|a, b| a.output == b.output);
    for of_output in of_outputs.filter(|own| is_one_number(&own[0].output)) {
        let share = |contribution: &ContributionSummary| {
            format!("{} {:.0} %", contribution.parameter, 100.0 * contribution.total)
        };
        let shares: Vec<String> = of_output.iter().filter(varies).take(MOST).map(share).collect();
        // A single parameter has all of the variance.
        if of_output.len() > 1 && !shares.is_empty() {
            text += &format!("  tolerances that matter for {}: {}\n", of_output[0].output, shares.join(", "));
        }
    }
    if text.is_empty() { text } else { text + "\n" }
}

/// Which bounds are unreliable, and from when.
pub(super) fn unreliable(summary: &Summary) -> Option<String> {
    const MOST: usize = 4;
    let mut bands: Vec<(f64, String)> = summary
        .errors
        .iter()
        .filter_map(|error| Some((error.unresolved_from?, format!("{}.{}", error.output, error.method))))
        .collect();
    let total = bands.len();
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    bands.truncate(MOST);
    let (from, first) = bands.first()?;
    let others: String =
        bands[1..].iter().map(|(time, band)| format!(", of `{band}` from {} s", rounded(*time))).collect();
    let more = if total > MOST { format!(", and {} more", total - MOST) } else { String::new() };
    let is_cause = |time: f64| time <= *from;
    let help = if summary.unmet_switch.is_some_and(is_cause) {
        "some values meet a contact, a stop or a kink that no sample meets: narrow the intervals until all values meet it or none does, \
         or divide them where that changes (`--set`)"
    } else if summary.events_followed.as_ref().is_some_and(|events| events.until <= *from) {
        "events are not followed further: narrow the intervals, or shorten the duration"
    } else if summary.passed_force.is_some_and(is_cause) {
        "fixed steps pass over what a force does in time or space: shorten the step, or let `simulation: { tolerance: … }` choose it"
    } else {
        "raise the order, shorten the step, or set `bounds: { tolerance: … }`"
    };
    Some(format!("bounds of `{first}` are unreliable from {} s{others}{more}: {help}", rounded(*from)))
}

/// A time without the rounding error of a multiple of the output step.
fn rounded(time: f64) -> f64 {
    (1e9 * time).round() / 1e9
}

/// Surfaces that a contact does not hold apart any more.
pub(super) fn too_deep(found: &TooDeep) -> String {
    let TooDeep { contact, time, depth, deepest } = found;
    let (time, deepest) = (rounded(*time), digits(1e3 * deepest));
    match depth {
        Some(depth) => format!(
            "the surfaces of `{contact}` overlap by {} mm at {time} s, where its `rounding` and radii allow {deepest} mm: rows from there on are \
             unreliable; make the contact stiffer, or these larger",
            digits(1e3 * depth)
        ),
        None => format!(
            "the surfaces of `{contact}` pass through one another in the step to {time} s: rows from there on are unreliable; shorten the step, \
             or let a `tolerance` choose it"
        ),
    }
}

/// The mode that the steps damp.
pub(super) fn damped(summary: &Summary) -> Option<String> {
    let mode = summary.damped_mode.as_ref()?;
    Some(format!(
        "the steps damp a mode near {:.0} Hz that the start excites: shorten them to {:.0e} s, or accept that its amplitude counts as \
         error",
        mode.frequency, mode.step
    ))
}

/// A start that is a choice, singular configurations, and reactions that equilibrium does not determine.
fn singular(summary: &Summary) -> String {
    const MOST: usize = 4;
    let mut text = String::new();
    if !summary.shared_start.is_empty() {
        text += &format!(
            "  the model leaves the start open: {} are as near to 0 as joints allow; name them under `initial`\n",
            named(&summary.shared_start)
        );
    }
    let passes = &summary.singular_configurations;
    if !passes.is_empty() {
        let times: Vec<String> = passes.iter().take(MOST).map(|pass| format!("{:.6}", pass.time)).collect();
        let more = if passes.len() > MOST { ", …" } else { "" };
        let passed = count(passes.len(), "singular configuration", "singular configurations");
        text += &format!(
            "  {passed}, at t = {}{more} s: {} depend on other constraints there\n",
            times.join(", "),
            named(&passes[0].constraints)
        );
    }
    for EventSummary { event, samples, met, grazed_at } in summary.events.iter().take(MOST) {
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
    const MOST: usize = 6;
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    format!("{}{more}", names[..names.len().min(MOST)].join(", "))
}

/// The part of the box that the bounds cover, if it is not all of it.
pub(super) fn excluded(bounds: &Bounds, summary: &Summary) -> Option<String> {
    let least = bounds.covered.iter().copied().fold(1.0, f64::min);
    if least == 1.0 {
        return None;
    }
    let hull = |(index, parameter): (usize, &ParameterSummary)| {
        let ends = summary.pieces.iter().map(|piece| (piece.lower[index], piece.upper[index]));
        let (lower, upper) = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let narrower = lower > parameter.lower || upper < parameter.upper;
        let unit = ShownUnit::of(&parameter.display, &parameter.unit);
        let [lower, upper] = [lower, upper].map(|end| rounded_number(unit.of_si(end)));
        let range = format!("{} from {lower} to {upper} {}", parameter.name, unit.text);
        narrower.then(|| format!(", with {}", range.trim_end()))
    };
    let hulls: String = summary.parameters.iter().enumerate().filter_map(hull).collect();
    let pieces = count(summary.pieces.len(), "piece", "pieces");
    let times = bounds.times.iter().zip(&bounds.covered);
    let ended: Vec<&f64> =
        times.filter(|(_, share)| **share < bounds.covered[0]).map(|(time, _)| time).take(1).collect();
    let first = 100.0 * bounds.covered[0];
    let later = ended
        .first()
        .map_or(String::new(), |time| format!(", and less from {time} s on, {:.3} % at the end", 100.0 * least));
    Some(format!("the bounds cover {first:.3} % of the box ({pieces}{hulls}){later}: see the column `covered`"))
}

/// Prints for people what ran, the reliability of the results, and their files.
pub(super) fn overview(summary: &Summary, folder: &Path, files: &[PathBuf]) -> String {
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
    text += &super::assemblies::lines(&summary.assemblies);
    text += &summary.integration.as_ref().map_or_else(String::new, |name| format!("  integrated by {name}\n"));
    match &summary.analysis {
        Some(found) if !found.values.is_empty() => text += &analysis(found),
        found => {
            text += &errors(&summary.errors);
            text += &found.as_ref().map_or_else(String::new, analysis);
        }
    }
    text += &summary.black_box.as_ref().map_or_else(String::new, |own| black_box::lines(own, &summary.errors));
    text += &super::excitations::lines(summary);
    text += &contributions(&summary.contributions);
    text += &verdicts::tables(summary);
    text += &super::statistics::statistics(summary);
    for method in summary.methods.iter().filter(|method| method.rank_revealing_solves > 0) {
        let times = match method.rank_revealing_solves {
            1 => "once".to_owned(),
            times => format!("{times} times"),
        };
        text += &format!("  {}: passed a singular configuration {times}\n", method.method);
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
            redundant_constraints: vec![],
            undetermined_outputs: vec![],
            singular_at_start: vec![],
            shared_start: vec![],
            singular_configurations: vec![],
            damped_mode: None,
            events: Vec::new(),
            events_followed: None,
            unmet_switch: None,
            passed_force: None,
            too_deep: None,
            beyond_tolerance: None,
            integration: None,
            alpha: -0.1,
            duration: 2.0,
            analysis: None,
            black_box: None,
            parameters: vec![],
            assemblies: vec![],
            chains: vec![],
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
            contributions: vec![],
            statistics: None,
            pieces: vec![],
            reduced: vec![],
            requirements: vec![],
            not_simulated: vec![],
            subsystems: vec![],
            failure: None,
            excitations: Vec::new(),
            realisations: Vec::new(),
            is_cut: false,
        };
        let files = ["bounds.csv", "x3.svg"].map(|name| Path::new("results/slider_crank").join(name));
        let text = overview(&summary, Path::new("results/slider_crank"), &files);
        let plain = crate::cli::console::plain(&text);
        insta::assert_snapshot!(plain, @r"
        slider_crank: 7 absolute coordinates, 6 constraints, 1 degree of freedom

          method   simulations    steps  Newton iterations  seconds
          nominal            1     2000               4013    0.004
          scan             900  1800000            3611700        –

          bounds   largest width    error  of the surrogate  of the steps  unit
          x3.scan        2.00e-1  2.00e-3           unknown       1.50e-3  m

          scan: passed a singular configuration 12 times
          results/slider_crank: bounds.csv, x3.svg
        ");
    }
}
