//! The stepper: one step of HHT-I3, or of another scheme of its family, for a tile of samples.

use symdiff::Tile;

use super::local_error::{LocalError, measure_errors};
use super::newton::{Counters, Newton};
use super::pace::Pace;
use super::tuning::TUNING;
use crate::assemble::EquationId;
use crate::compile::{Program, Tapes};

/// A step that failed for a sample, however short its substeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFailure {
    /// Lane of the tile.
    pub lane: usize,
    /// Time of the step's end, s.
    pub time: f64,
    /// The equation with the largest scaled residual.
    pub equation: EquationId,
}

/// The states of a tile of samples, advanced together.
#[derive(Clone, Debug)]
pub struct Stepper<'p> {
    program: &'p Program,
    tile: Tile,
    newton: Newton,
    /// Step size that a belongs to; NaN before the first step.
    step_size: f64,
    /// Step size that the tile's step-size stage was run for.
    prepared_size: f64,
    /// Times of lanes, if they have their own.
    pace: Option<Pace>,
    /// Whether a lane still runs.
    alive: Vec<bool>,
    /// Whether steps end with accelerations that are as accurate as positions.
    refines: bool,
    /// Local errors, if they are estimated.
    errors: Option<Vec<LocalError>>,
}

impl<'p> Stepper<'p> {
    /// A tile with the states and parameters of `start`, whose first registers have the same layout.
    pub fn new(program: &'p Program, start: &Tile) -> Self {
        let width = start.width();
        let mut tile = Tile::new(width, program.registers(), program.constants());
        let shared = program.layout.registers() * width;
        tile.values_mut()[..shared].copy_from_slice(&start.values()[..shared]);
        tile.run(program.sample());
        Self {
            program,
            tile,
            newton: Newton::new(width),
            step_size: f64::NAN,
            prepared_size: f64::NAN,
            pace: None,
            alive: vec![true; width],
            refines: false,
            errors: None,
        }
    }

    /// The memory: states between steps.
    pub fn tile(&self) -> &Tile {
        &self.tile
    }

    /// The memory, to restore a saved state.
    pub fn tile_mut(&mut self) -> &mut Tile {
        &mut self.tile
    }

    /// The layout's registers of one lane.
    pub(in crate::simulate) fn lane(&self, lane: usize) -> Vec<f64> {
        (0..self.program.layout.registers()).map(|register| self.tile.lane(register)[lane]).collect()
    }

    /// [`lane`](Self::lane) without a new allocation.
    pub(in crate::simulate) fn copy_lane(&self, lane: usize, into: &mut Vec<f64>) {
        into.clear();
        let registers = self.tile.block(0..self.program.layout.registers());
        into.extend(registers.iter().skip(lane).step_by(self.tile.width()));
    }

    /// Largest |1/pivot| of a lane's last factors, over the largest that is trusted.
    pub fn pivot_loss(&self, lane: usize) -> f64 {
        let value = |register: usize| self.tile.lane(register)[lane];
        let watched = self.program.watched.iter();
        let used = watched.filter(|watched| watched.mode.is_none_or(|mode| mode.holds(value(mode.register))));
        used.flat_map(|watched| &watched.pivots)
            .map(|pivot| self.tile.lane(pivot.register)[lane].abs() / pivot.largest_inverse)
            .fold(0.0, f64::max)
    }

    /// Number of coordinates, n.
    pub fn coordinates(&self) -> usize {
        self.program.layout.q.len()
    }

    /// Which lanes still run.
    pub fn alive(&self) -> &[bool] {
        &self.alive
    }

    /// Stops lanes, such as those without a sample of their own.
    pub fn retire(&mut self, lanes: std::ops::Range<usize>) {
        self.alive[lanes].fill(false);
    }

    /// Restores a saved state in all lanes; its a belongs to steps of length h.
    pub fn rewind(&mut self, saved: &[f64], h: f64) {
        self.restore_lanes(saved, |_| true);
        self.step_size = h;
    }

    /// Goes on from a saved state whose a belongs to steps of length h, and knows no steps before it.
    pub(in crate::simulate) fn restart(&mut self, saved: &[f64], h: f64) {
        self.rewind(saved, h);
        self.newton.forget();
    }

    /// Gives lanes times of their own: lengths and ends of steps are shares from now on. Accelerations of the steps
    /// before are those of other times.
    pub(in crate::simulate) fn set_pace(&mut self, pace: &Pace) {
        self.newton.set_lengths(&pace.length);
        self.prepared_size = f64::NAN;
        self.pace = Some(pace.clone());
    }

    /// Whether a lane's last step took the rank-revealing solve.
    pub(in crate::simulate) fn is_singular(&self, lane: usize) -> bool {
        self.newton.is_singular(lane)
    }

    /// Whether steps from now on take one more correction, after which accelerations are as accurate as positions.
    pub(in crate::simulate) fn refine(&mut self, refines: bool) {
        self.refines = refines;
    }

    /// Whether steps take one more correction ([`refine`](Self::refine)).
    pub(in crate::simulate) fn refines(&self) -> bool {
        self.refines
    }

    /// Takes the state of a stepper of one lane, whose a belongs to steps of the same length.
    pub(in crate::simulate) fn set_lane(&mut self, lane: usize, alone: &Self) {
        for register in self.program.layout.state() {
            self.tile.lane_mut(register)[lane] = alone.tile.lane(register)[0];
        }
    }

    /// Length of the step before, to which a belongs, s.
    pub(in crate::simulate) fn step_size(&self) -> f64 {
        self.step_size
    }

    /// Goes on with other velocities, accelerations and multipliers, where those are finite.
    pub(in crate::simulate) fn begin_anew(&mut self, from: &Tile) {
        let layout = &self.program.layout;
        for register in layout.v.start..layout.lambda.end {
            let values = self.tile.lane_mut(register).iter_mut().zip(from.lane(register));
            values.filter(|(_, new)| new.is_finite()).for_each(|(value, new)| *value = *new);
        }
        self.newton.forget();
    }

    /// Counts the work of another stepper for this one since it had counted `before`.
    pub(in crate::simulate) fn count_since(&mut self, now: Counters, before: Counters) {
        self.newton.counters.iterations += now.iterations - before.iterations;
        self.newton.counters.rank_revealing += now.rank_revealing - before.rank_revealing;
    }

    /// Newton iterations and rank-revealing solves so far.
    pub fn counters(&self) -> Counters {
        self.newton.counters
    }

    /// One step of length h to time t₊. A lane that does not converge is stepped alone with substeps; lanes that fail
    /// even then are returned and no longer run.
    pub fn step(&mut self, h: f64, end: f64) -> Vec<StepFailure> {
        let mut converged = self.try_step(h, end);
        let mut failures = Vec::new();
        if converged != self.alive {
            for lane in (0..converged.len()).filter(|&lane| self.alive[lane] && !converged[lane]).collect::<Vec<_>>() {
                match self.substep(lane, h, end) {
                    Ok(()) => converged[lane] = true,
                    Err(equation) => failures.push(StepFailure { lane, time: end, equation }),
                }
            }
        }
        self.alive = converged;
        failures
    }

    /// One step without substeps. Returns which of the running lanes converged and advanced; the others keep their
    /// state.
    pub fn try_step(&mut self, h: f64, end: f64) -> Vec<bool> {
        let converged = self.solve(h, end);
        if let Some(errors) = &mut self.errors {
            measure_errors(self.program, &mut self.tile, &self.newton, h, errors);
        }
        if converged != self.alive {
            let state = self.save();
            self.finish();
            self.restore_lanes(&state, |lane| !converged[lane]);
        } else {
            self.finish();
        }
        converged
    }

    /// One step without substeps, after which the motion of lanes that do not converge is unknown.
    pub(in crate::simulate) fn advance_or_lose(&mut self, h: f64, end: f64) {
        let converged = self.try_step(h, end);
        for lane in (0..converged.len()).filter(|&lane| !converged[lane]) {
            for register in self.program.layout.state() {
                self.tile.lane_mut(register)[lane] = f64::NAN;
            }
        }
    }

    /// First half of a step: solves for the state at its end. Returns which of the running lanes converged.
    pub(in crate::simulate) fn solve(&mut self, h: f64, end: f64) -> Vec<bool> {
        self.set_step_size(h);
        self.set_time(end);
        self.tile.run(self.program.step());
        let mut converged = self.alive.clone();
        self.newton.solve(self.program, &mut self.tile, h, self.refines, &mut converged);
        converged
    }

    fn set_time(&mut self, end: f64) {
        let times = self.tile.lane_mut(self.program.layout.time);
        match &self.pace {
            None => times.fill(end),
            Some(pace) => pace.set_times(end, times),
        }
    }

    /// Second half of a step: the state becomes the one at the step's end.
    pub(in crate::simulate) fn finish(&mut self) {
        self.tile.run(self.program.advance());
    }

    /// The states q, v, a, w, λ of all lanes.
    pub fn save(&self) -> Vec<f64> {
        let state = self.program.layout.state();
        self.tile.values()[state.start * self.tile.width()..state.end * self.tile.width()].to_vec()
    }

    /// Restores saved states in the chosen lanes.
    pub fn restore_lanes(&mut self, saved: &[f64], chosen: impl Fn(usize) -> bool) {
        let width = self.tile.width();
        for (register, values) in self.program.layout.state().zip(saved.chunks_exact(width)) {
            for lane in (0..width).filter(|&lane| chosen(lane)) {
                self.tile.lane_mut(register)[lane] = values[lane];
            }
        }
    }

    /// Runs the step-size stage where h differs, and moves a ≈ w(t + Δh) to the new Δh, along the line through a and w.
    pub fn set_step_size(&mut self, h: f64) {
        let layout = &self.program.layout;
        if self.step_size.is_finite() && self.step_size != h {
            let ratio = h / self.step_size;
            for (a, w) in layout.a.clone().zip(layout.w.clone()) {
                for lane in 0..self.tile.width() {
                    let exact = self.tile.lane(w)[lane];
                    let algorithmic = &mut self.tile.lane_mut(a)[lane];
                    *algorithmic = exact + ratio * (*algorithmic - exact);
                }
            }
        }
        self.step_size = h;
        if self.prepared_size != h {
            let steps = self.tile.lane_mut(layout.step);
            match &self.pace {
                None => steps.fill(h),
                Some(pace) => pace.set_steps(h, steps),
            }
            self.tile.run(self.program.step_size());
            self.prepared_size = h;
        }
    }

    /// Steps one lane alone, with ever shorter substeps.
    ///
    /// # Errors
    /// The equation with the largest scaled residual of the last attempt.
    fn substep(&mut self, lane: usize, h: f64, end: f64) -> Result<(), EquationId> {
        let layout = &self.program.layout;
        let mut alone = Tile::new(1, self.program.registers(), self.program.constants());
        for register in 0..layout.registers() {
            alone.lane_mut(register)[0] = self.tile.lane(register)[lane];
        }
        let mut single = Stepper::new(self.program, &alone);
        let start = single.save();
        single.refines = self.refines;
        single.errors = self.errors.as_ref().map(|_| vec![LocalError::default()]);
        for halvings in 1..=TUNING.max_halvings {
            let parts = 1_u32 << halvings;
            single.rewind(&start, h);
            let part = h / f64::from(parts);
            let [mut size, mut whole] = [0.0; 2];
            let done = (1..=parts).all(|count| {
                let converged = single.try_step(part, end - f64::from(parts - count) * part)[0];
                let error = single.local_errors().first().copied().unwrap_or_default();
                size += error.size;
                whole += error.whole;
                converged
            });
            if done {
                for (error_of, last) in self.errors.iter_mut().zip(&single.errors) {
                    error_of[lane] = LocalError { size, whole, ..last[0] };
                }
                // Back to the schedule's step size, so that a fits it.
                single.set_step_size(h);
                self.set_lane(lane, &single);
                self.count_since(single.counters(), Counters::default());
                return Ok(());
            }
        }
        Err(single.worst_equation(0))
    }

    /// The equation with the largest scaled residual at a lane's iterate.
    pub(in crate::simulate) fn worst_equation(&mut self, lane: usize) -> EquationId {
        self.tile.run(self.program.matrix());
        let sizes = self.program.residual.iter().zip(&self.program.equilibration);
        let sizes = sizes.map(|(&register, scale)| (self.tile.lane(register)[lane] * scale).abs());
        let sizes = sizes.map(|size| if size.is_nan() { f64::INFINITY } else { size });
        let worst = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        EquationId::new(worst.map_or(0, |(equation, _)| equation))
    }

    /// Estimates the local error of every step from now on.
    pub fn estimate_errors(&mut self) {
        self.errors = Some(vec![LocalError::default(); self.tile.width()]);
    }

    /// Local errors of the lanes in the last step; empty unless they are estimated.
    pub fn local_errors(&self) -> &[LocalError] {
        self.errors.as_deref().unwrap_or_default()
    }

    /// Values of the outputs now: output by output, lane by lane; NaN for lanes that no longer run.
    pub fn observe(&mut self, into: &mut [f64]) {
        self.tile.run(self.program.observe());
        self.copy(self.program.outputs.iter().copied(), into);
    }

    /// Positions and velocities now: coordinate by coordinate, lane by lane.
    pub(in crate::simulate) fn motion(&self) -> &[f64] {
        self.tile.block(self.program.layout.q.start..self.program.layout.v.end)
    }

    /// Positions and velocities of a lane now.
    pub(in crate::simulate) fn motion_of(&self, lane: usize) -> impl Iterator<Item = &f64> {
        let layout = &self.program.layout;
        self.tile.block(layout.q.start..layout.v.end).iter().skip(lane).step_by(self.tile.width())
    }

    /// Positions and velocities now: coordinate by coordinate, lane by lane; NaN for lanes that no longer run.
    pub fn copy_motion(&self, into: &mut [f64]) {
        let layout = &self.program.layout;
        self.copy(layout.q.clone().chain(layout.v.clone()), into);
    }

    fn copy(&self, registers: impl Iterator<Item = usize>, into: &mut [f64]) {
        for (row, register) in into.chunks_exact_mut(self.tile.width()).zip(registers) {
            row.copy_from_slice(self.tile.lane(register));
            row.iter_mut().zip(&self.alive).filter(|(_, alive)| !**alive).for_each(|(value, _)| *value = f64::NAN);
        }
    }
}
