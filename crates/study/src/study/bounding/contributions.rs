//! Contributions of parameters to the spread of outputs.

use super::{Bounded, Outcome};
use crate::methods::{Method, Sensitivity};
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
    outcome.result.sensitivities.iter().map(of_output).collect()
}
