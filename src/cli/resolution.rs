//! Questions that no method resolves.

use super::Status;
use crate::results::{Bounds, OutputBounds, ReducedSummary, Summary};

/// Whether everything that was asked is answered: every output at every time by some method, every reduced output, and
/// every statistic.
pub(super) fn resolution(bounds: &Bounds, summary: &Summary) -> Status {
    // One reliable method is enough.
    let answered = |output: &OutputBounds| {
        let resolved = |row: usize| output.bands.iter().any(|band| !band.error.unresolved[row]);
        output.bands.is_empty() || (0..bounds.times.len()).all(resolved)
    };
    let is_answered = bounds.outputs.iter().all(answered) && unanswered(summary).is_empty();
    if is_answered { Status::Done } else { Status::Unresolved }
}

/// Reduced outputs and statistics that are not resolved, by their names.
pub(super) fn unanswered(summary: &Summary) -> Vec<String> {
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

/// Which reduced outputs and statistics are unreliable.
pub(super) fn unreliable(summary: &Summary) -> Option<String> {
    const MOST: usize = 4;
    let names = unanswered(summary);
    let (first, others) = names.split_first()?;
    let shown: String = others.iter().take(MOST - 1).map(|name| format!(", {name}")).collect();
    let more = if names.len() > MOST { format!(", and {} more", names.len() - MOST) } else { String::new() };
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
