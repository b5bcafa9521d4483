//! A flexible body that its first node carries along: mass, centre and moments of inertia, and how each coordinate of
//! deformation changes them.
//!
//! x is a point of the undeformed body from the first node, N_k the displacement there by coordinate k, ρ the density:
//!
//! ```text
//! m = ∫ρ,   S_0 = ∫ρ x,   J_0 = ∫ρ (x·x 1 − x xᵀ)
//! a_k = ∫ρ N_k,   b_k = ∫ρ x × N_k,   c_k = ∫ρ (x·N_k 1 − ½ (x N_kᵀ + N_k xᵀ))
//! ```
//!
//! All but c_k are exact from the mass matrix, since it knows displacements and rotations of the whole body. c_k needs
//! strains of the whole body, x ↦ G x with G symmetric: the nodes are displaced by G x, and the other coordinates (the
//! nodes' rotations, the modes) take the values of least stored energy. That is exact where such a strain is among the
//! shapes, as along a bar or for lumped masses at nodes.

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};

use super::matrices::{Matrices, OF_NODE};
use crate::elements::tuning::TUNING;

/// Rows and columns of a symmetric matrix.
const SYMMETRIC: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

/// Inertia of the whole body in the axes of its first node, and its slopes by the coordinates of deformation.
#[derive(Clone, Debug)]
pub struct Carried {
    /// m, kg
    pub mass: f64,
    /// S_0, kg m
    pub moment: [f64; 3],
    /// J_0, kg m²
    pub inertia: Matrix3<f64>,
    /// a_k of each row of the mass matrix
    pub translation: Vec<[f64; 3]>,
    /// b_k
    pub rotation: Vec<[f64; 3]>,
    /// c_k, half of the slope of J
    pub stretch: Vec<Matrix3<f64>>,
}

impl Carried {
    /// Inertia of a body by its matrices.
    pub fn of(matrices: &Matrices) -> Self {
        let mass = &matrices.mass;
        let motions = |motion: &dyn Fn(usize) -> DVector<f64>| {
            let columns = [0, 1, 2].map(motion);
            let images = columns.each_ref().map(|column| mass * column);
            (columns, images)
        };
        let (along, momenta) = motions(&|axis| matrices.translation(axis));
        let (about, angular) = motions(&|axis| matrices.rotation(axis));
        let rows =
            |images: &[DVector<f64>; 3]| (0..mass.nrows()).map(|row| images.each_ref().map(|of| of[row])).collect();
        let momentum = |turn: usize, axis: usize| along[axis].dot(&angular[turn]);
        let strains = SYMMETRIC.map(|place| {
            let is_in = |i, j| place == [i, j] || place == [j, i];
            let unit = Matrix3::from_fn(|i, j| if is_in(i, j) { 1.0 } else { 0.0 });
            // Beside the diagonal half of x_i and half of x_j, as in the mean of both moments.
            let share = if place[0] == place[1] { 1.0 } else { 0.5 };
            (unit, mass * strained(matrices, share * unit))
        });
        let stretch = |row: usize| {
            let moments: Matrix3<f64> = strains.iter().map(|(unit, image)| image[row] * unit).sum();
            Matrix3::identity() * moments.trace() - moments
        };
        Self {
            mass: along[0].dot(&momenta[0]),
            moment: [momentum(2, 1), -momentum(2, 0), -momentum(0, 1)],
            inertia: Matrix3::from_fn(|i, j| about[i].dot(&angular[j])),
            translation: rows(&momenta),
            rotation: rows(&angular),
            stretch: (0..mass.nrows()).map(stretch).collect(),
        }
    }
}

/// The coordinates of a strain of the whole body.
fn strained(matrices: &Matrices, strain: Matrix3<f64>) -> DVector<f64> {
    let of_nodes = OF_NODE * matrices.nodes.len();
    let is_displacement = |row: usize| row < of_nodes && row % OF_NODE < 3;
    let displacement = |row: usize| match is_displacement(row) {
        true => (strain * Vector3::from(matrices.offset(row / OF_NODE)))[row % OF_NODE],
        false => 0.0,
    };
    let mut all = DVector::from_fn(matrices.stiffness.nrows(), |row, _| displacement(row));
    let free: Vec<usize> = (0..all.len()).filter(|&row| !is_displacement(row)).collect();
    let force = (&matrices.stiffness * &all).select_rows(&free);
    let stiffness = matrices.stiffness.select_rows(&free).select_columns(&free);
    // Scales metres, radians and modes alike; coordinates that store no energy stay zero.
    let scales = stiffness.diagonal().map(|own| if own > 0.0 { 1.0 / own.sqrt() } else { 0.0 });
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| scales[i] * stiffness[(i, j)] * scales[j]);
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(scaled);
    let none = TUNING.no_stiffness * eigenvalues.amax();
    let parts = (eigenvectors.tr_mul(&force.component_mul(&scales)))
        .zip_map(&eigenvalues, |part, stiffness| if stiffness > none { -part / stiffness } else { 0.0 });
    let least = (eigenvectors * parts).component_mul(&scales);
    free.into_iter().zip(least.iter()).for_each(|(row, &value)| all[row] = value);
    all
}
