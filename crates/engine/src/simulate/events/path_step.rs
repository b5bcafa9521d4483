//! A step of a sample that is followed alone.

use super::segments::Event;

/// A motion that cannot be followed: it is stiff, not finite, or grazes a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lost;

/// A step that was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStep {
    /// Its beginning and its end, s.
    pub begin: f64,
    pub end: f64,
    /// The event at its end.
    pub event: Option<Event>,
    /// Equal parts into which others, who take it too, have to divide it.
    pub parts: usize,
}
