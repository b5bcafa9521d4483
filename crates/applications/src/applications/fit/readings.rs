//! Measured outputs at measured times as functions of the parameters, with the errors of a run's surrogates.

use std::collections::BTreeMap;

use super::data::Measured;
use super::{FitError, Measurements};
use crate::applications::allocate::{raise, run_simulations};
use crate::methods::Method;
use crate::model::{Description, Stepping};
use crate::numerics::{Interpolation, ParameterBox, PointSet};
use crate::study::{Evaluator, Kept, Options, run_keeping};

/// Surrogates over a box of the parameters.
pub struct SurrogateRun {
    kept: Kept,
    /// Their box, in the parameters' units.
    pub domain: ParameterBox,
    pub simulations: usize,
}

/// Numbers of times that the model's orders are raised and its steps halved.
#[derive(Clone, Copy, Debug, Default)]
pub struct Finer {
    pub orders: usize,
    pub steps: usize,
}

/// The measured rows of a run's surrogates.
pub struct Readings<'r> {
    kept: &'r Kept,
    evaluator: Evaluator<'r>,
    rows: Vec<Reading>,
    /// Whether rows that are flagged count as unknown, though their error is known.
    strict: bool,
}

/// A measured row.
struct Reading {
    output: usize,
    /// `None` if the motion ends before.
    interpolation: Option<Interpolation>,
    /// Interpolations from either side, for a model that switches: next to an impact they differ by more than the
    /// noise.
    sides: Vec<Vec<(usize, f64)>>,
    noise: f64,
}

/// Values at samples.
pub struct ReadValues {
    /// By measured row, then sample.
    pub values: Vec<Vec<f64>>,
    /// By measured row: the largest difference of interpolations in time; infinite next to an impact.
    pub interpolation: Vec<f64>,
}

impl SurrogateRun {
    /// A run over a box within the model's.
    ///
    /// # Errors
    /// If the model cannot be run, or has no surrogate.
    pub fn new(
        description: &Description,
        domain: &ParameterBox,
        finer: Finer,
        options: &Options,
    ) -> Result<Self, FitError> {
        let mut model = description.over(domain.lower.iter().zip(&domain.upper).map(|(lower, upper)| [*lower, *upper]));
        for [nominal, lower, upper] in model.intervals_mut() {
            *nominal = nominal.clamp(*lower, *upper);
        }
        let shorter = 0.5_f64.powi(finer.steps as i32);
        match &mut model.simulation.stepping {
            Stepping::Fixed(step) => *step *= shorter,
            Stepping::Tolerance(tolerance) => *tolerance *= shorter * shorter,
        }
        let is_raised = (0..finer.orders).all(|_| raise(&mut model));
        let (_, summary, kept) =
            run_keeping(&model, Options { methods: Some(vec![Method::Chebyshev]), store: None, ..*options })?;
        if (options.interrupted)() {
            return Err(FitError::Interrupted);
        }
        let kept = kept.filter(|_| is_raised).ok_or(FitError::NoSurrogate)?;
        Ok(Self { kept, domain: domain.clone(), simulations: run_simulations(&summary) })
    }

    /// Whether some output's surrogate has a larger error than its steps.
    pub fn is_rough(&self) -> bool {
        (0..self.kept.outputs()).map(|output| self.kept.error(output)).any(|error| error.surrogate > error.time)
    }

    /// Measured rows.
    ///
    /// # Errors
    /// If an output's equations have no finite values at the start.
    pub fn readings(&self, measurements: &Measurements) -> Result<Readings<'_>, FitError> {
        let evaluator = self.kept.evaluator().map_err(|error| FitError::Run(error.into()))?;
        let (times, switches) = (self.kept.times(), self.kept.switches());
        let reading = |own: &Measured| {
            let interpolation = Interpolation::new(times, own.time);
            let sides = interpolation.iter().filter(|_| switches).flat_map(|found| found.sides(times, own.time));
            Reading { output: own.output, sides: sides.collect(), interpolation, noise: own.noise }
        };
        let rows = measurements.values.iter().map(reading).collect();
        Ok(Readings { kept: &self.kept, evaluator, rows, strict: false })
    }
}

impl Readings<'_> {
    /// The same; with `strict`, rows that are flagged count as unknown.
    pub fn strict(self, strict: bool) -> Self {
        Self { strict, ..self }
    }

    /// Whether some row is flagged with a known error.
    pub fn has_flagged(&self) -> bool {
        let is_flagged = |reading: &Reading| {
            let rows = reading.interpolation.iter().flat_map(|own| &own.fine);
            let error = self.kept.error(reading.output);
            rows.into_iter().any(|(row, _)| error.coarse.get(*row) == Some(&true))
        };
        self.rows.iter().any(is_flagged)
    }

    /// Errors of simulation and surrogate anywhere in the box, by measured row; infinite if nothing is known.
    pub fn errors(&self) -> Vec<f64> {
        let of = |reading: &Reading| {
            let Some(interpolation) = &reading.interpolation else { return f64::INFINITY };
            let error = self.kept.error(reading.output);
            let at = |&(row, weight): &(usize, f64)| -> f64 {
                let own = error.total.get(row).copied().unwrap_or(f64::INFINITY);
                // A row whose error is large but known narrows the set; alone it does not make it empty.
                let flag = |flags: &[bool]| flags.get(row).copied();
                let is_coarse = !self.strict && flag(&error.coarse) == Some(true);
                let is_known = flag(&error.unresolved) == Some(false) || is_coarse;
                if own.is_nan() || !is_known { f64::INFINITY } else { weight.abs() * own }
            };
            interpolation.fine.iter().map(at).sum()
        };
        self.rows.iter().map(of).collect()
    }

    /// Values at samples (values of all parameters in their units); NaN if one is not known.
    pub fn at(&self, samples: &[Vec<f64>]) -> ReadValues {
        let mut wanted: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for reading in &self.rows {
            let fine = reading.interpolation.iter().flat_map(|own| &own.fine);
            for &(row, _) in fine.chain(reading.sides.iter().flatten()) {
                let outputs = wanted.entry(row).or_default();
                if !outputs.contains(&reading.output) {
                    outputs.push(reading.output);
                }
            }
        }
        let points = PointSet::of(samples);
        let of_row = |(row, outputs): (usize, Vec<usize>)| {
            let values = self.evaluator.values(row, &outputs, points.points());
            let lines = values.chunks_exact(samples.len()).map(<[f64]>::to_vec);
            outputs.into_iter().zip(lines).map(|(output, line)| ((row, output), line)).collect::<Vec<_>>()
        };
        let known: BTreeMap<(usize, usize), Vec<f64>> = wanted.into_iter().flat_map(of_row).collect();
        let sum = |weights: &[(usize, f64)], output: usize| {
            let mut sum = vec![0.0; samples.len()];
            for (row, weight) in weights {
                let line = &known[&(*row, output)];
                sum.iter_mut().zip(line).for_each(|(sum, value)| *sum += weight * value);
            }
            sum
        };
        let of = |reading: &Reading| match &reading.interpolation {
            None => (vec![f64::NAN; samples.len()], f64::INFINITY),
            Some(own) => {
                let fine = sum(&own.fine, reading.output);
                let apart = |others: &Vec<(usize, f64)>| {
                    let others = sum(others, reading.output);
                    fine.iter().zip(others).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
                };
                let error = if own.coarse.is_empty() { 0.0 } else { apart(&own.coarse) };
                let beside_impact = reading.sides.iter().map(apart).any(|apart| apart > reading.noise);
                (fine, if beside_impact { f64::INFINITY } else { error })
            }
        };
        let (values, interpolation) = self.rows.iter().map(of).unzip();
        ReadValues { values, interpolation }
    }
}
