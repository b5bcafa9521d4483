//! Singular configurations that a motion passes: there, constraints that are independent elsewhere depend on others,
//! and the mechanism has more degrees of freedom for a moment.
//!
//! A step hardly ever ends in one. Where the Newton matrix's pivots are smallest between two steps, the least
//! independent constraint is therefore sought on positions interpolated between the steps. Its independence vanishes in
//! a singular configuration, and stays positive where the mechanism only comes near to one.

use super::tuning::TUNING;
use crate::assemble::ConstraintId;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::tuning::TUNING as START;
use crate::simulate::start::{jacobian_rows, row_independence, usual_row_sizes};
use crate::simulate::step::Stepper;

/// A singular configuration that was passed.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularPass {
    /// s
    pub time: f64,
    /// Constraints that depend on earlier ones there.
    pub constraints: Vec<ConstraintId>,
}

/// The state at a step's end.
#[derive(Clone, Debug, Default)]
struct Moment {
    time: f64,
    pivot_loss: f64,
    /// The layout's registers.
    state: Vec<f64>,
}

/// Search for singular configurations, over all steps of the first lane of a tile.
#[derive(Clone, Debug)]
pub struct SingularWatch<'s> {
    simulator: &'s Simulator,
    /// Sizes of the constraints' rows in general position.
    usual: Vec<f64>,
    /// The last three steps' ends, the latest last.
    moments: [Moment; 3],
    suspects: usize,
    passes: Vec<SingularPass>,
}

impl<'s> SingularWatch<'s> {
    /// Whether steps may be as long as their local errors allow: no force or constraint switches, depends on the time
    /// itself, or has a feature that a step may pass over.
    pub fn allows_long_steps(simulator: &Simulator) -> bool {
        !simulator.system.depends_on_time() && simulator.switches().is_none() && simulator.features().is_none()
    }

    /// Begins at the start.
    pub fn new(simulator: &'s Simulator, stepper: &Stepper) -> Self {
        let start = Moment { time: 0.0, pivot_loss: f64::INFINITY, state: stepper.lane(0) };
        let moments = [start.clone(), start.clone(), start];
        let usual = usual_row_sizes(&simulator.system, &simulator.start, &simulator.nominal);
        Self { simulator, usual, moments, suspects: 0, passes: Vec::new() }
    }

    /// Singular configurations found so far.
    pub fn passes(&self) -> Vec<SingularPass> {
        self.passes.clone()
    }

    /// Whether one was found so far.
    pub fn has_passed(&self) -> bool {
        !self.passes.is_empty()
    }

    /// Examines the step that has just ended.
    pub fn look(&mut self, stepper: &Stepper, time: f64) {
        self.moments.rotate_left(1);
        let latest = &mut self.moments[2];
        (latest.time, latest.pivot_loss) = (time, stepper.pivot_loss(0));
        stepper.copy_lane(0, &mut latest.state);
        let [first, middle, last] = &self.moments;
        let nearest = middle.pivot_loss > first.pivot_loss && middle.pivot_loss >= last.pivot_loss;
        if nearest && middle.pivot_loss > TUNING.suspect_pivot && self.suspects < TUNING.most_examined_steps {
            self.suspects += 1;
            self.passes.extend(self.weakest());
        }
    }

    /// The singular configuration between the last three steps' ends, if there is one: the moment in which a constraint
    /// is least independent, and the constraints that depend on others there.
    fn weakest(&self) -> Option<SingularPass> {
        let weakness = |time: f64| {
            let independence = self.independence(time);
            let least = independence.into_iter().map(|(_, independent)| independent).fold(f64::INFINITY, f64::min);
            (time, least)
        };
        let slope = |a: (f64, f64), b: (f64, f64)| ((b.1 - a.1) / (b.0 - a.0)).abs();
        let golden = 0.618_033_988_749_895;
        let [mut from, mut to] = [0, 2].map(|end| weakness(self.moments[end].time));
        let inner = |from: (f64, f64), to: (f64, f64)| to.0 - golden * (to.0 - from.0);
        let (mut left, mut right) = (weakness(inner(from, to)), weakness(inner(to, from)));
        let mut steepest = slope(from, left).max(slope(left, right)).max(slope(right, to));
        for _ in 0..TUNING.golden_sections {
            let may_fall = TUNING.steepest_fall * steepest * (to.0 - from.0);
            if left.1.min(right.1) > TUNING.vanishing_independence + may_fall {
                return None;
            }
            if left.1 < right.1 {
                (to, right) = (right, left);
                left = weakness(inner(from, to));
            } else {
                (from, left) = (left, right);
                right = weakness(inner(to, from));
            }
            steepest = steepest.max(slope(from, left)).max(slope(right, to));
        }
        let time = 0.5 * (from.0 + to.0);
        let vanished =
            self.independence(time).into_iter().filter(|(_, independent)| *independent < TUNING.vanishing_independence);
        let constraints: Vec<_> = vanished.map(|(constraint, _)| constraint).collect();
        (!constraints.is_empty()).then_some(SingularPass { time, constraints })
    }

    /// Independence of each constraint that is not redundant everywhere from the constraints before it.
    fn independence(&self, time: f64) -> Vec<(ConstraintId, f64)> {
        let rows = jacobian_rows(&self.simulator.system, &self.simulator.start, &self.between(time));
        let redundant = &self.simulator.mobility.redundant;
        let constraints = (0..rows.len()).map(ConstraintId::new);
        let independence = constraints.zip(row_independence(&rows, &self.usual, START.dependent_row));
        independence.filter(|(constraint, _)| !redundant.contains(constraint)).collect()
    }

    /// The state at a time between steps' ends: positions are cubic through positions and velocities there.
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
