//! The corners of the parameters' intervals, at which every formula is checked.

use std::collections::{HashMap, HashSet};

use crate::grammar::formulas::evaluate;
use crate::grammar::reader::Corner;
use crate::model::description::{Parameter, ParameterValue};
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;

/// Parameters with the values that they take at a corner.
type Choice = Vec<(usize, f64)>;

/// Evaluates all parameters at the nominal values and at the corners of the intervals.
pub fn read(reader: &mut Reader, name_spans: &[Span]) {
    let parameters = &reader.model.parameters;
    let uncertain: Vec<(usize, f64, f64)> = parameters
        .iter()
        .enumerate()
        .filter_map(|(index, parameter)| match parameter.value {
            ParameterValue::Interval { lower, upper, .. } => Some((index, lower, upper)),
            ParameterValue::Formula(_) => None,
        })
        .collect();
    let beyond = uncertain.get(TUNING.uncertain).map(|&(index, ..)| index);
    // Too many are an error: no other error has to be found at their corners.
    let choices = if beyond.is_some() { vec![Choice::new()] } else { choices(&uncertain) };
    let positions: HashMap<&str, usize> =
        parameters.iter().enumerate().map(|(index, parameter)| (parameter.name.as_str(), index)).collect();
    let varies = varies(parameters, &positions, &reader.free);
    let corners = evaluated(parameters, &positions, &varies, choices);
    let infinite: Vec<(usize, String)> = (0..parameters.len())
        .filter_map(|index| {
            let corner = corners.iter().find(|corner| !corner.values[index].is_finite())?;
            // A parameter that uses one without a value has none either: only the first is reported.
            let follows_another = match &parameters[index].value {
                ParameterValue::Formula(formula) if formula.as_number().is_some_and(f64::is_nan) => true,
                ParameterValue::Formula(formula) => formula.names().any(|(name, _)| {
                    positions.get(name).is_none_or(|&used| used >= index || !corner.values[used].is_finite())
                }),
                ParameterValue::Interval { .. } => true,
            };
            (!follows_another).then(|| (index, corner.label.clone()))
        })
        .collect();
    if let Some(index) = beyond {
        let message = format!("the model has more than {uncertain} uncertain parameters", uncertain = TUNING.uncertain);
        reader.error(Code::TooLarge, name_spans[index].clone(), message, None);
    }
    for (index, label) in infinite {
        let message = format!("`{}` is not a finite number{label}", reader.model.parameters[index].name);
        reader.error(Code::NotANumber, name_spans[index].clone(), message, None);
    }
    reader.broken = corners.iter().any(|corner| corner.values.iter().any(|value| !value.is_finite()));
    reader.corners_of = moved(&corners, reader.model.parameters.len());
    reader.corners = corners;
    reader.varies = varies;
}

/// The nominal values first; then all corners, or the ends of each interval.
fn choices(uncertain: &[(usize, f64, f64)]) -> Vec<Choice> {
    let mut choices = vec![Choice::new()];
    if uncertain.len() <= TUNING.corners {
        choices.extend((0..1_usize << uncertain.len()).filter(|_| !uncertain.is_empty()).map(|corner| {
            let end = |(bit, &(index, lower, upper)): (usize, &(usize, f64, f64))| {
                (index, if corner >> bit & 1 == 0 { lower } else { upper })
            };
            uncertain.iter().enumerate().map(end).collect()
        }));
    } else {
        choices
            .extend(uncertain.iter().flat_map(|&(index, lower, upper)| [vec![(index, lower)], vec![(index, upper)]]));
    }
    choices
}

/// Per parameter, whether it is uncertain or free, or depends on one that is.
fn varies(parameters: &[Parameter], positions: &HashMap<&str, usize>, free: &HashSet<String>) -> Vec<bool> {
    parameters.iter().fold(Vec::new(), |mut varies: Vec<bool>, parameter| {
        varies.push(match &parameter.value {
            ParameterValue::Interval { .. } => true,
            ParameterValue::Formula(_) if free.contains(&parameter.name) => true,
            ParameterValue::Formula(formula) => formula
                .names()
                .any(|(name, _)| positions.get(name).is_some_and(|&index| varies.get(index).copied().unwrap_or(false))),
        });
        varies
    })
}

fn evaluated(
    parameters: &[Parameter],
    positions: &HashMap<&str, usize>,
    varies: &[bool],
    choices: Vec<Choice>,
) -> Vec<Corner> {
    let mut corners: Vec<Corner> = Vec::new();
    let used = |parameter: &Parameter| match &parameter.value {
        ParameterValue::Interval { .. } => Vec::new(),
        ParameterValue::Formula(formula) => {
            formula.names().filter_map(|(name, _)| positions.get(name).copied()).collect::<Vec<usize>>()
        }
    };
    let used: Vec<Vec<usize>> = parameters.iter().map(used).collect();
    for chosen in choices {
        let mut values: Vec<f64> = Vec::with_capacity(parameters.len());
        for (index, parameter) in parameters.iter().enumerate() {
            let value = match &parameter.value {
                ParameterValue::Interval { nominal, .. } => {
                    chosen.iter().find(|(chosen, _)| *chosen == index).map_or(*nominal, |(_, value)| *value)
                }
                ParameterValue::Formula(_) if !varies[index] && !corners.is_empty() => corners[0].values[index],
                ParameterValue::Formula(_) if is_as_nominal(&corners, &values, &used[index]) => {
                    corners[0].values[index]
                }
                ParameterValue::Formula(formula) => {
                    evaluate(formula, |name| positions.get(name).and_then(|&used| values.get(used).copied()))
                        .unwrap_or(f64::NAN)
                }
            };
            values.push(value);
        }
        let place: Vec<String> =
            chosen.iter().map(|(index, value)| format!("{} = {value}", parameters[*index].name)).collect();
        let label = if place.is_empty() { String::new() } else { format!(" at {}", place.join(", ")) };
        corners.push(Corner { values, label });
    }
    corners
}

/// Whether the parameters `used` have their nominal values in `values`; values that follow from them are then nominal,
/// too.
fn is_as_nominal(corners: &[Corner], values: &[f64], used: &[usize]) -> bool {
    let Some(nominal) = corners.first().map(|corner| &corner.values) else { return false };
    let bits = |values: &[f64], index: usize| values.get(index).map(|value| value.to_bits());
    used.iter().all(|&index| index < values.len() && bits(values, index) == bits(nominal, index))
}

/// For each parameter the corners at which its value is not the nominal one.
fn moved(corners: &[Corner], parameters: usize) -> Vec<Vec<usize>> {
    let is_moved =
        |corner: &usize, index: usize| corners[*corner].values[index].to_bits() != corners[0].values[index].to_bits();
    (0..parameters).map(|index| (1..corners.len()).filter(|corner| is_moved(corner, index)).collect()).collect()
}
