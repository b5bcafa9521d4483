//! Requirements at instants instead of over the time.
//!
//! The extreme of a motion over the time moves where nominal values change the motion's shape: over wide ranges it is
//! no polynomial. Its value at an instant is one; the least of many instants is taken of their surrogates. Values
//! between the instants are checked by the studies that confirm.

use std::ops::Range;

use symdiff::Formula;

use super::tuning::TUNING;
use crate::model::{Analysis, Description, Requirement};

/// The model with only the elements that its requirements use.
pub fn required(mut model: Description) -> Description {
    let requirements = &model.requirements;
    let is_named = |name: &str| {
        let slacks = requirements.iter().filter(|own| own.times.is_none()).flat_map(|own| &own.slacks);
        slacks.flat_map(Formula::names).any(|(own, _)| own == name)
    };
    model.reduced.retain(|own| is_named(&own.name));
    let of_results = requirements.iter().any(|own| own.of_results) || model.reduced.iter().any(|own| own.of_results);
    if !of_results && model.black_box.is_none() {
        model.outputs.clear();
        model.chains.clear();
    }
    model
}

/// The model with its requirements at instants, and which of these stand for each requirement.
pub fn at_instants(description: &Description) -> (Description, Vec<Range<usize>>) {
    let mut model = description.clone();
    model.requirements.clear();
    let mut groups = Vec::with_capacity(description.requirements.len());
    for own in &description.requirements {
        let first = model.requirements.len();
        let at = |time: f64| Requirement { times: Some((time, time)), ..own.clone() };
        match instants(description, own) {
            Some(times) => model.requirements.extend(times.into_iter().map(at)),
            None => model.requirements.push(own.clone()),
        }
        groups.push(first..model.requirements.len());
    }
    (model, groups)
}

/// Output rows spread over the time of a requirement; `None` if it has no time.
fn instants(description: &Description, own: &Requirement) -> Option<Vec<f64>> {
    let has_time = matches!(description.analysis, Analysis::Motion | Analysis::Kinematics);
    let (from, to) = own.times.filter(|(from, to)| has_time && !own.of_results && from < to)?;
    let step = description.simulation.output_step;
    let ends = [(from / step).ceil(), (to.min(description.simulation.duration) / step * (1.0 + 1e-12)).floor()];
    let [first, last] = ends.map(|row| row as usize);
    let rows = last.checked_sub(first).filter(|rows| *rows > 0)?;
    let count = rows.min(TUNING.instants - 1);
    Some((0..=count).map(|index| (first + (index * rows + count / 2) / count) as f64 * step).collect())
}
