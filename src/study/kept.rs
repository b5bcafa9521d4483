//! The surrogates of a run, kept after it: outputs at any point of the box, in any row, without simulation.
//!
//! Nothing is kept unless [`run_keeping`](super::run_keeping) is asked. What it keeps are coefficients and the compiled mechanism, from
//! which [`Kept::evaluator`] compiles the loop closures through which outputs follow from expanded coordinates.

use rayon::prelude::*;

use super::outcome::{Outcome, Results};
use super::single::{Study, problem};
use crate::methods::{self, KeptSurrogate, Method, Refusal};
use crate::numerics::{BandError, Sample, SparseBasis, largest, step_error, surrogate_error};
use crate::simulate::{Closure, SimulationError, Simulator};

/// The method whose surrogate is kept.
const METHOD: Method = Method::Chebyshev;

/// Samples evaluated by one thread at once. Fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 1024;

/// A subsystem's surrogate.
#[derive(Clone, Debug)]
pub(super) struct KeptPart {
    simulator: Simulator,
    surrogate: KeptSurrogate,
    /// Errors of the values, by output.
    errors: Vec<BandError>,
    /// Output times, s.
    times: Vec<f64>,
}

/// The surrogates of all subsystems of a run.
#[derive(Clone, Debug)]
pub struct Kept {
    parts: Vec<Placed>,
    /// By output of the model: its subsystem, and its number there.
    places: Vec<(usize, usize)>,
    times: Vec<f64>,
}

/// A subsystem's surrogate among the whole model's parameters.
#[derive(Clone, Debug)]
struct Placed {
    part: KeptPart,
    /// Numbers of its uncertain parameters among those of the model.
    parameters: Vec<usize>,
}

/// Evaluates what is kept of a run.
pub struct Evaluator<'k> {
    kept: &'k Kept,
    /// By subsystem, for each choice of independent coordinates.
    closures: Vec<Vec<Box<dyn methods::Closure + 'k>>>,
}

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

    /// What is kept of a run, with the errors of its values in the first `rows` rows; where it is to be kept and is known.
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
        };
        let (_, outcome) = results.methods.iter().find(|(method, _)| *method == METHOD)?;
        let errors = self.errors_of_values(&part, results, outcome).ok()?;
        Some(KeptPart { errors, ..part })
    }

    /// Errors of values anywhere in the box, by output: what the validation samples' differ by and what the method knows of its
    /// surrogate, and the time steps'.
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
            let corrections = validation.corrections(output, rows);
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
            if let Some(unresolved) = results.unreliable_from().and_then(|row| error.unresolved.get_mut(row..)) {
                unresolved.fill(true);
            }
            error
        };
        Ok((0..outputs).map(of_output).collect())
    }
}

impl KeptPart {
    fn closures(&self) -> Result<Vec<Box<dyn methods::Closure + '_>>, SimulationError> {
        let closure = |independent: Vec<usize>| -> Result<Box<dyn methods::Closure + '_>, SimulationError> {
            Ok(Box::new(Closure::new(&self.simulator, independent)?))
        };
        self.surrogate.independent().into_iter().map(closure).collect()
    }
}

impl Kept {
    /// Of all subsystems, with the numbers of their outputs and uncertain parameters in the model of so many outputs.
    pub(super) fn of_parts(parts: Vec<(KeptPart, &[usize], &[usize])>, outputs: usize) -> Self {
        let mut places = vec![(0, 0); outputs];
        for (number, (_, outputs, _)) in parts.iter().enumerate() {
            outputs.iter().enumerate().for_each(|(place, &output)| places[output] = (number, place));
        }
        let shortest = parts.iter().map(|(part, ..)| &part.times).min_by_key(|times| times.len());
        let times = shortest.cloned().unwrap_or_default();
        let placed =
            |(part, _, parameters): (KeptPart, &[usize], &[usize])| Placed { part, parameters: parameters.to_vec() };
        Self { parts: parts.into_iter().map(placed).collect(), places, times }
    }

    /// Output times, s, up to the last row that all samples of all subsystems have reached.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// How far an output's values may be from the truth, in each row, anywhere in the box, and in which rows they cannot be relied on.
    pub fn error(&self, output: usize) -> &BandError {
        let (part, place) = self.places[output];
        &self.parts[part].part.errors[place]
    }

    /// Numbers of the uncertain parameters on which an output may depend.
    pub fn parameters(&self, output: usize) -> &[usize] {
        &self.parts[self.places[output].0].parameters
    }

    /// Whether an output is one polynomial of the parameters over the whole box in a row: then it takes nanoseconds, else a loop closure.
    pub fn is_polynomial(&self, row: usize, output: usize) -> bool {
        let (part, place) = self.places[output];
        self.parts[part].part.surrogate.is_polynomial(row, place)
    }

    /// The polynomial through an output's own samples in a row: its terms in ξ ∈ \[−1, 1\] of [`parameters`](Self::parameters), and the
    /// coefficients before them. `None` where the box was split.
    pub fn polynomial(&self, row: usize, output: usize) -> Option<(&SparseBasis, &[f64])> {
        let (part, place) = self.places[output];
        self.parts[part].part.surrogate.polynomial(row, place)
    }

    /// Prepares evaluation: compiles the loop closures that outputs need.
    ///
    /// # Errors
    /// Where a closure's equations have no finite values at the start.
    pub fn evaluator(&self) -> Result<Evaluator<'_>, SimulationError> {
        let closures = self.parts.iter().map(|placed| placed.part.closures()).collect::<Result<_, _>>()?;
        Ok(Evaluator { kept: self, closures })
    }
}

impl Evaluator<'_> {
    /// Outputs in one row at samples of the model's box (values of all its uncertain parameters, in their units), output by output,
    /// sample by sample; NaN where a closure has no solution. In parallel, with the same bits for any number of threads.
    pub fn values<P: AsRef<[f64]> + Sync>(&self, row: usize, outputs: &[usize], samples: &[P]) -> Vec<f64> {
        let chunks: Vec<Vec<f64>> =
            samples.par_chunks(CHUNK).map(|samples| self.values_of_chunk(row, outputs, samples)).collect();
        let mut values = Vec::with_capacity(outputs.len() * samples.len());
        for place in 0..outputs.len() {
            for (chunk, samples) in chunks.iter().zip(samples.chunks(CHUNK)) {
                values.extend_from_slice(&chunk[place * samples.len()..][..samples.len()]);
            }
        }
        values
    }

    fn values_of_chunk<P: AsRef<[f64]>>(&self, row: usize, outputs: &[usize], samples: &[P]) -> Vec<f64> {
        let mut values = vec![f64::NAN; outputs.len() * samples.len()];
        for (number, (Placed { part, parameters }, closures)) in self.kept.parts.iter().zip(&self.closures).enumerate()
        {
            let asked = |place: &usize| self.kept.places[outputs[*place]].0 == number;
            let places: Vec<usize> = (0..outputs.len()).filter(asked).collect();
            if places.is_empty() {
                continue;
            }
            let pick = |sample: &P| parameters.iter().map(|&parameter| sample.as_ref()[parameter]).collect();
            let own: Vec<Vec<f64>> = samples.iter().map(pick).collect();
            let of_part: Vec<usize> = places.iter().map(|&place| self.kept.places[outputs[place]].1).collect();
            let found = part.surrogate.values(row, (&of_part, &own), closures);
            for (&place, found) in places.iter().zip(found.chunks_exact(samples.len().max(1))) {
                values[place * samples.len()..][..samples.len()].copy_from_slice(found);
            }
        }
        values
    }
}
