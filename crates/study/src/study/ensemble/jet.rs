//! The run of one jet under a schedule.

use std::ops::Range as Rows;

use symdiff::jet::JetSpace;

use super::effort;
use crate::methods::Effort;
use crate::simulate::{
    ExplicitJets, ExtrapolatedJets, Integration, JetRun, Schedule, SimulationError, Simulator, Stop,
};

/// The run of one jet, however the schedule's steps are taken.
pub(super) enum SampleJet<'s> {
    Plain(Box<JetRun<'s>>),
    Extrapolated(Box<ExtrapolatedJets<'s>>),
    Explicit(Box<ExplicitJets<'s>>),
}

impl<'s> SampleJet<'s> {
    pub fn start(
        simulator: &'s Simulator,
        space: &'s JetSpace,
        (center, half_widths): (&[f64], &[f64]),
        schedule: &Schedule,
        controlled: bool,
    ) -> Result<Self, SimulationError> {
        let first_step = schedule.first_step();
        Ok(match schedule.integration {
            Integration::Plain => {
                let jet = JetRun::start(simulator, space, center, half_widths, first_step)?;
                Self::Plain(Box::new(if controlled { jet.controlled() } else { jet }))
            }
            Integration::Extrapolated { levels } => {
                let jets = ExtrapolatedJets::start(simulator, space, (center, half_widths), first_step, levels)?;
                Self::Extrapolated(Box::new(jets))
            }
            Integration::Explicit | Integration::Segments => {
                Self::Explicit(Box::new(ExplicitJets::start(simulator, space, (center, half_widths))?))
            }
        })
    }

    pub fn advance(&mut self, schedule: &Schedule, rows: Rows<usize>, into: &mut Vec<f64>) -> Option<Stop> {
        match self {
            Self::Plain(jet) => jet.advance(schedule, rows, into),
            Self::Extrapolated(jets) => jets.advance(schedule, rows, into),
            Self::Explicit(jets) => jets.advance(schedule, rows, into),
        }
    }

    pub fn effort(&self) -> Effort {
        match self {
            Self::Plain(jet) => effort(jet.counters()),
            Self::Extrapolated(jets) => {
                let mut total = Effort::default();
                jets.levels().iter().for_each(|jet| total += effort(jet.counters()));
                total
            }
            Self::Explicit(_) => Effort::default(),
        }
    }
}
