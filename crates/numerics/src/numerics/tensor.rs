//! Products of matrices along the axes of a tensor.

use symdiff::sincos::sin_cos;

/// cos(π p/q) for whole numbers: reduced exactly, so zeros, ±1 and symmetries are exact.
pub(super) fn cos_pi(p: usize, q: usize) -> f64 {
    let p = p % (2 * q);
    let p = if p > q { 2 * q - p } else { p };
    if 2 * p == q {
        0.0
    } else if 2 * p > q {
        -cos_pi(q - p, q)
    } else if 4 * p > q {
        sin_cos(std::f64::consts::PI * (q - 2 * p) as f64 / (2 * q) as f64).0
    } else {
        sin_cos(std::f64::consts::PI * p as f64 / q as f64).1
    }
}

/// A dense matrix, row by row.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub rows: usize,
    pub columns: usize,
    pub entries: Vec<f64>,
}

impl Matrix {
    pub fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let entry = &entry;
        let entries = (0..rows).flat_map(|row| (0..columns).map(move |column| entry(row, column))).collect();
        Self { rows, columns, entries }
    }
}

/// One matrix for each axis: out[i₁…i_k] = Σ A¹[i₁,j₁] … A^k[i_k,j_k] in[j₁…j_k], tensors with the last index fastest.
#[derive(Clone, Debug)]
pub(super) struct Separable {
    pub axes: Vec<Matrix>,
}

impl Separable {
    pub fn new(axes: Vec<Matrix>) -> Self {
        Self { axes }
    }

    /// Applies them, first axis first. `work` grows at the first call and then stays. Returns the result, which lies in
    /// `work`.
    pub fn apply<'a>(&self, input: &[f64], work: &'a mut Work) -> &'a mut Vec<f64> {
        let Work { current, next } = work;
        current.clear();
        current.extend_from_slice(input);
        let mut outer = 1;
        for matrix in &self.axes {
            let inner = current.len() / (outer * matrix.columns);
            next.clear();
            next.resize(outer * matrix.rows * inner, 0.0);
            let blocks = current.chunks_exact(matrix.columns * inner).zip(next.chunks_exact_mut(matrix.rows * inner));
            for (from, to) in blocks {
                multiply(matrix, from, to, inner);
            }
            std::mem::swap(current, next);
            outer *= matrix.rows;
        }
        current
    }
}

/// to[i, ·] = Σ_j A[i, j] from[j, ·], rows of `inner` entries; `to` starts as zero.
fn multiply(matrix: &Matrix, from: &[f64], to: &mut [f64], inner: usize) {
    for (weights, to) in matrix.entries.chunks_exact(matrix.columns).zip(to.chunks_exact_mut(inner)) {
        if inner == 1 {
            to[0] = weights.iter().zip(from).map(|(w, x)| w * x).sum();
            continue;
        }
        for (&weight, from) in weights.iter().zip(from.chunks_exact(inner)) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += weight * from);
        }
    }
}

/// Two work buffers, reused between calls.
#[derive(Clone, Debug, Default)]
pub struct Work {
    current: Vec<f64>,
    next: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosines_are_exact_where_they_can_be() {
        assert_eq!([0, 1, 2, 3, 4, 5, 6].map(|p| cos_pi(p, 2)), [1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0]);
        for p in 0..400 {
            let exact = (std::f64::consts::PI * p as f64 / 37.0).cos();
            assert!((cos_pi(p, 37) - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn axes_are_multiplied_in_turn() {
        let a = Matrix { rows: 1, columns: 2, entries: vec![1.0, 10.0] };
        let b = Matrix { rows: 2, columns: 3, entries: vec![1.0, 0.0, 0.0, 1.0, 1.0, 1.0] };
        let mut work = Work::default();
        let result = Separable::new(vec![a, b]).apply(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &mut work);
        assert_eq!(*result, [41.0, 156.0]);
    }
}
