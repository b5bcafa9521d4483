//! The events that samples meet, and the steps between them.

use serde::{Deserialize, Serialize};

use super::tuning::TUNING;
use crate::simulate::diagnostics::{place_of, written};
use crate::simulate::simulator::Simulator;

/// A switch that changes its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// Its number.
    pub switch: usize,
    /// Whether its value is positive afterwards.
    pub rises: bool,
}

impl Event {
    /// The term that switches, and the motion that it is part of.
    pub fn name(self, simulator: &Simulator) -> Option<String> {
        let switch = simulator.switches()?.switches.get(self.switch)?;
        let system = &simulator.system;
        Some(place_of(system, switch.of, &written(&system.graph, switch.of)))
    }
}

/// A motion cut into segments that end at events.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Word {
    /// The events, in the order in which each sample of the word meets them.
    pub events: Vec<Event>,
    /// Time at which a last segment without an event ends, s; none where the last event is after the rows.
    pub tail: Option<f64>,
    /// Ends of the steps of each segment, as shares of its length; the last is 1.
    pub steps: Vec<Vec<f64>>,
}

impl Word {
    /// Time at which a segment ends that has no event, if the rows end at `end`, s; later for those that have one.
    pub fn reach(&self, segment: usize, end: f64) -> f64 {
        if segment < self.events.len() { f64::INFINITY } else { self.tail.unwrap_or(end) }
    }
}

/// A surface in the box on which an event is just grazed: words on its one side have it, on its other side not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Boundary {
    /// Number of events before it, which all these words share.
    pub before: usize,
    /// The event.
    pub event: Event,
    /// Indices of the words that have it there.
    pub met: Vec<usize>,
    /// Indices of those that do not.
    pub missed: Vec<usize>,
    /// Number of samples that meet the event, and of those that do not.
    pub samples: [usize; 2],
    /// Value of each parameter, SI, at which it is grazed while the others are nominal, if that is in the box.
    pub grazed_at: Vec<Option<f64>>,
}

/// Why words end before the rows do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum WordsEnd {
    /// More words than the budget follow.
    MoreWords,
    /// A sample meets more events than are followed.
    MoreEvents,
}

/// Method for motions between events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SegmentMethod {
    /// The explicit method.
    #[default]
    Explicit,
    /// The same, where steps may also err by rounding: near rest the whole motion is of its size.
    ExplicitFromRest,
    /// The scheme, where forces are stiff or the model asks for it.
    Scheme {
        /// Levels of extrapolation; 1 is the scheme itself.
        levels: usize,
    },
}

impl SegmentMethod {
    /// Most steps that are tried, given those of the explicit method: of the scheme each is many.
    pub fn most_steps(self, of_explicit: usize) -> usize {
        match self {
            Self::Scheme { .. } => TUNING.most_steps_of_scheme,
            Self::Explicit | Self::ExplicitFromRest => of_explicit,
        }
    }
}

/// Accuracy and method by which a sample is followed from event to event.
#[derive(Clone, Copy, Debug)]
pub struct Following {
    /// Largest error of a step, as a share of how far the motion has gone.
    pub tolerance: f64,
    /// Method of integration.
    pub method: SegmentMethod,
    /// With the scheme: allowed error of its steps up to the end, as a share of how far the motion has gone.
    pub of_steps: Option<f64>,
}

/// The words of a box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segments {
    pub words: Vec<Word>,
    pub boundaries: Vec<Boundary>,
    /// Time up to which the words are followed, s: the end of the rows, or earlier where more words than a budget would
    /// follow.
    pub horizon: f64,
    /// Why they end before the rows do.
    pub end: Option<WordsEnd>,
    /// Accuracy of events: a motion that is followed alone errs by this share of how far it has gone, in each of its
    /// steps.
    pub tolerance: f64,
    /// Method of integration.
    #[serde(default)]
    pub method: SegmentMethod,
}

/// Steps that end at the events of all samples.
#[derive(Clone, Debug, PartialEq)]
pub enum EventSchedule {
    /// At times that are each sample's own.
    Segments(Segments),
    /// At times that are the same in all samples, those of functions of the time.
    Instants {
        /// Ends of the steps up to the end of the rows, s.
        ends: Vec<f64>,
        /// Indices of those that end at events.
        at_events: Vec<usize>,
    },
}

impl EventSchedule {
    /// Time up to which events are followed, s.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Segments(segments) => segments.horizon,
            Self::Instants { ends, .. } => ends.last().copied().unwrap_or(0.0),
        }
    }
}

impl Segments {
    /// Accuracy and method by which their samples are followed, whatever the steps that they share.
    pub fn following(&self) -> Following {
        Following { tolerance: self.tolerance, method: self.method, of_steps: None }
    }

    /// Number of steps of the word that has most.
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.steps.iter().map(Vec::len).sum()).max().unwrap_or(0)
    }

    /// The same with `others(n)` steps instead of the n steps of each segment.
    #[must_use]
    pub fn with_steps(&self, others: impl Fn(usize) -> usize) -> Self {
        let of_segment = |ends: &Vec<f64>| shares_divided(ends, others(ends.len()));
        let of_word = |word: &Word| Word { steps: word.steps.iter().map(of_segment).collect(), ..word.clone() };
        Self { words: self.words.iter().map(of_word).collect(), ..self.clone() }
    }
}

/// Ends of `others` steps of a segment, instead of those that end at these shares of it.
pub(super) fn shares_divided(ends: &[f64], others: usize) -> Vec<f64> {
    let times: Vec<f64> = std::iter::once(0.0).chain(ends.iter().copied()).collect();
    divided(&times, others).collect()
}

/// Ends of `others` steps, instead of those that end at these times after the first, as dense as they are.
pub fn divided(times: &[f64], others: usize) -> impl Iterator<Item = f64> {
    let count = times.len() - 1;
    (1..=others).map(move |other| {
        let (whole, part) = (other * count / others, other * count % others);
        match part {
            0 => times[whole],
            _ => times[whole] + (times[whole + 1] - times[whole]) * part as f64 / others as f64,
        }
    })
}
