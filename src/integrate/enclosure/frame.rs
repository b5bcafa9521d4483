//! Frames for what a state's polynomials miss, which turn with ξ.
//!
//! A state's remainder d is carried in coordinates z, |zᵢ| ≤ rᵢ, of a frame that each step chooses anew: boxes in fixed coordinates
//! would grow at every step by what their turned corners stick out (the wrapping effect). The scheme moves d in
//! two ways. 2f directions are slow: changed independent coordinates and velocities, with all else consistent. The others are fast:
//! errors of hidden constraints and of the algorithmic acceleration, in velocities h and in accelerations h² times as
//! large as in positions, which fade by 0.82 a step (α = −0.1). A frame that is not right for every ξ mixes them, a thousand times a second. So
//!
//! ```text
//! d = S(ξ) Q z_s + E(ξ) F(ξ) z_f,     W S = I,     E = [K(ξ); I]
//! ```
//!
//! where W takes the independent coordinates and velocities out of d, and S and E have the rows that W takes first. S follows
//! the motion exactly, S₊ = B S (W₊ B S)⁻¹ for the step's derivative B(ξ), so that nothing slow becomes fast. K makes E's
//! columns orthogonal to the motion in the metric of the masses, as are the reactions' pushes: what is fast then fades without
//! much of it becoming slow, and staying. F(ξ) is orthonormal for all ξ at once, by Gram and Schmidt in jets. The slow coordinates no
//! longer turn with ξ, and a constant Q is enough for them. Both orthogonalisations are Lohner's, the column with the largest
//! remainder first.

use nalgebra::DMatrix;
use symdiff::jet::JetScratch;
use symdiff::taylor_model::{ModelSpace, up};
use symdiff::{Interval, Unary};

use super::Lost;
use super::matrix::{Models, apply_bounds, larger};

/// A column that stands out of the ones before it by less than this, relative to the longest, has no direction of its
/// own: what little it adds would turn fast with ξ. (The scheme shortens nothing that it keeps by more than 0.11.)
const DEPENDENT: f64 = 1e-3;

/// Independent coordinates are chosen anew when another moves this many times as much.
const OUTRUN: f64 = 2.0;

/// A frame of dimension 3n: q̂, v̂, w.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Rows of the independent coordinates, and then of their velocities: what W takes.
    independent: Vec<usize>,
    /// The other rows.
    rest: Vec<usize>,
    /// What W multiplies by: 1 for coordinates; velocities are measured in a unit of the motion, not of the step.
    weights: Vec<f64>,
    /// S, 3n × 2f.
    slow: Models,
    /// K, 2f rows.
    coupling: Models,
    /// Q.
    turned: DMatrix<f64>,
    /// F.
    fast: Models,
}

impl Frame {
    /// At the start: `tangent` has the n rows of ∂q/∂(independent coordinates) at the centre. `velocity_weight` is
    /// the motion's time unit over the step's.
    pub fn new(space: &ModelSpace, tangent: &DMatrix<f64>, independent: &[usize], velocity_weight: f64) -> Self {
        let (n, f) = tangent.shape();
        let mut slow = Models::zero(space, 3 * n, 2 * f);
        for column in 0..f {
            for row in 0..n {
                let slope = tangent[(row, column)];
                slow.at_mut(row, column)[0] = slope;
                slow.at_mut(n + row, f + column)[0] = slope / velocity_weight;
                if !independent.contains(&row) {
                    slow.at_mut(row, f + column)[0] = slope / velocity_weight;
                }
            }
        }
        let (independent, rest, weights) = rows(n, independent, velocity_weight);
        let fast = Models::identity(space, rest.len());
        let coupling = Models::zero(space, 2 * f, rest.len());
        let turned = DMatrix::identity(2 * f, 2 * f);
        let mut frame = Self { independent, rest, weights, slow, coupling, turned, fast };
        frame.make_exact();
        frame
    }

    /// The frame's columns [S Q, E F].
    pub fn columns(&self, space: &ModelSpace) -> Models {
        let (slow_count, dimension) = (self.independent.len(), self.slow.rows);
        let slow = self.slow.times(space, &constant(space, &self.turned));
        let mut columns = Models::zero(space, dimension, dimension);
        for row in 0..dimension {
            for column in 0..slow_count {
                columns.at_mut(row, column).copy_from_slice(slow.at(row, column));
            }
        }
        for (place, &row) in self.rest.iter().enumerate() {
            for column in 0..self.rest.len() {
                columns.at_mut(row, slow_count + column).copy_from_slice(self.fast.at(place, column));
            }
        }
        let coupled = self.coupling.times(space, &self.fast);
        for (place, (&row, weight)) in self.independent.iter().zip(&self.weights).enumerate() {
            for column in 0..self.rest.len() {
                columns.at_mut(row, slow_count + column).copy_from_slice(coupled.at(place, column));
            }
            for column in slow_count..dimension {
                columns.at_mut(row, column).iter_mut().for_each(|c| *c /= weight);
            }
        }
        columns
    }

    /// z of a box |dᵢ| ≤ `spread`.
    pub fn radii_of(&self, space: &ModelSpace, spread: &[f64]) -> Result<Vec<f64>, Lost> {
        let nothing = Models::zero(space, self.slow.rows, 1);
        let split = self.split(space, &nothing)?;
        self.coordinates_of(space, &split, &[0.0], spread)
    }

    /// The frame for B z + e, where the first columns of `moved` are B, a step's derivative along this frame's columns; and the
    /// radii in it of all that `moved` maps from |zᵢ| ≤ `radii`, and of |eᵢ| ≤ `fresh`. `mass` is M in the coordinates' units.
    ///
    /// # Errors
    /// Where the frame degenerates.
    pub fn next(
        &self,
        space: &ModelSpace,
        moved: &Models,
        radii: &[f64],
        fresh: &[f64],
        mass: &Models,
    ) -> Result<(Self, Vec<f64>), Lost> {
        let (slow_count, dimension, n) = (self.independent.len(), self.slow.rows, mass.rows);
        let f = slow_count / 2;
        let slow_columns = moved.part(space, 0..dimension, 0..slow_count).without_radii();
        let mut next = self.clone();
        next.follow(space, &slow_columns)?;
        // At the centre: what another coordinate moves per movement of the independent ones.
        let outrun = (0..n).any(|row| (0..f).any(|column| next.slow.at(row, column)[0].abs() > OUTRUN));
        if outrun {
            let better = pivots(&next.slow, n, f);
            (next.independent, next.rest, next.weights) = rows(n, &better, self.weights[f]);
            next.follow(space, &slow_columns)?;
        }
        next.couple(space, mass)?;

        let split = next.split(space, moved)?;
        let direct = &split.slow;
        let size = |column: usize| (0..slow_count).map(|row| direct.at(row, column)[0].powi(2)).sum();
        let order = by_size(&radii[..slow_count], size);
        let sorted = DMatrix::from_fn(slow_count, slow_count, |row, column| {
            direct.at(row, order[column])[0] * radii[order[column]].max(f64::MIN_POSITIVE.sqrt())
        });
        next.turned = sorted.qr().q();
        let fast_columns = split.fast.part(space, 0..next.rest.len(), slow_count..dimension);
        next.fast = orthonormal(space, &fast_columns, &radii[slow_count..dimension]);
        let radii = next.coordinates_of(space, &split, radii, fresh)?;
        Ok((next, radii))
    }

    /// K = −(Tᵀ M)_W⁻¹ (Tᵀ M)_rest for positions, and the same for velocities, T being S for positions.
    fn couple(&mut self, space: &ModelSpace, mass: &Models) -> Result<(), Lost> {
        let (n, f) = (mass.rows, self.independent.len() / 2);
        let tangent = self.slow.part(space, 0..n, 0..f).transposed();
        let pushed = tangent.approximate_times(space, mass);
        let mut direct = Models::zero(space, f, f);
        for (column, &row) in self.independent[..f].iter().enumerate() {
            (0..f).for_each(|i| direct.at_mut(i, column).copy_from_slice(pushed.at(i, row)));
        }
        let mut inverse = direct.inverse_at_centre(space).ok_or(Lost::Unproven)?;
        if !inverse.refine_inverse_of(space, &direct) {
            return Err(Lost::Unproven);
        }
        let mut ratio = inverse.approximate_times(space, &pushed);
        ratio.negate();
        self.coupling = Models::zero(space, 2 * f, self.rest.len());
        for (place, &row) in self.rest.iter().enumerate().filter(|(_, row)| **row < 2 * n) {
            let block = row / n;
            for i in 0..f {
                let target = self.coupling.at_mut(block * f + i, place);
                target.copy_from_slice(ratio.at(i, row % n));
                target.iter_mut().for_each(|c| *c *= self.weights[block * f]);
            }
        }
        Ok(())
    }

    pub fn debug(&self) -> String {
        let var = |m: &Models| (0..m.rows).flat_map(|r| (0..m.columns).map(move |c| (r, c))).map(|(r, c)| m.at(r, c)[1..].iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
        format!("slowvar {:.1e} fastvar {:.1e} indep {:?}", var(&self.slow), var(&self.fast), self.independent)
    }

    /// S from the columns that it is to span.
    fn follow(&mut self, space: &ModelSpace, columns: &Models) -> Result<(), Lost> {
        let direct = self.take(space, columns);
        let mut inverse = direct.inverse_at_centre(space).ok_or(Lost::Unproven)?;
        if !inverse.refine_inverse_of(space, &direct) {
            return Err(Lost::Unproven);
        }
        self.slow = columns.approximate_times(space, &inverse);
        self.make_exact();
        Ok(())
    }

    /// W S = I to the bit.
    fn make_exact(&mut self) {
        for (place, &row) in self.independent.iter().enumerate() {
            for column in 0..self.independent.len() {
                let model = self.slow.at_mut(row, column);
                model.fill(0.0);
                if column == place {
                    model[0] = 1.0 / self.weights[place];
                }
            }
        }
    }

    /// W d for each column d.
    fn take(&self, space: &ModelSpace, columns: &Models) -> Models {
        let mut taken = Models::zero(space, self.independent.len(), columns.columns);
        for (place, (&row, weight)) in self.independent.iter().zip(&self.weights).enumerate() {
            for column in 0..columns.columns {
                let target = taken.at_mut(place, column);
                target.copy_from_slice(columns.at(row, column));
                target.iter_mut().for_each(|c| *c *= weight);
            }
        }
        taken
    }

    /// Some rows of columns.
    fn rest_of(&self, space: &ModelSpace, columns: &Models) -> Models {
        let mut rest = Models::zero(space, self.rest.len(), columns.columns);
        for (place, &row) in self.rest.iter().enumerate() {
            (0..columns.columns).for_each(|column| rest.at_mut(place, column).copy_from_slice(columns.at(row, column)));
        }
        rest
    }

    /// Columns d as S u + E y: u = N (W d − K d_rest), N ≈ (I − K S_rest)⁻¹, and y = d_rest − S_rest u.
    fn split(&self, space: &ModelSpace, columns: &Models) -> Result<Split, Lost> {
        let (direct, rest, slow_rest) = (self.take(space, columns), self.rest_of(space, columns), self.rest_of(space, &self.slow));
        let overlap = self.coupling.times(space, &slow_rest).from_identity(space);
        let mut inverse = overlap.inverse_at_centre(space).ok_or(Lost::Unproven)?;
        if !inverse.refine_inverse_of(space, &overlap) {
            return Err(Lost::Unproven);
        }
        let uncoupled = direct.minus(space, &self.coupling.times(space, &rest));
        let slow = inverse.times(space, &uncoupled);
        let fast = rest.minus(space, &slow_rest.times(space, &slow));
        let skew = inverse.times(space, &overlap).from_identity(space).row_norm(space);
        // Written so that not a number is lost too.
        if !(skew < 0.5) {
            return Err(Lost::Unproven);
        }
        Ok(Split { slow, fast, inverse, slow_rest, skew })
    }

    /// Bounds of this frame's coordinates of B z + e, |zᵢ| ≤ `radii`, |eᵢ| ≤ `fresh`.
    fn coordinates_of(&self, space: &ModelSpace, split: &Split, radii: &[f64], fresh: &[f64]) -> Result<Vec<f64>, Lost> {
        let taken = self.independent.iter().zip(&self.weights).map(|(&row, weight)| fresh[row] * weight);
        let of_rest: Vec<f64> = self.rest.iter().map(|&row| fresh[row]).collect();
        let coupled = apply_bounds(&self.coupling.bounds(space), &of_rest);
        let uncoupled: Vec<f64> = taken.zip(&coupled).map(|(a, b)| up(a + b)).collect();
        let mut slow_fresh = apply_bounds(&split.inverse.bounds(space), &uncoupled);
        // u = N (…) + (I − N (I − K S_rest)) u.
        let rough = apply_bounds(&split.slow.bounds(space), radii);
        let largest = rough.iter().zip(&slow_fresh).map(|(a, b)| up(a + b)).fold(0.0, larger);
        let more = up(split.skew * largest / (1.0 - split.skew));
        slow_fresh.iter_mut().for_each(|fresh| *fresh = up(*fresh + more));
        let followed = apply_bounds(&split.slow_rest.bounds(space), &slow_fresh);
        let fast_fresh: Vec<f64> = of_rest.iter().zip(&followed).map(|(a, b)| up(a + b)).collect();
        let mut coordinates = within(space, &constant(space, &self.turned), &split.slow, radii, &slow_fresh)?;
        coordinates.extend(within(space, &self.fast, &split.fast, radii, &fast_fresh)?);
        Ok(coordinates)
    }
}

/// Columns taken apart.
struct Split {
    /// u of each column.
    slow: Models,
    /// y of each column.
    fast: Models,
    /// N.
    inverse: Models,
    slow_rest: Models,
    /// ‖I − N (I − K S_rest)‖.
    skew: f64,
}

/// Rows of W, the others, and W's weights, for independent coordinates among n.
fn rows(n: usize, independent: &[usize], velocity_weight: f64) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let taken: Vec<usize> = independent.iter().copied().chain(independent.iter().map(|i| n + i)).collect();
    let rest = (0..3 * n).filter(|row| !taken.contains(row)).collect();
    let weights = [1.0, velocity_weight].into_iter().flat_map(|weight| vec![weight; independent.len()]).collect();
    (taken, rest, weights)
}

/// The f of n coordinates that others follow best at the centre: elimination with complete pivoting.
fn pivots(slow: &Models, n: usize, f: usize) -> Vec<usize> {
    let mut matrix = DMatrix::from_fn(n, f, |row, column| slow.at(row, column)[0]);
    let mut chosen = Vec::new();
    for _ in 0..f {
        let place = matrix.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(0, |(place, _)| place);
        let (row, column) = (place % n, place / n);
        chosen.push(row);
        let pivot_row = matrix.row(row) / matrix[(row, column)];
        let pivot_column = matrix.column(column).clone_owned();
        matrix -= pivot_column * pivot_row;
        matrix.row_mut(row).fill(0.0);
        matrix.column_mut(column).fill(0.0);
    }
    chosen.sort_unstable();
    chosen
}

/// A matrix of numbers.
fn constant(space: &ModelSpace, numbers: &DMatrix<f64>) -> Models {
    let mut models = Models::zero(space, numbers.nrows(), numbers.ncols());
    for row in 0..numbers.nrows() {
        for column in 0..numbers.ncols() {
            space.constant(Interval::point(numbers[(row, column)]), models.at_mut(row, column));
        }
    }
    models
}

/// Bounds of x with Q x = B z + e for a nearly orthogonal Q: x = Qᵀ(B z + e) + (I − QᵀQ) x.
fn within(space: &ModelSpace, basis: &Models, matrix: &Models, radii: &[f64], fresh: &[f64]) -> Result<Vec<f64>, Lost> {
    let back = basis.transposed();
    let moved = apply_bounds(&back.times(space, matrix).bounds(space), radii);
    let entering = apply_bounds(&back.bounds(space), fresh);
    let rough: Vec<f64> = moved.iter().zip(&entering).map(|(a, b)| up(a + b)).collect();
    let rest = back.times(space, basis).from_identity(space);
    let skew = rest.row_norm(space);
    // Written so that not a number is lost too.
    if !(skew < 0.5) {
        return Err(Lost::Unproven);
    }
    let largest = up(rough.iter().copied().fold(0.0, larger) / (1.0 - skew));
    let rows = rest.bounds(space);
    let more = rows.chunks_exact(basis.columns).map(|row| up(row.iter().sum::<f64>()) * largest);
    Ok(rough.iter().zip(more).map(|(rough, more)| up(rough + more)).collect())
}

/// Columns by falling length times radius.
fn by_size(radii: &[f64], square: impl Fn(usize) -> f64) -> Vec<usize> {
    let size: Vec<f64> = radii.iter().enumerate().map(|(column, radius)| square(column).sqrt() * radius).collect();
    let mut order: Vec<usize> = (0..radii.len()).collect();
    order.sort_by(|&a, &b| size[b].total_cmp(&size[a]).then(a.cmp(&b)));
    order
}

/// An approximately orthonormal basis of all dimensions, whose first members span the columns of `matrix` (square), those
/// with the largest `radii` first.
fn orthonormal(space: &ModelSpace, matrix: &Models, radii: &[f64]) -> Models {
    let dimension = matrix.rows;
    let columns = matrix.transposed();
    let square = |column: usize| (0..dimension).map(|row| matrix.at(row, column)[0].powi(2)).sum::<f64>();
    let longest = (0..dimension).map(square).fold(f64::MIN_POSITIVE, f64::max).sqrt();
    let mut basis = Basis::new(space, dimension);
    let mut candidate = vec![0.0; dimension * space.size()];
    for column in by_size(radii, square) {
        candidate.copy_from_slice(columns.row(column));
        basis.project_out(&mut candidate);
        if basis.length(&candidate) > DEPENDENT * longest {
            basis.push(&mut candidate);
        }
    }
    while basis.count < dimension {
        // The axis that the basis so far represents worst.
        let axis = (0..dimension).min_by(|&a, &b| basis.share(a).total_cmp(&basis.share(b))).unwrap_or(0);
        candidate.fill(0.0);
        candidate[axis * space.size()] = 1.0;
        basis.project_out(&mut candidate);
        basis.push(&mut candidate);
    }
    basis.vectors.transposed()
}

/// The vectors so far, a row each.
struct Basis<'s> {
    space: &'s ModelSpace,
    vectors: Models,
    count: usize,
    scratch: JetScratch,
}

impl<'s> Basis<'s> {
    fn new(space: &'s ModelSpace, dimension: usize) -> Self {
        let vectors = Models::zero(space, dimension, dimension);
        Self { space, vectors, count: 0, scratch: JetScratch::new(space.jets()) }
    }

    /// Length of a vector at the centre.
    fn length(&self, vector: &[f64]) -> f64 {
        vector.chunks_exact(self.space.size()).map(|entry| entry[0] * entry[0]).sum::<f64>().sqrt()
    }

    /// Squared length of an axis' projection on the basis, at the centre.
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
