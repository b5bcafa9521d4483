//! Results of a search over functions of the time: how much further they move outputs than constants do, and the worst.

use super::tuning::TUNING;
use crate::numerics::Cell;
use crate::results::{Bounds, ExcitationSummary, FunctionWitness, OutputBounds, WitnessFunction};
use crate::study::bounding::{Bounded, FunctionEnds, WorstFunction, as_constants};
use crate::study::excited::Limits;
use crate::study::problem::Study;

/// Displacement of each output by excitations, if known.
pub fn excitations(study: &Study, bounded: &Bounded, bounds: &Bounds) -> Vec<ExcitationSummary> {
    let Some(functions) = &bounded.functions else { return Vec::new() };
    let of_output = |(index, output): (usize, &OutputBounds)| {
        let (_, worst) = functions.worst[index].as_ref()?;
        let band = output.bands.first()?;
        let widths = band.upper.iter().zip(&band.lower).map(|(upper, lower)| upper - lower);
        Some(ExcitationSummary {
            output: output.name.clone(),
            unit: output.unit.clone(),
            display: study.description.display.get(&output.name).cloned(),
            as_constant: 0.5 * as_constants(bounded, index, bounds.times.len()),
            as_function: 0.5 * widths.fold(0.0, f64::max),
            time: bounded.plan.schedule.time(worst.row),
            value: worst.value,
        })
    };
    bounds.outputs.iter().enumerate().filter_map(of_output).collect()
}

/// The functions under which each output and reduced output goes the furthest, and under which requirements fail.
pub fn function_witnesses(study: &Study, bounded: &Bounded) -> Vec<FunctionWitness> {
    let Some(functions) = &bounded.functions else { return Vec::new() };
    let description = study.description;
    let (schedule, duration) = (&bounded.plan.schedule, description.simulation.duration);
    let witness = |name: &str, unit: &str, time: Option<f64>, worst: &WorstFunction| FunctionWitness {
        name: name.to_owned(),
        unit: unit.to_owned(),
        display: description.display.get(name).cloned(),
        output: None,
        time,
        value: worst.value,
        parameters: worst.sample.to_vec(),
        functions: of_excitations(study, functions, worst, time.unwrap_or(duration)),
    };
    let of_output = |(output, worst): (usize, &Option<(f64, WorstFunction)>)| {
        let (own, (_, worst)) = (&description.outputs[output], worst.as_ref()?);
        let time = Some(schedule.time(worst.row));
        Some(FunctionWitness { output: Some(output), ..witness(&own.name, &own.unit, time, worst) })
    };
    let mut all: Vec<FunctionWitness> = functions.worst.iter().enumerate().filter_map(of_output).collect();
    let values = functions.of_values.as_deref();
    for (own, worst) in description.reduced.iter().zip(values.iter().flat_map(|values| &values.worst)) {
        all.extend(worst.as_ref().map(|(_, worst)| witness(&own.name, &own.unit, None, worst)));
    }
    for (number, own) in description.requirements.iter().enumerate() {
        let lowest = match own.times {
            Some(_) => own.outputs.iter().filter_map(|&output| functions.extremes[output][0].as_ref()).collect(),
            None => lowest_parts(study, values, number),
        };
        let lowest = lowest.into_iter().min_by(|a, b| a.value.total_cmp(&b.value));
        let Some(lowest) = lowest.filter(|lowest| lowest.value < 0.0) else { continue };
        let time = own.times.map(|_| schedule.time(lowest.row));
        all.push(FunctionWitness { display: own.display.clone(), ..witness(&own.name, &own.unit, time, lowest) });
    }
    all
}

/// The functions under which the parts of a requirement's margin are least.
fn lowest_parts<'f>(study: &Study, values: Option<&'f FunctionEnds>, requirement: usize) -> Vec<&'f WorstFunction> {
    let (Some(store), Some(values)) = (study.store.get(), values) else { return Vec::new() };
    store.plan.values.parts(requirement).filter_map(|part| values.extremes[part][0].as_ref()).collect()
}

/// The excitations up to a time, s.
fn of_excitations(study: &Study, functions: &FunctionEnds, worst: &WorstFunction, end: f64) -> Vec<WitnessFunction> {
    let limits = Limits::of(study.description, &worst.sample);
    let duration = study.description.simulation.duration;
    let of_input = |(&trajectory, cells): (&usize, &Vec<Cell>)| {
        let own = &study.description.trajectories[trajectory];
        let excitation = own.excitation()?;
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut begin = 0.0;
        for (cell, &to) in cells.iter().zip(&*worst.ends) {
            if begin >= end * (1.0 - TUNING.jump_time) && begin > 0.0 {
                break;
            }
            let [from, until] = [begin, to].map(|time| limits.value_at(excitation, *cell, time));
            let jumps = points.last().is_some_and(|(_, value)| (value - from).abs() > TUNING.straight * from.abs());
            if points.is_empty() {
                points.push((0.0, from));
            } else if jumps {
                points.push((begin + TUNING.jump_time * duration, from));
            }
            points.push((to, until));
            begin = to;
        }
        Some(WitnessFunction { name: own.name.clone(), points: without_those_between(points) })
    };
    functions.inputs.iter().zip(&worst.cells).filter_map(of_input).collect()
}

/// The points without those on a straight line between their neighbours.
fn without_those_between(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let reach = points.iter().map(|(_, value)| value.abs()).fold(0.0, f64::max);
    let mut kept: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    for (index, &(time, value)) in points.iter().enumerate() {
        let is_between = match (kept.last(), points.get(index + 1)) {
            (Some(&(before, from)), Some(&(after, to))) => {
                let on_line = from + (to - from) * (time - before) / (after - before);
                (on_line - value).abs() <= TUNING.straight * reach
            }
            _ => false,
        };
        if !is_between {
            kept.push((time, value));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_and_jumps_stay() {
        let points = vec![(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (2.000_000_01, -1.0), (3.0, -1.0), (4.0, 0.0)];
        let kept = without_those_between(points);
        assert_eq!(kept, [(0.0, 1.0), (2.0, 1.0), (2.000_000_01, -1.0), (3.0, -1.0), (4.0, 0.0)]);
    }
}
