//! A straight beam of finite elements, and its reduction by Craig and Bampton: matrices that this project did not make.

use nalgebra::{DMatrix, SymmetricEigen};

/// Coordinates of a node.
const OF_NODE: usize = 6;

/// A beam along x of one material and a section with two axes of symmetry.
#[derive(Clone, Copy)]
pub struct Beam {
    /// m
    pub length: f64,
    /// EA, N
    pub axial: f64,
    /// EI about y and z, N m²
    pub bending: [f64; 2],
    /// GJ, N m²
    pub torsional: f64,
    /// kg/m
    pub mass: f64,
    /// Moment of inertia about x over the length, kg m
    pub turning: f64,
}

/// Mass and stiffness.
pub struct Matrices {
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
}

impl Beam {
    /// Euler and Bernoulli's beam with consistent masses (Przemieniecki 1968, ch. 5 and 11).
    pub fn of_elements(&self, elements: usize) -> Matrices {
        let size = OF_NODE * (elements + 1);
        let (mut mass, mut stiffness) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        let h = self.length / elements as f64;
        for element in 0..elements {
            let first = OF_NODE * element;
            // Axial and torsional: two coordinates; bending about z: y and its slope θ_z; about y: z and its slope
            // −θ_y.
            for (coordinate, k, m) in [(0, self.axial, self.mass), (3, self.torsional, self.turning)] {
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let index = (first + OF_NODE * i + coordinate, first + OF_NODE * j + coordinate);
                    stiffness[index] += k / h * if i == j { 1.0 } else { -1.0 };
                    mass[index] += m * h / 6.0 * if i == j { 2.0 } else { 1.0 };
                }
            }
            for (across, slope, sign, bending) in [(1, 5, 1.0, self.bending[1]), (2, 4, -1.0, self.bending[0])] {
                let places = [across, slope, across + OF_NODE, slope + OF_NODE].map(|index| first + index);
                let signs = [1.0, sign * h, 1.0, sign * h];
                let k =
                    [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]];
                let m = [
                    [156.0, 22.0, 54.0, -13.0],
                    [22.0, 4.0, 13.0, -3.0],
                    [54.0, 13.0, 156.0, -22.0],
                    [-13.0, -3.0, -22.0, 4.0],
                ];
                for i in 0..4 {
                    for j in 0..4 {
                        let factor = signs[i] * signs[j];
                        stiffness[(places[i], places[j])] += bending / h.powi(3) * k[i][j] * factor;
                        mass[(places[i], places[j])] += self.mass * h / 420.0 * m[i][j] * factor;
                    }
                }
            }
        }
        Matrices { mass, stiffness }
    }
}

impl Matrices {
    /// Constraint modes of the `kept` nodes, then the lowest normal modes with those nodes fixed.
    pub fn reduced(&self, kept: &[usize], modes: usize) -> Self {
        let nodes = self.mass.nrows() / OF_NODE;
        let rows = |of: &dyn Fn(usize) -> bool| -> Vec<usize> {
            (0..nodes).filter(|&node| of(node)).flat_map(|node| OF_NODE * node..OF_NODE * (node + 1)).collect()
        };
        let outer: Vec<usize> = kept.iter().flat_map(|&node| OF_NODE * node..OF_NODE * (node + 1)).collect();
        let inner = rows(&|node| !kept.contains(&node));
        let part = |of: &DMatrix<f64>, a: &[usize], b: &[usize]| of.select_rows(a).select_columns(b);
        let within = part(&self.stiffness, &inner, &inner);
        let follow = -within.clone().cholesky().unwrap().solve(&part(&self.stiffness, &inner, &outer));
        let lower = part(&self.mass, &inner, &inner).cholesky().unwrap().l();
        let inverse = lower.try_inverse().unwrap();
        let eigen = SymmetricEigen::new(&inverse * within * inverse.transpose());
        let mut order: Vec<usize> = (0..inner.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let shapes = inverse.transpose() * eigen.eigenvectors.select_columns(&order[..modes]);
        let size = outer.len() + modes;
        let mut basis = DMatrix::zeros(self.mass.nrows(), size);
        for (column, &row) in outer.iter().enumerate() {
            basis[(row, column)] = 1.0;
        }
        for (index, &row) in inner.iter().enumerate() {
            (0..outer.len()).for_each(|column| basis[(row, column)] = follow[(index, column)]);
            (0..modes).for_each(|mode| basis[(row, outer.len() + mode)] = shapes[(index, mode)]);
        }
        let [mass, stiffness] = [&self.mass, &self.stiffness].map(|of| basis.transpose() * of * &basis);
        Self { mass, stiffness }
    }

    /// Text of a model's superelement: rows of the matrices up to the diagonal.
    pub fn yaml(&self, nodes: &[[f64; 3]], modes: usize) -> String {
        let rows = |of: &DMatrix<f64>| {
            let row = |i: usize| {
                let entries: Vec<String> = (0..=i).map(|j| format!("{:e}", 0.5 * (of[(i, j)] + of[(j, i)]))).collect();
                format!("[{}]", entries.join(", "))
            };
            (0..of.nrows()).map(row).collect::<Vec<_>>().join(",\n  ")
        };
        let (mass, stiffness) = (rows(&self.mass), rows(&self.stiffness));
        format!("{{ nodes: {nodes:?}, modes: {modes},\n  mass: [{mass}],\n  stiffness: [{stiffness}] }}")
    }
}
