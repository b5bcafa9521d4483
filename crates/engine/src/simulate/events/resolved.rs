//! Steps of words that resolve the functions of the time, and features of forces in space. Each sample follows steps
//! that do so; but these steps are shares of segments that begin and end at other times in other samples.

use super::followed::Followed;
use super::segments::Word;
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::time_functions::tuning::TUNING as TIME_FUNCTIONS;
use crate::simulate::time_functions::{TimeFunctions, Work};

/// A word of some motions up to a time, with those of its steps halved that do not resolve a function wherever they lie
/// between the earliest and the latest of the motions; `None` if there would be too many.
pub(super) fn resolved_word(
    word: Word,
    all: &[&Followed],
    samples: &[&Sample],
    end: f64,
    functions: Option<&TimeFunctions>,
) -> Option<Word> {
    if functions.is_none() && all.iter().all(|own| own.featured.is_empty()) {
        return Some(word);
    }
    let mut work = Work::default();
    let mut left = TUNING.most_steps;
    let mut steps = Vec::with_capacity(word.steps.len());
    for (segment, ends) in word.steps.iter().enumerate() {
        let reach = word.reach(segment, end);
        let segments: Vec<(f64, f64)> =
            all.iter().map(|own| (own.begin(segment), own.length(segment, reach))).collect();
        let length = segments.iter().map(|(_, length)| *length).fold(0.0, f64::max);
        let windows = windows(all, &segments);
        // A pulse between two events moves with them, and changes in no other segment.
        let inner = |&(begin, length): &(f64, f64)| {
            let margin = TUNING.rounded_instant * (begin + length);
            (begin + margin, begin + length - margin)
        };
        let spans: Vec<(f64, f64)> = segments.iter().map(inner).collect();
        let of_samples = || samples.iter().copied().zip(spans.iter().copied()).filter(|(_, (a, b))| a < b);
        let functions = functions.map(|functions| functions.changing(of_samples(), &mut work));
        let mut is_resolved = |[first, last]: [f64; 2], share: f64| {
            if windows.iter().any(|window| window.is_passed_by([first, last])) {
                return false;
            }
            let Some(functions) = &functions else { return true };
            let times = |share: f64| segments.iter().map(move |(begin, length)| begin + share * length);
            let span = (times(first).fold(f64::INFINITY, f64::min), times(last).fold(0.0, f64::max));
            functions.are_slow_in_parts(span, (last - first) * length, share, &mut work)
        };
        let mut divided = Vec::with_capacity(ends.len());
        let begins = std::iter::once(0.0).chain(ends.iter().copied());
        for (begin, end) in begins.zip(ends.iter().copied()) {
            // The next part is the last of the list.
            let mut parts = vec![Part { ends: [begin, end], is_divided: false }];
            while let Some(part) = parts.pop() {
                let share = if part.is_divided { TIME_FUNCTIONS.resolved } else { TIME_FUNCTIONS.too_fast };
                if is_resolved(part.ends, share) {
                    divided.push(part);
                } else {
                    parts.extend(part.halves());
                }
                if parts.len() + divided.len() > left {
                    return None;
                }
            }
        }
        let mut graded = graded(divided, left)?;
        graded.reverse();
        let graded = self::graded(graded, left)?;
        left -= graded.len();
        steps.push(graded.iter().rev().map(|part| part.ends[1]).collect());
    }
    Some(Word { steps, ..word })
}

/// A part of a segment in which features of forces in space act in some sample.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    /// Its beginning and its end, as shares of the segment.
    ends: [f64; 2],
    /// Shortest step that a sample takes there, as a share of its segment.
    shortest: f64,
}

impl Window {
    /// The least window that holds both.
    fn or(self, other: Self) -> Self {
        let ends = [self.ends[0].min(other.ends[0]), self.ends[1].max(other.ends[1])];
        Self { ends, shortest: self.shortest.min(other.shortest) }
    }

    /// Whether a step between two shares is too long there.
    fn is_passed_by(self, [first, last]: [f64; 2]) -> bool {
        let is_beside = last <= self.ends[0] || self.ends[1] <= first;
        !is_beside && last - first > TIME_FUNCTIONS.growth_of_steps * self.shortest
    }
}

/// The windows of a segment, given its beginning and its length in each motion: each from the first sample to the last,
/// if all meet the same number of features one after the other, else one of all.
fn windows(all: &[&Followed], segments: &[(f64, f64)]) -> Vec<Window> {
    let of_motion = |(own, &(begin, length)): (&&Followed, &(f64, f64))| {
        let mut found: Vec<Window> = Vec::new();
        for step in &own.featured {
            let ends = step.map(|time| (time - begin) / length);
            if ends[1] <= 0.0 || ends[0] >= 1.0 {
                continue;
            }
            let step = Window { ends, shortest: ends[1] - ends[0] };
            match found.last_mut().filter(|last| last.ends[1] >= ends[0]) {
                Some(last) => *last = last.or(step),
                None => found.push(step),
            }
        }
        found
    };
    let of_motions: Vec<Vec<Window>> = all.iter().zip(segments).map(of_motion).collect();
    let count = of_motions.first().map_or(0, Vec::len);
    if of_motions.iter().any(|own| own.len() != count) {
        return of_motions.into_iter().flatten().reduce(Window::or).into_iter().collect();
    }
    (0..count).filter_map(|number| of_motions.iter().map(|own| own[number]).reduce(Window::or)).collect()
}

/// A step, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    /// Its beginning and its end, as shares of the segment.
    ends: [f64; 2],
    is_divided: bool,
}

impl Part {
    fn length(self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Its halves, the second first.
    fn halves(self) -> [Self; 2] {
        let [begin, end] = self.ends;
        let middle = 0.5 * (begin + end);
        [[middle, end], [begin, middle]].map(|ends| Self { ends, is_divided: true })
    }
}

/// Steps in either order with those halved that are more than twice as long as a divided one before them: there a
/// function begins to change, though by little. `None` if there would be more than `most`.
fn graded(steps: Vec<Part>, most: usize) -> Option<Vec<Part>> {
    let is_forward = steps.windows(2).all(|pair| pair[0].ends[0] < pair[1].ends[0]);
    let mut found: Vec<Part> = Vec::with_capacity(steps.len());
    for step in steps {
        let mut parts = vec![step];
        while let Some(part) = parts.pop() {
            let longest = found.last().filter(|last| last.is_divided).map_or(f64::INFINITY, |last| last.length());
            if part.length() > TIME_FUNCTIONS.growth_of_steps * longest * (1.0 + 1e-9) {
                let [later, sooner] = part.halves();
                parts.extend(if is_forward { [later, sooner] } else { [sooner, later] });
            } else {
                found.push(part);
            }
            if parts.len() + found.len() > most {
                return None;
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_beside_divided_ones_are_graded() {
        let part = |begin: f64, end: f64, is_divided: bool| Part { ends: [begin, end], is_divided };
        let steps = vec![part(0.0, 0.5, false), part(0.5, 0.5625, true), part(0.5625, 1.0, false)];
        let mut forward = graded(steps.clone(), 100).unwrap();
        assert_eq!(forward[..2], steps[..2], "nothing is divided before it");
        assert_eq!(forward[2].ends, [0.5625, 0.671_875]);
        forward.reverse();
        let both = graded(forward, 100).unwrap();
        assert!(both.windows(2).all(|pair| pair[0].ends[0] == pair[1].ends[1]), "{both:?}");
        assert!(both.windows(2).all(|pair| pair[1].length() <= 2.0 * pair[0].length() + 1e-12), "{both:?}");
        assert_eq!(both.last().unwrap().ends, [0.0, 0.25]);
        assert!(graded(steps, 3).is_none());
    }
}
