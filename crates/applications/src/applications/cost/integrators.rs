//! Schemes and other integrators side by side: the nominal trajectory, on one core, by each with each step.

use super::deviation::KnownBands;
use super::grid::{LEVELS, Setting, steppings, steppings_by};
use super::timing::{best_of, method, timed};
use super::tuning::TUNING;
use super::{CostError, CostOptions};
use crate::assemble::System;
use crate::compile::Scheme;
use crate::model::{Description, Simulation, Stepping};
use crate::numerics::Sample;
use crate::results::{CostMethod, CostPoint, Integrator};
use crate::simulate::{Interruption, Schedule, SimulationError, Simulator, Stepper, schedule_for_tolerance};
use crate::study::{RunError, first_step, scheme as model_scheme};

/// Integrators in place of plain steps.
const INTEGRATORS: [Integrator; 4] =
    [Integrator::Extrapolated { levels: 2 }, LEVELS, Integrator::Extrapolated { levels: 4 }, Integrator::Explicit];

/// Every scheme's settings, from coarse to fine; those that were done before an interruption.
///
/// # Errors
/// If a scheme cannot be compiled or started at all; steps that fail make a setting without a result.
pub(super) fn trajectories(
    model: &Description,
    system: &System,
    known: &KnownBands,
    progress: &dyn Fn(f64),
    options: &CostOptions,
) -> Result<Vec<CostPoint>, CostError> {
    let interrupted = options.interrupted;
    let mut schemes = vec![model_scheme(model), Scheme::TrapezoidalIndex2];
    schemes.extend(TUNING.spectral_radii.map(|spectral_radius| Scheme::GeneralisedAlpha { spectral_radius }));
    let steppings = steppings(&model.simulation);
    let others: Vec<(Integrator, Stepping)> = INTEGRATORS
        .into_iter()
        .flat_map(|other| steppings_by(other, &model.simulation).into_iter().map(move |stepping| (other, stepping)))
        .collect();
    let total = (schemes.len() * steppings.len() + others.len()) as f64;
    let mut points = Vec::new();
    for scheme in schemes {
        let simulator = Simulator::new(system.clone(), scheme, first_step(model)).map_err(RunError::from)?;
        for &stepping in steppings.iter().take_while(|_| !interrupted()) {
            let (run, seconds) = best_of(|| Course::run(&simulator, &model.simulation, stepping), |_, seconds| seconds)
                .map_err(RunError::from)?;
            points.push(CostPoint {
                simulations: 1,
                steps: run.steps,
                seconds,
                deviation: known.of_courses(run.outputs.iter().map(Vec::as_slice)),
                failure: run.failure,
                ..CostPoint::without_result(CostMethod::Scheme(scheme), stepping)
            });
            progress(points.len() as f64 / total);
        }
    }
    let options = CostOptions { threads: Some(1), ..*options };
    for (integrator, stepping) in others {
        if interrupted() {
            break;
        }
        let setting = Setting { method: CostMethod::By(integrator), count: 0, stepping };
        let without = CostPoint::without_result(setting.method, stepping);
        let point = match timed(model, &setting, &options, &|_| ()) {
            Ok(((bounds, summary), seconds)) => CostPoint {
                simulations: 1,
                steps: method(&summary, &setting).steps,
                seconds,
                deviation: known.of_courses(bounds.outputs.iter().map(|output| &output.nominal[..])),
                failure: summary.failure,
                ..without
            },
            Err(error) => CostPoint { failure: Some(error.to_string()), ..without },
        };
        // A run that was cut short measures nothing.
        if interrupted() {
            break;
        }
        points.push(point);
        progress(points.len() as f64 / total);
    }
    Ok(points)
}

/// The nominal sample's course.
struct Course {
    /// Each output's, up to where it stopped.
    outputs: Vec<Vec<f64>>,
    steps: usize,
    failure: Option<String>,
}

impl Course {
    fn run(simulator: &Simulator, simulation: &Simulation, stepping: Stepping) -> Result<Self, SimulationError> {
        let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let (schedule, mut failure) = match stepping {
            Stepping::Fixed(step) => (Schedule::fixed(simulation.duration, step, simulation.output_step), None),
            Stepping::Tolerance(tolerance) => {
                let samples = std::slice::from_ref(&nominal);
                let controlled = schedule_for_tolerance(
                    simulator,
                    samples,
                    simulation.duration,
                    simulation.output_step,
                    tolerance,
                    Interruption::default(),
                )?;
                (controlled.schedule, controlled.failure.map(|failure| failure.to_string()))
            }
        };
        let start = simulator.assemble(1, schedule.first_step(), |_| nominal.clone())?;
        let mut stepper = Stepper::new(&simulator.program, &start);
        let mut values = vec![0.0; simulator.program.outputs.len()];
        let mut outputs = vec![Vec::with_capacity(schedule.rows); values.len()];
        let mut steps = 0;
        for row in 0..schedule.rows {
            for (h, end) in schedule.steps_to(row) {
                if let Some(failed) = stepper.step(h, end).first() {
                    failure = Some(format!("did not converge at t = {} s", failed.time));
                    return Ok(Self { outputs, steps, failure });
                }
                steps += 1;
            }
            stepper.observe(&mut values);
            outputs.iter_mut().zip(&values).for_each(|(course, &value)| course.push(value));
        }
        Ok(Self { outputs, steps, failure })
    }
}
