//! One step of an enclosure, as described in the parent module.

use symdiff::taylor_model::up;
use symdiff::{Interval, ModelMemory};

use super::tuning::TUNING;
use super::{Enclosure, EnclosureError, Gains, NextGains};
use crate::certificate::krawczyk::{self, Image};
use crate::certificate::matrix::{Bounds, Models};
use crate::numerics::larger;

/// Derivatives of a step's equations F.
struct Slopes {
    /// ∂F/∂(w₊, λ₊).
    by_unknown: Models,
    /// ∂F/∂(q̂, v̂).
    by_state: Models,
}

impl<'s> Enclosure<'s> {
    fn coordinates(&self) -> usize {
        self.program.layout.q.len()
    }

    /// Goes from the start's q, v, a, w to the first q̂, v̂, w and their radii.
    pub(super) fn begin(&mut self) -> Result<(), EnclosureError> {
        let (n, space) = (self.coordinates(), self.space);
        let layout = self.program.layout.clone();
        let radius = space.size() - 1;
        let mut spread = vec![0.0; 3 * n];
        for i in 0..n {
            let model = |register: usize| self.memory.model(register + i);
            let [q, v, a, w] = [layout.q.start, layout.v.start, layout.a.start, layout.w.start].map(model);
            let predicted = self.predict(q, v, a, w);
            for (block, model) in [&predicted[0][..], &predicted[1], w].into_iter().enumerate() {
                let row = block * n + i;
                self.state.at_mut(row, 0)[..radius].copy_from_slice(&model[..radius]);
                spread[row] = up(model[radius] / self.units.scale[row]);
            }
        }
        let unknowns = layout.w.chain(layout.lambda);
        let mut first = Models::zero(space, unknowns.clone().count(), 1);
        for (row, register) in unknowns.enumerate() {
            first.at_mut(row, 0)[..radius].copy_from_slice(&self.memory.model(register)[..radius]);
        }
        self.before.push(first);
        self.radii = self.frame.radii_of(space, &spread)?;
        Ok(())
    }

    /// q̂ = q + h v + q_a a − q_w w,   v̂ = v + v_a a − v_w w.
    fn predict(&self, q: &[f64], v: &[f64], a: &[f64], w: &[f64]) -> [Vec<f64>; 2] {
        let gains = &self.next.gains;
        let position = self.combine(&[(None, q), (Some(gains.h), v), (Some(gains.q_a), a), (Some(-gains.q_w), w)]);
        let velocity = self.combine(&[(None, v), (Some(gains.v_a), a), (Some(-gains.v_w), w)]);
        [position, velocity]
    }

    /// Σ factor · model; no factor is one.
    fn combine(&self, terms: &[(Option<Interval>, &[f64])]) -> Vec<f64> {
        let mut sum = vec![0.0; self.space.size()];
        let (mut term, mut last) = (sum.clone(), sum.clone());
        for &(factor, model) in terms {
            match factor {
                Some(factor) => self.space.scale(factor, model, &mut term),
                None => term.copy_from_slice(model),
            }
            last.copy_from_slice(&sum);
            self.space.add(&last, &term, &mut sum);
        }
        sum
    }

    /// (q̂, v̂, w) and x at the step's end: q₊, v₊, and the next q̂, v̂. The map is linear and serves states and
    /// columns.
    fn advance_coordinate(&self, position: &[f64], velocity: &[f64], w: &[f64], x: &[f64]) -> [Vec<f64>; 4] {
        let gains = &self.gains;
        let q = self.combine(&[(None, position), (Some(gains.b), x)]);
        let v = self.combine(&[(None, velocity), (Some(gains.c), x)]);
        let mut a = self.combine(&[(Some(gains.a_x), x), (Some(-gains.a_w), w)]);
        if let Some(ratio) = self.next.ratio {
            let ratio = Interval::point(ratio);
            a = self.combine(&[(Some(Interval::point(1.0) - ratio), x), (Some(ratio), &a)]);
        }
        let [position, velocity] = self.predict(&q, &v, &a, x);
        [q, v, position, velocity]
    }

    /// One step to the time `end`, with its length and that of the step after it. On return the memory holds q₊, v₊,
    /// w₊, λ₊ with all their radii.
    pub(super) fn step(&mut self, end: f64, length: f64, next: f64) -> Result<(), EnclosureError> {
        let (n, space) = (self.coordinates(), self.space);
        self.gains = self.next.gains;
        self.next = if next == length {
            NextGains::same(self.gains)
        } else {
            let gains = Gains::new(self.certifier.simulator.program.coefficients, next);
            NextGains { gains, ratio: Some(next / length) }
        };
        space.constant(Interval::point(end), self.memory.model_mut(self.program.layout.time));
        let solution = self.solve()?;
        let count = solution.rows;
        self.place(&solution, None);
        let missed = self.residual().bounds(space);

        // Y: the derivative of the solution by the remainder, at the polynomials.
        let columns = self.columns();
        let of_state = columns.part(space, 0..2 * n, 0..3 * n);
        let Slopes { by_state, .. } = self.slopes();
        let inverse = self.inverse.take().ok_or(EnclosureError::Unproven)?;
        let pull = by_state.approximate_times(space, &of_state);
        let mut follows = inverse.approximate_times(space, &pull).without_radii();
        follows.negate();
        let sizes = inverse.bounds(space);
        let follow_sizes = follows.bounds(space);

        // The effect of A z and Y z on each coordinate: q₊, v₊, q̂₊, v̂₊, w₊.
        let (turned, moved) = self.turn(&columns, &follows);
        let moved_sizes = moved.bounds(space);
        let mut memory = self.take_memory();
        let spread_of = |y: &[f64]| -> Vec<f64> {
            // Spread of q₊, v₊, w₊, λ₊.
            let mut spread = moved_sizes.times(&self.radii);
            let of_unknowns = follow_sizes.times(&self.radii);
            for i in 0..n {
                spread[i] = up(spread[i] + self.gains.b.magnitude() * y[i]);
                spread[n + i] = up(spread[n + i] + self.gains.c.magnitude() * y[i]);
            }
            spread.extend(of_unknowns.iter().zip(y).map(|(follow, y)| up(follow + y)));
            spread
        };

        let first: Vec<f64> = if self.spread.is_empty() {
            sizes.times(missed.entries()).iter().map(|missed| 2.0 * missed).collect()
        } else {
            self.spread.iter().map(|spread| 1.5 * spread).collect()
        };
        let (mut forcing, mut rest) = (Vec::new(), Bounds::default());
        let found = krawczyk::enclose(first, |y| {
            self.place_in(&mut memory, &solution, Some(&spread_of(y)));
            let Slopes { by_unknown, by_state } = self.slopes_in(&mut memory);
            let contraction = inverse.times(space, &by_unknown).off_identity(space).bounds(space);
            let mut left = by_unknown.times(space, &follows);
            left.add(space, &by_state.times(space, &of_state));
            let of_remainder = left.bounds(space).times(&self.radii);
            let total: Vec<f64> = missed.entries().iter().zip(&of_remainder).map(|(a, b)| up(a + b)).collect();
            let missed = sizes.times(&total);
            (forcing, rest) = (total, contraction.clone());
            Image { missed, contraction }
        });
        let found = found.ok_or(EnclosureError::Unproven)?;
        self.place_in(&mut memory, &solution, Some(&spread_of(&found)));
        self.memory = memory;

        // y = −C η + (I − C J) y, |η| ≤ `forcing`: the first part is a known map, of the second only a bound is known.
        let forced = self.force(&inverse);
        let push = inverse.part(space, 0..n, n..count);
        let rest = rest.times(&found);
        let radii = [&self.radii[..], &forcing].concat();
        self.finish(&solution, &turned.beside(space, &forced), &radii, &rest[..n], &push)?;
        (self.inverse, self.spread) = (Some(inverse), found);
        self.before.insert(0, solution);
        self.before.truncate(3);
        Ok(())
    }

    /// X: polynomials near the solution.
    fn solve(&mut self) -> Result<Models, EnclosureError> {
        let (n, space) = (self.coordinates(), self.space);
        let mut solution = self.extrapolate();
        self.place(&solution, None);
        let matrix = self.slopes().by_unknown;
        let mut inverse = match self.inverse.take() {
            Some(inverse) => inverse,
            None => matrix.inverse_at_centre(space).ok_or(EnclosureError::Unproven)?,
        };
        if !inverse.refine_inverse_of(space, &matrix) {
            inverse = matrix.inverse_at_centre(space).ok_or(EnclosureError::Unproven)?;
            if !inverse.refine_inverse_of(space, &matrix) {
                return Err(EnclosureError::Unproven);
            }
        }
        let gain = self.gains.b.magnitude();
        for _ in 0..TUNING.max_corrections {
            let mut correction = inverse.approximate_times(space, &self.residual());
            correction.negate();
            solution.add_approximately(&correction);
            self.place(&solution, None);
            let sizes = correction.bounds(space);
            let scaled = sizes.entries()[..n].iter().zip(&self.units.scale).map(|(size, scale)| gain * size / scale);
            if scaled.fold(0.0, larger) < TUNING.settled_correction {
                break;
            }
        }
        self.inverse = Some(inverse);
        Ok(solution)
    }

    /// The parabola through the last solutions.
    fn extrapolate(&self) -> Models {
        let weights: &[f64] = match self.before.len() {
            1 => &[1.0],
            2 => &[2.0, -1.0],
            _ => &[3.0, -3.0, 1.0],
        };
        let mut sum = Models::zero(self.space, self.before[0].rows, 1);
        for (before, &weight) in self.before.iter().zip(weights) {
            sum.add_scaled(before, weight);
        }
        sum
    }

    /// Takes the memory out, so that it can be filled while the rest of `self` is read.
    fn take_memory(&mut self) -> ModelMemory<'s> {
        std::mem::replace(&mut self.memory, ModelMemory::new(self.space, 0, &[]))
    }

    /// Sets q₊, v₊, w₊, λ₊ in the memory from x and λ₊, with added radii (n, n, n + m) or as polynomials.
    fn place(&mut self, solution: &Models, radii: Option<&[f64]>) {
        let mut memory = self.take_memory();
        self.place_in(&mut memory, solution, radii);
        self.memory = memory;
    }

    fn place_in(&self, memory: &mut ModelMemory, solution: &Models, radii: Option<&[f64]>) {
        let n = self.coordinates();
        let layout = &self.program.layout;
        let radius = self.space.size() - 1;
        let more = |index: usize| radii.map_or(0.0, |radii| radii[index]);
        let mut set = |register: usize, model: &[f64], more: f64| {
            let target = memory.model_mut(register);
            target.copy_from_slice(model);
            target[radius] = up(target[radius] + more);
        };
        for i in 0..n {
            let x = solution.at(i, 0);
            let q = self.combine(&[(None, self.state.at(i, 0)), (Some(self.gains.b), x)]);
            let v = self.combine(&[(None, self.state.at(n + i, 0)), (Some(self.gains.c), x)]);
            set(layout.q.start + i, &q, more(i));
            set(layout.v.start + i, &v, more(n + i));
            set(layout.w.start + i, x, more(2 * n + i));
        }
        for (i, register) in layout.lambda.clone().enumerate() {
            set(register, solution.at(n + i, 0), more(3 * n + i));
        }
    }

    /// F at the values in the memory.
    fn residual(&mut self) -> Models {
        let (n, space) = (self.coordinates(), self.space);
        self.memory.run(self.program.residual());
        let mut residual = Models::zero(space, n + self.program.constraint.len(), 1);
        for (row, &register) in self.program.motion.iter().enumerate() {
            residual.at_mut(row, 0).copy_from_slice(self.memory.model(register));
        }
        let inverse_gain = Interval::point(1.0) / self.gains.b;
        for (row, &register) in self.program.constraint.iter().enumerate() {
            space.scale(inverse_gain, self.memory.model(register), residual.at_mut(n + row, 0));
        }
        residual
    }

    fn slopes(&mut self) -> Slopes {
        let mut memory = self.take_memory();
        let slopes = self.slopes_in(&mut memory);
        self.memory = memory;
        slopes
    }

    /// ∂F at the values in the memory.
    fn slopes_in(&self, memory: &mut ModelMemory) -> Slopes {
        let (n, space, gains) = (self.coordinates(), self.space, &self.gains);
        let program = self.program;
        memory.run(program.jacobian());
        let count = n + program.constraint.len();
        let (mut by_unknown, mut by_state) = (Models::zero(space, count, count), Models::zero(space, count, 2 * n));
        let mut add = |row: usize, column: usize, factor: Option<Interval>, register: usize| {
            let sum = self.combine(&[(None, by_unknown.at(row, column)), (factor, memory.model(register))]);
            by_unknown.at_mut(row, column).copy_from_slice(&sum);
        };
        let [by_q, by_v, by_w, by_lambda] = &program.motion_by;
        by_w.iter().for_each(|&(row, column, register)| add(row, column, None, register));
        by_q.iter().for_each(|&(row, column, register)| add(row, column, Some(gains.b), register));
        by_v.iter().for_each(|&(row, column, register)| add(row, column, Some(gains.c), register));
        by_lambda.iter().for_each(|&(row, column, register)| add(row, n + column, None, register));
        program.constraint_by_position.iter().for_each(|&(row, column, register)| add(n + row, column, None, register));
        let inverse_gain = Interval::point(1.0) / gains.b;
        by_q.iter()
            .for_each(|&(row, column, register)| by_state.at_mut(row, column).copy_from_slice(memory.model(register)));
        by_v.iter().for_each(|&(row, column, register)| {
            by_state.at_mut(row, n + column).copy_from_slice(memory.model(register))
        });
        for &(row, column, register) in &program.constraint_by_position {
            space.scale(inverse_gain, memory.model(register), by_state.at_mut(n + row, column));
        }
        Slopes { by_unknown, by_state }
    }

    /// The frame's columns in SI units, 3n × 3n.
    fn columns(&self) -> Models {
        let mut columns = self.frame.columns(self.space);
        for row in 0..columns.rows {
            columns.scale_row(row, self.units.scale[row]);
        }
        columns
    }

    /// The frame one step on, in units of `scale` (3n × 3n), and its q₊ and v₊ (2n × 3n).
    fn turn(&self, columns: &Models, follows: &Models) -> (Models, Models) {
        let (n, space) = (self.coordinates(), self.space);
        let (mut turned, mut moved) = (Models::zero(space, 3 * n, 3 * n), Models::zero(space, 2 * n, 3 * n));
        for column in 0..3 * n {
            for i in 0..n {
                let x = follows.at(i, column);
                let of = |block: usize| columns.at(block * n + i, column);
                let [q, v, position, velocity] = self.advance_coordinate(of(0), of(1), of(2), x);
                moved.at_mut(i, column).copy_from_slice(&q);
                moved.at_mut(n + i, column).copy_from_slice(&v);
                for (block, model) in [&position[..], &velocity, x].into_iter().enumerate() {
                    turned.at_mut(block * n + i, column).copy_from_slice(model);
                }
            }
        }
        for row in 0..3 * n {
            turned.scale_row(row, 1.0 / self.units.scale[row]);
        }
        (turned, moved)
    }

    /// The effect of corrections C η of x on the next q̂, v̂, w, in units of `scale`: 3n × (n + m).
    fn force(&self, inverse: &Models) -> Models {
        let (n, space) = (self.coordinates(), self.space);
        let mut forced = Models::zero(space, 3 * n, inverse.columns);
        let zero = vec![0.0; space.size()];
        for column in 0..inverse.columns {
            for i in 0..n {
                let x = inverse.at(i, column);
                let [_, _, position, velocity] = self.advance_coordinate(&zero, &zero, &zero, x);
                for (block, model) in [&position[..], &velocity, x].into_iter().enumerate() {
                    forced.at_mut(block * n + i, column).copy_from_slice(model);
                }
            }
        }
        for row in 0..3 * n {
            forced.scale_row(row, 1.0 / self.units.scale[row]);
        }
        forced
    }

    /// The next state's polynomials, frame and radii; |yᵢ| ≤ `found` (n) besides the part in `turned`.
    fn finish(
        &mut self,
        solution: &Models,
        turned: &Models,
        radii: &[f64],
        found: &[f64],
        push: &Models,
    ) -> Result<(), EnclosureError> {
        let (n, space) = (self.coordinates(), self.space);
        let radius = space.size() - 1;
        let gains = self.gains;
        // The effect of y on the next q̂, v̂, w.
        let next = self.next.gains;
        let of_algorithmic = match self.next.ratio.map(Interval::point) {
            Some(ratio) => Interval::point(1.0) - ratio + ratio * gains.a_x,
            None => gains.a_x,
        };
        let of_velocity = gains.c + next.v_a * of_algorithmic - next.v_w;
        let of_position = gains.b + next.h * gains.c + next.q_a * of_algorithmic - next.q_w;
        let effect = [of_position.magnitude(), of_velocity.magnitude(), 1.0];
        let mut fresh = vec![0.0; 3 * n];
        for (i, further) in found.iter().enumerate() {
            let state = |block: usize| self.state.at(block * n + i, 0);
            let x = solution.at(i, 0);
            let [_, _, position, velocity] = self.advance_coordinate(state(0), state(1), state(2), x);
            for (block, model) in [&position[..], &velocity, x].into_iter().enumerate() {
                let row = block * n + i;
                let target = self.state.at_mut(row, 0);
                target.copy_from_slice(model);
                target[radius] = 0.0;
                fresh[row] = up((model[radius] + effect[block] * further) / self.units.scale[row]);
            }
        }

        let (next, radii) = self.frame.clone().next(space, &self.units, turned, radii, &fresh, push)?;
        (self.frame, self.radii) = (next, radii);
        Ok(())
    }
}
