//! Backwards over steps of the explicit method.
//!
//! A step's end is y + h Σ bᵢ kᵢ, moved onto the constraints, with kᵢ = f(t + cᵢ h, Yᵢ) and Yᵢ = y + h Σ aᵢⱼ kⱼ. The
//! stages are evaluated once more, and followed from the last to the first: k̄ᵢ = h bᵢ ȳ₊ + h Σⱼ aⱼᵢ Ȳⱼ, Ȳᵢ = f_yᵀ k̄ᵢ.
//! Rows within a step are sums of the same kind.

use symdiff::Tile;

use super::runge_kutta::RungeKutta;
use super::tableau::{DENSE, Row, STAGES, TIMES, WEIGHTS, WITH_DENSE};
use super::tuning::TUNING;
use crate::simulate::adjoint::{LaneTerm, RowAdjoints, StartAdjoints, Stepping, TileInputs, TileKernel, TilePath, add};
use crate::simulate::ensemble::{Needs, RowClosure};
use crate::simulate::error::SimulationError;
use crate::simulate::events::EventAdjoints;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// A tile of samples that takes the steps of a list.
#[derive(Debug)]
pub(in crate::simulate) struct ExplicitSteps<'s> {
    simulator: &'s Simulator,
    motion: RowClosure<'s>,
    run: RungeKutta,
    /// Times at which steps end, s.
    ends: Vec<f64>,
    inputs: Option<&'s TileInputs>,
}

impl<'s> ExplicitSteps<'s> {
    /// From an assembled tile.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(
        simulator: &'s Simulator,
        start: &Tile,
        ends: Vec<f64>,
        inputs: Option<&'s TileInputs>,
    ) -> Result<Self, SimulationError> {
        let mut motion = RowClosure::new(simulator, start)?;
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let run = RungeKutta::start(&mut motion, 0.0, state);
        Ok(Self { simulator, motion, run, ends, inputs })
    }

    /// When a step begins, s.
    fn begin(&self, step: usize) -> f64 {
        step.checked_sub(1).map_or(0.0, |before| self.ends[before])
    }
}

impl Stepping for ExplicitSteps<'_> {
    fn state(&self) -> &[f64] {
        &self.run.state
    }

    fn restore(&mut self, step: usize, state: &[f64]) {
        let begin = self.begin(step);
        self.run = RungeKutta::start(&mut self.motion, begin, state.to_vec());
    }

    fn advance(&mut self, step: usize) -> Option<Vec<f64>> {
        let end = self.ends[step];
        if let Some(inputs) = self.inputs {
            self.motion.set_inputs(inputs.values(inputs.cell(end)));
            let before = step.checked_sub(1).map(|before| self.ends[before]);
            if inputs.begins(end, before) {
                let state = std::mem::take(&mut self.run.state);
                self.run = RungeKutta::start(&mut self.motion, before.unwrap_or(0.0), state);
            }
        }
        self.run.attempt(&mut self.motion, end);
        self.run.finish(&mut self.motion, end);
        let unchanged = Instants::of(self.simulator).contain(end).then(|| self.run.next.clone());
        self.run.accept(&mut self.motion, end);
        unchanged
    }
}

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
    /// Of the stages, and of closures.
    memory: StartAdjoints<'s>,
    closures: StartAdjoints<'s>,
    is_linear: bool,
    closes: bool,
    /// Of the step that is followed: times of the stages, s, their states (q and v), their accelerations and
    /// multipliers (w and λ), and the guesses of these.
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
    /// Over the path of an assembled tile.
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

    /// Through events at the ends of steps.
    #[must_use]
    pub fn through(self, events: Option<EventAdjoints<'s>>) -> Self {
        Self { events, ..self }
    }

    /// From the rows, the last first, to the start; the outputs' values are noted in `values` (by lane and term).
    /// Returns adjoints of the start's positions and velocities (2n lines).
    pub fn pull(&mut self, rows: &[ExplicitRow], closing: &mut RowAdjoints, values: &mut [Vec<f64>]) -> Vec<f64> {
        let mut adjoints = vec![0.0; self.path.start().len()];
        let mut rows = rows.iter().peekable();
        for step in (0..self.path.steps()).rev() {
            let (begin, end) = (self.path.stepping().begin(step), self.path.stepping().ends[step]);
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
            let next = unchanged.unwrap_or(after);
            let is_dense = rows.peek().is_some_and(|row| row.time > begin);
            let h = end - begin;
            self.evaluate(&state, &next, step, if is_dense { WITH_DENSE } else { STAGES - 1 });
            self.by_rates.iter_mut().for_each(|by_rate| by_rate.fill(0.0));
            let mut by_state = vec![0.0; state.len()];
            while let Some(row) = rows.next_if(|row| row.time > begin) {
                let (of_next, of_rates) = interpolation((row.time - begin) / h);
                let mut motion: Vec<f64> =
                    state.iter().zip(&next).map(|(state, next)| state + of_next * (next - state)).collect();
                for (stage, weight) in of_rates.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                    self.add_rate(&mut motion, h * weight, stage);
                }
                let by_motion = of_row(row, &motion);
                add(&mut by_state, 1.0 - of_next, &by_motion);
                add(&mut adjoints, of_next, &by_motion);
                for (by_rate, weight) in self.by_rates.iter_mut().zip(of_rates) {
                    add(by_rate, h * weight, &by_motion);
                }
            }
            for stage in (STAGES..WITH_DENSE).rev().filter(|_| is_dense) {
                let by_stage = self.pull_stage(stage);
                self.share(stage, h, &by_stage, &mut by_state);
            }
            if is_dense {
                let by_next = self.pull_stage(STAGES - 1);
                add(&mut adjoints, 1.0, &by_next);
            }
            self.pull_closure(end, h, &state, &mut adjoints);
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

    /// The stages of a step, given the states at its ends.
    fn evaluate(&mut self, state: &[f64], next: &[f64], step: usize, count: usize) {
        let layout = self.memory.layout();
        let begin = self.path.stepping().begin(step);
        let h = self.path.stepping().ends[step] - begin;
        for stage in 0..count {
            let mut at = if stage == STAGES - 1 { next.to_vec() } else { state.to_vec() };
            for &(other, weight) in if stage == STAGES - 1 { &[][..] } else { WEIGHTS[stage] } {
                self.add_rate(&mut at, h * weight, other);
            }
            self.times[stage] = begin + TIMES[stage] * h;
            if let Some(events) = &mut self.events {
                events.keep_before(step, &mut self.times[stage], &mut at);
            }
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

    /// Through the closure of a step's end, given the state at its beginning.
    fn pull_closure(&mut self, end: f64, h: f64, state: &[f64], adjoints: &mut [f64]) {
        if !self.closes {
            return;
        }
        let layout = self.closures.layout();
        let mut next = state.to_vec();
        for &(stage, weight) in WEIGHTS[STAGES - 1] {
            self.add_rate(&mut next, h * weight, stage);
        }
        self.closures.set(end, layout.q.start, &next);
        let closing = self.closures.close(TUNING.closing_corrections);
        self.closures.add(layout.q.start, adjoints);
        self.closures.pull_closing(&closing);
        adjoints.copy_from_slice(&self.closures.take(layout.q.start..layout.v.end));
    }

    /// Through the change of states at an instant, given the state before.
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

/// Dense output at a share of the step as a sum: the weight of the change over the step, and those of the rates times
/// h.
fn interpolation(share: f64) -> (f64, [f64; WITH_DENSE]) {
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
