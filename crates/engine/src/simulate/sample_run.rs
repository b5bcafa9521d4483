//! The run of an ensemble of samples, however the schedule's steps are taken.

use super::control::{Controller, Integration, Schedule};
use super::diagnostics::{OpenConstraint, SingularPass, TooDeep};
use super::ensemble::{Channel, EnsembleRun, ExtrapolatedRun, Observed, Stop};
use super::error::SimulationError;
use super::events::SegmentRun;
use super::explicit::ExplicitRun;
use super::interruption::Interruption;
use super::simulator::Simulator;
use super::step::Counters;
use crate::numerics::Sample;

/// A run by one of the ways to integrate.
#[derive(Debug)]
pub enum SampleRun<'s> {
    /// By the scheme itself.
    Plain(EnsembleRun<'s>),
    /// By the scheme on several levels.
    Extrapolated(ExtrapolatedRun<'s>),
    /// By the explicit method.
    Explicit(ExplicitRun<'s>),
    /// By the explicit method between events.
    Segments(SegmentRun<'s>),
}

impl<'s> SampleRun<'s> {
    /// Assembles samples for a schedule.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        samples: &[Sample],
        schedule: &'s Schedule,
    ) -> Result<Self, SimulationError> {
        if let Some(segments) = schedule.segments() {
            return Ok(Self::Segments(SegmentRun::start(simulator, samples, segments, schedule.end())?));
        }
        let first_step = schedule.first_step();
        Ok(match schedule.integration {
            Integration::Plain => Self::Plain(EnsembleRun::start(simulator, samples, first_step)?),
            Integration::Extrapolated { levels } => {
                Self::Extrapolated(ExtrapolatedRun::start(simulator, samples, first_step, levels)?)
            }
            Integration::Explicit | Integration::Segments => Self::Explicit(ExplicitRun::start(simulator, samples)?),
        })
    }

    /// Also searches for singular configurations that the first sample passes.
    #[must_use]
    pub fn watching(self) -> Self {
        match self {
            Self::Plain(run) => Self::Plain(run.watching()),
            Self::Extrapolated(run) => Self::Extrapolated(run.watching()),
            Self::Explicit(run) => Self::Explicit(run.watching()),
            Self::Segments(_) => self,
        }
    }

    /// Also reduces outputs to one number each.
    #[must_use]
    pub fn reducing(self, channels: &'s [Channel]) -> Self {
        match self {
            Self::Plain(run) => Self::Plain(run.reducing(channels)),
            Self::Extrapolated(run) => Self::Extrapolated(run.reducing(channels)),
            Self::Explicit(run) => Self::Explicit(run.reducing(channels)),
            Self::Segments(run) => Self::Segments(run.reducing(channels)),
        }
    }

    /// Ends where it is asked to.
    #[must_use]
    pub fn heeding(self, interruption: Interruption<'s>) -> Self {
        match self {
            Self::Plain(run) => Self::Plain(run.heeding(interruption)),
            Self::Extrapolated(run) => Self::Extrapolated(run.heeding(interruption)),
            Self::Explicit(run) => Self::Explicit(run.heeding(interruption)),
            Self::Segments(run) => Self::Segments(run.heeding(interruption)),
        }
    }

    /// As [`EnsembleRun::is_cut`].
    pub fn is_cut(&self) -> bool {
        match self {
            Self::Plain(run) => run.is_cut(),
            Self::Extrapolated(run) => run.is_cut(),
            Self::Explicit(run) => run.is_cut(),
            Self::Segments(run) => run.is_cut(),
        }
    }

    /// After the last row: what outputs are reduced to, channel by channel, sample by sample; NaN of samples that
    /// stopped.
    pub fn reduced(&mut self) -> Vec<f64> {
        match self {
            Self::Plain(run) => run.reduced(),
            Self::Extrapolated(run) => run.reduced(),
            Self::Explicit(run) => run.reduced(),
            Self::Segments(run) => run.reduced(),
        }
    }

    /// As [`EnsembleRun::advance`].
    pub fn advance(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        tolerance: Option<Controller>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        match self {
            Self::Plain(run) => run.advance(schedule, rows, tolerance, observed, into),
            Self::Extrapolated(run) => run.advance(schedule, rows, tolerance, observed, into),
            Self::Explicit(run) => run.advance(schedule, rows, observed, into),
            Self::Segments(run) => run.advance(schedule, rows, observed, into),
        }
    }

    /// The runs of the scheme behind it, that with the schedule's steps first.
    fn levels(&self) -> &[EnsembleRun<'s>] {
        match self {
            Self::Plain(run) => std::slice::from_ref(run),
            Self::Extrapolated(run) => run.levels(),
            Self::Explicit(_) | Self::Segments(_) => &[],
        }
    }

    /// Newton iterations and rank-revealing solves so far.
    pub fn counters(&self) -> Counters {
        self.levels().iter().map(EnsembleRun::counters).fold(Counters::default(), |total, counters| Counters {
            iterations: total.iterations + counters.iterations,
            rank_revealing: total.rank_revealing + counters.rank_revealing,
        })
    }

    /// Singular configurations that the first sample has passed, if they are searched for.
    pub fn singular_passes(&self) -> Vec<SingularPass> {
        self.levels().first().map(EnsembleRun::singular_passes).unwrap_or_default()
    }

    /// See [`EnsembleRun::parted`].
    pub fn parted(&self) -> Option<SimulationError> {
        match self {
            Self::Explicit(run) => run.parted(),
            _ => self.levels().first().and_then(EnsembleRun::parted),
        }
    }

    /// See [`EnsembleRun::open_constraint`].
    pub fn open_constraint(&self, stop: &Stop, schedule: &Schedule) -> Option<OpenConstraint> {
        self.levels().iter().find_map(|run| run.open_constraint(stop, schedule))
    }

    /// See [`EnsembleRun::too_deep`].
    pub fn too_deep(&self) -> Option<TooDeep> {
        self.levels().first().and_then(EnsembleRun::too_deep)
    }

    /// See [`EnsembleRun::beyond_tolerance_from`]; also the first row behind an event that others do not meet.
    pub fn beyond_tolerance_from(&self) -> Option<usize> {
        if let Self::Segments(run) = self {
            return run.deviates_from();
        }
        self.levels().iter().filter_map(EnsembleRun::beyond_tolerance_from).min()
    }

    /// See [`EnsembleRun::largest_error_ratio`].
    pub fn largest_error_ratio(&self) -> Option<(usize, f64)> {
        let ratios = self.levels().iter().filter_map(EnsembleRun::largest_error_ratio);
        ratios.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}
