//! What a study keeps of its surrogate after the run, with the error of its values.

use rayon::prelude::*;

use super::kept::KeptPart;
use super::outcome::{Outcome, Results};
use super::single::{Study, problem};
use crate::methods::{KeptSurrogate, Method, Refusal};
use crate::numerics::{BandError, Sample, largest, step_error, surrogate_error};
use crate::simulate::SimulationError;

/// The method whose surrogate is kept.
const METHOD: Method = Method::Chebyshev;

impl Study<'_> {
    /// Has the surrogate kept, and asks for the method that has one.
    ///
    /// # Errors
    /// Where that method cannot bound the subsystem.
    pub(super) fn keep_surrogate(&mut self) -> Result<(), Refusal> {
        let problem = problem(self.description, &self.simulator);
        self.request.keep = true;
        self.request.ask(METHOD, &problem);
        self.request.methods_mut().into_iter().try_for_each(|(_, method)| method.fit(&problem))
    }

    /// Surrogate kept of a run, with the errors of its values in the first `rows` rows; where requested and known.
    pub(super) fn kept(&self, results: &mut Results, rows: usize) -> Option<KeptPart> {
        if !self.request.keep {
            return None;
        }
        let times: Vec<f64> = (0..rows).map(|row| results.schedule.time(row)).collect();
        let (_, outcome) = results.methods.iter_mut().find(|(method, _)| *method == METHOD)?;
        let surrogate = match outcome.result.kept.take() {
            Some(kept) => kept,
            None if self.domain.dimension() == 0 => {
                let values = |row: usize| outcome.result.bands.iter().map(|ranges| ranges[row].lower).collect();
                KeptSurrogate::constant(times.iter().enumerate().map(|(row, &time)| (time, values(row))))
            }
            None => return None,
        };
        let rows = rows.min(surrogate.rows()).min(outcome.result.reached);
        let part = KeptPart {
            simulator: self.simulator.clone(),
            surrogate,
            errors: Vec::new(),
            times: times[..rows].to_vec(),
            reduced: results.found.kept.take(),
        };
        let (_, outcome) = results.methods.iter().find(|(method, _)| *method == METHOD)?;
        let errors = self.errors_of_values(&part, results, outcome).ok()?;
        Some(KeptPart { errors, ..part })
    }

    /// Errors of values anywhere in the box, by output: what the validation samples' differ by and what the method
    /// knows of its surrogate, and the time steps'.
    fn errors_of_values(
        &self,
        part: &KeptPart,
        results: &Results,
        outcome: &Outcome,
    ) -> Result<Vec<BandError>, SimulationError> {
        let outputs = outcome.result.bands.len();
        let rows = part.times.len();
        let Some((validation, _)) = &results.validation else { return Ok(vec![BandError::default(); outputs]) };
        let closures = part.closures()?;
        let samples: Vec<Sample> = self.domain.samples(&validation.points);
        let every: Vec<usize> = (0..outputs).collect();
        let own: Vec<Vec<f64>> =
            (0..rows).into_par_iter().map(|row| part.surrogate.values(row, (&every, &samples), &closures)).collect();
        let of_output = |output: usize| {
            let corrections = validation.corrections(output, rows, results.switched_from());
            let surrogate = |row: usize| {
                let values = &own[row][output * samples.len()..][..samples.len()];
                let found = surrogate_error(values, &validation.direct.at(row, output));
                largest([found, outcome.result.surrogate[output][row]])
            };
            let time = |row: usize| {
                let halved = validation.halved.at(row, output);
                let damped: f64 = results.damped.iter().map(|mode| mode.lost(output, part.times[row])).sum();
                corrections[row].of(step_error(&validation.direct.at(row, output), &halved)) + damped
            };
            let (surrogate, time): (Vec<f64>, Vec<f64>) = (0..rows).map(|row| (surrogate(row), time(row))).unzip();
            let ranges = &outcome.result.bands[output][..rows];
            let mut error = BandError::new(ranges, &surrogate, &time, validation.spans[output], self.request.tolerance);
            if let Some(row) = results.unreliable_from() {
                error.distrust(row..rows);
            }
            error
        };
        Ok((0..outputs).map(of_output).collect())
    }
}
