//! Rows of a simulation of which other things are asked than the model's outputs.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::drawing::asked::{DrawingOutputs, DrawingValues};
use super::super::stepping::StepPlan;
use super::super::{RunError, formulation};
use super::tuning::TUNING;
use crate::assemble::Questions;
use crate::model::{Analysis, Description, ModesRequest, Stepping};
use crate::numerics::{ParameterBox, Sample};
use crate::simulate::{
    Controller, EnsembleRun, Integration, Integrator, Interruption, Observed, Schedule, SimulationError, Simulator,
    Steps, TimeFunctions, schedule_for_tolerance,
};

/// A model that is asked for something in place of its outputs.
pub(in crate::study) struct MotionRows<'a> {
    pub(in crate::study) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) interruption: Interruption<'a>,
}

/// Simulated samples.
#[derive(Clone, Copy)]
struct Running<'a> {
    /// Places of the samples among those that are wanted.
    running: &'a [usize],
    samples: &'a [Sample],
    /// Numbers of a sample that are kept of a row.
    numbers: usize,
}

/// How many rows one stands for that is looked at, of so many numbers.
fn every(numbers: usize) -> usize {
    numbers.div_ceil(TUNING.most_numbers).max(1)
}

impl<'a> MotionRows<'a> {
    /// Asks something, until it is interrupted. `known`: the model's program for other questions, if there is one,
    /// whose formulation is taken.
    pub(super) fn asking(
        description: &Description,
        asked: DrawingOutputs,
        known: Option<&Simulator>,
        interruption: Interruption<'a>,
    ) -> Result<Self, RunError> {
        // Responses are between outputs that are not asked here.
        let modes = ModesRequest { responses: Vec::new(), ..description.modes };
        let questions = Questions { outputs: asked.0.into(), modes: Cow::Owned(modes), ..Questions::of(description) };
        let simulator = match known {
            Some(known) => formulation::compiled_alike(&questions, known)?,
            None => formulation::compiled(&questions)?,
        };
        let parameters = &simulator.system.parameters;
        let domain = ParameterBox {
            nominal: parameters.iter().map(|parameter| parameter.nominal).collect(),
            lower: parameters.iter().map(|parameter| parameter.lower).collect(),
            upper: parameters.iter().map(|parameter| parameter.upper).collect(),
            zones: Vec::new(),
        };
        Ok(Self { simulator, domain, interruption })
    }

    /// Times of the rows that are looked at, and where samples stop. What is asked is given to `keep`: the sample,
    /// whether it is its first
    /// row, and the values. The nominal sample, the first, reaches all rows; of a sample `numbers` are kept of a row.
    pub(super) fn of_samples(
        &self,
        description: &Description,
        wanted: &[Sample],
        numbers: usize,
        keep: impl FnMut(usize, bool, DrawingValues),
    ) -> Result<(Vec<f64>, Vec<Option<usize>>), RunError> {
        let can = self.simulator.can_assemble(wanted);
        let running: Vec<usize> = (0..wanted.len()).filter(|&sample| sample == 0 || can[sample]).collect();
        let samples: Vec<Sample> = running.iter().map(|&sample| wanted[sample].clone()).collect();
        let mut stopped = vec![Some(0); wanted.len()];
        running.iter().for_each(|&sample| stopped[sample] = None);
        let run = Running { running: &running, samples: &samples, numbers };
        let times = match description.analysis.is_without_steps() {
            true => self.visit(description, run, &mut stopped, keep)?,
            false => self.follow(description, run, &mut stopped, keep)?,
        };
        Ok((times, stopped))
    }

    /// By time steps.
    fn follow(
        &self,
        description: &Description,
        run: Running,
        stopped: &mut [Option<usize>],
        mut keep: impl FnMut(usize, bool, DrawingValues),
    ) -> Result<Vec<f64>, RunError> {
        let Running { running, samples, numbers } = run;
        let plan = self.plan(description, samples)?;
        let schedule = &plan.schedule;
        let every = every(schedule.rows * numbers * samples.len());
        let mut times = Vec::new();
        let mut run = EnsembleRun::start(&self.simulator, samples, schedule.first_step())?;
        run.heed(self.interruption);
        let outputs = self.simulator.system.outputs.len();
        let mut values = Vec::new();
        let mut next = 0;
        while next < schedule.rows && stopped[0].is_none() {
            let block = next..(next + TUNING.rows_at_once).min(schedule.rows);
            for stop in run.advance(plan.steps(), block.clone(), Observed::Outputs, &mut values) {
                stopped[running[stop.sample]].get_or_insert(stop.row.div_ceil(every));
            }
            if run.is_cut() {
                return Err(SimulationError::Interrupted.into());
            }
            let end = stopped[0].map_or(block.end, |row| block.end.min(row * every));
            for (row, of_row) in block.clone().zip(values.chunks_exact(outputs * samples.len())) {
                if row >= end || row % every > 0 {
                    continue;
                }
                times.push(schedule.time(row));
                for (index, &sample) in running.iter().enumerate() {
                    let own: Vec<f64> = (0..outputs).map(|output| of_row[output * samples.len() + index]).collect();
                    keep(sample, row == 0, DrawingValues(own));
                }
            }
            next = block.end;
        }
        Ok(times)
    }

    /// Configuration by configuration.
    fn visit(
        &self,
        description: &Description,
        run: Running,
        stopped: &mut [Option<usize>],
        mut keep: impl FnMut(usize, bool, DrawingValues),
    ) -> Result<Vec<f64>, RunError> {
        let Running { running, samples, numbers } = run;
        let (duration, output_step) = (description.simulation.duration, description.simulation.output_step);
        let rows =
            if description.analysis == Analysis::Kinematics { Schedule::rows_of(duration, output_step) } else { 1 };
        let every = every(rows * numbers * samples.len());
        let times: Vec<f64> =
            (0..rows).step_by(every).map(|row| Schedule::time_of(duration, output_step, row)).collect();
        let schedule = Schedule::fixed(duration, output_step, output_step);
        let outputs = self.simulator.system.outputs.len();
        let found: Vec<_> = samples
            .par_iter()
            .map(|sample| {
                self.simulator.visit(sample, Steps { schedule: &schedule, controller: None }, &[], self.interruption)
            })
            .collect();
        for (&sample, visit) in running.iter().zip(found) {
            let visit = match visit {
                Err(error) if sample == 0 => return Err(error.into()),
                Err(_) => {
                    stopped[sample] = Some(0);
                    continue;
                }
                Ok(visit) => visit,
            };
            stopped[sample] = visit.stop.map(|stop| stop.row.div_ceil(every));
            for (row, values) in visit.values.chunks_exact(outputs).step_by(every).enumerate() {
                keep(sample, row == 0, DrawingValues(values.to_vec()));
            }
        }
        let reached = stopped[0].unwrap_or(times.len());
        Ok(times[..reached.min(times.len())].to_vec())
    }

    /// The steps: the model's, or those that its tolerance asks for at the nominal sample and corners of the box.
    fn plan(&self, description: &Description, samples: &[Sample]) -> Result<StepPlan, RunError> {
        let simulation = &description.simulation;
        let (duration, output_step) = (simulation.duration, simulation.output_step);
        let (schedule, controller) = match simulation.stepping {
            Stepping::Fixed(step) => {
                let integration = Integration::of_levels(simulation.extrapolation.unwrap_or(1));
                (Schedule::fixed(duration, step, output_step).taken(integration), None)
            }
            Stepping::Tolerance(tolerance) => {
                let controlling = &samples[..samples.len().min(1 + TUNING.controlling)];
                let found = schedule_for_tolerance(
                    &self.simulator,
                    controlling,
                    duration,
                    output_step,
                    tolerance,
                    self.interruption,
                )?;
                (found.schedule, Some(Controller { tolerance, duration }))
            }
        };
        let functions = TimeFunctions::of(&self.simulator, duration);
        let schedule = functions.map_or_else(|| schedule.clone(), |functions| functions.divided(&schedule).schedule);
        Ok(StepPlan { schedule, controller })
    }
}
