//! Proof over one cell: how far the true motion is from an approximation at most.

use symdiff::ModelMemory;
use symdiff::taylor_model::{ModelSpace, up};

use super::super::EnclosureError;
use super::super::start;
use super::approximation::Approximation;
use super::tuning::TUNING;
use crate::certificate::flow::{Accelerations, Flow, kinematic_defect, of_first_order};
use crate::certificate::majorant::bound;
use crate::certificate::matrix::{Bounds, Models};
use crate::certificate::spaces::{Cell, Space, truncate};
use crate::compile::EquationsProgram;
use crate::numerics::larger;

/// Bounds over a cell for every ξ, for the distance e = y − ŷ of a motion y from the approximation ŷ, y = (q, v).
#[derive(Clone, Debug)]
pub(super) struct Proven {
    /// Growth of e.
    pub flow: Flow,
    /// Bound of the part of |e'| due to the approximation's defect in the equations, 2n.
    pub defect: Vec<f64>,
    /// Bound of |∂f/∂y|, 2n × 2n.
    pub slopes: Bounds,
    /// Bound of |e| over the cell, 2n.
    pub tube: Vec<f64>,
}

/// An approximation to be proven.
pub(super) struct Claim<'c> {
    pub program: &'c EquationsProgram,
    /// Polynomials of the approximation.
    pub fine: &'c Space,
    /// Polynomials of the transition matrix.
    pub coarse: &'c Space,
    pub cell: Cell,
    pub approximation: &'c Approximation,
    /// Approximate inverse of the matrix by (w, λ), coarse.
    pub inverse: &'c Models,
    /// Bound of |e(−1)|, 2n.
    pub at_start: &'c [f64],
    /// Bound of how far ŷ(−1) is from the polynomials it began with, 2n.
    pub jump: &'c [f64],
}

impl Claim<'_> {
    /// Proves it. `fine` and `coarse` have the cell's time and the parameters; `slopes` bounds |∂f/∂y|
    /// of a neighbouring cell, where the search for a tube begins.
    ///
    /// # Errors
    /// Where a motion may leave every tube that is tried.
    pub fn prove(
        &self,
        fine: &mut ModelMemory,
        coarse: &mut ModelMemory,
        slopes: Option<&Bounds>,
    ) -> Result<Proven, EnclosureError> {
        let duration = 2.0 * self.cell.half;
        let Approximation { q, v, w, .. } = self.approximation;
        let n = q.rows;
        let residual = self.residual(fine);
        let kinematic = kinematic_defect(self.fine, self.cell, q, v, w);
        let entry: Vec<f64> = self.at_start.iter().zip(self.jump).map(|(a, b)| up(a + b)).collect();
        let guess = slopes.and_then(|slopes| bound(slopes, &entry, duration, &kinematic));
        let mut tube: Vec<f64> =
            guess.unwrap_or_else(|| entry.clone()).iter().map(|e| TUNING.wider_tube * e + 1e-14).collect();
        for _ in 0..TUNING.most_tubes {
            let linear = self.linearise(coarse, &tube, &residual)?;
            let missed = kinematic.iter().enumerate().map(|(row, &rate)| match row.checked_sub(n) {
                Some(row) => up(rate + linear.missed[row]),
                None => rate,
            });
            let defect: Vec<f64> = missed.collect();
            let slopes = of_first_order(&linear.slopes.bounds(&self.coarse.cell));
            let reached = bound(&slopes, &entry, duration, &defect).ok_or(EnclosureError::Unproven)?;
            // Written so that NaN is no proof.
            if reached.iter().zip(&tube).all(|(reached, tube)| reached < tube) {
                let flow = Flow::new(self.coarse, self.cell, &linear.slopes, &slopes, self.jump, &defect);
                let flow = flow.ok_or(EnclosureError::Unproven)?;
                return Ok(Proven { flow, defect, slopes, tube });
            }
            tube = reached.iter().map(|e| TUNING.wider_tube * e + 1e-14).collect();
        }
        Err(EnclosureError::Unproven)
    }

    /// Bounds of the equations' residuals at the approximation, n + m.
    fn residual(&self, memory: &mut ModelMemory) -> Vec<f64> {
        self.approximation.put(self.program, |register, model| memory.model_mut(register).copy_from_slice(model));
        memory.run(self.program.residual());
        memory.run(self.program.rates());
        let rows = self.program.motion.iter().chain(&self.program.constraint_rates[1]);
        rows.map(|&register| self.fine.cell.bound(memory.model(register))).collect()
    }

    /// Derivatives of the accelerations by q and v for every motion in the tube.
    fn linearise(
        &self,
        memory: &mut ModelMemory,
        tube: &[f64],
        residual: &[f64],
    ) -> Result<Accelerations, EnclosureError> {
        let space = &self.coarse.cell;
        let (layout, n) = (&self.program.layout, self.approximation.q.rows);
        let last = space.size() - 1;
        self.approximation.put(self.program, |register, model| truncate(model, space, memory.model_mut(register)));
        let tails: Vec<f64> =
            layout.w.clone().chain(layout.lambda.clone()).map(|register| memory.model(register)[last]).collect();
        for (register, tube) in layout.q.clone().chain(layout.v.clone()).zip(tube) {
            let radius = &mut memory.model_mut(register)[last];
            *radius = up(*radius + tube);
        }
        let equations = start::accelerations(self.program);
        equations.prove(space, memory, self.inverse)?;
        // The accelerations of the approximation are to be in the box, too.
        for (register, tail) in layout.w.clone().chain(layout.lambda.clone()).zip(tails) {
            let radius = &mut memory.model_mut(register)[last];
            *radius = larger(*radius, tail);
        }
        let matrix = equations.matrix(space, memory);
        memory.run(self.program.rates_jacobian());
        let mut by_state = Models::zero(space, matrix.rows, 2 * n);
        let [by_q, by_v, ..] = &self.program.motion_by;
        let [rates_by_q, rates_by_v] = &self.program.constraint_acceleration_by;
        let blocks = [(by_q, 0, 0), (by_v, 0, n), (rates_by_q, n, 0), (rates_by_v, n, n)];
        for (entries, below, right) in blocks {
            for &(row, column, register) in entries {
                by_state.at_mut(below + row, right + column).copy_from_slice(memory.model(register));
            }
        }
        Accelerations::new(space, self.inverse, &matrix, &by_state, residual).ok_or(EnclosureError::Unproven)
    }
}

/// Approximate inverse of the matrix by (w, λ) about an approximation.
///
/// # Errors
/// Where it is not regular over the cell.
pub(super) fn inverse_about(
    program: &EquationsProgram,
    space: &ModelSpace,
    memory: &mut ModelMemory,
    approximation: &Approximation,
) -> Result<Models, EnclosureError> {
    let last = space.size() - 1;
    approximation.put(program, |register, model| {
        let to = memory.model_mut(register);
        truncate(model, space, to);
        to[last] = 0.0;
    });
    let matrix = start::accelerations(program).matrix(space, memory).without_radii();
    let mut inverse = matrix.inverse_at_centre(space).ok_or(EnclosureError::Unproven)?;
    if inverse.refine_inverse_of(space, &matrix) { Ok(inverse.without_radii()) } else { Err(EnclosureError::Unproven) }
}
