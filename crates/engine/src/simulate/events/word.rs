//! The words that samples spell: those that meet the same events in the same order share the steps between them.

use rayon::prelude::*;

use super::boundary::{boundaries, grazed_at, margins};
use super::followed::{Followed, meets_event, reaches};
use super::path::Path;
use super::resolved::resolved_word;
use super::same_instants::{at_instants, same_instants};
use super::segments::{
    Boundary, Event, EventSchedule, Following, SegmentMethod, Segments, Word, WordsEnd, shares_divided,
};
use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::numerics::{ParameterBox, STEP_NODES, Sample};
use crate::simulate::error::SimulationError;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// Steps up to a time that end at the events of samples; `None` where there are none, or they cannot be followed for a
/// share of the time that is worthwhile. Where the explicit method cannot follow the first, whose forces may be stiff,
/// the scheme does, if instants differ. Steps of the scheme that is asked for are no longer than `longest`, s.
///
/// # Errors
/// Where the first sample cannot be assembled.
pub fn cut_at_events(
    simulator: &Simulator,
    domain: &ParameterBox,
    samples: &[Sample],
    duration: f64,
    following: Following,
    longest: Option<f64>,
) -> Result<Option<EventSchedule>, SimulationError> {
    let Some(program) = simulator.switches().filter(|_| can_be_cut(simulator)) else { return Ok(None) };
    let following = match following.method {
        // Rounding of velocities in the scheme is that of positions over a short step.
        SegmentMethod::Scheme { .. } => {
            Following { tolerance: following.tolerance.max(TUNING.error_of_scheme), ..following }
        }
        _ => following,
    };
    let path = |sample: &Sample| Path::start(simulator, program, sample, duration, following);
    let is_whole = is_cut_as_a_whole(simulator);
    // Where words end, each sample goes on alone. A single motion has no bounds to gain.
    let may_end = !is_whole && samples.len() > 1;
    let kept = |sample: &Sample, followed: Followed| {
        let goes_on = || {
            let has_many = may_end && followed.events.len() >= TUNING.most_events;
            has_many && path(sample).is_ok_and(|path| reaches(path.behind_words(), duration))
        };
        (followed.known_to >= duration || goes_on()).then_some(followed)
    };
    let follow = |sample: &Sample| kept(sample, Followed::to(path(sample).ok()?, TUNING.followed_share * duration));
    let Some((first, others)) = samples.split_first() else { return Ok(None) };
    let by_first = Followed::to(path(first)?, TUNING.followed_share * duration);
    let has_failed = following.method == SegmentMethod::Explicit && by_first.events.len() < TUNING.most_events;
    let Some(first) = kept(first, by_first) else {
        let otherwise = has_failed.then(|| methods_for_failed(simulator, program, samples, duration, following));
        for following in otherwise.into_iter().flatten() {
            if let Some(found) = cut_at_events(simulator, domain, samples, duration, following, None)? {
                return Ok(Some(found));
            }
        }
        return Ok(None);
    };
    // The first few, at the ends of the box, decide whether there is anything to cut.
    let mut all = vec![first];
    for others in
        [&others[..TUNING.deciding_samples.min(others.len())], &others[TUNING.deciding_samples.min(others.len())..]]
    {
        let Some(followed) = others.par_iter().map(follow).collect::<Option<Vec<Followed>>>() else { return Ok(None) };
        all.extend(followed);
        if all.iter().all(|followed| followed.before(duration) == 0) {
            return Ok(None);
        }
    }
    let Some((horizon, end, found)) = within_budget(&all, duration) else { return Ok(None) };
    let has_few = || found.iter().all(|(word, _)| word.events.len() <= TUNING.most_turning_events);
    let has_parts = domain.dimension() <= TUNING.most_of_parts && (!is_whole || has_few());
    if found.len() > 1 && !has_parts || end.is_some() && is_whole {
        return Ok(None);
    }
    let (words, groups): (Vec<Word>, Vec<Vec<usize>>) = found.into_iter().unzip();
    let samples_of =
        |words: &[usize]| words.iter().flat_map(|&word| groups[word].iter().copied()).collect::<Vec<usize>>();
    let margins = |boundary: &Boundary| {
        let [met, missed] = [&boundary.met, &boundary.missed].map(|words| samples_of(words));
        let both = met.into_iter().map(|sample| (sample, true)).chain(missed.into_iter().map(|sample| (sample, false)));
        margins(boundary, &both.collect::<Vec<_>>(), |sample| path(&samples[sample]).ok(), horizon)
    };
    let Some(found) = boundaries(&words, margins) else { return Ok(None) };
    let described = |(boundary, margins): (Boundary, Vec<f64>)| {
        let [met, missed] = [&boundary.met, &boundary.missed].map(|words| samples_of(words));
        let xi: Vec<Vec<f64>> = met.iter().chain(&missed).map(|&sample| domain.xi(&samples[sample])).collect();
        let found = grazed_at(&xi, &domain.xi(&domain.nominal), &margins);
        let value = |(axis, xi): (usize, Option<f64>)| xi.map(|xi| domain.value(axis, xi));
        let grazed_at = found.into_iter().enumerate().map(value).collect();
        Boundary { grazed_at, samples: [met.len(), missed.len()], ..boundary }
    };
    let boundaries = found.into_iter().map(described).collect();
    let longest = longest.filter(|_| matches!(following.method, SegmentMethod::Scheme { .. }));
    let functions = simulator.time_functions(duration);
    let words = words.into_iter().zip(&groups).map(|(word, group)| {
        let members = members(&all, group);
        let word = match longest {
            Some(longest) => divided_word(word, &members, longest, horizon),
            None => word,
        };
        let samples: Vec<&Sample> = group.iter().map(|&sample| &samples[sample]).collect();
        resolved_word(word, &members, &samples, horizon, functions.as_ref())
    });
    let Some(words) = words.collect::<Option<Vec<Word>>>() else { return Ok(None) };
    let instants = if end.is_none() { same_instants(&all, duration) } else { None };
    if let ([word], Some(instants)) = (&words[..], instants) {
        let is_explicit = following.method == SegmentMethod::Explicit;
        return Ok(is_explicit.then(|| at_instants(word, &instants, duration)));
    }
    let Following { tolerance, method, .. } = following;
    Ok(Some(EventSchedule::Segments(Segments { words, boundaries, horizon, end, tolerance, method })))
}

/// Ways to follow motions that the explicit method cannot follow: it errs by rounding near rest, and the scheme takes
/// long steps where forces are stiff. Empty if some samples, followed roughly, meet no event, or if constraints drive a
/// mechanism, at the same instants for all.
fn methods_for_failed(
    simulator: &Simulator,
    program: &SwitchProgram,
    samples: &[Sample],
    duration: f64,
    following: Following,
) -> Vec<Following> {
    let method = SegmentMethod::Scheme { levels: TUNING.levels_of_stiff };
    let meets_by = |sample: &Sample, method: SegmentMethod| {
        let roughly = Following { tolerance: TUNING.rough_error, method, of_steps: None };
        meets_event(Path::start(simulator, program, sample, duration, roughly).ok()?, duration)
    };
    // The explicit method takes a tenth of the scheme's time to find no event, but cannot where forces are stiff.
    let meets = |sample: &Sample| {
        meets_by(sample, SegmentMethod::ExplicitFromRest) != Some(false) && meets_by(sample, method) == Some(true)
    };
    let is_driven = simulator.mobility.degrees_of_freedom == 0;
    if is_driven || !samples[..samples.len().min(1 + TUNING.deciding_samples)].par_iter().any(meets) {
        return Vec::new();
    }
    let from_rest = Following { method: SegmentMethod::ExplicitFromRest, ..following };
    vec![from_rest, Following { method, ..following }]
}

/// A word of some motions up to a time, of which no step of the scheme is longer than `longest`, s.
fn divided_word(word: Word, all: &[&Followed], longest: f64, end: f64) -> Word {
    let of_segment = |(segment, ends): (usize, &Vec<f64>)| {
        let reach = word.reach(segment, end);
        let length = all.iter().map(|own| own.length(segment, reach)).filter(|own| own.is_finite()).fold(0.0, f64::max);
        let least = (length / ((STEP_NODES - 1) as f64 * longest)).ceil() as usize;
        if ends.len() < least { shares_divided(ends, least) } else { ends.clone() }
    };
    Word { steps: word.steps.iter().enumerate().map(of_segment).collect(), ..word }
}

/// Whether motions may be cut at all: instants and overlaps need other schedules, and configurations have no motion.
fn can_be_cut(simulator: &Simulator) -> bool {
    Instants::of(simulator).is_empty() && simulator.overlaps().is_none() && !simulator.system.analysis.visits()
}

/// Whether motions are cut only where words last to the end, and several are of few events. A contact whose normal
/// turns in space rattles within a clearance: words are many, and their impacts so light that steps of one length for
/// all follow the motion.
fn is_cut_as_a_whole(simulator: &Simulator) -> bool {
    simulator.features().is_some()
}

/// Indices below a count, group by group: each is in the first group whose first member is alike.
fn grouped(count: usize, are_alike: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for index in 0..count {
        match groups.iter_mut().find(|group| are_alike(group[0], index)) {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    groups
}

/// Whether motions that can be followed to the time `reach` and through `events` events are worth cutting.
fn is_worthwhile(reach: f64, events: usize, duration: f64) -> bool {
    reach >= TUNING.worthwhile_share * duration || events >= TUNING.worthwhile_events
}

/// Indices of samples with the same events up to a time, group by group.
fn groups(all: &[Followed], end: f64) -> Vec<Vec<usize>> {
    grouped(all.len(), |own, other| all[own].agrees(&all[other], end))
}

/// Motions of these indices.
fn members<'f>(all: &'f [Followed], group: &[usize]) -> Vec<&'f Followed> {
    group.iter().map(|&sample| &all[sample]).collect()
}

/// Words up to a time, why they end there if they do not last to the duration, and the indices of their samples.
type Found = (f64, Option<WordsEnd>, Vec<(Word, Vec<usize>)>);

/// The words up to the duration; where there are more than the budget, or a sample meets more events than are followed,
/// up to the last event that all have, before which there are no more. `None` where that is too early.
fn within_budget(all: &[Followed], duration: f64) -> Option<Found> {
    let members = |group: &[usize]| members(all, group);
    let shortest = all.iter().min_by(|a, b| a.known_to.total_cmp(&b.known_to))?;
    let is_whole = shortest.known_to >= duration;
    let whole = groups(all, duration);
    if is_whole && whole.len() <= TUNING.most_words {
        let word = |group: Vec<usize>| Some((shared(&members(&group), duration)?, group));
        return Some((duration, None, whole.into_iter().map(word).collect::<Option<_>>()?));
    }
    let fewest = all.iter().map(|followed| followed.events.len()).min()?;
    let spelled = |sample: usize, count: usize| all[sample].events[..count].iter().map(|(event, _)| *event);
    let of_count = |count: usize| {
        let groups = grouped(all.len(), |own, other| spelled(own, count).eq(spelled(other, count)));
        (groups.len() <= TUNING.most_words).then_some((count, groups))
    };
    let (count, groups) = (1..=fewest).rev().find_map(of_count)?;
    let horizon = all.iter().map(|followed| followed.events[count - 1].1).fold(duration, f64::min);
    let end = if is_whole || count < fewest { WordsEnd::MoreWords } else { WordsEnd::MoreEvents };
    let word = |group: Vec<usize>| Some((of_extent(&members(&group), count, None, horizon)?, group));
    let words = groups.into_iter().map(word).collect::<Option<_>>()?;
    is_worthwhile(horizon, count, duration).then_some((horizon, Some(end), words))
}

/// The common word of some motions up to a time.
fn shared(all: &[&Followed], end: f64) -> Option<Word> {
    let (count, tail) = extent(all, end)?;
    of_extent(all, count, tail, end)
}

/// The word of some motions that are followed through `count` events, and to the end of a last segment without one.
fn of_extent(all: &[&Followed], count: usize, tail: Option<f64>, end: f64) -> Option<Word> {
    let word = |followed: &Followed| followed.events.iter().map(|(event, _)| *event).take(count).collect();
    let events: Vec<Event> = word(all.first()?);
    if all.iter().any(|followed| word(followed) != events) {
        return None;
    }
    let steps = |segment: usize| {
        let of = |followed: &&Followed| {
            followed.shares(segment, followed.events[..count].get(segment).map_or(tail.unwrap_or(end), |own| own.1))
        };
        // Those of the sample that takes most.
        all.iter().map(of).reduce(|a, b| if b.len() > a.len() { b } else { a })
    };
    let segments = count + usize::from(tail.is_some());
    let steps = (0..segments).filter_map(steps).collect();
    Some(Word { events, tail, steps })
}

/// Number of events that some motions are followed through, and the end of a last segment without one.
fn extent(all: &[&Followed], end: f64) -> Option<(usize, Option<f64>)> {
    let [least, most] = [1.0 - TUNING.beside_end, 1.0 + TUNING.beside_end].map(|share| {
        let counts = all.iter().map(|followed| followed.before(share * end));
        if share < 1.0 { counts.min() } else { counts.max() }
    });
    let (least, most) = (least?, most?);
    let reach = TUNING.followed_share * end;
    let are_known = |time: f64| all.iter().all(|followed| followed.known_to >= time);
    // If an event is near the end for some, all go on to the next that all have.
    let counts = || all.iter().map(|followed| followed.before(end));
    Some(match () {
        () if least == most => (most, Some(end)),
        () if all.iter().all(|followed| followed.events.len() > most) => (most + 1, None),
        () if all.iter().all(|followed| followed.before(reach) == most) && are_known(reach) => (most, Some(reach)),
        () if counts().min() == counts().max() => (counts().min()?, Some(end)),
        () => {
            // Between the last event of all and the first that is not followed any more.
            let last = all.iter().filter_map(|followed| Some(followed.events.get(most.checked_sub(1)?)?.1));
            let last = last.fold(end, f64::max);
            let next = |followed: &&Followed| followed.events.get(most).map_or(followed.known_to, |(_, time)| *time);
            let next = all.iter().map(next).fold(f64::INFINITY, f64::min);
            (next > last && all.iter().all(|followed| followed.events.len() >= most))
                .then_some((most, Some(0.5 * (last + next))))?
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Events at these times, with two equal steps in each segment.
    fn followed(times: &[f64]) -> Followed {
        let event = |index: usize| Event { switch: 0, rises: index.is_multiple_of(2) };
        let events = times.iter().enumerate().map(|(index, &time)| (event(index), time)).collect();
        let begins = std::iter::once(0.0).chain(times.iter().copied());
        let ends = times.iter().copied().chain([TUNING.followed_share]);
        let steps = begins.zip(ends).map(|(begin, end)| vec![0.5 * (begin + end), end]).collect();
        Followed { events, steps, known_to: TUNING.followed_share, ..Followed::default() }
    }

    fn spelled(all: &[Followed]) -> Option<Word> {
        shared(&all.iter().collect::<Vec<_>>(), 1.0)
    }

    #[test]
    fn word_has_the_events_that_all_samples_share() {
        let word = spelled(&[followed(&[0.4, 0.6]), followed(&[0.5, 0.7, 1.2])]).unwrap();
        assert_eq!((word.events.len(), word.tail), (2, Some(1.0)));
        assert_eq!(word.steps[..2], [vec![0.5, 1.0], vec![0.5, 1.0]]);
        assert_eq!(word.steps[2].last(), Some(&1.0));
    }

    #[test]
    fn samples_continue_past_an_event_near_the_end() {
        let word = spelled(&[followed(&[0.4, 0.99, 1.1]), followed(&[0.5, 1.01, 1.2])]).unwrap();
        assert_eq!((word.events.len(), word.tail, word.steps.len()), (3, None, 3));
        let word = spelled(&[followed(&[0.4, 0.99]), followed(&[0.5, 1.01])]).unwrap();
        assert_eq!((word.events.len(), word.tail), (2, Some(TUNING.followed_share)));
        // Behind the last event of both, and before the next of one.
        let word = spelled(&[followed(&[0.4, 0.99]), followed(&[0.5, 1.01, 1.2])]).unwrap();
        assert_eq!((word.events.len(), word.tail), (2, Some(0.5 * (1.01 + 1.2))));
    }

    #[test]
    fn different_events_give_different_words() {
        let mut other = followed(&[0.5]);
        other.events[0].0.switch = 1;
        let all = [followed(&[0.4, 0.6]), followed(&[0.5]), followed(&[0.45, 1.1]), other];
        // The third has the events of the first, of which one lies behind the end.
        assert_eq!(groups(&all, 1.0), [vec![0, 2], vec![1], vec![3]]);
    }

    /// A sample that meets more events than are followed ends the time at the last event that all have.
    #[test]
    fn unfollowed_events_shorten_the_horizon() {
        let (long, short) = (followed(&[0.4, 0.7, 0.9]), Followed { known_to: 0.8, ..followed(&[0.45, 0.75]) });
        let (horizon, end, words) = within_budget(&[long, short], 1.0).unwrap();
        assert_eq!((horizon, end, words.len()), (0.7, Some(WordsEnd::MoreEvents), 1));
        assert_eq!(words[0].0.events.len(), 2);
    }

    /// Eight words at the end: which of two switches three events are of. Two events make four of them.
    #[test]
    fn budget_of_words_shortens_the_horizon() {
        let of_number = |number: usize| {
            let mut own = followed(&[0.4, 0.5 + 0.01 * number as f64, 0.8]);
            own.events.iter_mut().enumerate().for_each(|(index, (event, _))| event.switch = number >> index & 1);
            own
        };
        let all: Vec<Followed> = (0..8).map(of_number).collect();
        let (horizon, end, words) = within_budget(&all, 1.0).unwrap();
        assert_eq!((horizon, end, words.len()), (0.5, Some(WordsEnd::MoreWords), 4));
        assert!(words.iter().all(|(word, samples)| word.events.len() == 2 && samples.len() == 2));
    }
}
