//! Points that are evaluated twice: differences are noise of the program.

use super::tuning::TUNING;
use crate::methods::Validation;
use crate::numerics::Sample;
use crate::results::{BlackBoxSummary, NoiseSummary};
use crate::simulate::SimulationError;
use crate::study::problem::Study;

/// Evaluates points a second time, and notes the differences of the answers; does nothing if the model has no program.
///
/// # Errors
/// If the program cannot be started.
pub(in crate::study) fn repeat(study: &Study, validation: Option<&Validation>) -> Result<(), SimulationError> {
    let Some(source) = &study.source else { return Ok(()) };
    let mut samples: Vec<Sample> = vec![study.domain.nominal.clone()];
    if let Some(validation) = validation {
        let points = &validation.points[..validation.points.len().min(TUNING.asked_twice)];
        samples.extend(study.domain.samples(points));
    }
    samples.dedup();
    let first = source.answers(&samples, 1.0, study.interruption, &|_| ());
    let again = first.and_then(|first| Ok((first, source.once_more(&samples, study.interruption)?)));
    let (first, again) = match again {
        Err(SimulationError::Interrupted) => return Ok(()),
        found => found?,
    };
    let both = || first.iter().zip(&again).filter_map(|(a, b)| Some((a.as_ref().ok()?, b.as_ref().ok()?)));
    let outputs = source.outputs();
    let noise = |output: usize| {
        let pairs = both().flat_map(|(a, b)| a.iter().zip(b).skip(output).step_by(outputs.max(1)));
        let (mut largest, mut size) = (0.0_f64, 0.0_f64);
        for (a, b) in pairs {
            largest = largest.max((a - b).abs());
            size = size.max(a.abs());
        }
        if largest > TUNING.rounding * size { largest } else { 0.0 }
    };
    let named = study.description.outputs.iter().enumerate();
    let noisy = named.map(|(output, own)| (own, noise(output))).filter(|(_, noise)| *noise > 0.0);
    source.note(BlackBoxSummary {
        command: source.own.words(),
        repeated: both().count(),
        noise: noisy
            .map(|(own, noise)| NoiseSummary {
                output: own.name.clone(),
                unit: own.unit.clone(),
                display: study.description.display.get(&own.name).cloned(),
                noise,
            })
            .collect(),
        refined_by: source.refined_by().map(str::to_owned),
    });
    Ok(())
}
