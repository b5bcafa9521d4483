//! The integrator that a schedule asks for.

use symdiff::WIDTHS;
use symdiff::jet::JetSpace;

use super::control::{Integration, Schedule};
use super::drive::{ClosedRows, Extrapolated, Integrator, TUNING};
use super::ensemble::{EnsembleRun, JetBox, JetClosure, JetRun, RowClosure};
use super::error::SimulationError;
use super::events::SegmentRun;
use super::explicit::{ExplicitJets, ExplicitRun};
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
        return Ok(SegmentRun::start(simulator, samples, segments, schedule.end())?.rows());
    }
    let first_step = schedule.first_step();
    Ok(match schedule.integration {
        Integration::Plain => Box::new(EnsembleRun::start(simulator, samples, first_step)?),
        Integration::Extrapolated { levels } => {
            let closures = closures(simulator, samples, first_step)?;
            let of_level = |share: f64| EnsembleRun::start(simulator, samples, share * first_step);
            Box::new(Extrapolated::of(simulator, levels, closures, of_level)?)
        }
        Integration::Explicit | Integration::Segments | Integration::SchemeSegments { .. } => {
            Box::new(ExplicitRun::start(simulator, samples)?)
        }
    })
}

/// Closures of the rows of samples.
fn closures<'s>(
    simulator: &'s Simulator,
    samples: &[Sample],
    first_step: f64,
) -> Result<Vec<ClosedRows<RowClosure<'s>>>, SimulationError> {
    let numbers: Vec<usize> = (0..samples.len()).collect();
    let of_chunk = |own: &[usize]| {
        let width = WIDTHS.into_iter().find(|&width| width >= own.len()).unwrap_or(own.len());
        let sample = |lane: usize| samples[own[lane.min(own.len() - 1)]].clone();
        let start = simulator.assemble(width, first_step, sample)?;
        Ok(ClosedRows { samples: own.to_vec(), closure: RowClosure::new(simulator, &start)? })
    };
    numbers.chunks(TUNING.extrapolated_width).map(of_chunk).collect()
}

/// A jet, assembled, to be integrated as a schedule asks for.
///
/// # Errors
/// Where the centre cannot be assembled.
pub fn jet_integrator<'s>(
    simulator: &'s Simulator,
    space: &'s JetSpace,
    about: JetBox<'_>,
    schedule: &Schedule,
) -> Result<Box<dyn Integrator<'s> + 's>, SimulationError> {
    let first_step = schedule.first_step();
    Ok(match schedule.integration {
        Integration::Plain => Box::new(JetRun::start(simulator, space, about, first_step)?),
        Integration::Extrapolated { levels } => {
            let start = simulator.assemble(1, first_step, |_| about.center.iter().copied().collect())?;
            let closure = JetClosure::new(simulator, space, about, &start)?;
            let closures = vec![ClosedRows { samples: (0..space.len()).collect(), closure }];
            let of_level = |share: f64| JetRun::start(simulator, space, about, share * first_step);
            Box::new(Extrapolated::of(simulator, levels, closures, of_level)?)
        }
        Integration::Explicit | Integration::Segments | Integration::SchemeSegments { .. } => {
            Box::new(ExplicitJets::start(simulator, space, about)?)
        }
    })
}
