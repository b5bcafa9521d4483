//! Motions under functions of the time, and their gradients.

use std::sync::Arc;

use super::limits::Limits;
use super::point::Point;
use crate::model::{Class, Excitation};
use crate::numerics::{Cell, FunctionClass, Sample};
use crate::simulate::{
    CellFunctions, Functional, Gradient, NoGradient, Schedule, SimulationError, Simulator, Term, Under, gradients_under,
};
use crate::study::bounding::WorstFunction;
use crate::study::problem::Study;

/// A weighted sum of outputs in rows at a point.
pub type WeightedPoint<'p> = (&'p Point, Vec<Term>);

/// An output in a row.
pub fn in_row(row: usize, output: usize) -> Vec<Term> {
    vec![Term { row, output, weight: 1.0 }]
}

/// Derivatives of a gradient by one of `inputs` inputs, cell by cell; upwards by the sign.
pub fn functional(found: &Gradient, sign: f64, input: usize, inputs: usize) -> Vec<Cell> {
    let of_cell = |by: &[f64]| [sign * by[2 * input], sign * by[2 * input + 1]];
    found.by_inputs.chunks_exact(2 * inputs).map(of_cell).collect()
}

/// The equations with excitations as inputs, and the steps.
pub struct ExcitedMotions<'s, 'm> {
    pub study: &'s Study<'m>,
    simulator: &'s Simulator,
    pub schedule: Schedule,
    /// Excitation of each input.
    excitations: Vec<&'s Excitation>,
    /// Times at which cells end, s.
    pub ends: Arc<[f64]>,
    /// Simulations and gradients so far.
    pub count: usize,
}

impl<'s, 'm> ExcitedMotions<'s, 'm> {
    /// Motions with the steps of a schedule, which end where held functions may jump.
    pub fn new(study: &'s Study<'m>, simulator: &'s Simulator, schedule: &Schedule) -> Self {
        let trajectories = &study.description.trajectories;
        let of_input = |input: &crate::assemble::InputInfo| trajectories[input.trajectory].excitation();
        let excitations: Vec<&Excitation> = simulator.system.inputs.iter().filter_map(of_input).collect();
        let periods = excitations.iter().filter_map(|own| match own.class {
            Class::Held(period) => Some(period),
            _ => None,
        });
        let schedule = schedule.ending_at_multiples(&periods.collect::<Vec<f64>>());
        let ends = schedule.ends().into();
        Self { study, simulator, schedule, excitations, ends, count: 0 }
    }

    /// The same with steps that also end at some times, s.
    pub fn ending_at_times(&self, times: &[f64]) -> Self {
        let schedule = self.schedule.ending_at_times(times);
        let ends = schedule.ends().into();
        Self { schedule, ends, excitations: self.excitations.clone(), count: 0, ..*self }
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.simulator.program.outputs.len()
    }

    /// Whether some function jumps.
    pub fn jumps(&self) -> bool {
        self.excitations.iter().any(|own| own.class.jumps())
    }

    /// Whether there are uncertain parameters in addition to those that represent excitations as constants.
    pub fn has_parameters(&self) -> bool {
        let of_excitations: Vec<String> =
            self.excitations.iter().flat_map(|own| own.deviation.names().map(|(name, _)| name.to_owned())).collect();
        self.simulator.system.parameters.iter().any(|own| !of_excitations.contains(&own.name))
    }

    /// Indices of the trajectories that inputs are.
    pub fn inputs(&self) -> Vec<usize> {
        self.simulator.system.inputs.iter().map(|input| input.trajectory).collect()
    }

    /// The nominal parameters with all functions in the middle of their limits.
    pub fn middle(&self) -> Point {
        let domain = &self.study.domain;
        let xi = domain.xi(&domain.nominal);
        let functions = self.classes(&xi).iter().map(|class| class.middle(&self.ends)).collect();
        Point { xi, functions }
    }

    /// The parameters at a point.
    pub fn sample(&self, point: &Point) -> Sample {
        self.study.domain.sample(&point.xi)
    }

    /// The functions of a point, under which an output has a value in a row.
    pub fn function(&self, row: usize, value: f64, point: &Point) -> WorstFunction {
        let (sample, cells) = (self.sample(point), point.functions.clone());
        WorstFunction { row, value, sample, cells, ends: self.ends.clone() }
    }

    /// The functions that each excitation may be at parameters (ξ).
    pub fn classes(&self, xi: &[f64]) -> Vec<FunctionClass> {
        let limits = Limits::of(self.study.description, &self.study.domain.sample(xi));
        self.excitations.iter().map(|own| limits.class(own, &self.ends)).collect()
    }

    /// Values and gradients.
    ///
    /// # Errors
    /// If a sample cannot be assembled, and at an interruption.
    pub fn gradients(&mut self, asked: &[WeightedPoint]) -> Result<Vec<Gradient>, SimulationError> {
        self.count += asked.len();
        self.run(&self.schedule, asked, true)
    }

    /// Values alone, with each step divided into `parts`; NaN if a step does not converge.
    ///
    /// # Errors
    /// As for gradients.
    pub fn values(&mut self, asked: &[WeightedPoint], parts: usize) -> Result<Vec<f64>, SimulationError> {
        Ok(self.all_values(asked, parts)?.into_iter().map(|found| found.value).collect())
    }

    /// The same, with the values of all terms.
    ///
    /// # Errors
    /// As for gradients.
    pub fn all_values(&mut self, asked: &[WeightedPoint], parts: usize) -> Result<Vec<Gradient>, SimulationError> {
        self.count += asked.len();
        self.run(&self.schedule.refined(parts), asked, false)
    }

    fn run(
        &self,
        schedule: &Schedule,
        asked: &[WeightedPoint],
        backwards: bool,
    ) -> Result<Vec<Gradient>, SimulationError> {
        let samples: Vec<Sample> = asked.iter().map(|(point, _)| self.sample(point)).collect();
        let wanted = |(sample, (_, terms)): (usize, &WeightedPoint)| Functional { sample, terms: terms.clone() };
        let wanted: Vec<Functional> = asked.iter().enumerate().map(wanted).collect();
        let values: Vec<Vec<f64>> = asked.iter().map(|(point, _)| point.inputs()).collect();
        let under = Under { functions: Some(CellFunctions { ends: &self.ends, values: &values }), backwards };
        let found = gradients_under(self.simulator, schedule, &samples, &wanted, under, self.study.interruption);
        found.map_err(simulation)
    }
}

/// Other reasons do not occur: motions are not cut if something is excited.
fn simulation(error: NoGradient) -> SimulationError {
    match error {
        NoGradient::Simulation(error) => error,
        NoGradient::NoMotion { .. } | NoGradient::Events => SimulationError::Deferred,
    }
}
