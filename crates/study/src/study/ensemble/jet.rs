//! The run of one jet under a schedule, about the middle of the box.

use std::ops::Range as Rows;
use std::sync::atomic::Ordering;

use symdiff::jet::JetSpace;

use super::visits::visit_jets;
use super::{Motions, effort, stopped_at};
use crate::methods::{Effort, JET_WORK, Simulated};
use crate::simulate::{
    ExplicitJets, ExtrapolatedJets, Integration, Interruption, JetBox, JetRun, Schedule, SimulationError, Simulator,
    Stop,
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
        about: JetBox<'_>,
        schedule: &Schedule,
        controlled: bool,
    ) -> Result<Self, SimulationError> {
        let first_step = schedule.first_step();
        Ok(match schedule.integration {
            Integration::Plain => {
                let jet = JetRun::start(simulator, space, about, first_step)?;
                Self::Plain(Box::new(if controlled { jet.controlled() } else { jet }))
            }
            Integration::Extrapolated { levels } => {
                let jets = ExtrapolatedJets::start(simulator, space, about, first_step, levels)?;
                Self::Extrapolated(Box::new(jets))
            }
            Integration::Explicit | Integration::Segments => {
                Self::Explicit(Box::new(ExplicitJets::start(simulator, space, about)?))
            }
        })
    }

    /// Ends where it is asked to.
    pub fn heeding(self, interruption: Interruption<'s>) -> Self {
        match self {
            Self::Plain(jet) => Self::Plain(Box::new(jet.heeding(interruption))),
            Self::Extrapolated(jets) => Self::Extrapolated(Box::new(jets.heeding(interruption))),
            Self::Explicit(jets) => Self::Explicit(Box::new(jets.heeding(interruption))),
        }
    }

    /// Whether it ended at an interruption: the rows of the last call are not known.
    pub fn is_cut(&self) -> bool {
        match self {
            Self::Plain(jet) => jet.is_cut(),
            Self::Extrapolated(jets) => jets.is_cut(),
            Self::Explicit(jets) => jets.is_cut(),
        }
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

/// Rows of a block.
const BLOCK: usize = 64;

/// As [`Ensemble::jets`](crate::methods::Ensemble::jets).
///
/// # Errors
/// Where the middle of the box cannot be assembled.
pub fn jet_about_middle(
    motions: &Motions,
    space: &JetSpace,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    let parameters = 0..motions.domain.dimension();
    let center: Vec<f64> = parameters.clone().map(|parameter| motions.domain.midpoint(parameter)).collect();
    let half_widths: Vec<f64> = parameters.map(|parameter| motions.domain.half_width(parameter)).collect();
    if motions.simulator.system.analysis.visits() {
        return visit_jets(motions, space, &center.into(), &half_widths, reduce);
    }
    let about = JetBox { center: &center, half_width: &half_widths };
    let jet = SampleJet::start(motions.simulator, space, about, motions.schedule, motions.tolerance.is_some())?;
    let mut jet = jet.heeding(motions.interruption);
    let (mut values, mut stop, mut next) = (Vec::new(), None, 0);
    while next < motions.schedule.rows && stop.is_none() {
        let rows = next..(next + BLOCK).min(motions.schedule.rows);
        stop = jet.advance(motions.schedule, rows.clone(), &mut values);
        if jet.is_cut() {
            break;
        }
        reduce(rows.clone(), &values);
        motions.progress.advance(JET_WORK * (space.monomials().order() + 1) * rows.len());
        next = rows.end;
    }
    if next == motions.schedule.rows || stop.is_some() {
        motions.over.fetch_add(1, Ordering::Relaxed);
    }
    let missing = motions.schedule.rows - stop.map_or(next, |stop| stop.row);
    let stop = stop.map(|stop| (stopped_at(&stop), center.into()));
    Ok(Simulated { effort: jet.effort(), stop, missing, ..Simulated::default() })
}
