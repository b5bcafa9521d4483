//! Whether the equations switched in a step, and when.

use symdiff::Tile;

use crate::compile::{Switch, SwitchProgram};
use crate::simulate::events::locate::{Crossing, crossing};

/// Compares the switches at both ends of a step.
#[derive(Clone, Debug)]
pub struct SwitchWatch<'s> {
    program: &'s SwitchProgram,
    tile: Tile,
    before: Vec<[f64; 2]>,
    after: Vec<[f64; 2]>,
}

impl<'s> SwitchWatch<'s> {
    /// Watches the samples of a tile.
    pub fn new(program: &'s SwitchProgram, samples: &Tile) -> Self {
        Self { program, tile: program.memory_for(samples), before: Vec::new(), after: Vec::new() }
    }

    /// Evaluates the switches before a step.
    pub fn begin(&mut self, states: &Tile) {
        let mut values = std::mem::take(&mut self.before);
        self.evaluate(states, &mut values);
        self.before = values;
    }

    /// Evaluates the switches after a step.
    pub fn end(&mut self, states: &Tile) {
        let mut values = std::mem::take(&mut self.after);
        self.evaluate(states, &mut values);
        self.after = values;
    }

    /// Goes on from a step's end: the next begins there.
    pub fn go_on(&mut self) {
        std::mem::swap(&mut self.before, &mut self.after);
    }

    /// (value, rate) of a switch at the step's beginning and at its end.
    pub fn ends(&self, switch: usize, lane: usize) -> [[f64; 2]; 2] {
        [self.at_beginning(switch, lane), self.at_end(switch, lane)]
    }

    /// (value, rate) of a switch at the step's beginning.
    pub fn at_beginning(&self, switch: usize, lane: usize) -> [f64; 2] {
        self.before[switch * self.tile.width() + lane]
    }

    /// (value, rate) of a switch at the step's end.
    pub fn at_end(&self, switch: usize, lane: usize) -> [f64; 2] {
        self.after[switch * self.tile.width() + lane]
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

    /// (value, rate) of each switch, switch by switch, lane by lane; a rate is NaN if it is not known.
    fn evaluate(&mut self, states: &Tile, into: &mut Vec<[f64; 2]>) {
        self.program.evaluate_at(states, &mut self.tile);
        let width = self.tile.width();
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
    /// With the index of its switch.
    pub fn crossing(&self, lane: usize, h: f64) -> Option<(usize, Crossing)> {
        let first = |(own, a): (usize, Crossing), (other, b): (usize, Crossing)| match b.share < a.share {
            true => (other, Crossing { hidden: b.hidden || a.hidden, ..b }),
            false => (own, a),
        };
        self.crossings(lane, h).reduce(first)
    }

    /// The crossings of a lane in that step, each with the number of its switch.
    pub fn crossings(&self, lane: usize, h: f64) -> impl Iterator<Item = (usize, Crossing)> {
        let of_switch = move |switch: usize| {
            let [start, end] = self.ends(switch, lane);
            crossing(start, end, h)
        };
        // A value that jumps at a whole number has no crossing of its own there.
        let jumps = move |switch: &usize| {
            self.program.switches[*switch]
                .jumps_with
                .iter()
                .any(|&other| other != *switch && of_switch(other).is_some())
        };
        let switches = (0..self.program.switches.len()).filter(move |switch| !jumps(switch));
        switches.filter_map(move |switch| Some((switch, of_switch(switch)?)))
    }
}
