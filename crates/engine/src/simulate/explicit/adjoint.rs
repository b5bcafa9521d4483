//! Backwards over steps of the explicit method.
//!
//! A step's end is y + h Σ bᵢ kᵢ, moved onto the constraints, with kᵢ = f(t + cᵢ h, Yᵢ) and Yᵢ = y + h Σ aᵢⱼ kⱼ. The
//! stages are evaluated once more, and followed from the last to the first: k̄ᵢ = h bᵢ ȳ₊ + h Σⱼ aⱼᵢ Ȳⱼ, Ȳᵢ = f_yᵀ k̄ᵢ.
//! Rows within a step are sums of the same kind, and so is the end of a step that ends at an event.

use symdiff::Tile;

use super::listed::ExplicitSteps;
use super::tableau::{DENSE, Row, STAGES, TIMES, WEIGHTS, WITH_DENSE};
use super::tuning::TUNING;
use crate::simulate::adjoint::{LaneTerm, RowAdjoints, StartAdjoints, TileInputs, TileKernel, TilePath, add};
use crate::simulate::ensemble::Needs;
use crate::simulate::error::SimulationError;
use crate::simulate::events::EventAdjoints;
use crate::simulate::simulator::Simulator;

/// A row: its time, s, and the terms of lanes in it.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct ExplicitRow {
    pub time: f64,
    pub terms: Vec<LaneTerm>,
}

/// Goes backwards over a path.
#[derive(Debug)]
pub(in crate::simulate) struct ExplicitAdjoints<'s> {
    path: TilePath<ExplicitSteps<'s>>,
    /// Adjoints of the stages, and of closures.
    memory: StartAdjoints<'s>,
    closures: StartAdjoints<'s>,
    is_linear: bool,
    closes: bool,
    /// The step that is followed: times of the stages, s, their states (q and v), their accelerations and multipliers
    /// (w and λ), and the guesses of these.
    times: [f64; WITH_DENSE],
    stages: Vec<Vec<f64>>,
    unknowns: Vec<Vec<f64>>,
    guesses: Vec<Vec<f64>>,
    /// Adjoints of the stages' rates.
    by_rates: Vec<Vec<f64>>,
    /// Adjoints of functions of the time.
    kernel: TileKernel,
    events: Option<EventAdjoints<'s>>,
}

impl<'s> ExplicitAdjoints<'s> {
    /// Adjoints over the path of an assembled tile.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(
        simulator: &'s Simulator,
        start: &Tile,
        path: TilePath<ExplicitSteps<'s>>,
    ) -> Result<Self, SimulationError> {
        let (needs, size) = (Needs::of(simulator), path.start().len());
        let program = simulator.free_closure()?;
        let [memory, closures] = [0, 1].map(|_| StartAdjoints::new(simulator, program, start));
        let unknowns = (memory.layout().lambda.end - memory.layout().w.start) * start.width();
        let kernel = path.stepping().inputs.map_or_else(TileKernel::default, TileInputs::kernel);
        Ok(Self {
            kernel,
            path,
            memory,
            closures,
            is_linear: needs.linear,
            closes: needs.closure,
            times: [0.0; WITH_DENSE],
            stages: vec![vec![0.0; size]; WITH_DENSE],
            unknowns: vec![vec![0.0; unknowns]; WITH_DENSE],
            guesses: vec![vec![0.0; unknowns]; WITH_DENSE],
            by_rates: vec![vec![0.0; size]; WITH_DENSE],
            events: None,
        })
    }

    /// Adds events at the ends of steps.
    #[must_use]
    pub fn through(self, events: Option<EventAdjoints<'s>>) -> Self {
        Self { events, ..self }
    }

    /// Pulls adjoints from the rows, the last first, to the start; the outputs' values are noted in `values` (by lane
    /// and term). Returns adjoints of the start's positions and velocities (2n lines).
    pub fn pull(&mut self, rows: &[ExplicitRow], closing: &mut RowAdjoints, values: &mut [Vec<f64>]) -> Vec<f64> {
        let mut adjoints = vec![0.0; self.path.start().len()];
        let mut rows = rows.iter().peekable();
        for step in (0..self.path.steps()).rev() {
            let stepping = self.path.stepping();
            let (begin, inner, end) = (stepping.begin(step), stepping.inner(step), stepping.ends[step]);
            let inputs = self.path.stepping().inputs;
            let mut of_row = |row: &ExplicitRow, motion: &[f64]| {
                let mut by_motion = closing.pull(row.time, motion, &row.terms, values);
                by_motion.truncate(motion.len());
                by_motion
            };
            let (state, after, unchanged) = self.path.around(step);
            let (state, after, unchanged) = (state.to_vec(), after.to_vec(), unchanged.map(<[f64]>::to_vec));
            while let Some(row) = rows.next_if(|row| row.time >= end) {
                add(&mut adjoints, 1.0, &of_row(row, &after));
            }
            if let Some(events) = &mut self.events {
                events.pull(step, end, &after, &mut adjoints);
            }
            if let Some(inputs) = inputs {
                let values = inputs.values(inputs.cell(end));
                self.memory.set_inputs(values);
                self.closures.set_inputs(values);
            }
            if let Some(unchanged) = &unchanged {
                self.pull_sampling(end, unchanged, &mut adjoints);
            }
            let is_at_event = inner < end;
            let next = Some(unchanged.unwrap_or(after)).filter(|_| !is_at_event);
            let is_dense = is_at_event || rows.peek().is_some_and(|row| row.time > begin);
            let h = inner - begin;
            let next = self.evaluate(&state, next, [begin, inner], if is_dense { WITH_DENSE } else { STAGES - 1 });
            self.by_rates.iter_mut().for_each(|by_rate| by_rate.fill(0.0));
            let mut by_state = vec![0.0; state.len()];
            if is_at_event {
                let weights = interpolation((end - begin) / h);
                self.pull_closure(end, &self.dense(&state, &next, h, &weights), &mut adjoints);
                let by_end = std::mem::replace(&mut adjoints, vec![0.0; state.len()]);
                self.pull_dense(&by_end, h, &weights, [&mut by_state, &mut adjoints]);
            }
            while let Some(row) = rows.next_if(|row| row.time > begin) {
                let weights = interpolation((row.time - begin) / h);
                let by_motion = of_row(row, &self.dense(&state, &next, h, &weights));
                self.pull_dense(&by_motion, h, &weights, [&mut by_state, &mut adjoints]);
            }
            for stage in (STAGES..WITH_DENSE).rev().filter(|_| is_dense) {
                let by_stage = self.pull_stage(stage);
                self.share(stage, h, &by_stage, &mut by_state);
            }
            if is_dense {
                let by_next = self.pull_stage(STAGES - 1);
                add(&mut adjoints, 1.0, &by_next);
            }
            self.pull_closure(inner, &self.end_of(&state, h), &mut adjoints);
            self.share(STAGES - 1, h, &adjoints, &mut by_state);
            for stage in (0..STAGES - 1).rev() {
                let by_stage = self.pull_stage(stage);
                self.share(stage, h, &by_stage, &mut by_state);
            }
            adjoints = by_state;
            if let Some(inputs) = inputs {
                for memory in [&mut self.memory, &mut self.closures] {
                    self.kernel.add(inputs.cell(end), &memory.take(memory.layout().inputs.clone()));
                }
            }
        }
        let start = self.path.start().to_vec();
        for row in rows {
            let mut by_motion = closing.pull(row.time, &start, &row.terms, values);
            by_motion.truncate(start.len());
            add(&mut adjoints, 1.0, &by_motion);
        }
        adjoints
    }

    /// Adjoints of the functions of the time.
    pub fn kernel(&self) -> &TileKernel {
        &self.kernel
    }

    /// The adjoints of the parameters, k lines.
    pub fn finish(&mut self) -> Vec<f64> {
        let mut total = self.memory.finish();
        add(&mut total, 1.0, &self.closures.finish());
        if let Some(events) = &mut self.events {
            add(&mut total, 1.0, &events.finish());
        }
        total
    }

    /// The stages of a step between two times, given the state at its beginning and the one at its end, if that is
    /// known: the latter.
    fn evaluate(&mut self, state: &[f64], next: Option<Vec<f64>>, [begin, end]: [f64; 2], count: usize) -> Vec<f64> {
        let layout = self.memory.layout();
        let h = end - begin;
        let mut next = next;
        for (stage, time) in TIMES.iter().enumerate().take(count) {
            self.times[stage] = begin + time * h;
            let at = if stage == STAGES - 1 {
                next.get_or_insert_with(|| self.closed(end, self.end_of(state, h))).clone()
            } else {
                self.combined(state, h, stage)
            };
            self.memory.set(self.times[stage], layout.q.start, &at);
            let unknowns = layout.w.start..layout.lambda.end;
            self.guesses[stage].copy_from_slice(self.memory.values(unknowns.clone()));
            if self.is_linear {
                self.memory.solve_acceleration();
            } else {
                self.memory.assembly().accelerate();
            }
            self.unknowns[stage].copy_from_slice(self.memory.values(unknowns));
            self.stages[stage] = at;
        }
        next.unwrap_or_default()
    }

    /// A state plus h times the rates of earlier stages with a stage's weights.
    fn combined(&self, state: &[f64], h: f64, stage: usize) -> Vec<f64> {
        let mut sum = state.to_vec();
        WEIGHTS[stage].iter().for_each(|&(other, weight)| self.add_rate(&mut sum, h * weight, other));
        sum
    }

    /// The end of a step from a state, before it is closed.
    fn end_of(&self, state: &[f64], h: f64) -> Vec<f64> {
        self.combined(state, h, STAGES - 1)
    }

    /// The motion by weights of [`interpolation`] in a step.
    fn dense(&self, state: &[f64], next: &[f64], h: f64, (of_next, of_rates): &DenseWeights) -> Vec<f64> {
        let mut motion: Vec<f64> =
            state.iter().zip(next).map(|(state, next)| state + of_next * (next - state)).collect();
        for (stage, weight) in of_rates.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            self.add_rate(&mut motion, h * weight, stage);
        }
        motion
    }

    /// Adds adjoints of such a motion to those of the states at the step's ends, and of its rates.
    fn pull_dense(&mut self, by: &[f64], h: f64, (of_next, of_rates): &DenseWeights, ends: [&mut [f64]; 2]) {
        let [by_state, by_next] = ends;
        add(by_state, 1.0 - of_next, by);
        add(by_next, *of_next, by);
        for (by_rate, weight) in self.by_rates.iter_mut().zip(of_rates) {
            add(by_rate, h * weight, by);
        }
    }

    /// Adds the rate of a stage times a factor.
    fn add_rate(&self, to: &mut [f64], factor: f64, stage: usize) {
        let half = to.len() / 2;
        let (positions, velocities) = to.split_at_mut(half);
        add(positions, factor, &self.stages[stage][half..]);
        add(velocities, factor, &self.unknowns[stage][..half]);
    }

    /// Adjoints of a stage's state, from those of its rate. Of the stages that were evaluated the last comes first.
    fn pull_stage(&mut self, stage: usize) -> Vec<f64> {
        let layout = self.memory.layout();
        let time = self.times[stage];
        let by_rate = &self.by_rates[stage];
        let half = by_rate.len() / 2;
        self.memory.set(time, layout.q.start, &self.stages[stage]);
        self.memory.add(layout.w.start, &by_rate[half..]);
        if self.is_linear {
            self.memory.set(time, layout.w.start, &self.guesses[stage]);
            self.memory.pull_solved();
        } else {
            self.memory.set(time, layout.w.start, &self.unknowns[stage]);
            self.memory.pull_acceleration();
        }
        let mut by_stage = self.memory.take(layout.q.start..layout.v.end);
        add(&mut by_stage[half..], 1.0, &self.by_rates[stage][..half]);
        by_stage
    }

    /// Shares adjoints of a stage's state, or of the step's end, among the terms of its sum.
    fn share(&mut self, stage: usize, h: f64, by_stage: &[f64], by_state: &mut [f64]) {
        add(by_state, 1.0, by_stage);
        for &(other, weight) in WEIGHTS[stage] {
            add(&mut self.by_rates[other], h * weight, by_stage);
        }
    }

    /// A state moved onto the constraints.
    fn closed(&mut self, time: f64, state: Vec<f64>) -> Vec<f64> {
        if !self.closes {
            return state;
        }
        let layout = self.closures.layout();
        self.closures.set(time, layout.q.start, &state);
        self.closures.close(TUNING.closing_corrections);
        self.closures.values(layout.q.start..layout.v.end).to_vec()
    }

    /// Pulls adjoints through the closure of a state.
    fn pull_closure(&mut self, time: f64, state: &[f64], adjoints: &mut [f64]) {
        if !self.closes {
            return;
        }
        let layout = self.closures.layout();
        self.closures.set(time, layout.q.start, state);
        let closing = self.closures.close(TUNING.closing_corrections);
        self.closures.add(layout.q.start, adjoints);
        self.closures.pull_closing(&closing);
        adjoints.copy_from_slice(&self.closures.take(layout.q.start..layout.v.end));
    }

    /// Pulls adjoints through the change of states at an instant, given the state before.
    fn pull_sampling(&mut self, time: f64, unchanged: &[f64], adjoints: &mut [f64]) {
        let layout = self.closures.layout();
        self.closures.set(time, layout.q.start, unchanged);
        self.closures.assembly().accelerate();
        self.closures.add(layout.q.start, adjoints);
        self.closures.pull_sampling(time);
        self.closures.pull_acceleration();
        adjoints.copy_from_slice(&self.closures.take(layout.q.start..layout.v.end));
    }
}

/// Weights of the change over a step, and of the rates times h.
type DenseWeights = (f64, [f64; WITH_DENSE]);

/// Dense output at a share of the step as a sum: the weight of the change over the step, and those of the rates times
/// h.
fn interpolation(share: f64) -> DenseWeights {
    let rest = 1.0 - share;
    let mut powers = [share; 3 + DENSE.len()];
    for term in 1..powers.len() {
        powers[term] = powers[term - 1] * if term % 2 == 0 { share } else { rest };
    }
    let mut of_rates = [0.0; WITH_DENSE];
    of_rates[0] = powers[1] - powers[2];
    of_rates[STAGES - 1] = -powers[2];
    for (power, row) in powers[3..].iter().zip::<[Row; 4]>(DENSE) {
        row.iter().for_each(|&(stage, weight)| of_rates[stage] += power * weight);
    }
    (powers[0] - powers[1] + 2.0 * powers[2], of_rates)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::drive::Motion;
    use crate::simulate::explicit::runge_kutta::RungeKutta;

    /// x' = v + t², v' = −x²: rates that differ in all stages.
    struct Falling;

    impl Motion for Falling {
        fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]) {
            (into[0], into[1]) = (state[1] + time * time, -state[0] * state[0]);
        }

        fn close(&mut self, _: f64, _: &mut [f64]) {}

        fn sample(&mut self, _: f64, _: &mut [f64]) -> bool {
            false
        }
    }

    /// The sum is the polynomial that the run evaluates.
    #[test]
    fn the_sum_is_the_dense_output() {
        let h = 0.7;
        let mut run = RungeKutta::start(&mut Falling, 0.0, vec![1.0, 0.3]);
        run.attempt(&mut Falling, h);
        run.finish(&mut Falling, h);
        run.prepare_dense(&mut Falling, h);
        for share in [0.1, 0.5, 0.93] {
            let mut interpolated = [0.0; 2];
            run.interpolate(share, &mut interpolated);
            let (of_next, of_rates) = interpolation(share);
            for (line, interpolated) in interpolated.into_iter().enumerate() {
                let rates = of_rates.iter().enumerate().map(|(stage, weight)| weight * run.rates(stage)[line]);
                let sum = run.state[line] + of_next * (run.next[line] - run.state[line]) + h * rates.sum::<f64>();
                assert!((sum - interpolated).abs() < 1e-13, "{sum}, not {}", interpolated);
            }
        }
    }
}
