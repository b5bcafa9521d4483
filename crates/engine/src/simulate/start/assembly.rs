//! Assembly: positions on the constraints, and velocities, accelerations and multipliers consistent with them.

use symdiff::{Tape, Tile};

use super::settling::Settling;
use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::{ClosureRow, Residual, StartProgram, Tapes};

/// Largest residual at which a constraint holds, given the coordinates' scales.
pub fn allowed_residual(scale: &[f64]) -> f64 {
    TUNING.closed_constraint * scale.iter().copied().fold(1.0, f64::min)
}

/// The largest constraint residual of a sample that cannot be assembled.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintResidual {
    /// Lane of the tile.
    pub lane: usize,
    /// The constraint or the condition of the start with the largest residual.
    pub row: ClosureRow,
    /// Its residual: m, rad, or m/s, rad/s for velocities.
    pub residual: f64,
    /// Whether positions are consistent and velocities are not.
    pub of_velocities: bool,
}

/// Start values of a tile of samples: a state for each lane.
#[derive(Debug)]
pub struct Assembly<'p> {
    program: &'p StartProgram,
    scale: Vec<f64>,
    tile: Tile,
    settling: Settling,
}

impl<'p> Assembly<'p> {
    /// Assembly of tiles of this width at t = 0. `parameters` holds k values a lane, parameter by parameter.
    pub fn new(
        program: &'p StartProgram,
        system: &System,
        width: usize,
        parameters: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let tile = Tile::new(width, program.registers(), program.constants());
        let scale = system.coordinates.iter().map(|coordinate| coordinate.scale).collect();
        let mut assembly = Self { program, scale, tile, settling: Settling::new(width) };
        assembly.set_parameters(parameters);
        assembly
    }

    /// Sets other parameters.
    pub fn set_parameters(&mut self, parameters: impl Fn(usize, usize) -> f64) {
        for (parameter, register) in self.program.layout.parameters.clone().enumerate() {
            for lane in 0..self.tile.width() {
                self.tile.lane_mut(register)[lane] = parameters(parameter, lane);
            }
        }
        self.tile.run(self.program.sample());
    }

    /// Sets the same state in every lane.
    pub fn set_state(&mut self, state: &[f64]) {
        for register in self.program.layout.state() {
            self.tile.lane_mut(register).fill(state[register]);
        }
    }

    /// Corrects the present positions for other parameters.
    pub fn follow(&mut self, parameters: impl Fn(usize, usize) -> f64) {
        self.set_parameters(parameters);
        self.tile.run(self.program.given());
        self.correct_until_settled(self.program.position(), self.program.layout.q.start);
    }

    /// Lanes that have a coordinate far from that of a state.
    pub fn far_from(&self, state: &[f64]) -> Vec<bool> {
        let is_far = |lane: usize| {
            let places = self.program.layout.q.clone().zip(&self.scale);
            // NaN is far.
            !places.into_iter().all(|(register, scale)| {
                (self.tile.lane(register)[lane] - state[register]).abs() <= TUNING.far_sample * scale
            })
        };
        (0..self.tile.width()).map(is_far).collect()
    }

    /// Copies some lanes of another assembly.
    pub fn copy_lanes(&mut self, other: &Self, lanes: &[usize]) {
        for register in 0..self.program.registers() {
            for &lane in lanes {
                self.tile.lane_mut(register)[lane] = other.tile.lane(register)[lane];
            }
        }
    }

    /// The memory, to set the values to start from.
    pub fn tile_mut(&mut self) -> &mut Tile {
        &mut self.tile
    }

    /// The assembled states, register by register as in the program's layout.
    pub fn tile(&self) -> &Tile {
        &self.tile
    }

    /// Assembles the one lane from the model's guess, or from guesses spread ever wider around it.
    ///
    /// # Errors
    /// The smallest of the guesses' largest residuals.
    pub fn assemble_nominal(&mut self) -> Result<(), ConstraintResidual> {
        let mut best: Option<ConstraintResidual> = None;
        for guess in 0..TUNING.guesses {
            self.tile.run(self.program.guess());
            let spread = 3.0 * guess as f64 / TUNING.guesses as f64;
            for (index, register) in self.program.layout.q.clone().enumerate() {
                // Additive recurrence: evenly spread, the same on every machine.
                let direction = 2.0 * ((guess * (2 * index + 1)) as f64 * 0.618_033_988_749_895).fract() - 1.0;
                self.tile.lane_mut(register)[0] += spread * self.scale[index] * direction;
            }
            self.tile.run(self.program.given());
            match self.descend() {
                Ok(()) => return self.complete().into_iter().next().map_or(Ok(()), Err),
                Err(worst)
                    if best
                        .as_ref()
                        .is_none_or(|best| worst.residual.abs() < best.residual.abs() || best.residual.is_nan()) =>
                {
                    best = Some(worst)
                }
                Err(_) => {}
            }
        }
        // `GUESSES` is not zero.
        Err(best.expect("at least one guess was tried"))
    }

    /// Assembles the one lane nearest to rest, from an assembled state.
    ///
    /// # Errors
    /// The largest residual, where the corrections do not end at one.
    pub fn assemble_nearest(&mut self, nominal: &[f64]) -> Result<(), ConstraintResidual> {
        self.set_state(nominal);
        self.tile.run(self.program.given());
        let (q, correction) = (self.program.layout.q.clone(), self.program.layout.correction.start);
        for _ in 0..TUNING.max_nominal_corrections {
            self.tile.run(self.program.position());
            let changes = self.tile.values()[correction..][..q.len()].to_vec();
            let largest = changes.iter().zip(&self.scale).map(|(c, s)| (c / s).abs()).fold(0.0, f64::max);
            if largest <= TUNING.reach_of_corrections {
                break;
            }
            let share = TUNING.reach_of_corrections / largest;
            q.clone().zip(changes).for_each(|(register, change)| self.tile.lane_mut(register)[0] += share * change);
        }
        self.assemble().into_iter().next().map_or(Ok(()), Err)
    }

    /// Assembles every lane from `nominal`, an assembled state of one lane. Returns the largest residual of each lane
    /// that cannot be assembled, lane by lane.
    pub fn assemble_from(&mut self, nominal: &[f64]) -> Vec<ConstraintResidual> {
        self.set_state(nominal);
        self.assemble()
    }

    /// Assembles every lane from its present state. Returns the largest residual of each lane that cannot be assembled.
    pub fn assemble(&mut self) -> Vec<ConstraintResidual> {
        self.tile.run(self.program.given());
        self.correct_until_settled(self.program.position(), self.program.layout.q.start);
        self.complete()
    }

    /// Velocities, accelerations and multipliers for assembled positions. Returns the largest residual of each lane
    /// that has none.
    fn complete(&mut self) -> Vec<ConstraintResidual> {
        let program = self.program;
        self.tile.run(program.position());
        let mut open = self.open_lanes(&program.constraint, false);
        for register in program.layout.v.clone() {
            self.tile.lane_mut(register).fill(0.0);
        }
        self.tile.run(program.given());
        // `given` sets positions too: to the values they have already.
        self.correct_until_settled(program.velocity(), program.layout.v.start);
        self.tile.run(program.velocity());
        open.extend(self.open_lanes(&program.constraint_rate, true));
        // If positions are inconsistent, velocities mean nothing.
        open.sort_by_key(|residual| (residual.lane, residual.of_velocities));
        open.dedup_by_key(|residual| residual.lane);
        for register in program.layout.w.start..program.layout.lambda.end {
            self.tile.lane_mut(register).fill(0.0);
        }
        self.accelerate();
        if !program.sampled.is_empty() {
            self.sample();
            self.accelerate();
        }
        open
    }

    /// Gives the states that change at instants their new values, where the tile's time is one of theirs.
    pub fn sample(&mut self) {
        let time = self.tile.lane(self.program.layout.time)[0];
        self.tile.run(self.program.sampling());
        let due = || self.program.sampled.iter().filter(|sampled| sampled.is_due(time));
        // All are taken before one changes: a value may be another of these states.
        let values: Vec<Vec<f64>> = due().map(|sampled| self.tile.lane(sampled.value).to_vec()).collect();
        for (sampled, values) in due().zip(values) {
            self.tile.lane_mut(sampled.state).copy_from_slice(&values);
        }
    }

    /// Corrects the velocities of a motion at the tile's positions and time. Returns which lanes have settled.
    pub fn project_velocities(&mut self) -> Vec<bool> {
        self.correct_until_settled(self.program.projection(), self.program.layout.v.start)
    }

    /// Accelerations and multipliers at the tile's positions, velocities and time. Returns which lanes have settled.
    pub fn accelerate(&mut self) -> Vec<bool> {
        self.correct_until_settled(self.program.acceleration(), self.program.layout.w.start)
    }

    /// a = w(t + shift) to first order: the accelerations of the state moved there.
    pub fn shift_accelerations(&mut self, shift: f64) {
        let layout = &self.program.layout;
        let time = self.tile.lane(layout.time)[0];
        let state: Vec<f64> =
            self.tile.values()[layout.q.start * self.tile.width()..layout.lambda.end * self.tile.width()].to_vec();
        for ((q, v), w) in layout.q.clone().zip(layout.v.clone()).zip(layout.w.clone()) {
            for lane in 0..self.tile.width() {
                let (speed, acceleration) = (self.tile.lane(v)[lane], self.tile.lane(w)[lane]);
                self.tile.lane_mut(q)[lane] += shift * (speed + 0.5 * shift * acceleration);
                self.tile.lane_mut(v)[lane] += shift * acceleration;
            }
        }
        self.tile.lane_mut(layout.time).fill(time + shift);
        self.accelerate();
        let shifted: Vec<f64> = self.tile.block(layout.w.clone()).to_vec();
        self.tile.block_mut(layout.q.start..layout.lambda.end).copy_from_slice(&state);
        self.tile.block_mut(layout.a.clone()).copy_from_slice(&shifted);
        self.tile.lane_mut(layout.time).fill(time);
    }

    /// Damped Gauss–Newton of a single lane.
    pub fn descend(&mut self) -> Result<(), ConstraintResidual> {
        let program = self.program;
        let q = program.layout.q.clone();
        self.tile.run(program.position());
        let mut size = self.constraint_norm();
        let mut damping = 1.0_f64;
        for _ in 0..TUNING.max_nominal_corrections {
            let before = self.tile.values()[q.clone()].to_vec();
            let correction = self.tile.values()[program.layout.correction.start..][..q.len()].to_vec();
            let largest = correction.iter().zip(&self.scale).map(|(c, s)| (c / s).abs()).fold(0.0, f64::max);
            if !size.is_finite() || !largest.is_finite() {
                break;
            }
            if largest < TUNING.settled {
                break;
            }
            // No coordinate turns or moves by more than about its own scale at once.
            damping = damping.min(1.0 / largest);
            loop {
                for ((register, old), change) in q.clone().zip(&before).zip(&correction) {
                    self.tile.lane_mut(register)[0] = old + damping * change;
                }
                self.tile.run(program.position());
                let new = self.constraint_norm();
                if new < size || new <= f64::EPSILON || damping < 1e-6 {
                    size = new;
                    break;
                }
                damping *= 0.5;
            }
            damping = (2.0 * damping).min(1.0);
        }
        self.open_lanes(&program.constraint, false).into_iter().next().map_or(Ok(()), Err)
    }

    fn constraint_norm(&self) -> f64 {
        let residuals = self.program.constraint.iter();
        residuals.map(|residual| self.tile.lane(residual.register)[0].powi(2)).sum::<f64>().sqrt()
    }

    /// Positions, velocities, accelerations and multipliers of the one lane at its time, from its present state.
    /// Returns whether there are any.
    pub fn close(&mut self) -> bool {
        let program = self.program;
        if !self.correct_until_settled(program.position(), program.layout.q.start)[0] {
            return false;
        }
        self.tile.run(program.position());
        let is_closed = self.open_lanes(&program.constraint, false).is_empty();
        self.correct_until_settled(program.velocity(), program.layout.v.start);
        let settled = self.correct_until_settled(program.acceleration(), program.layout.w.start)[0];
        is_closed && settled
    }

    /// Evaluates the outputs.
    pub fn observe(&mut self) {
        self.tile.run(self.program.observe());
    }

    /// The tapes.
    pub fn program(&self) -> &'p StartProgram {
        self.program
    }

    /// Scale of every coordinate.
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }

    /// Full corrections of the values from register `start` on, until every lane has settled or the corrections are
    /// used up. Returns which lanes have settled.
    pub fn correct_until_settled(&mut self, tape: &Tape, start: usize) -> Vec<bool> {
        let layout = &self.program.layout;
        let count = if start == layout.w.start { layout.correction.len() } else { self.scale.len() };
        let corrections = layout.correction.start;
        self.settling.begin();
        for _ in 0..TUNING.max_corrections {
            self.tile.run(tape);
            if !self.settling.apply(&mut self.tile, start, corrections, count, &self.scale) {
                break;
            }
        }
        self.settling.settled()
    }

    /// The largest residual of each lane with a constraint that does not hold.
    fn open_lanes(&self, residuals: &[Residual], of_velocities: bool) -> Vec<ConstraintResidual> {
        let allowed = allowed_residual(&self.scale);
        let of_lane = |lane: usize| {
            let residuals = residuals.iter().map(|residual| (residual.row, self.tile.lane(residual.register)[lane]));
            let worst = residuals.reduce(|a, b| if b.1.abs() <= a.1.abs() || a.1.is_nan() { a } else { b });
            // NaN does not hold either.
            let open = worst.filter(|(_, residual)| residual.is_nan() || residual.abs() > allowed);
            open.map(|(row, residual)| ConstraintResidual { lane, row, residual, of_velocities })
        };
        (0..self.tile.width()).filter_map(of_lane).collect()
    }
}
