//! Orthonormal frames that turn with ξ.
//!
//! What is not in a state's polynomials is carried as A(ξ) z, |zᵢ| ≤ rᵢ, and a step maps it to B(ξ) z. Boxes instead of A z would grow
//! at every step by what their corners stick out (the wrapping effect). Lohner's remedy, QR with the widest column first,
//! is done here in jets, for all ξ at once: a frame that is right at the centre only is turned against the motion's
//! directions elsewhere, and mixes what decays (errors of hidden constraints, by 0.82 a step for α = −0.1) into what does not.

use symdiff::Unary;
use symdiff::jet::JetScratch;
use symdiff::taylor_model::ModelSpace;

use super::matrix::Models;

/// A column that stands out of the ones before it by less than this, relative to its length, has no direction of its own.
const DEPENDENT: f64 = 1e-3;

/// An approximately orthonormal basis of all dimensions, whose first members span the columns of `matrix` (square), those with the largest
/// `radii` first.
pub(super) fn orthonormal(space: &ModelSpace, matrix: &Models, radii: &[f64]) -> Models {
    let dimension = matrix.rows;
    let columns = matrix.transposed();
    let centre = |column: usize| (0..dimension).map(move |row| matrix.at(row, column)[0]);
    let length = |column: usize| centre(column).map(|c| c * c).sum::<f64>().sqrt();
    let mut order: Vec<usize> = (0..dimension).collect();
    order.sort_by(|&a, &b| (length(b) * radii[b]).total_cmp(&(length(a) * radii[a])).then(a.cmp(&b)));

    let mut frame = Frame::new(space, dimension);
    let mut candidate = vec![0.0; dimension * space.size()];
    for column in order {
        candidate.copy_from_slice(columns.row(column));
        let before = frame.length(&candidate);
        frame.project_out(&mut candidate);
        let after = frame.length(&candidate);
        if after > DEPENDENT * before && after > f64::MIN_POSITIVE {
            frame.push(&mut candidate);
        }
    }
    while frame.count < dimension {
        // The axis that the frame so far represents worst.
        let axis = (0..dimension).min_by(|&a, &b| frame.share(a).total_cmp(&frame.share(b))).unwrap_or(0);
        candidate.fill(0.0);
        candidate[axis * space.size()] = 1.0;
        frame.project_out(&mut candidate);
        frame.push(&mut candidate);
    }
    frame.vectors.transposed()
}

/// The vectors so far, a row each.
struct Frame<'s> {
    space: &'s ModelSpace,
    vectors: Models,
    count: usize,
    scratch: JetScratch,
}

impl<'s> Frame<'s> {
    fn new(space: &'s ModelSpace, dimension: usize) -> Self {
        let vectors = Models::zero(space, dimension, dimension);
        Self { space, vectors, count: 0, scratch: JetScratch::new(space.jets()) }
    }

    /// Length of a vector at the centre.
    fn length(&self, vector: &[f64]) -> f64 {
        vector.chunks_exact(self.space.size()).map(|entry| entry[0] * entry[0]).sum::<f64>().sqrt()
    }

    /// Squared length of an axis' projection on the frame, at the centre.
    fn share(&self, axis: usize) -> f64 {
        (0..self.count).map(|row| self.vectors.at(row, axis)[0].powi(2)).sum()
    }

    /// v ← v − Q (Qᵀ v), vector by vector, twice: once leaves the rounding errors of what was taken off.
    fn project_out(&self, vector: &mut [f64]) {
        let (size, jets) = (self.space.size(), self.space.jets());
        let mut product = vec![0.0; jets.len()];
        for row in (0..self.count).chain(0..self.count) {
            product.fill(0.0);
            for (place, entry) in vector.chunks_exact(size).enumerate() {
                jets.accumulate(&self.vectors.at(row, place)[..jets.len()], &entry[..jets.len()], &mut product);
            }
            product.iter_mut().for_each(|c| *c = -*c);
            for (place, entry) in vector.chunks_exact_mut(size).enumerate() {
                jets.accumulate(&self.vectors.at(row, place)[..jets.len()], &product, &mut entry[..jets.len()]);
            }
        }
    }

    /// Adds a vector, made one long.
    fn push(&mut self, vector: &mut [f64]) {
        let (size, jets) = (self.space.size(), self.space.jets());
        let mut square = vec![0.0; jets.len()];
        for entry in vector.chunks_exact(size) {
            jets.accumulate(&entry[..jets.len()], &entry[..jets.len()], &mut square);
        }
        let mut length = vec![0.0; jets.len()];
        jets.unary(Unary::Sqrt, &square, &mut length, &mut self.scratch);
        for (place, entry) in vector.chunks_exact(size).enumerate() {
            jets.div(&entry[..jets.len()], &length, &mut self.vectors.at_mut(self.count, place)[..jets.len()]);
        }
        self.count += 1;
    }
}
