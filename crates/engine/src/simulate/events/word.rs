//! Whether some samples meet the same events in the same order, and the steps that they share between them.

use rayon::prelude::*;

use super::path::{Lost, Path};
use super::segments::{Event, Segments};
use crate::numerics::Sample;
use crate::simulate::error::SimulationError;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// Motions are followed so many times as long as they are asked for, so that an event beside the end is met by all.
const REACH: f64 = 1.25;

/// An event so close to the end, as a share of the duration, may be before it for other samples.
const BESIDE: f64 = 0.02;

/// Instants that differ by no more than this share of the duration are the same.
const SAME: f64 = 1e-9;

/// Most events of a motion.
const MOST_EVENTS: usize = 64;

/// The events of one sample, and the ends of its steps between them.
#[derive(Clone, Debug, Default)]
struct Followed {
    events: Vec<(Event, f64)>,
    steps: Vec<Vec<f64>>,
}

impl Followed {
    /// Follows a sample up to a time.
    fn to(mut path: Path, reach: f64) -> Result<Self, Lost> {
        let (mut followed, mut ends, mut time) = (Self::default(), Vec::new(), 0.0);
        while time < reach {
            let step = path.step(reach)?;
            path.go_on(step);
            ends.push(step.end);
            time = step.end;
            if let Some(event) = step.event {
                followed.events.push((event, time));
                followed.steps.push(std::mem::take(&mut ends));
                if followed.events.len() > MOST_EVENTS {
                    return Err(Lost);
                }
            }
        }
        followed.steps.push(ends);
        Ok(followed)
    }

    /// Whether another motion meets the same events up to a time, as far as both meet any.
    fn agrees(&self, other: &Self, end: f64) -> bool {
        let both = self.events.iter().zip(&other.events);
        both.take_while(|(own, other)| own.1.min(other.1) < end).all(|(own, other)| own.0 == other.0)
    }

    /// When a segment begins, s.
    fn begin(&self, segment: usize) -> f64 {
        segment.checked_sub(1).map_or(0.0, |before| self.events[before].1)
    }

    /// Ends of the steps of a segment up to a time, as shares of it.
    fn shares(&self, segment: usize, end: f64) -> Vec<f64> {
        let (begin, own) = (self.begin(segment), &self.steps[segment]);
        let inner = own.iter().take_while(|&&time| time < end).map(|time| (time - begin) / (end - begin));
        inner.filter(|&share| share < 1.0).chain([1.0]).collect()
    }
}

/// The events that all samples meet up to a time, at least one of them not at the same instant, and steps between
/// them; `None` where samples meet different ones, or the explicit method cannot follow them.
///
/// # Errors
/// Where the first sample cannot be assembled.
pub fn segments_of(
    simulator: &Simulator,
    samples: &[Sample],
    duration: f64,
    tolerance: f64,
) -> Result<Option<Segments>, SimulationError> {
    let Some(program) = simulator.switches().filter(|_| can_be_cut(simulator)) else { return Ok(None) };
    let follow = |sample: &Sample| -> Result<Result<Followed, Lost>, SimulationError> {
        let path = Path::start(simulator, program, sample, (duration, tolerance))?;
        Ok(Followed::to(path, REACH * duration))
    };
    // The first decides whether there is anything to cut.
    let Some((first, others)) = samples.split_first() else { return Ok(None) };
    let Ok(first) = follow(first)? else { return Ok(None) };
    if first.events.first().is_none_or(|(_, time)| *time >= duration) {
        return Ok(None);
    }
    // The first sample of another word ends the search, and one that cannot be assembled does.
    let of_other = |sample: &Sample| follow(sample).ok()?.ok().filter(|other| first.agrees(other, duration));
    let Some(others) = others.par_iter().map(of_other).collect::<Option<Vec<Followed>>>() else { return Ok(None) };
    let all: Vec<Followed> = std::iter::once(first).chain(others).collect();
    Ok(shared(&all, duration).map(|(events, tail, steps)| Segments { events, tail, steps, tolerance }))
}

/// Whether motions may be cut at all: what else steps have to resolve is left to the schedules that do.
fn can_be_cut(simulator: &Simulator) -> bool {
    Instants::of(simulator).is_empty()
        && simulator.features().is_none()
        && simulator.overlaps().is_none()
        && !simulator.system.analysis.visits()
}

/// The events, the end of a last segment without one, and the steps of each segment.
type Shared = (Vec<Event>, Option<f64>, Vec<Vec<f64>>);

/// What some motions share up to a time.
fn shared(all: &[Followed], duration: f64) -> Option<Shared> {
    let before = |followed: &Followed, end: f64| followed.events.iter().take_while(|(_, time)| *time < end).count();
    let [least, most] = [1.0 - BESIDE, 1.0 + BESIDE].map(|share| {
        let counts = all.iter().map(|followed| before(followed, share * duration));
        if share < 1.0 { counts.min() } else { counts.max() }
    });
    let (least, most) = (least?, most?);
    // Where an event is beside the end for some, all go on to the next that all have.
    let (count, tail) = match () {
        () if least == most => (most, Some(duration)),
        () if all.iter().all(|followed| followed.events.len() > most) => (most + 1, None),
        () if all.iter().all(|followed| followed.events.len() == most) => (most, Some(REACH * duration)),
        () => return None,
    };
    // Instants that are the same in all samples are kinks in time, none in the parameters.
    let differs = |event: usize| {
        let times = || all.iter().map(|followed| followed.events[event].1);
        times().fold(f64::NEG_INFINITY, f64::max) - times().fold(f64::INFINITY, f64::min) > SAME * duration
    };
    if all.len() > 1 && !(0..count).any(differs) {
        return None;
    }
    let word = |followed: &Followed| followed.events.iter().map(|(event, _)| *event).take(count).collect();
    let events: Vec<Event> = word(&all[0]);
    if all.iter().any(|followed| word(followed) != events) {
        return None;
    }
    let steps = |segment: usize| {
        let of = |followed: &Followed| {
            followed
                .shares(segment, followed.events[..count].get(segment).map_or(tail.unwrap_or(duration), |own| own.1))
        };
        // Those of the sample that takes most.
        all.iter().map(of).reduce(|a, b| if b.len() > a.len() { b } else { a })
    };
    let segments = count + usize::from(tail.is_some());
    Some((events, tail, (0..segments).filter_map(steps).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Events at these times, with two equal steps in each segment.
    fn followed(times: &[f64]) -> Followed {
        let event = |place: usize| Event { switch: 0, rises: place.is_multiple_of(2) };
        let events = times.iter().enumerate().map(|(place, &time)| (event(place), time)).collect();
        let begins = std::iter::once(0.0).chain(times.iter().copied());
        let ends = times.iter().copied().chain([REACH]);
        let steps = begins.zip(ends).map(|(begin, end)| vec![0.5 * (begin + end), end]).collect();
        Followed { events, steps }
    }

    #[test]
    fn what_all_meet_before_the_end_is_shared() {
        let (events, tail, steps) = shared(&[followed(&[0.4, 0.6]), followed(&[0.5, 0.7, 1.2])], 1.0).unwrap();
        assert_eq!((events.len(), tail), (2, Some(1.0)));
        assert_eq!(steps[..2], [vec![0.5, 1.0], vec![0.5, 1.0]]);
        assert_eq!(steps[2].last(), Some(&1.0));
    }

    #[test]
    fn beside_the_end_all_go_on() {
        let both = [followed(&[0.4, 0.99, 1.1]), followed(&[0.5, 1.01, 1.2])];
        let (events, tail, steps) = shared(&both, 1.0).unwrap();
        assert_eq!((events.len(), tail, steps.len()), (3, None, 3));
        let (events, tail, _) = shared(&[followed(&[0.4, 0.99]), followed(&[0.5, 1.01])], 1.0).unwrap();
        assert_eq!((events.len(), tail), (2, Some(REACH)));
        assert!(shared(&[followed(&[0.4, 0.99]), followed(&[0.5, 1.01, 1.2])], 1.0).is_none());
    }

    #[test]
    fn other_words_and_the_same_instants_are_not_cut() {
        assert!(shared(&[followed(&[0.4, 0.6]), followed(&[0.5])], 1.0).is_none());
        assert!(shared(&[followed(&[0.4]), followed(&[0.4])], 1.0).is_none());
        let mut other = followed(&[0.5]);
        other.events[0].0.switch = 1;
        assert!(shared(&[followed(&[0.4]), other], 1.0).is_none());
    }
}
