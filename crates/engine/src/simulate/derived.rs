//! Outputs that follow from the results of an analysis, once a sample has them: slacks of requirements on frequencies.

use super::error::SimulationError;
use super::modal::is_one_number;
use super::tuning::TUNING;
use crate::assemble::{NumberFormulas, System};
use crate::model::Analysis;

/// Outputs of results.
#[derive(Clone, Debug)]
pub struct Derived {
    formulas: NumberFormulas,
    /// Indices of the results among the outputs, in the formulas' order.
    results: Vec<usize>,
    /// Indices of the outputs.
    indices: Vec<usize>,
}

impl Derived {
    /// For a system whose further outputs are known; `None` if no output follows from results.
    ///
    /// # Errors
    /// Where the analysis has no result of a name.
    pub fn of(system: &System) -> Result<Option<Self>, SimulationError> {
        let indices: Vec<usize> =
            (0..system.outputs.len()).filter(|&index| system.outputs[index].is_derived()).collect();
        // Those of a black box follow from its answers.
        if indices.is_empty() || system.analysis == Analysis::BlackBox {
            return Ok(None);
        }
        let formulas: Vec<_> = indices.iter().filter_map(|&index| system.outputs[index].of_results.clone()).collect();
        let parameters = &system.declared_parameters;
        let is_parameter = |name: &str| parameters.iter().any(|parameter| parameter.name == name);
        let place_of = |name: &str| system.outputs.iter().position(|own| own.name == name && !own.is_derived());
        let (mut names, mut results) = (Vec::new(), Vec::new());
        for name in formulas.iter().flat_map(symdiff::Formula::names).map(|(name, _)| name) {
            match place_of(name) {
                _ if names.contains(&name) => {}
                Some(index) => {
                    names.push(name);
                    results.push(index);
                }
                None if is_parameter(name) => {}
                None => return Err(no_result(system, name)),
            }
        }
        Ok(Some(Self { formulas: NumberFormulas::of(parameters, &names, &formulas), results, indices }))
    }

    /// Sets them in the outputs of a row.
    pub fn set(&self, parameters: &[f64], row: &mut [f64]) {
        let known: Vec<f64> = self.results.iter().map(|&index| row[index]).collect();
        for (&index, value) in self.indices.iter().zip(self.formulas.values(parameters, &known)) {
            row[index] = value;
        }
    }
}

fn no_result(system: &System, name: &str) -> SimulationError {
    let further = system.outputs.iter().filter(|own| !own.is_derived()).map(|own| own.name.as_str());
    let all: Vec<String> = further.filter(|own| is_one_number(own)).map(|own| format!("`{own}`")).collect();
    let more = if all.len() > TUNING.derived_listed { ", …" } else { "" };
    let known = format!("{}{more}", all[..all.len().min(TUNING.derived_listed)].join(", "));
    SimulationError::NoResult { name: name.to_owned(), known }
}
