//! The distance of the true motion from the approximation, e = B(ξ) z with |zᵢ| ≤ rᵢ: B follows the transition matrix.

use symdiff::taylor_model::{ModelSpace, up};

use super::super::EnclosureError;
use crate::certificate::matrix::{Bounds, Models};
use crate::certificate::majorant::resolvent;
use super::proof::Proven;
use crate::certificate::spaces::{Space, matrix_at};

/// B, an approximation of its inverse, and r.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    directions: Models,
    inverse: Models,
    radii: Vec<f64>,
}

impl Frame {
    /// The identity.
    pub fn new(space: &ModelSpace, radii: Vec<f64>) -> Self {
        let identity = Models::identity(space, radii.len());
        Self { directions: identity.clone(), inverse: identity, radii }
    }

    /// Largest radius.
    pub fn size(&self) -> f64 {
        self.radii.iter().copied().fold(0.0, f64::max)
    }

    /// Bound of |e|, 2n.
    pub fn error(&self, space: &ModelSpace) -> Vec<f64> {
        self.directions.bounds(space).times(&self.radii)
    }

    /// Bound of |e| at an instant of a cell that begins with this frame.
    pub fn error_at(&self, space: &Space, proven: &Proven, tau: f64) -> Vec<f64> {
        let moved = matrix_at(space, &proven.transition, tau).times(&space.box_of, &self.directions);
        let moved = moved.bounds(&space.box_of).times(&self.radii);
        let missed = proven.missed.times(&self.error(&space.box_of));
        moved.iter().zip(&missed).zip(&proven.growth).map(|((a, b), c)| up(a + b + c)).collect()
    }

    /// The frame at the end of a cell. `jump` bounds how far the next approximation begins from the end of this one.
    ///
    /// # Errors
    /// Where B has no inverse that can be proven.
    pub fn advance(&self, space: &Space, proven: &Proven, jump: &[f64]) -> Result<Self, EnclosureError> {
        let of_box = &space.box_of;
        let transition = matrix_at(space, &proven.transition, 1.0);
        let moved = transition.times(of_box, &self.directions);
        let rounding = Bounds::of(moved.rows, moved.columns, &radii_of(of_box, &moved));
        let directions = moved.without_radii();

        let back = transition.without_radii();
        let mut backwards = back.inverse_at_centre(of_box).ok_or(EnclosureError::Unproven)?;
        let mut inverse = if backwards.refine_inverse_of(of_box, &back) {
            self.inverse.approximate_times(of_box, &backwards)
        } else {
            return Err(EnclosureError::Unproven);
        };
        if !inverse.refine_inverse_of(of_box, &directions) {
            return Err(EnclosureError::Unproven);
        }
        let inverse = inverse.without_radii();
        // |B⁻¹ x| ≤ (1 + (I − K)⁻¹ K) |G| |x| with |I − G B| ≤ K.
        let contraction = inverse.times(of_box, &directions).off_identity(of_box).bounds(of_box);
        let errors = self.error(of_box);
        let lost = rounding.times(&self.radii);
        let missed = proven.missed.times(&errors);
        let all: Vec<f64> =
            (0..lost.len()).map(|row| up(lost[row] + missed[row] + proven.growth[row] + jump[row])).collect();
        let seen = inverse.bounds(of_box).times(&all);
        let column = Bounds::of(seen.len(), 1, &seen);
        let beyond = resolvent(&contraction, &column).ok_or(EnclosureError::Unproven)?;
        let radii = (0..seen.len()).map(|row| up(self.radii[row] + seen[row] + beyond.at(row, 0))).collect();
        Ok(Self { directions, inverse, radii })
    }
}

fn radii_of(space: &ModelSpace, matrix: &Models) -> Vec<f64> {
    let entries = (0..matrix.rows).flat_map(|row| (0..matrix.columns).map(move |column| (row, column)));
    entries.map(|(row, column)| matrix.at(row, column)[space.size() - 1]).collect()
}
