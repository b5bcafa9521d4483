//! One climb to an extreme.

use super::evaluations::{Evaluations, Goal};
use super::tuning::TUNING;

/// One way up. A round probes, strides and refines: each stage sees the values that the one before it asked for.
pub(super) struct Climb {
    pub(super) goal: Goal,
    pub(super) at: usize,
    /// Distances of the probes along each axis.
    reach: Vec<f64>,
    /// The points that were asked for last.
    pub(super) last: Vec<usize>,
    /// Best point of the round.
    best: usize,
    /// All axes' targets, and their joint promise.
    targets: Vec<f64>,
    promised: f64,
    pub(super) arrived: bool,
}

impl Climb {
    pub(super) fn new(goal: Goal, at: usize, dimension: usize) -> Self {
        let (reach, targets) = (vec![TUNING.reach; dimension], Vec::with_capacity(dimension));
        Self { goal, at, reach, last: Vec::new(), best: at, targets, promised: 0.0, arrived: false }
    }

    /// Asks for two points along each axis, or one on a face.
    pub(super) fn probe(&mut self, seen: &Evaluations) -> Vec<Vec<f64>> {
        let x = &seen.points[self.at];
        let along = |(axis, &reach): (usize, &f64)| {
            sides(x[axis], reach).into_iter().flatten().map(move |xi| {
                let mut probe = x.clone();
                probe[axis] = xi;
                probe
            })
        };
        self.reach.iter().enumerate().flat_map(along).collect()
    }

    /// Finds the targets from the probes, and asks for points on the way to them: axes that are coupled overshoot
    /// together.
    pub(super) fn stride(&mut self, seen: &Evaluations) -> Vec<Vec<f64>> {
        let x = &seen.points[self.at];
        let here = seen.value(self.goal, self.at);
        self.targets.clone_from(x);
        self.promised = 0.0;
        let mut probes = self.last.iter().map(|&place| seen.value(self.goal, place));
        for (xi, reach) in self.targets.iter_mut().zip(&mut self.reach) {
            // One value for each side that was probed.
            let mut value = || probes.next().unwrap_or(here);
            let (to, gain) = match sides(*xi, *reach) {
                [Some(a), Some(b)] => {
                    let found = target(*xi, here, (a, value()), (b, value()));
                    *reach = (found.0 - *xi).abs().clamp(TUNING.nearest, *reach);
                    found
                }
                [Some(inwards), None] | [None, Some(inwards)] => match value() - here {
                    gain if gain > 0.0 => {
                        (*xi + TUNING.reach * (inwards - *xi).signum(), gain * TUNING.reach / TUNING.on_face)
                    }
                    _ => (*xi, 0.0),
                },
                [None, None] => (*xi, 0.0),
            };
            self.promised += gain;
            *xi = to;
        }
        self.keep_best(seen);
        if self.targets == *x { Vec::new() } else { TUNING.strides.map(|share| self.towards(x, share)).to_vec() }
    }

    /// Asks for the vertex of the parabola through the best stride and its neighbours.
    pub(super) fn refine(&mut self, seen: &Evaluations) -> Vec<Vec<f64>> {
        let here = seen.value(self.goal, self.at);
        let mut along = [(0.0, here); TUNING.strides.len() + 1];
        for ((along, &place), share) in along[1..].iter_mut().zip(&self.last).zip(TUNING.strides) {
            *along = (share, seen.value(self.goal, place));
        }
        let unmoved = self.last.is_empty();
        self.keep_best(seen);
        let higher = |a: usize, b: usize| if along[b].1 > along[a].1 { b } else { a };
        let top = (1..along.len()).fold(0, higher).clamp(1, along.len() - 2);
        let (share, gain) = target(along[top].0, along[top].1, along[top - 1], along[top + 1]);
        if unmoved || gain <= 0.0 { Vec::new() } else { vec![self.towards(&seen.points[self.at], share)] }
    }

    /// The point this share of the way to the targets.
    fn towards(&self, x: &[f64], share: f64) -> Vec<f64> {
        let between = |(x, to): (&f64, &f64)| if share == 1.0 { *to } else { (x + share * (to - x)).clamp(-1.0, 1.0) };
        x.iter().zip(&self.targets).map(between).collect()
    }

    fn keep_best(&mut self, seen: &Evaluations) {
        let better = |best, &index: &usize| {
            if seen.value(self.goal, index) > seen.value(self.goal, best) { index } else { best }
        };
        self.best = self.last.iter().fold(self.best, better);
    }

    /// Moves to the best point, and decides whether to go on.
    pub(super) fn settle(&mut self, seen: &Evaluations) {
        self.keep_best(seen);
        let value = seen.value(self.goal, self.best);
        let gained = value - seen.value(self.goal, self.at);
        self.at = self.best;
        let least = TUNING.tolerance * seen.width(self.goal);
        let hopeless = value + self.promised.max(gained) < seen.best_value(self.goal);
        // NaN ends it too.
        let goes_on = gained > least && self.promised > least;
        self.arrived = hopeless || !goes_on;
    }
}

/// Points to probe along an axis.
fn sides(xi: f64, reach: f64) -> [Option<f64>; 2] {
    if xi >= 1.0 {
        [Some(1.0 - TUNING.on_face), None]
    } else if xi <= -1.0 {
        [None, Some(-1.0 + TUNING.on_face)]
    } else {
        [Some((xi - reach).max(-1.0)), Some((xi + reach).min(1.0))]
    }
}

/// The point in [−1, 1] at which the parabola through three values is largest, and by how much it is larger there than
/// at x. (Position and value below and above x.)
pub(super) fn target(x: f64, here: f64, below: (f64, f64), above: (f64, f64)) -> (f64, f64) {
    let (a, b) = (below.0 - x, above.0 - x);
    let (left, right) = ((below.1 - here) / a, (above.1 - here) / b);
    let bend = (right - left) / (b - a);
    let slope = right - bend * b;
    let gain = |to: f64| (to - x) * (slope + bend * (to - x));
    let better_end = if gain(1.0) > gain(-1.0) { 1.0 } else { -1.0 };
    let to = if bend < 0.0 { (x - 0.5 * slope / bend).clamp(-1.0, 1.0) } else { better_end };
    if gain(to) > 0.0 { (to, gain(to)) } else { (x, 0.0) }
}
