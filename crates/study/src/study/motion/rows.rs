//! Rows of a simulation of which other things are asked than the model's outputs.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::drawing::asked::{DrawingOutputs, DrawingValues};
use super::super::stepping::StepPlan;
use super::super::{RunError, formulation};
use super::tuning::TUNING;
use crate::assemble::{FormulationInfo, Questions};
use crate::model::{Analysis, Description, ModesRequest, Stepping};
use crate::numerics::{ParameterBox, Sample};
use crate::simulate::{
    Controller, Following, Integration, Interruption, Observed, Schedule, SegmentMethod, SegmentRun, SimulationError,
    Simulator, Steps, cut_at_events, integrator, schedule_for_tolerance,
};

/// A model with other outputs in place of its own.
pub(in crate::study) struct MotionRows<'a> {
    pub(in crate::study) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) interruption: Interruption<'a>,
    /// Whether motions are cut at events if they can be.
    pub(super) between_events: bool,
}

/// The rows of some samples.
pub(super) struct SimulatedRows {
    /// Times of the rows that are looked at, s.
    pub times: Vec<f64>,
    /// By sample, the row in which it stops.
    pub stopped: Vec<Option<usize>>,
    /// By sample, times of the events that all of them meet in the same order from the start on, s.
    pub events: Vec<Vec<f64>>,
}

/// Simulated samples.
#[derive(Clone, Copy)]
struct Running<'a> {
    /// Places of the samples among those that are wanted.
    running: &'a [usize],
    samples: &'a [Sample],
    /// Numbers of a sample that are stored of a row.
    numbers: usize,
}

/// Interval of the rows that are examined, for `numbers` numbers in all rows.
fn every(numbers: usize) -> usize {
    numbers.div_ceil(TUNING.most_numbers).max(1)
}

/// The nominal sample and corners of the box, which come first.
fn controlling(samples: &[Sample]) -> &[Sample] {
    &samples[..samples.len().min(1 + TUNING.controlling)]
}

impl<'a> MotionRows<'a> {
    /// Asks something, until it is interrupted. `known`: the formulation that was chosen for the model, if one was.
    pub(super) fn asking(
        description: &Description,
        asked: DrawingOutputs,
        known: Option<&FormulationInfo>,
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
        Ok(Self { simulator, domain, interruption, between_events: false })
    }

    /// Simulates samples. `keep` receives the sample, whether it is its first row, and the values. The nominal sample,
    /// the first, reaches all rows; `numbers` numbers of a sample are stored of a row.
    pub(super) fn of_samples(
        &self,
        description: &Description,
        wanted: &[Sample],
        numbers: usize,
        keep: impl FnMut(usize, bool, DrawingValues),
    ) -> Result<SimulatedRows, RunError> {
        let can = self.simulator.can_assemble(wanted);
        let running: Vec<usize> = (0..wanted.len()).filter(|&sample| sample == 0 || can[sample]).collect();
        let samples: Vec<Sample> = running.iter().map(|&sample| wanted[sample].clone()).collect();
        let mut stopped = vec![Some(0); wanted.len()];
        running.iter().for_each(|&sample| stopped[sample] = None);
        let run = Running { running: &running, samples: &samples, numbers };
        let mut events = vec![Vec::new(); wanted.len()];
        let times = match description.analysis.is_without_steps() {
            true => self.visit(description, run, &mut stopped, keep)?,
            false => {
                let (times, found) = self.follow(description, run, &mut stopped, keep)?;
                running.iter().zip(found).for_each(|(&sample, found)| events[sample] = found);
                times
            }
        };
        Ok(SimulatedRows { times, stopped, events })
    }

    /// Simulates by time steps. Returns times of rows, and times of common events by running sample.
    fn follow(
        &self,
        description: &Description,
        run: Running,
        stopped: &mut [Option<usize>],
        mut keep: impl FnMut(usize, bool, DrawingValues),
    ) -> Result<(Vec<f64>, Vec<Vec<f64>>), RunError> {
        let Running { running, samples, numbers } = run;
        let plan = self.plan(description, samples)?;
        let schedule = &plan.schedule;
        let every = every(schedule.rows * numbers * samples.len());
        let mut times = Vec::new();
        let (mut run, events) = match schedule.segments() {
            Some(segments) => {
                let run = SegmentRun::start(&self.simulator, samples, segments, schedule.end())?;
                let events = run.common_event_times();
                (run.rows(), events)
            }
            None => (integrator(&self.simulator, samples, schedule)?, Vec::new()),
        };
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
        Ok((times, events))
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

    /// Steps between the events that controlling samples meet, which each sample has at its own times; `None` where
    /// they are not cut there up to the end. Rows are denser than those of the outputs by a power of two.
    fn between_events(
        &self,
        description: &Description,
        samples: &[Sample],
    ) -> Result<Option<Schedule>, SimulationError> {
        // Constraints that open later are not watched for.
        if !self.between_events || !self.simulator.mobility.redundant.is_empty() {
            return Ok(None);
        }
        let (duration, output_step) = (description.simulation.duration, description.simulation.output_step);
        let following = Following { tolerance: TUNING.event_error, method: SegmentMethod::Explicit, of_steps: None };
        let found = cut_at_events(&self.simulator, &self.domain, controlling(samples), duration, following, None)?;
        let rows = Schedule::rows_of(duration, output_step);
        let finer = (TUNING.rows_between_events / rows).max(1).ilog2();
        let dense = output_step / f64::from(1 << finer);
        let whole = found.filter(|steps| steps.horizon() >= duration);
        Ok(whole.map(|steps| Schedule::ending_at_events(duration, dense, steps)))
    }

    /// The steps: those between events, the model's, or those that its tolerance asks for at the nominal sample and
    /// corners of the box.
    fn plan(&self, description: &Description, samples: &[Sample]) -> Result<StepPlan, RunError> {
        if let Some(schedule) = self.between_events(description, samples)? {
            return Ok(StepPlan::fixed(schedule));
        }
        let simulation = &description.simulation;
        let (duration, output_step) = (simulation.duration, simulation.output_step);
        let (schedule, controller) = match simulation.stepping {
            Stepping::Fixed(step) => {
                let integration = Integration::of_levels(simulation.extrapolation.unwrap_or(1));
                (Schedule::fixed(duration, step, output_step).taken(integration), None)
            }
            Stepping::Tolerance(tolerance) => {
                let found = schedule_for_tolerance(
                    &self.simulator,
                    controlling(samples),
                    duration,
                    output_step,
                    tolerance,
                    self.interruption,
                )?;
                (found.schedule, Some(Controller { tolerance, duration }))
            }
        };
        let functions = self.simulator.time_functions(duration);
        let schedule = functions.map_or_else(|| schedule.clone(), |functions| functions.divided(&schedule).schedule);
        Ok(StepPlan { schedule, controller })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MotionOptions, report_motion};
    use super::*;
    use crate::model;

    /// A ball that bounces without loss; the floor's spring is as stiff as the sample says, the step too long for it.
    const BALL: &str = "
parameters: { K: { value: 1e5, unit: N/m, tolerance: 5% }, h0: { value: 1, unit: m, tolerance: 2% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ground: { force: { on: ball, value: [0, \"K*max(-ball.y, 0)\"] } }
initial: { ball.y: h0, ball.vy: 0 }
outputs: { y: ball.y }
simulation: { duration: 2, step: 1e-3, output_step: 0.02 }
";

    /// Height of a ball: parabolas, and in contact y = −(u/ω) sin ωτ − (g/ω²)(1 − cos ωτ).
    fn height(stiffness: f64, from: f64, t: f64) -> f64 {
        let (g, omega) = (9.81, stiffness.sqrt());
        let speed = (2.0 * g * from).sqrt();
        let fall = speed / g;
        let contact = (std::f64::consts::PI + 2.0 * (g / (speed * omega)).atan()) / omega;
        if t < fall {
            return from - 0.5 * g * t * t;
        }
        let within = (t - fall) % (contact + 2.0 * fall);
        if within < contact {
            let (sin, cos) = (omega * within).sin_cos();
            return -speed / omega * sin - g / (omega * omega) * (1.0 - cos);
        }
        let flight = within - contact;
        speed * flight - 0.5 * g * flight * flight
    }

    #[test]
    fn each_sample_bounces_at_its_own_times() {
        let description = model::load_str("ball.yaml", BALL, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        let options = MotionOptions {
            threads: Some(2),
            size: 300_000,
            interruption: Interruption::default(),
            between_events: true,
            formulation: None,
        };
        let motion = report_motion(&description, &[], options).unwrap();
        assert!(motion.samples.len() > 8 && motion.stopped == 0);
        let named = |name: &str| motion.parameters.iter().position(|own| own.name == name).unwrap();
        let (stiffness, from) = (named("K"), named("h0"));
        let nominal: Vec<f64> = motion.parameters.iter().map(|own| own.nominal).collect();
        let samples = motion.samples.iter().map(|sample| (&sample.values, &sample.poses));
        for (values, poses) in samples.chain([(&nominal, &motion.nominal)]) {
            let heights: Vec<f64> = poses.bodies.chunks_exact(3).map(|pose| pose[1]).collect();
            for (&time, found) in motion.times.iter().zip(&heights) {
                let own = height(values[stiffness], values[from], time);
                assert!((found - own).abs() < 1e-6, "{values:?} at {time} s: {found} m, not {own} m");
            }
            // Contacts last for 10 ms, rows of the outputs are 20 ms apart: those of the motion are denser.
            let deepest = (2.0 * 9.81 * values[from] / values[stiffness]).sqrt();
            let least = heights.iter().copied().fold(0.0, f64::min);
            assert!(least < 2e-3 - deepest, "{values:?}: {least} m, not {} m", -deepest);
        }
        // At fixed times they are off by 6.2 mm, and lines between poses by 0.2 mm.
        let polynomials = motion.polynomials.unwrap();
        assert!(polynomials.events.len() == 4 && polynomials.error < 1e-3, "{} m", polynomials.error);
    }
}
