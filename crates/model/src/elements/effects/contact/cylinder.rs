//! A cylinder with flat faces on the second body of a contact.
//!
//! ```text
//! faces about b and b + M v, radius r; a place p = b + t v + l with l across v
//! outside:   n = (c − p)/|c − p|,  c = b + ⟨t⟩ v + ⟨l⟩,   t within 0 … M and |l| within r there,   gap = |c − p| − ρ
//! inside:    gap = max(|l| − r, −t, t − M) − ρ,  n = −l/|l|, v or −v
//! line p(τ) = a + τ u, length L; ½ |c − p|² + ½ ε² (τ − m)² is least where
//! g(τ) = ⟨1 − r/|l|⟩ l · l′ + (t − ⟨t⟩) u · v + ε² (τ − m) = 0 within 0 … L,    ε² = 2·10⁻⁴ ρ/L
//! rims, a surface with the normal n:  p = n − (n·v) v,   q = p + w e,   w = ε³/(ε² + p²),   k = q/√(q² + w²/100)
//! place = face − r (k cos φ + v × k sin φ),   φ = 0, ±120°
//! ```
//!
//! n pushes the cylinder. g grows with τ: sixteen halvings find its root, and two steps of Newton's method from there
//! make it smooth. Where the line is parallel to the side or to a face many points are as near: m, the middle of the
//! part next to it, takes over within an angle of 10⁻⁴.
//!
//! At φ = 0 each rim's deepest point touches, so that a cylinder rolls on the line between two of them and tips about
//! its rim; on a face it stands on three. There p is 0: up to an angle of ε = 10⁻³ a direction e of the body turns into
//! that of the deepest point. The pushes at ±120° are alike, and their torques about the axis cancel.

use symdiff::Scalar;

use super::rod::Rod;
use super::solid::{Gap, Segment};
use super::touch::Touch;
use crate::elements::tuning::TUNING;
use crate::multibody::{Pair, Vector};

/// A cylinder of the second body.
#[derive(Clone, Copy, Debug)]
pub struct ContactCylinder<'g> {
    pub axis: Rod<'g>,
    /// r, m
    pub radius: Scalar<'g>,
}

impl<'g> ContactCylinder<'g> {
    /// Where it touches a ball of radius ρ about p: in c.
    pub fn touch(&self, pair: &Pair<'g>, ball: Vector<'g>, reach: Scalar<'g>) -> Touch<'g> {
        let g = reach.builder();
        let (zero, one) = (g.number(0.0), g.number(1.0));
        let (start, along) = self.axis.outward(pair);
        let height = self.axis.length;
        let from = ball - start;
        let ahead = along.dot(from);
        let aside = from - ahead * along;
        let square = aside.dot(aside);
        let distance = square.select(square, one).sqrt();
        // Exactly zero inside.
        let over = (distance - self.radius).max(zero) / distance;
        let past = (ahead - height).max(zero) + ahead.min(zero);
        let way = -(over * aside) - past * along;
        let nearest = ball + way;
        let square_of_way = way.dot(way);
        let outside = square_of_way.select(square_of_way, one).sqrt();
        // Inside, the nearest of the side and both faces.
        let beside = square.select(distance, zero) - self.radius;
        let beyond = (-ahead).max(ahead - height);
        let is_below = height - 2.0 * ahead;
        let face = is_below.select(one, -one) * along;
        let is_side = beside - beyond;
        let inward = |side: Vector<'g>, face: Vector<'g>| {
            let (side, face) = (side.components(), face.components());
            Vector::from([0, 1, 2].map(|axis| is_side.select(side[axis], face[axis])))
        };
        let inside = inward((-1.0 / distance) * aside, face).components();
        let normal = (way / outside).components();
        let normal = Vector::from([0, 1, 2].map(|axis| square_of_way.select(normal[axis], inside[axis])));
        let gap = square_of_way.select(outside, beside.max(beyond)) - reach;
        Touch::at(nearest, Gap { gap, normal, overlap: reach * reach - square_of_way, near: None })
    }

    /// The point p on a line of the ground's frame that is nearest to it; `reach` is ρ.
    pub fn nearest_on(&self, pair: &Pair<'g>, line: Segment<'g>, reach: Scalar<'g>) -> Vector<'g> {
        let (from, tangent, length) = line;
        let beside = Beside::of(self, pair, line, reach);
        let mut before = length.builder().number(0.0);
        for halving in 1..=TUNING.halvings_of_line {
            let step = 0.5_f64.powi(halving) * length;
            before += step.only_where(-beside.slope(before + step).0);
        }
        let after = before + 0.5_f64.powi(TUNING.halvings_of_line) * length;
        let mut place = 0.5 * (before + after);
        for _ in 0..2 {
            let (slope, steepness) = beside.slope(place);
            place = (place - slope / steepness).max(before).min(after);
        }
        from + place * tangent
    }

    /// The least of n · p over its points, for a unit vector n of the ground's frame.
    pub fn lowest(&self, pair: &Pair<'g>, normal: Vector<'g>) -> Scalar<'g> {
        let (_, along) = self.axis.outward(pair);
        let lean = along.dot(normal);
        let [first, second] = self.axis.ends(pair).map(|end| normal.dot(end));
        let across = (1.0 - lean * lean).max(self.radius.builder().number(TUNING.no_angle));
        first.min(second) - self.radius * across.sqrt()
    }

    /// Points of both rims that touch a surface with a normal in the ground's frame.
    pub fn rims(&self, pair: &Pair<'g>, normal: Vector<'g>) -> Vec<Vector<'g>> {
        let (_, along) = self.axis.outward(pair);
        let lean = normal - along.dot(normal) * along;
        let square = lean.dot(lean);
        let small = TUNING.flat_face * TUNING.flat_face;
        let upright = TUNING.flat_face * small / (square + small);
        let toward = lean + upright * pair.outward_of_second(self.axis.aside());
        let size = (toward.dot(toward) + 0.01 * upright * upright).sqrt();
        let down = self.radius * (toward / size);
        let side = along.cross(down);
        let third = 0.5 * 3.0_f64.sqrt();
        let arms = [down, -0.5 * down + third * side, -0.5 * down - third * side];
        self.axis.ends(pair).into_iter().flat_map(|face| arms.map(|arm| face - arm)).collect()
    }
}

/// A line next to a cylinder: t = t₀ + τ t′, l² = A + 2 B τ + C τ².
struct Beside<'g> {
    height: Scalar<'g>,
    radius: Scalar<'g>,
    /// t₀ and t′
    ahead: [Scalar<'g>; 2],
    /// A, B and C
    aside: [Scalar<'g>; 3],
    /// m
    middle: Scalar<'g>,
    /// ε²
    small: Scalar<'g>,
}

impl<'g> Beside<'g> {
    fn of(
        cylinder: &ContactCylinder<'g>,
        pair: &Pair<'g>,
        (from, tangent, length): Segment<'g>,
        reach: Scalar<'g>,
    ) -> Self {
        let (start, along) = cylinder.axis.outward(pair);
        let height = cylinder.axis.length;
        let zero = length.builder().number(0.0);
        let offset = from - start;
        let ahead = [along.dot(offset), along.dot(tangent)];
        let across = [offset - ahead[0] * along, tangent - ahead[1] * along];
        let aside = [across[0].dot(across[0]), across[0].dot(across[1]), across[1].dot(across[1])];
        let middle = |ends: [Scalar<'g>; 2]| {
            let [first, second] = ends.map(|end| end.max(zero).min(length));
            0.5 * (first + second)
        };
        let per_ahead = ahead[1] / (ahead[1] * ahead[1] + TUNING.no_angle);
        let along_side = middle([zero, height].map(|end| (end - ahead[0]) * per_ahead));
        let per_aside = 1.0 / (aside[2] + TUNING.no_angle);
        let chord = aside[1] * aside[1] - aside[2] * (aside[0] - cylinder.radius * cylinder.radius);
        let half = chord.select(chord.select(chord, zero + 1.0).sqrt(), zero);
        let over_face = middle([-half, half].map(|half| (half - aside[1]) * per_aside));
        let middle = ahead[1] * ahead[1] * along_side + aside[2] * over_face;
        let small = 2.0 * TUNING.line_along_cylinder * reach / length;
        Self { height, radius: cylinder.radius, ahead, aside, middle, small }
    }

    /// g and its derivative.
    fn slope(&self, place: Scalar<'g>) -> (Scalar<'g>, Scalar<'g>) {
        let zero = place.builder().number(0.0);
        let [constant, linear, square] = self.aside;
        let away = linear + square * place;
        let distance = (constant + (linear + away) * place).max(self.radius * self.radius).sqrt();
        let share = self.radius / distance;
        let ahead = self.ahead[0] + place * self.ahead[1];
        let beyond = (ahead - self.height).max(zero) + ahead.min(zero);
        let slope = (1.0 - share) * away + beyond * self.ahead[1] + self.small * (place - self.middle);
        let turning = (distance - self.radius).select(share * away * away / (distance * distance), zero);
        let along = (beyond * beyond).select(self.ahead[1] * self.ahead[1], zero);
        (slope, (1.0 - share) * square + turning + along + self.small)
    }
}
