//! One step of HHT-I3, or of another scheme of its family, for a tile of samples.

use symdiff::Tile;

use super::newton::{Counters, Newton};
use crate::program::Program;

/// A step that fails is divided into 2, 4, … up to 2 to the power of this many before it is given up.
const MAX_HALVINGS: u32 = 10;

/// A sample that could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuck {
    /// Lane of the tile.
    pub lane: usize,
    /// Time of the step's end, s.
    pub time: f64,
    /// Equation (of n + m) with the largest scaled residual.
    pub equation: usize,
}

/// Samples in step: the states of a tile, advanced together.
#[derive(Clone, Debug)]
pub struct Stepper<'p> {
    program: &'p Program,
    tile: Tile,
    newton: Newton,
    /// Step size that a belongs to; not a number before the first step.
    step_size: f64,
    /// Step size that the tile's step-size stage was run for.
    prepared_size: f64,
    /// Whether a lane still runs.
    alive: Vec<bool>,
}

impl<'p> Stepper<'p> {
    /// A tile in the states (and with the parameters) of `start`, whose first slots are laid out alike.
    pub fn new(program: &'p Program, start: &Tile) -> Self {
        let width = start.width();
        let mut tile = Tile::new(width, program.slots(), program.constants());
        let shared = program.layout.slots() * width;
        tile.values_mut()[..shared].copy_from_slice(&start.values()[..shared]);
        tile.run(program.sample());
        Self {
            program,
            tile,
            newton: Newton::new(width),
            step_size: f64::NAN,
            prepared_size: f64::NAN,
            alive: vec![true; width],
        }
    }

    /// The memory: states between steps.
    pub fn tile(&self) -> &Tile {
        &self.tile
    }

    /// The memory, to put back a state that was saved.
    pub fn tile_mut(&mut self) -> &mut Tile {
        &mut self.tile
    }

    /// Number of coordinates, n.
    pub fn coordinates(&self) -> usize {
        self.program.layout.q.len()
    }

    /// Which lanes still run.
    pub fn alive(&self) -> &[bool] {
        &self.alive
    }

    /// Lanes that carry no sample of their own stop running.
    pub fn retire(&mut self, lanes: std::ops::Range<usize>) {
        self.alive[lanes].fill(false);
    }

    /// All lanes back to a state that was saved; its a belongs to steps of length h.
    pub fn rewind(&mut self, saved: &[f64], h: f64) {
        self.restore_lanes(saved, |_| true);
        self.step_size = h;
    }

    /// What Newton's iteration took so far.
    pub fn counters(&self) -> Counters {
        self.newton.counters
    }

    /// One step of length h to time t₊. A lane that does not converge is stepped alone, with smaller steps; those that
    /// cannot be helped are returned and no longer run.
    pub fn step(&mut self, h: f64, end: f64) -> Vec<Stuck> {
        let mut converged = self.try_step(h, end);
        let mut stuck = Vec::new();
        if converged != self.alive {
            for lane in (0..converged.len()).filter(|&lane| self.alive[lane] && !converged[lane]).collect::<Vec<_>>() {
                match self.rescue(lane, h, end) {
                    Ok(()) => converged[lane] = true,
                    Err(equation) => stuck.push(Stuck { lane, time: end, equation }),
                }
            }
        }
        self.alive = converged;
        stuck
    }

    /// One step without rescue: which of the running lanes converged and advanced. Those that did not keep their state.
    pub fn try_step(&mut self, h: f64, end: f64) -> Vec<bool> {
        let converged = self.solve(h, end);
        if converged != self.alive {
            let state = self.save();
            self.finish();
            self.restore_lanes(&state, |lane| !converged[lane]);
        } else {
            self.finish();
        }
        converged
    }

    /// First half of a step: solves for its end. Which of the running lanes converged.
    pub(super) fn solve(&mut self, h: f64, end: f64) -> Vec<bool> {
        self.set_step_size(h);
        self.tile.lane_mut(self.program.layout.time).fill(end);
        self.tile.run(self.program.step());
        let mut converged = self.alive.clone();
        self.newton.solve(self.program, &mut self.tile, h, &mut converged);
        converged
    }

    /// Second half: the state becomes the one at the step's end.
    pub(super) fn finish(&mut self) {
        self.tile.run(self.program.advance());
    }

    /// The states q, v, a, w, λ of all lanes.
    pub fn save(&self) -> Vec<f64> {
        let state = self.program.layout.state();
        self.tile.values()[state.start * self.tile.width()..state.end * self.tile.width()].to_vec()
    }

    /// Puts saved states back into the chosen lanes.
    pub fn restore_lanes(&mut self, saved: &[f64], chosen: impl Fn(usize) -> bool) {
        let width = self.tile.width();
        for (slot, values) in self.program.layout.state().zip(saved.chunks_exact(width)) {
            for lane in (0..width).filter(|&lane| chosen(lane)) {
                self.tile.lane_mut(slot)[lane] = values[lane];
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
            self.tile.lane_mut(layout.step).fill(h);
            self.tile.run(self.program.step_size());
            self.prepared_size = h;
        }
    }

    /// One lane alone, the step divided ever finer. Returns the equation that resists.
    fn rescue(&mut self, lane: usize, h: f64, end: f64) -> Result<(), usize> {
        let layout = &self.program.layout;
        let mut alone = Tile::new(1, self.program.slots(), self.program.constants());
        for slot in 0..layout.slots() {
            alone.lane_mut(slot)[0] = self.tile.lane(slot)[lane];
        }
        let mut single = Stepper::new(self.program, &alone);
        let start = single.save();
        for halvings in 1..=MAX_HALVINGS {
            let parts = 1_u32 << halvings;
            single.rewind(&start, h);
            let part = h / f64::from(parts);
            let done = (1..=parts).all(|count| single.try_step(part, end - f64::from(parts - count) * part)[0]);
            if done {
                // Back to the schedule's step size, so that a fits it.
                single.set_step_size(h);
                for slot in layout.state() {
                    self.tile.lane_mut(slot)[lane] = single.tile.lane(slot)[0];
                }
                self.newton.counters.iterations += single.newton.counters.iterations;
                self.newton.counters.rank_revealing += single.newton.counters.rank_revealing;
                return Ok(());
            }
        }
        Err(single.worst_equation())
    }

    /// The equation with the largest residual at the iterate, each against its scale.
    pub(super) fn worst_equation(&mut self) -> usize {
        self.tile.run(self.program.matrix());
        let sizes = self.program.residual.iter().zip(&self.program.equilibration);
        let sizes = sizes.map(|(&slot, scale)| (self.tile.lane(slot)[0] * scale).abs());
        let sizes = sizes.map(|size| if size.is_nan() { f64::INFINITY } else { size });
        sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(equation, _)| equation)
    }

    /// Largest local position error of each running lane in the step just taken, relative to max(1, |q|) and the
    /// coordinate's scale: (β + Δ/2 − 1/6) h² (a₊ − a), with the state before the step given, saved after
    /// [`set_step_size`](Self::set_step_size).
    pub fn local_error(&self, before: &[f64], h: f64) -> Vec<f64> {
        let layout = &self.program.layout;
        let width = self.tile.width();
        let gain = self.program.coefficients.error_gain(h).abs();
        let algorithmic = &before[(layout.a.start - layout.q.start) * width..];
        let mut errors = vec![0.0_f64; width];
        for (place, (q, a)) in layout.q.clone().zip(layout.a.clone()).enumerate() {
            for (lane, error) in errors.iter_mut().enumerate().filter(|(lane, _)| self.alive[*lane]) {
                let change = self.tile.lane(a)[lane] - algorithmic[place * width + lane];
                let size = self.program.scale[place].max(self.tile.lane(q)[lane].abs());
                let relative = gain * change.abs() / size;
                *error = if relative <= *error { *error } else { relative };
            }
        }
        errors
    }

    /// Values of the outputs now: output by output, lane by lane; not a number for lanes that no longer run.
    pub fn observe(&mut self, into: &mut [f64]) {
        self.tile.run(self.program.observe());
        self.copy(self.program.outputs.iter().copied(), into);
    }

    /// Positions and velocities now: coordinate by coordinate, lane by lane; not a number for lanes that no longer run.
    pub fn copy_motion(&self, into: &mut [f64]) {
        let layout = &self.program.layout;
        self.copy(layout.q.clone().chain(layout.v.clone()), into);
    }

    fn copy(&self, slots: impl Iterator<Item = usize>, into: &mut [f64]) {
        for (row, slot) in into.chunks_exact_mut(self.tile.width()).zip(slots) {
            row.copy_from_slice(self.tile.lane(slot));
            row.iter_mut().zip(&self.alive).filter(|(_, alive)| !**alive).for_each(|(value, _)| *value = f64::NAN);
        }
    }
}
