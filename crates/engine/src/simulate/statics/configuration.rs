//! The equations at one configuration, with their derivatives, as small dense matrices.
//!
//! ```text
//! M δẅ + C δv + K δq + Φ_qᵀ δλ = 0,  Φ_q δq = 0,   K = ∂(M w + Φ_qᵀ λ − Q)/∂q,  C = ∂(…)/∂v
//! ```
//!
//! Everything is per scale of the coordinates: q̂ = q/s, so K̂ = S K S and Φ̂_q = Φ_q S with S = diag(s). Eigenvalues
//! do not change by that.

use nalgebra::DMatrix;
use symdiff::Tile;

use crate::assemble::ConstraintId;
use crate::compile::{EquationsProgram, Tapes};

/// The tapes of the equations with one state.
#[derive(Debug)]
pub struct StaticConfiguration<'p> {
    program: &'p EquationsProgram,
    scale: &'p [f64],
    /// Constraints that others imply: they have no multipliers.
    redundant: &'p [ConstraintId],
    tile: Tile,
}

/// The equations about a configuration, per scale of the coordinates.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// M w + Φ_qᵀ λ − Q, n.
    pub motion: Vec<f64>,
    /// Φ, m.
    pub constraint: Vec<f64>,
    /// M, n × n.
    pub mass: DMatrix<f64>,
    /// C, n × n.
    pub damping: DMatrix<f64>,
    /// K, n × n.
    pub stiffness: DMatrix<f64>,
    /// Φ_q, m rows of n; zero for redundant constraints.
    pub jacobian: Vec<Vec<f64>>,
}

impl<'p> StaticConfiguration<'p> {
    /// The configuration at rest at the origin, with these parameters.
    pub fn new(
        program: &'p EquationsProgram,
        scale: &'p [f64],
        redundant: &'p [ConstraintId],
        parameters: &[f64],
    ) -> Self {
        let mut tile = Tile::new(1, program.registers(), program.constants());
        let mut configuration = {
            tile.lane_mut(program.layout.time)[0] = 0.0;
            Self { program, scale, redundant, tile }
        };
        configuration.set(program.layout.parameters.clone(), parameters);
        configuration.tile.run(program.sample());
        configuration
    }

    /// Sets registers of the layout.
    pub fn set(&mut self, registers: std::ops::Range<usize>, values: &[f64]) {
        registers.zip(values).for_each(|(register, &value)| self.tile.lane_mut(register)[0] = value);
    }

    /// Values of registers.
    pub fn get(&self, registers: impl IntoIterator<Item = usize>) -> Vec<f64> {
        registers.into_iter().map(|register| self.tile.lane(register)[0]).collect()
    }

    /// The equations at the present state.
    pub fn linearise(&mut self) -> Linearised {
        let program = self.program;
        self.tile.run(program.residual());
        let scaled = |(&register, scale): (&usize, &f64)| self.tile.lane(register)[0] * scale;
        let motion = program.motion.iter().zip(self.scale).map(scaled).collect();
        let constraint = self.get(program.constraint.iter().copied());
        self.tile.run(program.jacobian());
        let n = self.scale.len();
        let matrix = |entries: &[(usize, usize, usize)]| {
            let mut matrix = DMatrix::zeros(n, n);
            for &(row, column, register) in entries {
                matrix[(row, column)] = self.tile.lane(register)[0] * self.scale[row] * self.scale[column];
            }
            matrix
        };
        let [stiffness, damping, mass, _] = &program.motion_by;
        let [stiffness, damping, mass] = [stiffness, damping, mass].map(|entries| matrix(entries));
        let mut jacobian = vec![vec![0.0; n]; program.constraint.len()];
        let independent = program
            .constraint_by_position
            .iter()
            .filter(|(row, ..)| !self.redundant.contains(&ConstraintId::new(*row)));
        for &(row, column, register) in independent {
            jacobian[row][column] = self.tile.lane(register)[0] * self.scale[column];
        }
        Linearised { motion, constraint, mass, damping, stiffness, jacobian }
    }

    /// The outputs at the present state.
    pub fn outputs(&mut self) -> Vec<f64> {
        self.tile.run(self.program.observe());
        self.get(self.program.outputs.iter().copied())
    }
}

/// A x, by plain sums: a product of matrices may be fused with its addition on some processors.
pub fn times(matrix: &DMatrix<f64>, vector: &[f64]) -> Vec<f64> {
    (0..matrix.nrows())
        .map(|row| vector.iter().enumerate().map(|(column, x)| matrix[(row, column)] * x).sum())
        .collect()
}

/// Nᵀ A N for vectors N.
pub fn reduced(matrix: &DMatrix<f64>, basis: &[Vec<f64>]) -> DMatrix<f64> {
    let mut small = DMatrix::zeros(basis.len(), basis.len());
    for (column, vector) in basis.iter().enumerate() {
        let image = times(matrix, vector);
        for (row, other) in basis.iter().enumerate() {
            small[(row, column)] = crate::numerics::dot(other, &image);
        }
    }
    small
}
