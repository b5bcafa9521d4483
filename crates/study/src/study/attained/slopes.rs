//! Values and gradients at samples, which climbs follow.

use crate::numerics::Sample;
use crate::simulate::{NoGradient, Schedule, SimulationError, Wanted, gradients};
use crate::study::problem::Study;

/// Value of an output and its derivatives by the parameters.
pub type Slope = (f64, Vec<f64>);

/// Gradients of the outputs of an ensemble.
pub trait Slopes {
    /// One for each output in a row of a sample that is wanted; `None` where
    /// there are none.
    ///
    /// # Errors
    /// At an interruption.
    fn slopes(&self, samples: &[Sample], wanted: &[Wanted]) -> Result<Option<Vec<Slope>>, SimulationError>;
}

/// Slopes of outputs over time.
pub(super) struct OfRows<'s, 'm> {
    pub study: &'s Study<'m>,
    pub schedule: &'s Schedule,
}

impl Slopes for OfRows<'_, '_> {
    fn slopes(&self, samples: &[Sample], wanted: &[Wanted]) -> Result<Option<Vec<Slope>>, SimulationError> {
        let Self { study, schedule } = self;
        match gradients(&study.simulator, schedule, samples, wanted, study.interruption) {
            Err(NoGradient::Simulation(SimulationError::Interrupted)) => Err(SimulationError::Interrupted),
            // Some corner cannot be assembled: the ends so far remain.
            Err(_) => Ok(None),
            Ok(found) => Ok(Some(found.into_iter().map(|own| (own.value, own.by_parameters)).collect())),
        }
    }
}
