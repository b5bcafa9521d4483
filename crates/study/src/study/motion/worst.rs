//! Motions under the worst functions of excitations: each a model of its own, with the functions in place of limits.

use super::polynomials::pose_at;
use super::tuning::TUNING;
use super::{MotionOptions, Posed, Recorded};
use crate::model::{Description, Witness, deviation_of};
use crate::results::{FunctionWitness, Motion, Poses, WorstMotion};
use crate::simulate::SimulationError;
use crate::study::{RunError, pool};

/// Adds the motions under the functions of a run to that of a report, at its times. One that cannot be simulated is
/// omitted.
///
/// # Errors
/// At an interruption, and if threads cannot be had.
pub(super) fn add_worst_motions(
    description: &Description,
    motion: &mut Motion,
    witnesses: &[FunctionWitness],
    options: MotionOptions,
) -> Result<(), RunError> {
    let pool = pool(options.threads)?;
    pool.install(|| {
        for own in witnesses.iter().take(TUNING.worst_motions) {
            match worst(description, motion, own, options) {
                Err(RunError::Simulation(SimulationError::Interrupted)) => {
                    return Err(SimulationError::Interrupted.into());
                }
                found => motion.worst.extend(found.ok().flatten()),
            }
        }
        Ok(())
    })
}

/// `None` if the functions are none, or the motion does not reach the instant.
fn worst(
    description: &Description,
    motion: &Motion,
    own: &FunctionWitness,
    options: MotionOptions,
) -> Result<Option<WorstMotion>, RunError> {
    let functions = own.functions.iter().map(|function| (function.name.as_str(), function.points.as_slice()));
    let is_constant = |name: &str| own.functions.iter().any(|function| name == deviation_of(&function.name));
    let values = motion.parameters.iter().zip(&own.parameters);
    let values = values.map(|(parameter, value)| (parameter.name.clone(), *value));
    let Ok(witness) = Witness::new(functions, values.filter(|(name, _)| !is_constant(name)).collect()) else {
        return Ok(None);
    };
    let mut replayed = description.clone();
    if witness.replay(&mut replayed).is_err() {
        return Ok(None);
    }
    let posed = Posed::compile(&replayed, None, options.interruption)?;
    let nominal = [posed.rows.domain.nominal.clone()];
    let (times, mut recorded) = posed.record(&replayed, &motion.drawing, &nominal)?;
    let Recorded { rows, points, .. } = recorded.swap_remove(0);
    let lines = posed.per_body() * (posed.bodies.len() - 1);
    let last = own.time.unwrap_or(f64::INFINITY);
    if times.last().is_none_or(|end| *end < last.min(motion.times.last().copied().unwrap_or(0.0))) {
        return Ok(None);
    }
    let bodies = motion.times.iter().flat_map(|&time| pose_at(&times, &rows, lines, time.min(last))).collect();
    Ok(Some(WorstMotion { name: own.name.clone(), time: own.time, poses: Poses { bodies, points } }))
}
