//! The integrator that a schedule asks for.

use symdiff::jet::JetSpace;

use super::control::{Integration, Schedule};
use super::ensemble::{EnsembleRun, ExtrapolatedJets, ExtrapolatedRun, JetBox, JetRun};
use super::error::SimulationError;
use super::events::SegmentRun;
use super::explicit::{ExplicitJets, ExplicitRun};
use super::integrator::{Integrator, JetIntegrator};
use super::simulator::Simulator;
use crate::numerics::Sample;

/// Samples, assembled, to be integrated as a schedule asks for.
///
/// # Errors
/// The first sample that cannot be assembled.
pub fn integrator<'s>(
    simulator: &'s Simulator,
    samples: &[Sample],
    schedule: &'s Schedule,
) -> Result<Box<dyn Integrator<'s> + 's>, SimulationError> {
    if let Some(segments) = schedule.segments() {
        return Ok(Box::new(SegmentRun::start(simulator, samples, segments, schedule.end())?));
    }
    let first_step = schedule.first_step();
    Ok(match schedule.integration {
        Integration::Plain => Box::new(EnsembleRun::start(simulator, samples, first_step)?),
        Integration::Extrapolated { levels } => {
            Box::new(ExtrapolatedRun::start(simulator, samples, first_step, levels)?)
        }
        Integration::Explicit | Integration::Segments => Box::new(ExplicitRun::start(simulator, samples)?),
    })
}

/// A jet, assembled, to be integrated as a schedule asks for; `is_controlled`: a tolerance decides the steps.
///
/// # Errors
/// Where the centre cannot be assembled.
pub fn jet_integrator<'s>(
    simulator: &'s Simulator,
    space: &'s JetSpace,
    about: JetBox<'_>,
    schedule: &Schedule,
    is_controlled: bool,
) -> Result<Box<dyn JetIntegrator<'s> + 's>, SimulationError> {
    let first_step = schedule.first_step();
    Ok(match schedule.integration {
        Integration::Plain => {
            let jet = JetRun::start(simulator, space, about, first_step)?;
            Box::new(if is_controlled { jet.controlled() } else { jet })
        }
        Integration::Extrapolated { levels } => {
            Box::new(ExtrapolatedJets::start(simulator, space, about, first_step, levels)?)
        }
        Integration::Explicit | Integration::Segments => Box::new(ExplicitJets::start(simulator, space, about)?),
    })
}
