//! Codes of the reasons why a mechanism cannot be simulated.

use super::error::SimulationError;
use crate::syntax::{Code, Coded};

impl Coded for SimulationError {
    fn code(&self) -> Option<Code> {
        Some(match self {
            Self::Assembly { .. } => Code::CannotAssemble,
            Self::OffBranch { .. } => Code::Infeasible,
            Self::NotExplicit { .. } => Code::NotExplicit,
            Self::BlackBox { .. } | Self::NoAnswer { .. } => Code::ProgramFails,
            Self::Contradiction { .. } | Self::Parted { .. } => Code::Contradiction,
            Self::StartsOutside { .. } => Code::StartsOutside,
            Self::Singular { .. } => Code::Massless,
            Self::NoEquilibrium { .. } => Code::NoEquilibrium,
            Self::NotDriven { .. } => Code::NotDriven,
            Self::NoResult { .. } => Code::UnknownName,
            Self::NotFinite { .. } => Code::NotFinite,
            Self::Store { .. } => Code::CannotWrite,
            Self::TooLong => Code::TooLarge,
            Self::NotConverged { .. } => Code::NotConverged,
            Self::SingularJet { .. } => Code::NoDerivatives,
            Self::Locked { .. } => Code::Locked,
            Self::StepTooSmall { .. } | Self::TooManySteps { .. } => Code::StepsTooSmall,
            Self::TooFast { .. } => Code::TooFast,
            Self::Interrupted | Self::Deferred => return None,
        })
    }
}
