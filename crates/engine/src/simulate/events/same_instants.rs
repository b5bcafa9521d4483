//! Events at instants that are the same in all samples, those of functions of the time: they are kinks in the time, and
//! none in the parameters, so that all samples share steps that end there.

use super::followed::Followed;
use super::segments::{EventSchedule, Word};
use super::tuning::TUNING;

/// Instants of the events of several motions up to a time, s, if they are the same in all of them.
pub(super) fn same_instants(all: &[Followed], end: f64) -> Option<Vec<f64>> {
    let (first, others) = all.split_first().filter(|(_, others)| !others.is_empty())?;
    let instants: Vec<f64> = first.events[..first.before(end)].iter().map(|(_, time)| *time).collect();
    let are_same = |other: &Followed| {
        let times = other.events[..other.before(end)].iter().map(|(_, time)| *time);
        let differs = |(own, time): (&f64, f64)| (own - time).abs() > TUNING.same_instant * end;
        other.before(end) == instants.len() && !instants.iter().zip(times).any(differs)
    };
    others.iter().all(are_same).then_some(instants)
}

/// The steps of a word with events at these instants, s, up to the end of the rows, s.
pub(super) fn at_instants(word: &Word, instants: &[f64], end: f64) -> EventSchedule {
    let begins = std::iter::once(0.0).chain(instants.iter().copied());
    let (mut ends, mut at_events) = (Vec::new(), Vec::new());
    for (segment, (begin, shares)) in begins.zip(&word.steps).enumerate() {
        // The last segment ends behind the rows if an event is near their end.
        let instant = instants.get(segment).copied();
        let reach = instant.or(word.tail).unwrap_or(end);
        ends.extend(
            shares.iter().map(|share| begin + share * (reach - begin)).take_while(|&time| time < reach.min(end)),
        );
        ends.push(reach.min(end));
        at_events.extend(instant.map(|_| ends.len() - 1));
    }
    EventSchedule::Instants { ends, at_events }
}

#[cfg(test)]
mod tests {
    use super::super::segments::Event;
    use super::*;

    /// Events at these times.
    fn followed(times: &[f64]) -> Followed {
        let events = times.iter().map(|&time| (Event { switch: 0, rises: true }, time)).collect();
        Followed { events, known_to: TUNING.followed_share, ..Followed::default() }
    }

    #[test]
    fn instants_are_the_same_in_all_samples_or_in_none() {
        assert_eq!(same_instants(&[followed(&[0.4, 0.6]), followed(&[0.4, 0.6])], 1.0), Some(vec![0.4, 0.6]));
        assert_eq!(same_instants(&[followed(&[0.4, 0.6]), followed(&[0.4, 0.61])], 1.0), None);
        assert_eq!(same_instants(&[followed(&[0.4])], 1.0), None, "a single motion");
        // Events after the rows may differ.
        assert_eq!(same_instants(&[followed(&[0.4, 1.1]), followed(&[0.4, 1.2])], 1.0), Some(vec![0.4]));
    }

    #[test]
    fn steps_end_at_instants_and_with_the_rows() {
        let event = Event { switch: 0, rises: true };
        let halves = vec![0.5, 1.0];
        let word = Word { events: vec![event], tail: Some(1.25), steps: vec![halves.clone(), halves.clone()] };
        let found = at_instants(&word, &[0.4], 1.0);
        assert_eq!(found, EventSchedule::Instants { ends: vec![0.2, 0.4, 0.825, 1.0], at_events: vec![1] });
        assert_eq!(found.horizon(), 1.0);
        let word = Word { events: vec![event], tail: Some(1.0), steps: vec![halves.clone(), halves] };
        let found = at_instants(&word, &[0.4], 1.0);
        assert_eq!(found, EventSchedule::Instants { ends: vec![0.2, 0.4, 0.7, 1.0], at_events: vec![1] });
    }
}
