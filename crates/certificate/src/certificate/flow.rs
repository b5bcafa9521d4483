//! Growth of distances between motions over a cell: e(τ) = Φ(τ) e(−1) + g(τ).

use symdiff::taylor_model::{ModelSpace, up};

use super::majorant::{bound, resolvent};
use super::matrix::{Bounds, Models};
use super::spaces::{Cell, Space, matrix_at};

/// The transition matrix, approximately, with its error.
#[derive(Clone, Debug)]
pub struct Flow {
    /// Φ̂, 2n × 2n, polynomials of (τ, ξ) of low order.
    pub transition: Models,
    /// Bound of |Φ − Φ̂|.
    pub missed: Bounds,
    /// Bound of |g|, 2n.
    pub growth: Vec<f64>,
}

impl Flow {
    /// Flow from the accelerations' derivatives by positions and velocities, n × 2n; `sizes` bounds [0 I; A], `jump` is
    /// the initial g, and `defect` how fast it grows by itself. `None` if no bound is found.
    pub fn new(
        space: &Space,
        cell: Cell,
        slopes: &Models,
        sizes: &Bounds,
        jump: &[f64],
        defect: &[f64],
    ) -> Option<Self> {
        let growth = bound(sizes, jump, 2.0 * cell.half, defect)?;
        let transition = transition(space, cell, slopes);
        let missed = missed(space, cell, &transition, slopes, sizes)?;
        Some(Self { transition, missed, growth })
    }
}

/// Accelerations over a tube about an approximation.
#[derive(Clone, Debug)]
pub struct Accelerations {
    /// A: derivatives by positions and velocities, n × 2n.
    pub missed: Vec<f64>,
    /// A: by positions and velocities, n × 2n.
    pub slopes: Models,
}

impl Accelerations {
    /// Accelerations from equations F(y, x) = 0 for x = (w, λ): their derivatives by x and by y over the tube,
    /// `inverse`, which may be any matrix, for those by x, and bounds of F at the approximation. `None` if
    /// derivatives by x may be singular.
    pub fn new(
        space: &ModelSpace,
        inverse: &Models,
        by_unknown: &Models,
        by_state: &Models,
        residual: &[f64],
    ) -> Option<Self> {
        let (n, last) = (by_state.columns / 2, space.size() - 1);
        let contraction = inverse.times(space, by_unknown).off_identity(space).bounds(space);
        let sizes = inverse.bounds(space).times(residual);
        let beyond = resolvent(&contraction, &Bounds::of(sizes.len(), 1, &sizes))?;
        let missed = (0..n).map(|row| up(sizes[row] + beyond.at(row, 0))).collect();
        // ∂x/∂y = −J⁻¹ F_y, and J⁻¹ = (C J)⁻¹ C.
        let mut all = inverse.times(space, by_state);
        all.negate();
        let beyond = resolvent(&contraction, &all.bounds(space))?;
        let mut slopes = all.part(space, 0..n, 0..2 * n);
        for (row, column) in (0..n).flat_map(|row| (0..2 * n).map(move |column| (row, column))) {
            let radius = &mut slopes.at_mut(row, column)[last];
            *radius = up(*radius + beyond.at(row, column));
        }
        Some(Self { missed, slopes })
    }
}

/// Bounds of v̂ − q̂' and of ŵ − v̂', 2n.
#[must_use]
pub fn kinematic_defect(space: &Space, cell: Cell, q: &Models, v: &Models, w: &Models) -> Vec<f64> {
    let (mut rate, mut left) = (vec![0.0; space.cell.size()], vec![0.0; space.cell.size()]);
    let mut found = Vec::with_capacity(2 * q.rows);
    for (of, by) in [(q, v), (v, w)] {
        for row in 0..of.rows {
            space.rate(of.at(row, 0), cell.half, &mut rate);
            space.cell.sub(by.at(row, 0), &rate, &mut left);
            found.push(space.cell.bound(&left));
        }
    }
    found
}

/// [0 I; A] of bounds of A.
#[must_use]
pub fn of_first_order(accelerations: &Bounds) -> Bounds {
    let (n, columns) = accelerations.shape();
    let mut values = vec![0.0; n * columns];
    (0..n).for_each(|row| values[row * columns + n + row] = 1.0);
    values.extend_from_slice(accelerations.entries());
    Bounds::of(columns, columns, &values)
}

/// Some Φ̂ with Φ̂' ≈ [0 I; A] Φ̂ and Φ̂(−1) = I.
fn transition(space: &Space, cell: Cell, slopes: &Models) -> Models {
    let (n, kept) = (slopes.rows, space.box_of.size() - 1);
    let identity = Models::identity(&space.box_of, 2 * n);
    let mut found = Models::identity(&space.cell, 2 * n);
    let mut integral = vec![0.0; space.cell.size()];
    for _ in 0..space.cell.jets().monomials().order() + 2 {
        let rates = slopes.approximate_times(&space.cell, &found);
        for (row, column) in (0..n).flat_map(|row| (0..2 * n).map(move |column| (row, column))) {
            space.integral(&identity.at(n + row, column)[..kept], cell.half, rates.at(row, column), &mut integral);
            found.at_mut(n + row, column).copy_from_slice(&integral);
            space.integral(&identity.at(row, column)[..kept], cell.half, found.at(n + row, column), &mut integral);
            found.at_mut(row, column).copy_from_slice(&integral);
        }
    }
    found
}

/// Bound of |Φ − Φ̂|: |E|' ≤ |[0 I; A]| |E| + |[0 I; A] Φ̂ − Φ̂'|.
fn missed(space: &Space, cell: Cell, transition: &Models, slopes: &Models, sizes: &Bounds) -> Option<Bounds> {
    let n = slopes.rows;
    let rates = slopes.times(&space.cell, transition);
    let start = matrix_at(space, transition, -1.0).off_identity(&space.box_of).bounds(&space.box_of);
    let (mut rate, mut left) = (vec![0.0; space.cell.size()], vec![0.0; space.cell.size()]);
    let mut values = vec![0.0; 4 * n * n];
    for column in 0..2 * n {
        let mut residual = vec![0.0; 2 * n];
        for (row, residual) in residual.iter_mut().enumerate() {
            space.rate(transition.at(row, column), cell.half, &mut rate);
            let of_equation = if row < n { transition.at(n + row, column) } else { rates.at(row - n, column) };
            space.cell.sub(of_equation, &rate, &mut left);
            *residual = space.cell.bound(&left);
        }
        let found = bound(sizes, &start.column(column), 2.0 * cell.half, &residual)?;
        found.into_iter().enumerate().for_each(|(row, value)| values[row * 2 * n + column] = value);
    }
    Some(Bounds::of(2 * n, 2 * n, &values))
}
