//! The events that all samples have, and the steps between them.

use serde::{Deserialize, Serialize};

/// A switch that changes its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// Its number.
    pub switch: usize,
    /// Whether its value is positive afterwards.
    pub rises: bool,
}

/// A motion cut into segments that end at events.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segments {
    /// The events, in the order in which each sample meets them.
    pub events: Vec<Event>,
    /// Time at which a last segment without an event ends, s; none where the last event is after the rows.
    pub tail: Option<f64>,
    /// Ends of the steps of each segment, as shares of its length; the last is 1.
    pub steps: Vec<Vec<f64>>,
    /// How closely events are located: a motion that is followed alone errs by this share of how far it has gone, in
    /// each of its steps.
    pub tolerance: f64,
}

impl Segments {
    /// Number of steps.
    pub fn count(&self) -> usize {
        self.steps.iter().map(Vec::len).sum()
    }

    /// The same with so many steps instead of those of each segment.
    #[must_use]
    pub fn with_steps(&self, others: impl Fn(usize) -> usize) -> Self {
        let of_segment = |ends: &Vec<f64>| {
            let times: Vec<f64> = std::iter::once(0.0).chain(ends.iter().copied()).collect();
            divided(&times, others(ends.len())).collect()
        };
        Self { steps: self.steps.iter().map(of_segment).collect(), ..self.clone() }
    }
}

/// So many steps instead of those that end at these times after the first, as dense as they are.
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
