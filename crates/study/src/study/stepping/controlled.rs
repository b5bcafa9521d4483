//! Steps from a tolerance: the error of every output, relative to how far it moves.

use super::plan::StepPlan;
use super::validated::integration;
use crate::study::bounding::simulation_error;
use crate::study::ensemble::Progress;
use crate::study::problem::Study;
use crate::study::stepping::tuning::TUNING;
use symdiff::math;

use crate::methods::{Ensemble, Observed, Sampling, Until};
use crate::numerics::{Sample, corners};
use crate::simulate::{Controller, SimulationError, ToleranceSchedule, schedule_for_tolerance};

/// A schedule whose errors in the outputs are within the tolerance at the controlling samples, and the local errors
/// that are allowed for it; also the error that ended it before the last row, if there is one. How far an early error
/// is carried depends on the problem: the first schedule shows it.
pub fn schedule_within(
    study: &Study,
    tolerance: f64,
    samples: &[Sample],
) -> Result<(StepPlan, Option<SimulationError>), SimulationError> {
    let (duration, output_step) = (study.description.simulation.duration, study.description.simulation.output_step);
    let integration = integration(study);
    // Plain steps for an error of e are as long as the root of e, extrapolated ones as long as a higher root.
    let of_plain = |error: f64| match integration.order() {
        2 => error,
        order => math::pow(error, 2.0 / order as f64),
    };
    let mut controller = Controller { tolerance: of_plain(tolerance), duration };
    let schedule = |controller: Controller| -> Result<ToleranceSchedule, SimulationError> {
        let controlled = schedule_for_tolerance(
            &study.simulator,
            samples,
            duration,
            output_step,
            controller.tolerance,
            study.interruption,
        )?;
        Ok(ToleranceSchedule { schedule: controlled.schedule.taken(integration), ..controlled })
    };
    let mut controlled = schedule(controller)?;
    let steps = |controlled: &ToleranceSchedule| controlled.schedule.steps_before(controlled.schedule.rows - 1) as f64;
    let most = (TUNING.controlled_growth * steps(&controlled))
        .max(TUNING.controlled_steps / study.simulator.system.q.len() as f64);
    for _ in 1..TUNING.controlled_rounds {
        if controlled.failure.is_some() || study.interruption.is_asked() {
            break;
        }
        let plan = StepPlan { schedule: controlled.schedule.clone(), controller: Some(controller) };
        let share = steps_error(study, &plan, samples)? / tolerance;
        // Steps go with the root of the tolerance.
        let room = (most / steps(&controlled).max(1.0)).powi(2);
        let factor = of_plain(share / TUNING.controlled_aim).min(room);
        if share <= 1.0 || factor < 1.5 {
            break;
        }
        let finer = Controller { tolerance: controller.tolerance / factor, ..controller };
        let next = schedule(finer)?;
        if next.failure.is_some() {
            break;
        }
        (controlled, controller) = (next, finer);
    }
    Ok((StepPlan { schedule: controlled.schedule, controller: Some(controller) }, controlled.failure))
}

/// The largest error of an output at the controlling samples, relative to how far it moves, by halving the steps.
pub fn steps_error(study: &Study, plan: &StepPlan, samples: &[Sample]) -> Result<f64, SimulationError> {
    let progress = Progress::new(usize::MAX, study.progress);
    let values = |plan: &StepPlan| {
        let motions = study.motions(plan.steps(), &progress);
        let mut values: Vec<f64> = Vec::new();
        let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
        motions
            .simulate(samples, sampling, &mut |_, block| values.extend_from_slice(block))
            .map_err(simulation_error)?;
        Ok(values)
    };
    let (direct, halved) = (values(plan)?, values(&plan.halved())?);
    let outputs = &study.simulator.system.outputs;
    let lines = |values: &[f64]| -> Vec<Vec<f64>> {
        let line = |output: usize| values.chunks_exact(samples.len()).skip(output).step_by(outputs.len()).flatten();
        (0..outputs.len()).map(|output| line(output).copied().collect()).collect()
    };
    let (direct, halved) = (lines(&direct), lines(&halved));
    let sizes: Vec<f64> = direct.iter().map(|values| largest(values.iter().copied())).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let share = |output: usize| {
        let same = sizes.iter().zip(outputs).filter(|(_, other)| other.dimension == outputs[output].dimension);
        let size = same.map(|(size, _)| *size).fold(0.0, f64::max);
        let error = TUNING.richardson * largest(direct[output].iter().zip(&halved[output]).map(|(a, b)| a - b));
        let [moves, moves_halved] = [&direct, &halved].map(|values| width(&values[output]));
        if moves <= (TUNING.constant * size).max(TUNING.rounding * most) {
            return 0.0;
        }
        // An output that moves by the steps' errors alone, as an energy does, moves less with halved steps.
        error / if moves_halved < TUNING.steady * moves { size } else { moves }
    };
    Ok((0..outputs.len()).map(share).fold(0.0, f64::max))
}

/// The nominal sample and corners of the box.
pub fn controlling_samples(study: &Study) -> Vec<Sample> {
    let mut samples = vec![study.domain.nominal.clone()];
    for corner in corners(study.domain.dimension(), TUNING.controlling_corners).iter().map(|xi| study.domain.sample(xi))
    {
        if !samples.contains(&corner) {
            samples.push(corner);
        }
    }
    samples
}

/// Largest absolute value; NaN, of samples that stopped, is passed over.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Distance from the smallest to the largest value.
fn width(values: &[f64]) -> f64 {
    let (lower, upper) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), &value| (lower.min(value), upper.max(value)));
    upper - lower
}
