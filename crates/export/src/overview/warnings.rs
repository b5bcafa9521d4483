//! Warnings to read before believing the results of a run.

use super::tuning::TUNING;
use super::words::{count, digits};
use crate::export::rounded as rounded_number;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Bounds, ParameterSummary, ReducedSummary, StartOverlap, Summary, TooDeep};
use crate::syntax::codes::Code;

/// A warning of a run, in a line, with its code if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Number of its page, for `mbint explain`.
    pub code: Option<Code>,
    /// The warning without its name.
    pub text: String,
}

impl Warning {
    /// A warning that has a page.
    fn coded(code: Code, text: String) -> Self {
        Self { code: Some(code), text }
    }
}

/// All warnings of a run.
pub fn warnings(bounds: &Bounds, summary: &Summary) -> Vec<Warning> {
    let beyond = summary.beyond_tolerance.map(|ratio| {
        format!(
            "the local errors of a sample's steps add up to {ratio:.3e} times the tolerance: results that need this sample are unreliable"
        )
    });
    let deep = summary.too_deep.as_ref().map(too_deep);
    let overlaps = summary.overlaps_at_start.iter().map(overlaps_at_start);
    let all =
        [unreliable(summary), unreliable_numbers(summary), beyond, deep, damped(summary), excluded(bounds, summary)];
    overlaps.chain(all.into_iter().flatten().map(|text| Warning { code: None, text })).collect()
}

/// Surfaces that overlap at the start.
fn overlaps_at_start(found: &StartOverlap) -> Warning {
    let text = format!(
        "the surfaces of `{}` overlap by {} mm at the nominal start and throw each other apart: let the bodies start outside of each \
         other, or with `initial: equilibrium` where one is to rest on the other",
        found.contact,
        digits(1e3 * found.depth)
    );
    Warning::coded(Code::OverlapsAtStart, text)
}

/// Unreliable bounds, with the times from which on they are.
fn unreliable(summary: &Summary) -> Option<String> {
    let mut bands: Vec<(f64, String)> = summary
        .errors
        .iter()
        .filter_map(|error| Some((error.unresolved_from?, format!("{}.{}", error.output, error.method))))
        .collect();
    let total = bands.len();
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    bands.truncate(TUNING.unreliable_bounds);
    let (from, first) = bands.first()?;
    let others: String =
        bands[1..].iter().map(|(time, band)| format!(", of `{band}` from {} s", rounded(*time))).collect();
    let more = if total > TUNING.unreliable_bounds {
        format!(", and {} more", total - TUNING.unreliable_bounds)
    } else {
        String::new()
    };
    let is_cause = |time: f64| time <= *from;
    let help = if summary.unmet_switch.is_some_and(is_cause) {
        "some values meet a contact, a stop or a kink that no sample meets: narrow the intervals until all values meet it or none does, \
         or divide them where that changes (`--set`)"
    } else if summary.events_followed.as_ref().is_some_and(|events| events.until <= *from) {
        "events are not followed further: narrow the intervals, or shorten the duration"
    } else if summary.passed_force.is_some_and(is_cause) {
        "fixed steps pass over changes of a force in time or space: shorten the step, or let `simulation: { tolerance: … }` choose it"
    } else {
        "raise the order, shorten the step, or set `bounds: { tolerance: … }`"
    };
    Some(format!("bounds of `{first}` are unreliable from {} s{others}{more}: {help}", rounded(*from)))
}

/// A time without the rounding error of a multiple of the output step.
fn rounded(time: f64) -> f64 {
    (1e9 * time).round() / 1e9
}

/// Surfaces that a contact no longer keeps apart.
fn too_deep(found: &TooDeep) -> String {
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
fn damped(summary: &Summary) -> Option<String> {
    let mode = summary.damped_mode.as_ref()?;
    Some(format!(
        "the steps damp a mode near {:.0} Hz that the start excites: shorten them to {:.0e} s, or accept that its amplitude counts as \
         error",
        mode.frequency, mode.step
    ))
}

/// The part of the box that the bounds cover, if that is not all.
fn excluded(bounds: &Bounds, summary: &Summary) -> Option<String> {
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

/// Reduced outputs and statistics that are not resolved, by their names.
pub fn unanswered(summary: &Summary) -> Vec<String> {
    let reduced = summary.reduced.iter().filter(|own| !is_resolved(own)).map(|own| format!("`{}`", own.name));
    let mut names: Vec<String> = reduced.collect();
    let Some(found) = &summary.statistics else { return names };
    if found.times.is_empty() {
        names.push("statistics".to_owned());
        return names;
    }
    let of_outputs = found.outputs.iter().filter(|output| output.resolved.contains(&false));
    names.extend(of_outputs.map(|output| format!("statistics of `{}`", output.name)));
    let is_known = |name: &String| found.summary.requirements.iter().any(|own| own.requirement == *name);
    let missing = summary.requirements.iter().map(|own| &own.name).filter(|name| !is_known(name));
    names.extend(missing.map(|name| format!("the share that fulfils `{name}`")));
    names
}

/// One reliable band is enough.
fn is_resolved(own: &ReducedSummary) -> bool {
    own.bands.is_empty() || own.bands.iter().any(|band| !band.unresolved && band.error.is_finite())
}

/// The unreliable reduced outputs and statistics.
fn unreliable_numbers(summary: &Summary) -> Option<String> {
    let names = unanswered(summary);
    let (first, others) = names.split_first()?;
    let shown: String = others.iter().take(TUNING.unreliable_numbers - 1).map(|name| format!(", {name}")).collect();
    let more = if names.len() > TUNING.unreliable_numbers {
        format!(", and {} more", names.len() - TUNING.unreliable_numbers)
    } else {
        String::new()
    };
    let verb = if names.len() == 1 && !first.starts_with("statistics") { "is" } else { "are" };
    Some(format!(
        "{first}{shown}{more} {verb} unreliable by every method: raise the order, shorten the step, or set `bounds: {{ tolerance: … }}`"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ReducedBand;

    #[test]
    fn one_reliable_band_is_enough() {
        let band = |unresolved, error| ReducedBand {
            method: "scan".to_owned(),
            lower: 0.0,
            upper: 1.0,
            error,
            surrogate: error,
            time: 0.0,
            unresolved,
        };
        let own = |bands| ReducedSummary {
            name: "top".to_owned(),
            of: "max of x".to_owned(),
            unit: "m".to_owned(),
            display: None,
            nominal: 0.5,
            bands,
            contributions: Vec::new(),
            worst: None,
            occurs: None,
        };
        assert!(is_resolved(&own(vec![band(true, 0.9), band(false, 0.1)])));
        assert!(!is_resolved(&own(vec![band(true, 0.9), band(true, 0.1)])));
        assert!(!is_resolved(&own(vec![band(false, f64::NAN)])));
        assert!(is_resolved(&own(Vec::new())));
    }
}
