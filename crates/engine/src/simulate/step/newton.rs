//! Newton's iteration of one step, all lanes of a tile in lockstep.
//!
//! The iteration starts from extrapolated w and λ. One correction is mostly enough, because the contraction that was
//! last observed of the lane's first corrections is taken into account. The matrix is factorised at the step's
//! beginning and reused for the first corrections; where they do not suffice, it is factorised again for each further
//! one. Every decision is a lane's own or counts steps and iterations, so that a sample's numbers do not depend on the
//! samples that share its tile.

use symdiff::{LaneWork, Tile, in_lanes, lanes, lanes_mut};

use super::pivots::Watch;
use super::prediction::Predict;
use super::rank_revealing::solve_rank_deficient;
use super::rounding::{is_rounding, matrix_entries, rounding_of_residuals};
use super::tuning::TUNING;
use crate::compile::{ConstraintLevel, Program};
use crate::simulate::start::allowed_residual;

/// Work of the iteration, summed over all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Corrections, summed over lanes.
    pub iterations: u64,
    /// Steps in which a lane needed the rank-revealing solve.
    pub rank_revealing: u64,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.iterations += other.iterations;
        self.rank_revealing += other.rank_revealing;
    }
}

/// The state of an iteration over the lanes of a tile.
#[derive(Clone, Debug)]
pub struct Newton {
    pending: Vec<bool>,
    singular: Vec<bool>,
    /// Lanes that took factors of their own, and whether the tile's factors are not those of its prediction any more.
    late: Vec<bool>,
    is_renewed: bool,
    last: Vec<f64>,
    norm: Vec<f64>,
    /// Estimated contraction of each lane's first correction.
    contraction: Vec<f64>,
    /// w and λ when the step began.
    start: Vec<f64>,
    /// The same of the steps before, the last first, and how many of them there are.
    before: [Vec<f64>; 2],
    known: usize,
    size_before: f64,
    steps: u64,
    /// Lengths by which the steps of lanes are shares, s; none where steps are lengths.
    lengths: Option<Vec<f64>>,
    /// Totals.
    pub counters: Counters,
}

impl Newton {
    /// Iteration of tiles of this width.
    pub fn new(width: usize) -> Self {
        Self {
            pending: vec![false; width],
            singular: vec![false; width],
            late: vec![false; width],
            is_renewed: false,
            last: vec![0.0; width],
            norm: vec![0.0; width],
            contraction: vec![TUNING.first_contraction; width],
            start: Vec::new(),
            before: [Vec::new(), Vec::new()],
            known: 0,
            size_before: f64::NAN,
            steps: 0,
            lengths: None,
            counters: Counters::default(),
        }
    }

    /// Forgets the steps before: accelerations and multipliers do not go on from theirs.
    pub fn forget(&mut self) {
        self.known = 0;
        self.contraction.fill(TUNING.first_contraction);
    }

    /// Steps are shares of these lengths, s, from now on.
    pub fn set_lengths(&mut self, lengths: &[f64]) {
        self.lengths = Some(lengths.to_vec());
    }

    /// Ratio of a lane's step to the h that all lanes share, to a power.
    fn stretch(&self, lane: usize, power: i32) -> f64 {
        self.lengths.as_ref().map_or(1.0, |lengths| lengths[lane].powi(power))
    }

    /// Whether a lane's last step took the rank-revealing solve.
    pub fn is_singular(&self, lane: usize) -> bool {
        self.singular[lane]
    }

    /// Solves the step whose `time` and h stand in the tile, for the lanes in `alive`; on return `alive` holds only
    /// those that converged. The step's tape must have run. With `refine`, lanes that have converged are corrected once
    /// more: errors of positions within Newton's tolerance are 1/(βh²) times as large in accelerations.
    pub fn solve(&mut self, program: &Program, tile: &mut Tile, h: f64, refine: bool, alive: &mut [bool]) {
        self.pending.copy_from_slice(alive);
        self.start.clear();
        self.start.extend_from_slice(tile.block(program.layout.w.start..program.layout.lambda.end));
        if h != self.size_before {
            self.known = self.known.min(1);
        }
        self.predict(program, tile, self.known, h, &self.pending);
        self.singular.fill(false);
        self.late.fill(false);
        self.is_renewed = false;
        if self.steps.is_multiple_of(TUNING.steps_between_looks) {
            self.contraction.fill(TUNING.first_contraction);
        }
        self.steps += 1;
        self.iterate(program, tile, h);
        if self.pending.contains(&true) {
            self.accept_rounding(program, tile, h);
        }
        if self.pending.contains(&true) {
            // Lanes that did not converge start again from their prediction, with the rank-revealing solve.
            self.singular.iter_mut().zip(&self.pending).for_each(|(singular, pending)| *singular |= pending);
            self.predict(program, tile, 0, h, &self.pending);
            self.is_renewed = true;
            self.iterate(program, tile, h);
        }
        if alive.iter().zip(&self.singular).any(|(alive, singular)| *alive && *singular) {
            self.reject_open_constraints(program, tile, h);
        }
        if refine {
            self.correct_converged(program, tile, h, alive);
        }
        if self.pending.contains(&true) {
            self.restore_multipliers(program, tile);
        }
        for ((alive, pending), singular) in alive.iter_mut().zip(&self.pending).zip(&self.singular) {
            self.counters.rank_revealing += u64::from(*alive && *singular);
            *alive &= !pending;
        }
        self.before.swap(0, 1);
        std::mem::swap(&mut self.before[0], &mut self.start);
        self.known = (self.known + 1).min(2);
        self.size_before = h;
    }

    /// Predicts w₊ and λ₊ of these lanes on the parabola (line, constant) through their values now and at the `known`
    /// steps before. λ₊ of a redundant constraint starts from zero: a value that is not unique must not depend on
    /// earlier steps.
    fn predict(&self, program: &Program, tile: &mut Tile, known: usize, h: f64, lanes: &[bool]) {
        let [last, second_last] = &self.before;
        let (weights, last, second_last) = match known {
            0 => ([1.0, 0.0, 0.0], &self.start, &self.start),
            1 => ([1.0 + h / self.size_before, -h / self.size_before, 0.0], last, &self.start),
            _ => ([3.0, -3.0, 1.0], last, second_last),
        };
        let values = [&self.start[..], last, second_last];
        in_lanes(tile.width(), Predict { program, tile, pending: lanes, weights, values });
        for &register in &program.redundant {
            for (value, _) in tile.lane_mut(register).iter_mut().zip(lanes).filter(|(_, chosen)| **chosen) {
                *value = 0.0;
            }
        }
    }

    /// Restores λ of the step's beginning in pending lanes.
    fn restore_multipliers(&self, program: &Program, tile: &mut Tile) {
        let width = tile.width();
        let saved = &self.start[program.layout.w.len() * width..];
        for (register, saved) in program.layout.lambda.clone().zip(saved.chunks_exact(width)) {
            for ((value, saved), _) in
                tile.lane_mut(register).iter_mut().zip(saved).zip(&self.pending).filter(|(_, pending)| **pending)
            {
                *value = *saved;
            }
        }
    }

    fn iterate(&mut self, program: &Program, tile: &mut Tile, h: f64) {
        let (width, gain) = (tile.width(), program.coefficients.position_gain(h));
        for count in 0..TUNING.max_corrections {
            if count >= TUNING.frozen_corrections {
                self.is_renewed = true;
                self.late.iter_mut().zip(&self.pending).for_each(|(late, pending)| *late |= pending);
            }
            if count == 0 || count >= TUNING.frozen_corrections {
                tile.run(program.factor());
                in_lanes(width, Watch { watched: &program.watched, tile, singular: &mut self.singular });
                tile.run(program.first_correction());
            } else {
                tile.run(program.correct());
            }
            if self.pending.iter().zip(&self.singular).any(|(pending, singular)| *pending && *singular) {
                self.correct_singular(program, tile, gain, count);
            }
            in_lanes(width, Apply { program, tile, gain, pending: &self.pending, norm: &mut self.norm });
            if let Some(lengths) = &self.lengths {
                self.norm.iter_mut().zip(lengths).for_each(|(norm, length)| *norm *= length * length);
            }
            self.counters.iterations += self.pending.iter().map(|&pending| u64::from(pending)).sum::<u64>();
            let test = TestConvergence {
                count,
                norm: &self.norm,
                last: &mut self.last,
                contraction: &mut self.contraction,
                pending: &mut self.pending,
            };
            in_lanes(width, test);
            if !self.pending.contains(&true) {
                return;
            }
        }
    }

    /// One more correction of the lanes that have converged with factors of their own.
    fn correct_converged(&mut self, program: &Program, tile: &mut Tile, h: f64, alive: &[bool]) {
        let lanes = alive.iter().zip(&self.pending).zip(&self.singular);
        let converged: Vec<bool> = lanes.map(|((alive, pending), singular)| *alive && !pending && !singular).collect();
        let gain = program.coefficients.position_gain(h);
        if self.is_renewed {
            self.factor_apart(program, tile, h, &converged);
        }
        tile.run(program.correct());
        in_lanes(tile.width(), Apply { program, tile, gain, pending: &converged, norm: &mut self.norm });
        self.counters.iterations += converged.iter().map(|&converged| u64::from(converged)).sum::<u64>();
    }

    /// Factors of converged lanes as each would have them alone: those of its prediction, or those of its solution
    /// where it took its own. A slower lane of the tile has renewed them.
    fn factor_apart(&self, program: &Program, tile: &mut Tile, h: f64, converged: &[bool]) {
        let early: Vec<bool> = converged.iter().zip(&self.late).map(|(converged, late)| *converged && !late).collect();
        let unknowns = [program.layout.iterate.clone(), program.layout.lambda.clone()];
        let solutions = unknowns.each_ref().map(|registers| tile.block(registers.clone()).to_vec());
        self.predict(program, tile, self.known, h, &early);
        tile.run(program.factor());
        for (registers, solution) in unknowns.into_iter().zip(&solutions) {
            tile.block_mut(registers).copy_from_slice(solution);
        }
    }

    /// Corrections by the rank-revealing solve, for singular lanes. After the first few corrections, a constraint that
    /// holds to rounding is not corrected any more: near a singular position each such correction would move the
    /// mechanism by ε over the distance to it. `gain` is that of positions.
    fn correct_singular(&self, program: &Program, tile: &mut Tile, gain: f64, count: usize) {
        tile.run(program.matrix());
        for lane in (0..self.pending.len()).filter(|&lane| self.pending[lane] && self.singular[lane]) {
            let value = |register: usize| tile.lane(register)[lane];
            let entries = matrix_entries(program, tile, lane);
            let rounding = if count < TUNING.frozen_corrections {
                vec![0.0; program.residual.len()]
            } else {
                rounding_of_residuals(program, tile, lane, &entries, gain * self.stretch(lane, 2))
            };
            let uncertain = |residual: f64, rounding: f64| if residual.abs() <= rounding { 0.0 } else { -residual };
            let residuals = program.residual.iter().zip(&rounding);
            let right: Vec<f64> =
                residuals.map(|(&register, rounding)| uncertain(value(register), *rounding)).collect();
            let solution = solve_rank_deficient(&entries, &right, &program.equilibration);
            for (index, register) in program.layout.correction.clone().enumerate() {
                tile.lane_mut(register)[lane] = solution.as_ref().map_or(f64::NAN, |solution| solution[index]);
            }
        }
    }

    /// Ends the iteration of lanes whose constraints hold to rounding and whose corrections are of its size: near a
    /// singular position they flip between neighbouring numbers for ever.
    fn accept_rounding(&mut self, program: &Program, tile: &mut Tile, h: f64) {
        tile.run(program.matrix());
        let gain = program.coefficients.position_gain(h);
        for lane in 0..self.pending.len() {
            let gain = gain * self.stretch(lane, 2);
            self.pending[lane] &= self.singular[lane] || !is_rounding(program, tile, lane, self.last[lane], gain);
        }
    }

    /// Marks lanes as not converged whose rank-revealing solve has settled without fulfilling the constraints: least
    /// squares also settle where the constraints cannot be fulfilled.
    fn reject_open_constraints(&mut self, program: &Program, tile: &mut Tile, h: f64) {
        tile.run(program.matrix());
        let gain = program.coefficients.constraint_gain(h);
        let power = match program.coefficients.level {
            ConstraintLevel::Position => 2,
            ConstraintLevel::Velocity => 1,
        };
        let allowed = allowed_residual(&program.scale);
        for &register in &program.residual[program.scale.len()..] {
            for (lane, residual) in tile.lane(register).iter().enumerate() {
                let closed = (gain * self.stretch(lane, power) * residual).abs() <= allowed;
                self.pending[lane] |= self.singular[lane] && !closed;
            }
        }
    }
}

/// Adds the correction to the iterate of pending lanes; its norm is in relative positions.
struct Apply<'a> {
    program: &'a Program,
    tile: &'a mut Tile,
    gain: f64,
    pending: &'a [bool],
    norm: &'a mut [f64],
}

impl LaneWork for Apply<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) {
        let Self { program, tile, gain, pending, norm } = self;
        let layout = &program.layout;
        let (pending, norm) = (lanes::<W, _>(pending), lanes_mut::<W, _>(norm));
        *norm = [0.0; W];
        let (known, corrections) = tile.values_mut().split_at_mut(layout.correction.start * W);
        let (known, iterates) = known.split_at_mut(layout.iterate.start * W);
        let multipliers = &mut known[layout.lambda.start * W..];
        let (of_accelerations, of_multipliers) = corrections.split_at(iterates.len());
        let rows = iterates.as_chunks_mut::<W>().0.iter_mut().zip(of_accelerations.as_chunks::<W>().0);
        for ((iterate, correction), scale) in rows.zip(&program.scale) {
            add(pending, correction, iterate);
            let weight = gain / scale;
            for (norm, correction) in norm.iter_mut().zip(correction) {
                let size = (weight * correction).abs();
                // Written so that NaN wins and stays.
                *norm = if size <= *norm || norm.is_nan() { *norm } else { size };
            }
        }
        let multipliers = multipliers.as_chunks_mut::<W>().0.iter_mut();
        for (lambda, correction) in multipliers.zip(of_multipliers.as_chunks::<W>().0) {
            add(pending, correction, lambda);
        }
    }
}

/// Adds to the chosen lanes.
#[inline(always)]
fn add<const W: usize>(chosen: &[bool; W], change: &[f64; W], to: &mut [f64; W]) {
    for ((to, change), chosen) in to.iter_mut().zip(change).zip(chosen) {
        *to = if *chosen { *to + change } else { *to };
    }
}

/// The convergence test: lanes whose estimated error is small enough are no longer pending.
struct TestConvergence<'a> {
    count: usize,
    norm: &'a [f64],
    last: &'a mut [f64],
    contraction: &'a mut [f64],
    pending: &'a mut [bool],
}

impl LaneWork for TestConvergence<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) {
        let (pending, last) = (lanes_mut::<W, _>(self.pending), lanes_mut::<W, _>(self.last));
        let (contraction, norm) = (lanes_mut::<W, _>(self.contraction), lanes::<W, _>(self.norm));
        for (((pending, last), expected), &norm) in pending.iter_mut().zip(last).zip(contraction).zip(norm) {
            let contraction = if self.count == 0 { *expected } else { norm / *last };
            let seen = (TUNING.contraction_safety * contraction).max(TUNING.least_contraction);
            *expected = if self.count == 1 && *pending { seen } else { *expected };
            let error = if contraction < 1.0 { norm * contraction / (1.0 - contraction) } else { f64::INFINITY };
            *last = if *pending { norm } else { *last };
            let tolerance = if self.count == 0 { TUNING.first_tolerance } else { TUNING.tolerance };
            *pending &= !(error <= tolerance || norm <= TUNING.round_off);
        }
    }
}
