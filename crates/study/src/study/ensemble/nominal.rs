//! The nominal motion.

use super::Motions;
use crate::methods::{self, BandBuilder, Ensemble, MethodResult, Sampling, Until};
use crate::numerics::Range;
use crate::simulate::{SimulationError, SingularPass};

impl Motions<'_> {
    /// The nominal motion as bands without width, and the singular configurations that it passes.
    ///
    /// # Errors
    /// Where it cannot be assembled, or constraints contradict one another on the way.
    pub fn nominal(&self) -> Result<(MethodResult, Vec<SingularPass>), SimulationError> {
        let outputs = self.outputs();
        let mut bands = BandBuilder::new(outputs, self.schedule.rows);
        if self.simulator.system.analysis.visits() {
            let sampling = Sampling { observed: methods::Observed::Outputs, until: Until::FirstStop, whole: false };
            let nominal = std::slice::from_ref(&self.domain.nominal);
            let (simulated, singular) = self.visit_watching(nominal, sampling, &mut |rows, values| {
                for (row, output) in rows.flat_map(|row| (0..outputs).map(move |output| (row, output))) {
                    let value = values[row * outputs + output];
                    bands.set(row, output, Range { lower: value, upper: value }, 0.0);
                }
            })?;
            return Ok((bands.finish(1, simulated), singular));
        }
        let sample = std::slice::from_ref(&self.domain.nominal);
        let mut run = self.start(sample)?.watching();
        let sampling = Sampling { observed: methods::Observed::Outputs, until: Until::FirstStop, whole: false };
        let simulated = self.advance(&mut run, sample, sampling, &mut |rows, values| {
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
}
