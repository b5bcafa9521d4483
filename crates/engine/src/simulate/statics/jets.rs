//! How an equilibrium changes with the parameters: its jet.

use nalgebra::{DMatrix, DVector};
use symdiff::JetMemory;
use symdiff::jet::JetSpace;

use super::equilibrium::Equilibrium;
use super::scaled::Scaled;
use super::tuning::TUNING;
use crate::assemble::ConstraintId;
use crate::compile::Tapes;

impl Equilibrium {
    /// The jet of an equilibrium whose state is that of the box's centre: each sweep x ← x − J₀⁻¹ R(x) in jets makes
    /// one more order exact. The outputs are observed. `None` where the equations are singular at the centre.
    pub fn jet<'s>(
        &self,
        space: &'s JetSpace,
        center: &[f64],
        half_width: &[f64],
        state: &[f64],
    ) -> Option<JetMemory<'s>> {
        let (program, layout) = (&self.program, &self.program.layout);
        let (n, m) = (layout.q.len(), layout.lambda.len());
        let inverse = self.inverse(state, center)?;
        let mut memory = JetMemory::new(space, program.registers(), program.constants());
        for (variable, register) in layout.parameters.clone().enumerate() {
            space.variable(variable, center[variable], half_width[variable], memory.jet_mut(register));
        }
        memory.set_constant(layout.time, 0.0);
        for register in layout.state() {
            let is_solved = layout.q.contains(&register) || layout.lambda.contains(&register);
            memory.set_constant(register, if is_solved { state[register] } else { 0.0 });
        }
        memory.run(program.sample());
        let unknowns: Vec<usize> = layout.q.clone().chain(layout.lambda.clone()).collect();
        let residuals: Vec<usize> = program.motion.iter().chain(&program.constraint).copied().collect();
        for _ in 0..=space.monomials().order() {
            memory.run(program.residual());
            let right: Vec<Vec<f64>> = residuals.iter().map(|&register| memory.jet(register).to_vec()).collect();
            for (row, &register) in unknowns.iter().enumerate() {
                for (column, right) in right.iter().enumerate() {
                    let share = inverse[(row, column)];
                    if share != 0.0 {
                        memory.jet_mut(register).iter_mut().zip(right).for_each(|(x, r)| *x -= share * r);
                    }
                }
            }
        }
        debug_assert_eq!(unknowns.len(), n + m);
        memory.run(program.observe());
        Some(memory)
    }

    /// The outputs of a jet, coefficient by coefficient.
    pub fn output_jets(&self, memory: &JetMemory) -> Vec<f64> {
        self.program.outputs.iter().flat_map(|&register| memory.jet(register)).copied().collect()
    }

    /// J₀⁻¹ of the equations (motion, Φ) by (q, λ); rows and columns of redundant constraints are zero.
    pub(super) fn inverse(&self, state: &[f64], parameters: &[f64]) -> Option<DMatrix<f64>> {
        let (n, m) = (self.scale.len(), self.program.layout.lambda.len());
        let linear = self.at(state, parameters).linearise();
        let kept: Vec<usize> =
            (0..n + m).filter(|&index| index < n || !self.redundant.contains(&ConstraintId::new(index - n))).collect();
        let entry = |row: usize, column: usize| match (row < n, column < n) {
            (true, true) => linear.stiffness[(row, column)],
            (false, true) => linear.jacobian[row - n][column],
            (true, false) => linear.jacobian[column - n][row],
            (false, false) => 0.0,
        };
        let size = kept.len();
        let matrix = DMatrix::from_fn(size, size, |row, column| entry(kept[row], kept[column]));
        let scaled = if self.states.is_empty() { Scaled::not(matrix) } else { Scaled::of(&matrix) };
        let factors = scaled.matrix.full_piv_lu();
        let pivots = factors.u().diagonal().map(f64::abs);
        let (least, most) = (pivots.min(), pivots.max());
        if least.is_nan() || most.is_nan() || least <= TUNING.singular_pivot * most {
            return None;
        }
        let scale = |index: usize| if index < n { self.scale[index] } else { 1.0 };
        let mut inverse = DMatrix::zeros(n + m, n + m);
        for (index, &column) in kept.iter().enumerate() {
            let mut unit = DVector::zeros(size);
            unit[index] = scaled.rows[index];
            let solution = factors.solve(&unit)?;
            for ((value, factor), &row) in solution.iter().zip(&scaled.columns).zip(&kept) {
                inverse[(row, column)] = value * factor * scale(row) * scale(column);
            }
        }
        Some(inverse)
    }
}
