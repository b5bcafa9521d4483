//! Contributions of parameters to the spread of outputs.

use super::{Bounded, FunctionEnds, Outcome};
use crate::methods::{Method, Sensitivity};
use crate::model::deviation_of;
use crate::results::Contribution;
use crate::study::problem::Study;

/// Every parameter's contribution to every output's spread, from a method that knows it.
pub fn contributions(study: &Study, bounded: &Bounded, rows: usize) -> Vec<Vec<Contribution>> {
    let known = |(_, outcome): &&(Method, Outcome)| outcome.result.sensitivities.iter().flatten().any(Option::is_some);
    let Some((_, outcome)) = bounded.methods.iter().find(known) else { return Vec::new() };
    let of_parameter = |rows_of_output: &[Option<Sensitivity>], index: usize| {
        let over_time = |pick: fn(&Sensitivity) -> &Vec<f64>| {
            let at = |row: &Option<Sensitivity>| row.as_ref().map_or(f64::NAN, |sensitivity| pick(sensitivity)[index]);
            rows_of_output[..rows].iter().map(at).collect()
        };
        Contribution {
            parameter: study.simulator.system.parameters[index].name.clone(),
            main: over_time(|sensitivity| &sensitivity.main),
            total: over_time(|sensitivity| &sensitivity.total),
            width_without: over_time(|sensitivity| &sensitivity.width_without),
        }
    };
    let parameters = 0..study.domain.dimension();
    let of_output =
        |rows: &Vec<Option<Sensitivity>>| parameters.clone().map(|index| of_parameter(rows, index)).collect();
    let mut all: Vec<Vec<Contribution>> = outcome.result.sensitivities.iter().map(of_output).collect();
    if let Some(functions) = &bounded.functions {
        for (output, own) in all.iter_mut().enumerate() {
            (0..rows).for_each(|row| by_functions(study, functions, row, output, own));
        }
    }
    all
}

/// Contributions in a row with excitations that are functions, to first order: a parameter, or a function, that moves
/// an output by p either way has the share p²/Σp² of the variance, and p/Σp of the width.
fn by_functions(study: &Study, functions: &FunctionEnds, row: usize, output: usize, own: &mut [Contribution]) {
    let parts = functions.parts(row, output);
    if parts.is_empty() {
        return;
    }
    let (by_parameters, by_inputs) = parts.split_at(own.len());
    let (sum, squares) = parts.iter().fold((0.0, 0.0), |(sum, squares), part| (sum + part, squares + part * part));
    let width = functions.range(row, output).width();
    for (contribution, part) in own.iter_mut().zip(by_parameters) {
        let input = functions.inputs.iter().position(|&trajectory| {
            contribution.parameter == deviation_of(&study.description.trajectories[trajectory].name)
        });
        let part = input.map_or(*part, |input| by_inputs[input]);
        let share = |part: f64, sum: f64| if sum > 0.0 { part / sum } else { 0.0 };
        contribution.main[row] = share(part * part, squares);
        contribution.total[row] = contribution.main[row];
        contribution.width_without[row] = width * (1.0 - share(part, sum));
    }
}
