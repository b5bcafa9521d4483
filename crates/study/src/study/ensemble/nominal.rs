//! The nominal motion.

use super::Motions;
use super::visits::visit_watching;
use crate::methods::{self, BandBuilder, Ensemble, MethodResult, Sampling, Until};
use crate::numerics::Range;
use crate::simulate::{SimulationError, SingularPass};

/// The nominal motion as bands without width, and the singular configurations that it passes.
///
/// # Errors
/// If it cannot be assembled, or constraints contradict one another on the way.
pub fn nominal(motions: &Motions) -> Result<(MethodResult, Vec<SingularPass>), SimulationError> {
    let outputs = motions.outputs();
    let mut bands = BandBuilder::new(outputs, motions.schedule.rows);
    if motions.simulator.system.analysis.visits() {
        let sampling = Sampling { observed: methods::Observed::Outputs, until: Until::FirstStop, whole: false };
        let nominal = std::slice::from_ref(&motions.domain.nominal);
        let (simulated, singular) = visit_watching(motions, nominal, sampling, &mut |rows, values| {
            for (row, output) in rows.flat_map(|row| (0..outputs).map(move |output| (row, output))) {
                let value = values[row * outputs + output];
                bands.set(row, output, Range { lower: value, upper: value }, 0.0);
            }
        })?;
        return Ok((bands.finish(1, simulated), singular));
    }
    let sample = std::slice::from_ref(&motions.domain.nominal);
    let mut run = motions.start(sample)?;
    run.watch();
    let sampling = Sampling { observed: methods::Observed::Outputs, until: Until::FirstStop, whole: false };
    let simulated = motions.advance(run.as_mut(), sample, sampling, &mut |rows, values| {
        for (row, values) in rows.zip(values.chunks_exact(outputs)) {
            for (output, &value) in values.iter().enumerate() {
                bands.set(row, output, Range { lower: value, upper: value }, 0.0);
            }
        }
    });
    match run.parted() {
        Some(parted) => Err(parted),
        None => Ok((bands.finish(1, simulated), run.singular_passes())),
    }
}
