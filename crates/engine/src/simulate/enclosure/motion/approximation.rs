//! An approximate motion over a cell as polynomials of (τ, ξ): Picard's iteration in jets.
//!
//! Nothing here is proven: the errors of these polynomials are bounded afterwards.

use symdiff::JetMemory;

use super::super::EnclosureError;
use super::tuning::TUNING;
use crate::certificate::matrix::Models;
use crate::certificate::spaces::{Cell, Space, matrix_at};
use crate::compile::EquationsProgram;

/// Positions, velocities, accelerations and multipliers: over a cell polynomials of (τ, ξ), at its start of ξ.
#[derive(Clone, Debug)]
pub(super) struct Approximation {
    pub q: Models,
    pub v: Models,
    pub w: Models,
    pub lambda: Models,
}

impl Approximation {
    /// The first guess: accelerations and multipliers of the cell before, extrapolated; without one as at the start.
    pub fn first(space: &Space, start: &Self, cell: Cell, before: Option<(Cell, &Self)>) -> Self {
        let extrapolate = |before: Cell, of_cell: &Models| {
            let (shift, scale) = ((cell.middle - before.middle) / before.half, cell.half / before.half);
            let mut found = Models::zero(&space.cell, of_cell.rows, 1);
            (0..of_cell.rows).for_each(|row| space.substituted(of_cell.at(row, 0), shift, scale, found.at_mut(row, 0)));
            found
        };
        let lift = |of_box: &Models| {
            let mut lifted = Models::zero(&space.cell, of_box.rows, 1);
            (0..of_box.rows).for_each(|row| space.lift(of_box.at(row, 0), lifted.at_mut(row, 0)));
            lifted
        };
        let (w, lambda) = match before {
            Some((of, before)) => (extrapolate(of, &before.w), extrapolate(of, &before.lambda)),
            None => (lift(&start.w), lift(&start.lambda)),
        };
        let mut first = Self { q: lift(&start.q), v: lift(&start.v), w, lambda };
        first.integrate(space, start, cell);
        first
    }

    /// Velocities and positions of the accelerations.
    fn integrate(&mut self, space: &Space, start: &Self, cell: Cell) {
        for row in 0..self.q.rows {
            let v0 = &start.v.at(row, 0)[..space.box_of.size() - 1];
            space.integral(v0, cell.half, self.w.at(row, 0), self.v.at_mut(row, 0));
            let q0 = &start.q.at(row, 0)[..space.box_of.size() - 1];
            space.integral(q0, cell.half, self.v.at(row, 0), self.q.at_mut(row, 0));
        }
    }

    /// Iterates. `inverse` approximates that of the matrix by (w, λ) over the cell. `memory` has the cell's time and
    /// the parameters.
    pub fn iterate(
        &mut self,
        space: &Space,
        program: &EquationsProgram,
        memory: &mut JetMemory,
        inverse: &Models,
        start: &Self,
        cell: Cell,
    ) -> Result<(), EnclosureError> {
        let jets = space.cell.jets();
        let (n, m) = (self.q.rows, self.lambda.rows);
        let mut residual = Models::zero(&space.cell, n + m, 1);
        let mut last = f64::INFINITY;
        for _ in 0..TUNING.max_iterations {
            self.put(program, |register, model| memory.jet_mut(register).copy_from_slice(&model[..jets.len()]));
            memory.run(program.residual());
            memory.run(program.rates());
            let rows = program.motion.iter().chain(&program.constraint_rates[1]);
            for (row, &register) in rows.enumerate() {
                residual.at_mut(row, 0)[..jets.len()].copy_from_slice(memory.jet(register));
            }
            let correction = inverse.approximate_times(&space.cell, &residual);
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for row in 0..n + m {
                let value = if row < n { self.w.at_mut(row, 0) } else { self.lambda.at_mut(row - n, 0) };
                for (c, change) in value.iter_mut().zip(correction.at(row, 0)) {
                    *c -= change;
                }
                if row < n {
                    let sum = |model: &[f64]| model.iter().map(|c| c.abs()).sum::<f64>();
                    change = change.max(sum(correction.at(row, 0)));
                    size = size.max(sum(self.w.at(row, 0)));
                }
            }
            self.integrate(space, start, cell);
            if !change.is_finite() {
                return Err(EnclosureError::Unproven);
            }
            if change <= TUNING.converged_accelerations * size
                || (change <= TUNING.near_convergence * size && change > 0.5 * last)
            {
                return Ok(());
            }
            last = change;
        }
        Err(EnclosureError::Unproven)
    }

    /// Polynomials at an instant of the cell, with rounding as radius.
    pub fn at(&self, space: &Space, tau: f64) -> Self {
        let at = |models: &Models| matrix_at(space, models, tau);
        Self { q: at(&self.q), v: at(&self.v), w: at(&self.w), lambda: at(&self.lambda) }
    }

    /// Hands each polynomial to its register.
    pub fn put(&self, program: &EquationsProgram, mut put: impl FnMut(usize, &[f64])) {
        let layout = &program.layout;
        let blocks = [(&layout.q, &self.q), (&layout.v, &self.v), (&layout.w, &self.w), (&layout.lambda, &self.lambda)];
        for (registers, models) in blocks {
            registers.clone().enumerate().for_each(|(row, register)| put(register, models.at(row, 0)));
        }
    }
}
