//! Newton's iteration of one step, all lanes of a tile in lockstep.
//!
//! The matrix is factorised at the step's beginning and kept for the first corrections; where they do not suffice, it is
//! factorised anew for each further one. Every decision is a lane's own or counts iterations, so that a sample's numbers do
//! not depend on which others share its tile.

use nalgebra::{DMatrix, DVector};
use symdiff::Tile;

use super::rank::smallest_solution;
use crate::program::Program;

/// Corrections with the step's first factorisation before each gets its own.
const FROZEN_CORRECTIONS: usize = 4;

/// Corrections before the iteration is given up.
const MAX_CORRECTIONS: usize = 12;

/// Error of positions at which the iteration ends, relative to the coordinate's scale: the last correction in position
/// units times the observed contraction.
const TOLERANCE: f64 = 1e-11;

/// Contraction that is assumed of a first correction, about which nothing is known yet.
const FIRST_CONTRACTION: f64 = 0.1;

/// Corrections below this (relative positions) are round-off, whatever their contraction.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// A constraint gapes no more than this, relative to the smallest coordinate scale, after a dense solve: least squares also
/// settle where the constraints cannot be fulfilled.
const GAP: f64 = 1e-9;

/// What the iteration did; counters of the whole life of the solver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Corrections, summed over lanes.
    pub iterations: u64,
    /// Steps in which a lane needed the dense rank-revealing solve.
    pub rank_revealing: u64,
}

/// The state of an iteration over the lanes of a tile.
#[derive(Clone, Debug)]
pub struct Newton {
    pending: Vec<bool>,
    dense: Vec<bool>,
    last: Vec<f64>,
    norm: Vec<f64>,
    /// λ when the step began.
    multipliers: Vec<f64>,
    /// Totals.
    pub counters: Counters,
}

impl Newton {
    /// For tiles of this width.
    pub fn new(width: usize) -> Self {
        Self {
            pending: vec![false; width],
            dense: vec![false; width],
            last: vec![0.0; width],
            norm: vec![0.0; width],
            multipliers: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// Solves the step whose `time` and h stand in the tile, for the lanes in `alive`; on return `alive` holds only those
    /// that converged. The step's tape must have run.
    pub fn solve(&mut self, program: &Program, tile: &mut Tile, h: f64, alive: &mut [bool]) {
        self.pending.copy_from_slice(alive);
        let lambda = program.layout.lambda.start * tile.width()..program.layout.lambda.end * tile.width();
        self.multipliers.clear();
        self.multipliers.extend_from_slice(&tile.values()[lambda]);
        self.predict(program, tile);
        self.dense.fill(false);
        self.iterate(program, tile, h);
        if self.pending.contains(&true) {
            // What did not converge starts again from its prediction, with the dense solve.
            self.dense.copy_from_slice(&self.pending);
            self.predict(program, tile);
            self.iterate(program, tile, h);
        }
        if self.dense.contains(&true) {
            self.reject_gaps(program, tile, h);
        }
        self.restore_multipliers(program, tile);
        for ((alive, pending), dense) in alive.iter_mut().zip(&self.pending).zip(&self.dense) {
            self.counters.rank_revealing += u64::from(*dense);
            *alive &= !pending;
        }
    }

    /// w₊ ≈ w where the iteration is still to run; λ₊ starts from λ, that of a redundant constraint from zero: what has no
    /// unique value must not have a memory either.
    fn predict(&mut self, program: &Program, tile: &mut Tile) {
        let layout = &program.layout;
        for (from, to) in layout.w.clone().zip(layout.iterate.clone()) {
            for lane in (0..self.pending.len()).filter(|&lane| self.pending[lane]) {
                tile.lane_mut(to)[lane] = tile.lane(from)[lane];
            }
        }
        self.restore_multipliers(program, tile);
        for &slot in &program.redundant {
            for lane in (0..self.pending.len()).filter(|&lane| self.pending[lane]) {
                tile.lane_mut(slot)[lane] = 0.0;
            }
        }
    }

    /// λ as it was when the step began, for pending lanes.
    fn restore_multipliers(&self, program: &Program, tile: &mut Tile) {
        for (slot, saved) in program.layout.lambda.clone().zip(self.multipliers.chunks_exact(tile.width())) {
            for lane in (0..self.pending.len()).filter(|&lane| self.pending[lane]) {
                tile.lane_mut(slot)[lane] = saved[lane];
            }
        }
    }

    fn iterate(&mut self, program: &Program, tile: &mut Tile, h: f64) {
        let gain = program.coefficients.position_gain(h);
        for count in 0..MAX_CORRECTIONS {
            if count == 0 || count >= FROZEN_CORRECTIONS {
                tile.run(program.factor());
                self.watch(program, tile);
            }
            tile.run(program.correct());
            if (0..self.pending.len()).any(|lane| self.pending[lane] && self.dense[lane]) {
                self.correct_densely(program, tile);
            }
            self.apply(program, tile, gain);
            self.judge(count);
            if !self.pending.contains(&true) {
                return;
            }
        }
    }

    /// Lanes with a pivot that has become too small are solved densely.
    fn watch(&mut self, program: &Program, tile: &Tile) {
        for watched in &program.watched {
            for (dense, inverse) in self.dense.iter_mut().zip(tile.lane(watched.slot)) {
                *dense |= inverse.is_nan() || inverse.abs() > watched.largest_inverse;
            }
        }
    }

    /// Corrections from the dense matrix, for the lanes that need it.
    fn correct_densely(&self, program: &Program, tile: &mut Tile) {
        let size = program.residual.len();
        tile.run(program.matrix());
        for lane in (0..self.pending.len()).filter(|&lane| self.pending[lane] && self.dense[lane]) {
            let mut matrix = DMatrix::zeros(size, size);
            for &(row, column, slot) in &program.matrix_entries {
                matrix[(row, column)] = tile.lane(slot)[lane];
            }
            let right = DVector::from_iterator(size, program.residual.iter().map(|&slot| -tile.lane(slot)[lane]));
            let solution = smallest_solution(&matrix, &right, &program.equilibration);
            for (place, slot) in program.layout.correction.clone().enumerate() {
                tile.lane_mut(slot)[lane] = solution.as_ref().map_or(f64::NAN, |solution| solution[place]);
            }
        }
    }

    /// Lanes whose dense solve has settled without fulfilling the constraints have not converged.
    fn reject_gaps(&mut self, program: &Program, tile: &mut Tile, h: f64) {
        tile.run(program.matrix());
        let gain = program.coefficients.position_gain(h);
        let smallest = program.scale.iter().copied().fold(1.0, f64::min);
        for &slot in &program.residual[program.scale.len()..] {
            for (lane, residual) in tile.lane(slot).iter().enumerate() {
                let closed = (gain * residual).abs() <= GAP * smallest;
                self.pending[lane] |= self.dense[lane] && !closed;
            }
        }
    }

    /// Adds the correction to the iterate of pending lanes and measures it in relative positions.
    fn apply(&mut self, program: &Program, tile: &mut Tile, gain: f64) {
        let layout = &program.layout;
        let width = self.pending.len();
        self.norm.fill(0.0);
        let (known, corrections) = tile.values_mut().split_at_mut(layout.correction.start * width);
        let n = program.scale.len();
        for (place, correction) in corrections.chunks_exact(width).take(layout.correction.len()).enumerate() {
            let target = if place < n { layout.iterate.start + place } else { layout.lambda.start + place - n };
            let iterate = &mut known[target * width..][..width];
            for ((iterate, correction), pending) in iterate.iter_mut().zip(correction).zip(&self.pending) {
                *iterate = if *pending { *iterate + correction } else { *iterate };
            }
            if place < n {
                let weight = gain / program.scale[place];
                for (norm, correction) in self.norm.iter_mut().zip(correction) {
                    let size = (weight * correction).abs();
                    // Written so that not a number wins and stays.
                    *norm = if size <= *norm || norm.is_nan() { *norm } else { size };
                }
            }
        }
    }

    /// Which lanes are done.
    fn judge(&mut self, count: usize) {
        for lane in 0..self.pending.len() {
            if !self.pending[lane] {
                continue;
            }
            self.counters.iterations += 1;
            let norm = self.norm[lane];
            let contraction = if count == 0 { FIRST_CONTRACTION } else { norm / self.last[lane] };
            let error = if contraction < 1.0 { norm * contraction / (1.0 - contraction) } else { f64::INFINITY };
            self.last[lane] = norm;
            if error <= TOLERANCE || norm <= ROUND_OFF {
                self.pending[lane] = false;
            }
        }
    }
}
