//! Singular configurations that a motion passes: where constraints depend on others that do not elsewhere, and the mechanism
//! has more degrees of freedom for a moment.
//!
//! Steps hardly ever end in one. So where the Newton matrix's pivots are smallest between two steps, the weakest constraint is
//! sought on the positions interpolated there; it vanishes in a singular configuration, and does not where the mechanism
//! only comes near to one.

use super::hht::Stepper;
use super::rank::row_strengths;
use super::simulator::{DEPENDENT, Simulator, slope_rows};

/// A pivot that is this much nearer to what is not trusted than it was at the probes (1e-10) is looked into.
const SUSPECT: f64 = 1e-8;

/// A constraint that stands out of the others by less than this (scaled) depends on them. Interpolated positions are off by
/// (hω)⁴/384, 1e-6 for twenty steps a turn.
const VANISHES: f64 = 1e-5;

/// Divisions of the time between steps by the golden section: to 1e-8 of it.
const DIVISIONS: usize = 40;

/// Suspects that are looked into at most, so that the search stays short beside the run.
const MOST: usize = 200;

/// A singular configuration that was passed.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularPass {
    /// s
    pub time: f64,
    /// Constraints that depend on earlier ones there.
    pub constraints: Vec<usize>,
}

/// What is kept of a step's end.
#[derive(Clone, Debug, Default)]
struct Moment {
    time: f64,
    strain: f64,
    /// The layout's slots.
    state: Vec<f64>,
}

/// Looks at every step of the first lane of a tile.
#[derive(Clone, Debug)]
pub struct SingularWatch<'s> {
    simulator: &'s Simulator,
    /// The last three steps' ends, the latest last.
    moments: [Moment; 3],
    suspects: usize,
    passes: Vec<SingularPass>,
}

impl<'s> SingularWatch<'s> {
    /// From the start on.
    pub fn new(simulator: &'s Simulator, stepper: &Stepper) -> Self {
        let start = Moment { time: 0.0, strain: f64::INFINITY, state: stepper.lane(0) };
        let moments = [start.clone(), start.clone(), start];
        Self { simulator, moments, suspects: 0, passes: Vec::new() }
    }

    /// What was found.
    pub fn passes(&self) -> Vec<SingularPass> {
        self.passes.clone()
    }

    /// After a step.
    pub fn look(&mut self, stepper: &Stepper, time: f64) {
        self.moments.rotate_left(1);
        let latest = &mut self.moments[2];
        (latest.time, latest.strain) = (time, stepper.pivot_strain(0));
        stepper.copy_lane(0, &mut latest.state);
        let [first, middle, last] = &self.moments;
        let nearest = middle.strain > first.strain && middle.strain >= last.strain;
        if nearest && middle.strain > SUSPECT && self.suspects < MOST {
            self.suspects += 1;
            let pass = self.weakest();
            self.passes.extend((!pass.constraints.is_empty()).then_some(pass));
        }
    }

    /// The moment between the last three steps' ends in which a constraint is weakest, and what has vanished there.
    fn weakest(&self) -> SingularPass {
        let weakness = |time: f64| {
            let strengths = self.strengths(time);
            strengths.into_iter().map(|(_, strength)| strength).fold(f64::INFINITY, f64::min)
        };
        let golden = 0.618_033_988_749_895;
        let (mut from, mut to) = (self.moments[0].time, self.moments[2].time);
        let mut inner = [to - golden * (to - from), from + golden * (to - from)];
        let mut values = inner.map(weakness);
        for _ in 0..DIVISIONS {
            if values[0] < values[1] {
                to = inner[1];
                inner = [to - golden * (to - from), inner[0]];
                values = [weakness(inner[0]), values[0]];
            } else {
                from = inner[0];
                inner = [inner[1], from + golden * (to - from)];
                values = [values[1], weakness(inner[1])];
            }
        }
        let time = 0.5 * (from + to);
        let vanished = self.strengths(time).into_iter().filter(|(_, strength)| *strength < VANISHES);
        SingularPass { time, constraints: vanished.map(|(constraint, _)| constraint).collect() }
    }

    /// How far each constraint that is not redundant everywhere stands out of those before it.
    fn strengths(&self, time: f64) -> Vec<(usize, f64)> {
        let rows = slope_rows(&self.simulator.system, &self.simulator.start, &self.between(time));
        let redundant = &self.simulator.mobility.redundant;
        let strengths = row_strengths(&rows, DEPENDENT).into_iter().enumerate();
        strengths.filter(|(constraint, _)| !redundant.contains(constraint)).collect()
    }

    /// The state whose positions are cubic between steps' ends, by positions and velocities there.
    fn between(&self, time: f64) -> Vec<f64> {
        let after = if time < self.moments[1].time { 1 } else { 2 };
        let (start, end) = (&self.moments[after - 1], &self.moments[after]);
        let (h, s) = (end.time - start.time, (time - start.time) / (end.time - start.time));
        let layout = &self.simulator.program.layout;
        let mut state = end.state.clone();
        state[layout.time] = time;
        for (q, v) in layout.q.clone().zip(layout.v.clone()) {
            let (a, b) = (start.state[q], end.state[q]);
            let bend = (1.0 - s) * (h * start.state[v] - (b - a)) - s * (h * end.state[v] - (b - a));
            state[q] = a + s * (b - a) + s * (1.0 - s) * bend;
        }
        state
    }
}
