//! Whether the equations switched in a step, and when.

use symdiff::Tile;

use crate::compile::{Switch, SwitchProgram, Tapes};

/// A cubic's first root is searched for at this many points between the ends of a step, and then by bisection.
const POINTS: usize = 16;
const BISECTIONS: usize = 50;

/// A crossing after this share of a step is at its end.
const AT_THE_END: f64 = 0.999;

/// Compares the switches at both ends of a step.
#[derive(Clone, Debug)]
pub struct SwitchWatch<'s> {
    program: &'s SwitchProgram,
    tile: Tile,
    before: Vec<[f64; 2]>,
    after: Vec<[f64; 2]>,
}

/// A switch that changed its sign in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// When it first did, as a share of the step.
    pub share: f64,
    /// Whether the ends of the step do not show it: it changed back.
    pub hidden: bool,
    /// The index of the switch.
    pub switch: usize,
}

impl Crossing {
    /// Whether the step ends with it, so that nothing that it begins is stepped over.
    pub fn is_at_the_end(&self) -> bool {
        !self.hidden && self.share >= AT_THE_END
    }
}

impl<'s> SwitchWatch<'s> {
    /// For the samples of a tile.
    pub fn new(program: &'s SwitchProgram, samples: &Tile) -> Self {
        let width = samples.width();
        let mut tile = Tile::new(width, program.registers(), program.constants());
        let parameters = program.layout.parameters.clone();
        let shared = parameters.start * width..parameters.end * width;
        tile.values_mut()[shared.clone()].copy_from_slice(&samples.values()[shared]);
        tile.run(program.sample());
        Self { program, tile, before: Vec::new(), after: Vec::new() }
    }

    /// Before a step.
    pub fn begin(&mut self, states: &Tile) {
        let mut values = std::mem::take(&mut self.before);
        self.evaluate(states, &mut values);
        self.before = values;
    }

    /// After a step.
    pub fn end(&mut self, states: &Tile) {
        let mut values = std::mem::take(&mut self.after);
        self.evaluate(states, &mut values);
        self.after = values;
    }

    /// (value, rate) of a switch at the step's beginning and at its end.
    pub fn ends(&self, switch: usize, lane: usize) -> [[f64; 2]; 2] {
        let place = switch * self.tile.width() + lane;
        [self.before[place], self.after[place]]
    }

    /// The least and the largest value that a switch has in the step between [`begin`](Self::begin) and
    /// [`end`](Self::end), as far as its ends and a change of sign between them show.
    pub fn extent(&self, switch: usize, lane: usize, h: f64) -> [f64; 2] {
        let [start, end] = self.ends(switch, lane);
        let [low, high] = [start[0].min(end[0]), start[0].max(end[0])];
        match crossing(start, end, h) {
            Some(Crossing { hidden: true, .. }) => [low.min(-high), high.max(-low)],
            _ => [low, high],
        }
    }

    /// (value, rate) of each switch, switch by switch, lane by lane; a rate is NaN where it is not known.
    fn evaluate(&mut self, states: &Tile, into: &mut Vec<[f64; 2]>) {
        let layout = &self.program.layout;
        let width = self.tile.width();
        let state = layout.state();
        let state = state.start * width..state.end * width;
        self.tile.values_mut()[state.clone()].copy_from_slice(&states.values()[state]);
        self.tile.lane_mut(layout.time).copy_from_slice(states.lane(layout.time));
        self.tile.run(self.program.evaluate());
        into.clear();
        for Switch { value, rate, .. } in &self.program.switches {
            for lane in 0..width {
                let rate = rate.map_or(f64::NAN, |rate| self.tile.lane(rate)[lane]);
                into.push([self.tile.lane(*value)[lane], rate]);
            }
        }
    }

    /// The switch at an index.
    pub fn switch(&self, index: usize) -> &Switch {
        &self.program.switches[index]
    }

    /// The first crossing of a lane in the step of length h between [`begin`](Self::begin) and [`end`](Self::end).
    pub fn crossing(&self, lane: usize, h: f64) -> Option<Crossing> {
        let width = self.tile.width();
        let of_switch = |switch: usize| {
            let place = switch * width + lane;
            crossing(self.before[place], self.after[place], h).map(|crossing| Crossing { switch, ..crossing })
        };
        // What jumps where a whole number is passed has no crossing of its own there.
        let jumps = |switch: &usize| {
            self.program.switches[*switch]
                .jumps_with
                .iter()
                .any(|&other| other != *switch && of_switch(other).is_some())
        };
        let crossings = (0..self.program.switches.len()).filter(|switch| !jumps(switch)).filter_map(of_switch);
        crossings.reduce(|a, b| if b.share < a.share { Crossing { hidden: b.hidden || a.hidden, ..b } } else { a })
    }
}

/// Where the cubic through (value, rate) at both ends of a step first changes its sign, as of switch 0; the line where
/// rates are unknown. A value of zero has the sign that follows.
fn crossing([start, start_rate]: [f64; 2], [end, end_rate]: [f64; 2], h: f64) -> Option<Crossing> {
    if !start.is_finite() || !end.is_finite() || start == 0.0 {
        return None;
    }
    let changes = start * end <= 0.0;
    if !(start_rate.is_finite() && end_rate.is_finite()) {
        return changes.then(|| Crossing { share: start / (start - end), hidden: false, switch: 0 });
    }
    // Without a change of sign at the ends, it has to approach zero first and to leave it last.
    let approaches = start * start_rate < 0.0 && end * end_rate > 0.0;
    if !(changes || approaches) {
        return None;
    }
    let cubic = |s: f64| {
        let rest = 1.0 - s;
        rest * rest * ((1.0 + 2.0 * s) * start + s * h * start_rate)
            + s * s * ((3.0 - 2.0 * s) * end - rest * h * end_rate)
    };
    let changed = |s: f64| cubic(s) * start <= 0.0;
    let first = (1..=POINTS).map(|point| point as f64 / POINTS as f64).find(|&s| changed(s))?;
    let (mut low, mut high) = (first - 1.0 / POINTS as f64, first);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if changed(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(Crossing { share: high, hidden: !changes, switch: 0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_meets_the_ground_where_its_parabola_does() {
        // y = 1 − 4 t²/2 over 1 s.
        let found = crossing([1.0, 0.0], [-1.0, -4.0], 1.0).unwrap();
        assert!((found.share - 0.5_f64.sqrt()).abs() < 1e-12 && !found.hidden);
        // (s − 0.3) (s − 0.5), touched between two ends of the same sign.
        let found = crossing([0.15, -0.8], [0.35, 1.2], 1.0).unwrap();
        assert!((found.share - 0.3).abs() < 1e-12 && found.hidden);
    }

    #[test]
    fn what_stays_on_its_side_does_not_switch() {
        assert_eq!(crossing([1.0, -1.0], [1.0, 1.0], 1.0), None);
        assert_eq!(crossing([0.0, -1.0], [-1.0, -1.0], 1.0), None);
        assert_eq!(crossing([f64::NAN, 0.0], [1.0, 0.0], 1.0), None);
        assert_eq!(crossing([1.0, f64::NAN], [2.0, f64::NAN], 1.0), None);
    }
}
