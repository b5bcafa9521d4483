//! Frames for the remainder of a state's polynomials; they rotate with ξ.
//!
//! A state's remainder d = (δq̂, δv̂, δw) is carried in coordinates z, |zᵢ| ≤ rᵢ, of a frame that each step chooses
//! anew: boxes in fixed coordinates would grow at every step, because a box must cover its rotated corners (the
//! wrapping effect). The scheme moves d in two ways. 2f directions are slow: changed independent coordinates and
//! velocities, with all else consistent. The others are fast: they break the constraints and their derivatives, in
//! velocities by h and in accelerations by h² times as large as in positions, and fade (by 0.82 a step for α = −0.1). A
//! frame that is not right for every ξ mixes both, a thousand times a second. So
//!
//! ```text
//! d = S(ξ) Q z_s + F(ξ) z_f,     F = [V ⊗ P(ξ), T(ξ) in w],     Φ_q P = I,   Φ_q T = 0
//! ```
//!
//! S follows the motion exactly, S₊ = B S (W B S)⁻¹ for the step's derivative B(ξ), where W takes the independent
//! coordinates and velocities out, and the inverse is that at the box's centre: nothing slow becomes fast, and the slow
//! coordinates are mapped by numbers that do not depend on ξ. Lohner's constant orthogonal Q, the column with the
//! largest remainder first, is then enough for them. P is the reactions' push M⁻¹Φ_qᵀ(Φ_q M⁻¹ Φ_qᵀ)⁻¹, which is
//! orthogonal to the motion in the metric of the masses: fast modes fade without becoming slow, up to O(h). It stands
//! in the Newton matrix's inverse. V brings the map of a gap ν and its derivatives, the same 3 × 3 numbers for every
//! constraint, nearly to diagonal form, so that absolute values contract too. T spans the remaining accelerations.

use nalgebra::{DMatrix, Matrix3, Vector3};
use symdiff::Interval;
use symdiff::taylor_model::{ModelSpace, up};

use super::tuning::TUNING;
use super::{EnclosureError, Gains};
use crate::assemble::CoordinateId;
use crate::certificate::matrix::Models;
use crate::numerics::larger;

/// Units in which frames are made.
#[derive(Clone, Debug)]
pub(super) struct Units {
    /// Units of q̂, v̂, w, 3n: powers of two.
    pub scale: Vec<f64>,
    /// h, s.
    pub step: f64,
    /// Time in which the slow velocities are measured, over that of `scale`: a power of two.
    pub motion: f64,
}

/// A frame of dimension 3n, in units of [`Units::scale`].
#[derive(Clone, Debug)]
pub(super) struct EnclosureFrame {
    /// The independent coordinates, f.
    independent: Vec<CoordinateId>,
    /// S and F.
    basis: Models,
    /// [S F]⁻¹, nearly.
    inverse: Option<Models>,
    /// Q.
    turned: DMatrix<f64>,
    /// V.
    fading: Matrix3<f64>,
}

impl EnclosureFrame {
    /// The frame at the start: `tangent` is ∂q/∂(independent coordinates), n × f, and `push` is P, n × m, in SI units.
    pub fn new(
        space: &ModelSpace,
        units: &Units,
        gains: &Gains,
        tangent: &Models,
        push: &Models,
        independent: Vec<CoordinateId>,
    ) -> Self {
        let (n, f) = (tangent.rows, tangent.columns);
        let mut slow = Models::zero(space, 3 * n, 2 * f);
        for (column, &leader) in independent.iter().enumerate() {
            for row in 0..n {
                let factor = units.scale[leader.number()] / units.scale[row];
                for (row, column, factor) in [
                    (row, column, factor),
                    (row, f + column, factor / units.motion),
                    (n + row, f + column, factor / units.motion),
                ] {
                    let target = slow.at_mut(row, column);
                    target.copy_from_slice(tangent.at(row % n, column % f));
                    target.iter_mut().for_each(|c| *c *= factor);
                }
            }
        }
        let turned = DMatrix::identity(2 * f, 2 * f);
        let (_, fading) = gap_map(gains);
        let basis = slow.clone();
        let mut frame = Self { independent, basis, inverse: None, turned, fading };
        frame.basis = frame.complete(space, units, &slow, push);
        frame
    }

    /// The frame's columns [S Q, F].
    pub fn columns(&self, space: &ModelSpace) -> Models {
        let (dimension, slow) = (self.basis.rows, self.turned.nrows());
        let turned = self.basis.part(space, 0..dimension, 0..slow).times(space, &Models::constant(space, &self.turned));
        turned.beside(space, &self.basis.part(space, 0..dimension, slow..dimension))
    }

    /// z of a box |dᵢ| ≤ `spread`.
    ///
    /// # Errors
    /// Where the frame has no inverse.
    pub fn radii_of(&mut self, space: &ModelSpace, spread: &[f64]) -> Result<Vec<f64>, EnclosureError> {
        let nothing = Models::zero(space, self.basis.rows, 1);
        self.refine_inverse(space)?;
        self.coordinates_of(space, &nothing, &[0.0], spread, |_, _| ())
    }

    /// The frame for B z + e, where the first 3n columns of `moved` are B, a step's derivative along this frame's
    /// columns; and the radii in it of all that `moved` maps from |zᵢ| ≤ `radii`, and of |eᵢ| ≤ `fresh`. `push` is P, n
    /// × m, in SI units.
    ///
    /// # Errors
    /// Where the frame degenerates.
    pub fn next(
        mut self,
        space: &ModelSpace,
        units: &Units,
        moved: &Models,
        radii: &[f64],
        fresh: &[f64],
        push: &Models,
    ) -> Result<(Self, Vec<f64>), EnclosureError> {
        let (dimension, n, f) = (self.basis.rows, self.basis.rows / 3, self.independent.len());
        let columns = moved.part(space, 0..dimension, 0..2 * f).without_radii();
        let mut slow = self.follow(space, units, &columns)?;
        // At the centre: movement of another coordinate per movement of the independent ones.
        if (0..n).any(|row| (0..f).any(|column| slow.at(row, column)[0].abs() > TUNING.outrun)) {
            self.independent = pivots(&slow, n, f);
            self.inverse = None;
            slow = self.follow(space, units, &columns)?;
        }
        self.basis = self.complete(space, units, &slow, push);
        self.refine_inverse(space)?;
        let radii = self.coordinates_of(space, moved, radii, fresh, |turned, found| {
            let size = |column: usize| {
                (0..2 * f).map(|row| found.at(row, column)[0].powi(2)).sum::<f64>().sqrt() * radii[column]
            };
            let mut order: Vec<usize> = (0..2 * f).collect();
            order.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
            let sorted = DMatrix::from_fn(2 * f, 2 * f, |row, column| found.at(row, order[column])[0]);
            *turned = sorted.qr().q();
        })?;
        Ok((self, radii))
    }

    /// S from the columns that it is to span.
    fn follow(&self, space: &ModelSpace, units: &Units, columns: &Models) -> Result<Models, EnclosureError> {
        let n = columns.rows / 3;
        let weights = [(0, 1.0), (n, units.motion)];
        let mut direct = Models::zero(space, columns.columns, columns.columns);
        let taken = weights
            .into_iter()
            .flat_map(|(block, weight)| self.independent.iter().map(move |i| (block + i.number(), weight)));
        for (index, (row, weight)) in taken.enumerate() {
            for column in 0..columns.columns {
                direct.at_mut(index, column).copy_from_slice(columns.at(row, column));
            }
            direct.scale_row(index, weight);
        }
        let inverse = direct.inverse_at_centre(space).ok_or(EnclosureError::Unproven)?;
        Ok(columns.approximate_times(space, &inverse))
    }

    /// [S, V ⊗ P, T in w].
    fn complete(&self, space: &ModelSpace, units: &Units, slow: &Models, push: &Models) -> Models {
        let (n, m, f) = (push.rows, push.columns, self.independent.len());
        let mut fast = Models::zero(space, 3 * n, 3 * m + f);
        for block in 0..3 {
            for i in 0..n {
                let row = block * n + i;
                let unit = units.step.powi(-(block as i32)) / units.scale[row];
                for mode in 0..3 {
                    let factor = unit * self.fading[(block, mode)];
                    for constraint in 0..m {
                        let target = fast.at_mut(row, mode * m + constraint);
                        target.copy_from_slice(push.at(i, constraint));
                        target.iter_mut().for_each(|c| *c *= factor);
                    }
                }
            }
        }
        for i in 0..n {
            for column in 0..f {
                fast.at_mut(2 * n + i, 3 * m + column).copy_from_slice(slow.at(i, column));
            }
        }
        slow.beside(space, &fast).without_radii()
    }

    /// The inverse, from the last frame's where that is near.
    fn refine_inverse(&mut self, space: &ModelSpace) -> Result<(), EnclosureError> {
        let kept = self
            .inverse
            .take()
            .and_then(|mut inverse| inverse.refine_inverse_of(space, &self.basis).then_some(inverse));
        let inverse = match kept {
            Some(inverse) => inverse,
            None => {
                let mut inverse = self.basis.inverse_at_centre(space).ok_or(EnclosureError::Unproven)?;
                if !inverse.refine_inverse_of(space, &self.basis) {
                    return Err(EnclosureError::Unproven);
                }
                inverse
            }
        };
        self.inverse = Some(inverse);
        Ok(())
    }

    /// Bounds of this frame's coordinates of B z + e, |zᵢ| ≤ `radii`, |eᵢ| ≤ `fresh`; `turn` may choose Q, given B in
    /// the basis.
    ///
    /// (S F) x = B z + e has x = R (B z + e) + (I − R (S F)) x for R ≈ (S F)⁻¹, and z_s = Qᵀ x_s + (I − QᵀQ) z_s.
    fn coordinates_of(
        &mut self,
        space: &ModelSpace,
        moved: &Models,
        radii: &[f64],
        fresh: &[f64],
        turn: impl FnOnce(&mut DMatrix<f64>, &Models),
    ) -> Result<Vec<f64>, EnclosureError> {
        let (dimension, slow) = (self.basis.rows, self.turned.nrows());
        let inverse = self.inverse.as_ref().ok_or(EnclosureError::Unproven)?;
        let found = inverse.times(space, moved);
        turn(&mut self.turned, &found);
        let rest = inverse.times(space, &self.basis).off_identity(space);
        let mut entering = inverse.bounds(space).times(fresh);
        let mut coordinates = found.bounds(space).times(radii);
        let rough: Vec<f64> = coordinates.iter().zip(&entering).map(|(a, b)| up(a + b)).collect();
        add_skew(space, &rest, &rough, &mut entering)?;
        coordinates.iter_mut().zip(&entering).for_each(|(z, more)| *z = up(*z + more));

        let back = Models::constant(space, &self.turned.transpose());
        let turned = back.times(space, &found.part(space, 0..slow, 0..moved.columns));
        let mut of_slow = turned.bounds(space).times(radii);
        let entering = back.bounds(space).times(&entering[..slow]);
        of_slow.iter_mut().zip(&entering).for_each(|(z, more)| *z = up(*z + more));
        let rest = back.times(space, &Models::constant(space, &self.turned)).off_identity(space);
        let rough = of_slow.clone();
        add_skew(space, &rest, &rough, &mut of_slow)?;
        coordinates[..slow].copy_from_slice(&of_slow);
        debug_assert_eq!(coordinates.len(), dimension);
        Ok(coordinates)
    }
}

/// Adds |Δ x| to `to`, for x = (a vector bounded by `rough`) + Δ x.
fn add_skew(space: &ModelSpace, skew: &Models, rough: &[f64], to: &mut [f64]) -> Result<(), EnclosureError> {
    let norm = skew.row_norm(space);
    // NaN is not small.
    let small = norm < 0.5;
    if !small {
        return Err(EnclosureError::Unproven);
    }
    let largest = up(rough.iter().copied().fold(0.0, larger) / (1.0 - norm));
    for (to, row) in to.iter_mut().zip(skew.bounds(space).rows()) {
        *to = up(*to + up(row.iter().sum::<f64>()) * largest);
    }
    Ok(())
}

/// The f of n coordinates that the others follow best at the centre: elimination with complete pivoting.
fn pivots(slow: &Models, n: usize, f: usize) -> Vec<CoordinateId> {
    let mut matrix = DMatrix::from_fn(n, f, |row, column| slow.at(row, column)[0]);
    let mut chosen = Vec::new();
    for _ in 0..f {
        let index =
            matrix.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(0, |(index, _)| index);
        let (row, column) = (index % n, index / n);
        chosen.push(CoordinateId::new(row));
        let pivot_row = matrix.row(row) / matrix[(row, column)];
        let pivot_column = matrix.column(column).clone_owned();
        matrix -= pivot_column * pivot_row;
        matrix.row_mut(row).fill(0.0);
        matrix.column_mut(column).fill(0.0);
    }
    chosen.sort_unstable();
    chosen
}

/// The map of (ν, h ν̇, h² ν̈) by a step that closes the gap, x = −ν/b, and V: the map is V (nearly diagonal) V⁻¹.
fn gap_map(gains: &Gains) -> (Matrix3<f64>, Matrix3<f64>) {
    let Gains { h, b, c, q_a, q_w, v_a, v_w, a_x, a_w } = *gains;
    let [h, b, c, q_a, q_w, v_a, v_w, a_x, a_w] = [h, b, c, q_a, q_w, v_a, v_w, a_x, a_w].map(Interval::middle);
    let column = |q: f64, v: f64, w: f64| {
        let x = -q / b;
        let (velocity, a) = (v + c * x, a_x * x - a_w * w);
        [h * velocity + q_a * a - q_w * x, h * (velocity + v_a * a - v_w * x), h * h * x]
    };
    let columns = [column(1.0, 0.0, 0.0), column(0.0, 1.0 / h, 0.0), column(0.0, 0.0, 1.0 / (h * h))];
    let map = Matrix3::from_fn(|row, column| columns[column][row]);
    let (basis, triangle) = map.schur().unpack();
    let largest = [(0, 1), (0, 2), (1, 2)].map(|index| triangle[index].abs()).into_iter().fold(0.0, f64::max);
    let shrink = (TUNING.off_diagonal / largest).min(1.0);
    (map, basis * Matrix3::from_diagonal(&Vector3::new(1.0, shrink, shrink * shrink)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::Scheme;

    #[test]
    fn gaps_fade_in_absolute_values_too() {
        // The scheme's damping at infinite frequency, (1 + α)/(1 − α), and the off-diagonal remainder.
        for alpha in [-0.05, -0.1, -0.2, -1.0 / 3.0] {
            let bound = (1.0 + alpha) / (1.0 - alpha) + 2.0 * TUNING.off_diagonal;
            for h in [1e-2, 1e-3, 1e-5] {
                let (map, fading) = gap_map(&Gains::new(Scheme::Hht { alpha }.coefficients(), h));
                let fades = fading.try_inverse().unwrap() * map * fading;
                let norm =
                    (0..3).map(|row| (0..3).map(|column| fades[(row, column)].abs()).sum::<f64>()).fold(0.0, f64::max);
                assert!(norm < bound, "α = {alpha}, h = {h}: {norm}");
            }
        }
    }
}
