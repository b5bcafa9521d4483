//! The path of a sample's positions in a step, and its parts.

use symdiff::Interval;

use super::Passage;
use crate::compile::Layout;

/// The cubics that positions follow in a step of a sample.
#[derive(Clone, Debug, Default)]
pub(super) struct StepCubics {
    times: [f64; 2],
    parameters: Vec<f64>,
    /// Bézier points of every position.
    points: Vec<[f64; 4]>,
}

impl StepCubics {
    /// Takes the path of a step.
    pub fn take(&mut self, passage: Passage, layout: &Layout) {
        let Passage { end, h, parameters, states: [before, after], width, lane } = passage;
        let n = layout.q.len();
        let line = |state: &[f64], line: usize| state[line * width + lane];
        self.times = [end - h, end];
        parameters.clone_into(&mut self.parameters);
        self.points.clear();
        self.points.extend((0..n).map(|coordinate| {
            let (a, b) = (line(before, coordinate), line(after, coordinate));
            let rates = [before, after].map(|state| h / 3.0 * line(state, n + coordinate));
            [a, a + rates[0], b - rates[1], b]
        }));
    }

    /// Writes intervals of time, parameters and positions over a part of the step, from 0 to 1: the points of a part
    /// of a cubic are its polar form at both ends, and hold it between them.
    pub fn between(&self, part: [f64; 2], symbols: &mut Vec<Interval>) {
        let [begin, end] = self.times;
        let at = |share: f64| if share == 1.0 { end } else { begin + share * (end - begin) };
        symbols.clear();
        symbols.push(Interval::new(at(part[0]), at(part[1])));
        symbols.extend(self.parameters.iter().copied().map(Interval::point));
        let [s, t] = part;
        symbols.extend(self.points.iter().map(|points| {
            let points = part_of_cubic(points, s, t);
            let least = points.into_iter().fold(f64::INFINITY, f64::min);
            Interval::new(least, points.into_iter().fold(f64::NEG_INFINITY, f64::max))
        }));
    }
}

/// Bézier points of a cubic's part from s to t: its polar form at (s, s, s), (s, s, t), (s, t, t) and (t, t, t).
fn part_of_cubic([a, b, c, d]: &[f64; 4], s: f64, t: f64) -> [f64; 4] {
    let at = |from: f64, to: f64, share: f64| (1.0 - share) * from + share * to;
    let [first, second, third] = [at(*a, *b, s), at(*b, *c, s), at(*c, *d, s)];
    let [near, far] = [at(first, second, s), at(second, third, s)];
    let last = [at(*a, *b, t), at(*b, *c, t), at(*c, *d, t)];
    [
        at(near, far, s),
        at(near, far, t),
        at(at(first, second, t), at(second, third, t), t),
        at(at(last[0], last[1], t), at(last[1], last[2], t), t),
    ]
}
