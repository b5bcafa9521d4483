//! How an equilibrium changes with all parameters at once.

use symdiff::{Adjoints, Tile};

use super::equilibrium::Equilibrium;
use crate::compile::Tapes;

impl Equilibrium {
    /// Adjoints of the parameters (k), from those of the positions (n) of an equilibrium with this state (the layout's
    /// registers): −R_ξᵀ J⁻ᵀ q̄. NaN where the equations are singular there.
    pub fn pull(&self, parameters: &[f64], state: &[f64], by_positions: &[f64]) -> Vec<f64> {
        let (program, layout) = (&self.program, &self.program.layout);
        let Some(inverse) = self.inverse(state, parameters) else { return vec![f64::NAN; parameters.len()] };
        let mut tile = Tile::new(1, program.registers(), program.constants());
        for (register, &value) in layout.parameters.clone().zip(parameters) {
            tile.lane_mut(register)[0] = value;
        }
        for register in layout.q.clone().chain(layout.lambda.clone()) {
            tile.lane_mut(register)[0] = state[register];
        }
        tile.run(program.sample());
        let mut adjoints = Adjoints::new(&tile);
        for (column, &residual) in program.motion.iter().chain(&program.constraint).enumerate() {
            let terms = by_positions.iter().enumerate().map(|(row, by)| inverse[(row, column)] * by);
            adjoints.lane_mut(residual)[0] -= terms.sum::<f64>();
        }
        adjoints.pull(program.residual(), &mut tile);
        adjoints.pull(program.sample(), &mut tile);
        adjoints.block(layout.parameters.clone()).to_vec()
    }
}
