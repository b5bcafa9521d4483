//! The events of one sample that is followed alone, and the word that it spells.

use super::path::Path;
use super::path_step::Lost;
use super::segments::{Event, Segments, Word, divided};
use super::tuning::TUNING;

/// The events of one sample, and the ends of its steps between them.
#[derive(Clone, Debug, Default)]
pub(super) struct Followed {
    pub events: Vec<(Event, f64)>,
    pub steps: Vec<Vec<f64>>,
    /// Beginnings and ends of steps in which features of forces in space act, s, in the order of time.
    pub featured: Vec<[f64; 2]>,
    /// Time up to which it could be followed, s.
    pub known_to: f64,
}

impl Followed {
    /// Follows a sample up to a time, or as far as that can be done.
    pub fn to(mut path: Path, reach: f64) -> Self {
        let (mut followed, mut ends) = (Self::default(), Vec::new());
        while followed.known_to < reach && followed.events.len() < TUNING.most_events {
            let Ok(step) = path.step(reach) else { break };
            if path.meets_feature(step) {
                followed.featured.push([step.begin, step.end]);
            }
            path.go_on(step);
            ends.extend(divided(&[step.begin, step.end], step.parts));
            followed.known_to = step.end;
            if let Some(event) = step.event {
                followed.events.push((event, step.end));
                followed.steps.push(std::mem::take(&mut ends));
            }
        }
        followed.steps.push(ends);
        followed
    }

    /// Length of a segment of those up to a time, s.
    pub fn length(&self, segment: usize, end: f64) -> f64 {
        self.events.get(segment).map_or(end, |(_, time)| *time) - self.begin(segment)
    }

    /// Whether another motion meets the same events up to a time.
    pub fn agrees(&self, other: &Self, end: f64) -> bool {
        let at = |followed: &Self, index: usize| followed.events.get(index).copied();
        for index in 0.. {
            let is_over = |event: Option<(Event, f64)>| event.is_none_or(|(_, time)| time >= end);
            match (at(self, index), at(other, index)) {
                (own, others) if is_over(own) && is_over(others) => return true,
                (Some(own), Some(others)) if own.0 == others.0 => {}
                _ => return false,
            }
        }
        false
    }

    /// Number of events before a time.
    pub fn before(&self, end: f64) -> usize {
        self.events.iter().take_while(|(_, time)| *time < end).count()
    }

    /// When a segment begins, s.
    pub fn begin(&self, segment: usize) -> f64 {
        segment.checked_sub(1).map_or(0.0, |before| self.events[before].1)
    }

    /// Ends of the steps of a segment up to a time, as shares of it.
    pub fn shares(&self, segment: usize, end: f64) -> Vec<f64> {
        let (begin, own) = (self.begin(segment), &self.steps[segment]);
        let inner = own.iter().take_while(|&&time| time < end).map(|time| (time - begin) / (end - begin));
        inner.filter(|&share| share < 1.0).chain([1.0]).collect()
    }
}

/// Whether a sample can be followed beyond a time, s.
pub(super) fn reaches(mut path: Path, time: f64) -> bool {
    let mut reached = 0.0;
    while reached < time {
        let Ok(step) = path.step(f64::INFINITY) else { return false };
        path.go_on(step);
        reached = step.end;
    }
    true
}

/// Whether a sample meets an event before a time, s; `None` if it cannot be followed until that is known.
pub(super) fn meets_event(mut path: Path, time: f64) -> Option<bool> {
    loop {
        let step = path.step(time).ok()?;
        if step.event.is_some() || step.end >= time {
            return Some(step.end < time);
        }
        path.go_on(step);
    }
}

/// The word that a sample spells.
#[derive(Clone, Debug)]
pub(super) struct Spelled {
    /// Its index; none of a sample that meets other events.
    pub word: Option<usize>,
    /// Lengths of its segments, s.
    pub lengths: Vec<f64>,
    /// When a sample without a word first meets another event, or cannot be followed any more, s.
    pub deviates: f64,
}

impl Spelled {
    /// Follows a sample until it is known to spell one of the words.
    pub fn by(mut path: Path, segments: &Segments) -> Self {
        let mut open: Vec<usize> = (0..segments.words.len()).collect();
        let (mut lengths, mut begin, mut time) = (Vec::new(), 0.0, 0.0);
        loop {
            let met = lengths.len();
            let tail_of = |word: &Word| word.tail.filter(|_| word.events.len() == met);
            let tails = open.iter().filter_map(|&word| Some((word, tail_of(&segments.words[word])?)));
            let first = tails.min_by(|a, b| a.1.total_cmp(&b.1));
            let step = match path.step(first.map_or(f64::INFINITY, |(_, tail)| tail)) {
                Ok(step) => step,
                Err(Lost) => return Self { word: None, lengths: Vec::new(), deviates: time },
            };
            path.go_on(step);
            time = step.end;
            let done = match (step.event, first) {
                (Some(event), _) => {
                    open.retain(|&word| segments.words[word].events.get(met) == Some(&event));
                    if open.is_empty() {
                        return Self { word: None, lengths: Vec::new(), deviates: time };
                    }
                    let is_last = |word: &Word| word.tail.is_none() && word.events.len() == met + 1;
                    lengths.push(time - begin);
                    begin = time;
                    open.iter().copied().find(|&word| is_last(&segments.words[word]))
                }
                (None, Some((word, tail))) if time >= tail => {
                    lengths.push(time - begin);
                    Some(word)
                }
                _ => None,
            };
            if done.is_some() {
                return Self { word: done, lengths, deviates: f64::INFINITY };
            }
        }
    }
}
