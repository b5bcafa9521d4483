//! The distance of the true motion from the approximation, e = B(ξ) z with |zᵢ| ≤ rᵢ: B follows the transition matrix.
//!
//! Where B's columns become nearly parallel, B⁻¹ makes every error large. Then B R⁻¹ is the next B, and R z the next z,
//! with the triangular factor R of B at the box's centre (Lohner): the columns that matter most come first.

use nalgebra::DMatrix;
use symdiff::taylor_model::{ModelSpace, up};

use super::flow::Flow;
use super::majorant::resolvent;
use super::matrix::{Bounds, Models};
use super::spaces::{Space, matrix_at};
use super::tuning::TUNING;

/// B, an approximation of its inverse, and r.
#[derive(Clone, Debug)]
pub struct Frame {
    directions: Models,
    inverse: Models,
    radii: Vec<f64>,
    gain: f64,
}

impl Frame {
    /// The identity.
    pub fn new(space: &ModelSpace, radii: Vec<f64>) -> Self {
        let identity = Models::identity(space, radii.len());
        Self { directions: identity.clone(), inverse: identity, radii, gain: 1.0 }
    }

    /// Factor by which errors of the last cell have made the distance larger.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// Bound of |e|, 2n.
    pub fn error(&self, space: &ModelSpace) -> Vec<f64> {
        self.directions.bounds(space).times(&self.radii)
    }

    /// Bound of |e| at an instant of a cell that begins with this frame.
    pub fn error_at(&self, space: &Space, flow: &Flow, tau: f64) -> Vec<f64> {
        let moved = matrix_at(space, &flow.transition, tau).times(&space.box_of, &self.directions);
        let moved = moved.bounds(&space.box_of).times(&self.radii);
        let missed = flow.missed.times(&self.error(&space.box_of));
        moved.iter().zip(&missed).zip(&flow.growth).map(|((a, b), c)| up(a + b + c)).collect()
    }

    /// The frame at the end of a cell. `jump` bounds how far the next approximation begins from the end of this one.
    /// `None` if B has no inverse that can be proven.
    pub fn advance(&self, space: &Space, flow: &Flow, jump: &[f64]) -> Option<Self> {
        let of_box = &space.box_of;
        let transition = matrix_at(space, &flow.transition, 1.0);
        let moved = transition.times(of_box, &self.directions);
        let rounding = Bounds::of(moved.rows, moved.columns, &radii_of(of_box, &moved));
        let mut directions = moved.without_radii();
        let mut lost = rounding.times(&self.radii);

        let back = transition.without_radii();
        let mut backwards = back.inverse_at_centre(of_box)?;
        backwards.refine_inverse_of(of_box, &back).then_some(())?;
        let mut inverse = self.inverse.approximate_times(of_box, &backwards);
        inverse.refine_inverse_of(of_box, &directions).then_some(())?;
        let mut radii = self.radii.clone();
        let sizes = directions.bounds(of_box);
        let distance = sizes.times(&radii);
        let enlarged = sizes.times(&inverse.bounds(of_box).times(&distance));
        if enlarged.iter().zip(&distance).any(|(enlarged, distance)| *enlarged > TUNING.skew * distance) {
            let turned = turn(of_box, &directions, &radii)?;
            lost = lost.iter().zip(&turned.lost).map(|(a, b)| up(a + b)).collect();
            inverse = turned.factor.approximate_times(of_box, &inverse);
            (directions, radii) = (turned.directions, turned.radii);
            inverse.refine_inverse_of(of_box, &directions).then_some(())?;
        }
        let inverse = inverse.without_radii();
        // |B⁻¹ x| ≤ (1 + (I − K)⁻¹ K) |G| |x| with |I − G B| ≤ K.
        let contraction = inverse.times(of_box, &directions).off_identity(of_box).bounds(of_box);
        let missed = flow.missed.times(&self.error(of_box));
        let all: Vec<f64> =
            (0..lost.len()).map(|row| up(lost[row] + missed[row] + flow.growth[row] + jump[row])).collect();
        let seen = inverse.bounds(of_box).times(&all);
        let column = Bounds::of(seen.len(), 1, &seen);
        let beyond = resolvent(&contraction, &column)?;
        let added: Vec<f64> = (0..seen.len()).map(|row| up(seen[row] + beyond.at(row, 0))).collect();
        let sizes = directions.bounds(of_box);
        let (kept, added_to) = (sizes.times(&radii), sizes.times(&added));
        let gains = kept.iter().zip(&added_to).map(|(kept, added)| 1.0 + added / (kept + TUNING.no_growth));
        let gain = gains.fold(1.0, f64::max);
        let radii = radii.iter().zip(&added).map(|(radius, added)| up(radius + added)).collect();
        Some(Self { directions, inverse, radii, gain })
    }
}

/// B z as B' z' and a rest.
struct Turned {
    directions: Models,
    radii: Vec<f64>,
    /// z' of z.
    factor: Models,
    /// Bound of the rest.
    lost: Vec<f64>,
}

/// B' = B P R⁻¹ of B P = Q R at the centre, where P sorts columns by their shares; z' = R Pᵀ z.
fn turn(space: &ModelSpace, directions: &Models, radii: &[f64]) -> Option<Turned> {
    let size = directions.rows;
    let centre = DMatrix::from_fn(size, size, |row, column| directions.at(row, column)[0]);
    let weight = |column: usize| radii[column] * centre.column(column).norm();
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| weight(b).total_cmp(&weight(a)));
    let sorted = DMatrix::from_fn(size, size, |row, column| centre[(row, order[column])]);
    let triangular = sorted.qr().r();
    let upper = triangular.clone().try_inverse()?;
    // Columns back in their order: the factors are R Pᵀ and P R⁻¹.
    let index = |column: usize| order.iter().position(|&own| own == column).unwrap_or(column);
    let factor = DMatrix::from_fn(size, size, |row, column| triangular[(row, index(column))]);
    let back = DMatrix::from_fn(size, size, |row, column| upper[(index(row), column)]);
    let turned = directions.approximate_times(space, &Models::constant(space, &back)).without_radii();
    // Whatever B' is, B z = B' (R Pᵀ z) + (B − B' R Pᵀ) z.
    let factor_of = Models::constant(space, &factor);
    let mut rest = turned.times(space, &factor_of);
    rest.negate();
    rest.add(space, directions);
    let lost = rest.bounds(space).times(radii);
    let sizes: Vec<f64> = (0..size * size).map(|at| factor[(at / size, at % size)].abs()).collect();
    let radii = Bounds::of(size, size, &sizes).times(radii);
    Some(Turned { directions: turned, radii, factor: factor_of, lost })
}

fn radii_of(space: &ModelSpace, matrix: &Models) -> Vec<f64> {
    let entries = (0..matrix.rows).flat_map(|row| (0..matrix.columns).map(move |column| (row, column)));
    entries.map(|(row, column)| matrix.at(row, column)[space.size() - 1]).collect()
}
