//! Tables of models: the cubic at the middle, with a radius for the other pieces within the box.
//!
//! Beyond a knot κ the cubics differ by Σ Δₖ (x − κ)ᵏ. For a spline with two continuous derivatives Δ₀, Δ₁ and Δ₂ are
//! rounding, so that a box across a knot costs the third power of its length beyond.

use super::{ModelScratch, ModelSpace, up};
use crate::eval::interval::Interval;
use crate::expr::{Spline, SplinePiece, cubic_about, cubic_derivative};
use crate::tuning::TUNING;

impl ModelSpace {
    /// `out` = the derivative of a table, of this order, at a; unknown if the box contains too many pieces. The radius
    /// includes the jumps at knots that rounding leaves ([`Spline::rounding_jumps`]).
    pub(super) fn spline(&self, spline: Spline, order: u8, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let range = self.range(a);
        let pieces = spline.pieces_over(range, TUNING.pieces_of_spline);
        let of_middle = pieces.iter().find(|piece| a[0] < piece.to);
        let Some(own) = of_middle.or(pieces.last()) else { return self.unknown(out) };
        self.with_spare(scratch, |from, product, _| {
            from.copy_from_slice(a);
            self.shift(-own.knot, from);
            let coefficients = cubic_derivative(own.cubic.map(Interval::point), order);
            self.constant(coefficients[3], out);
            for &coefficient in coefficients[..3].iter().rev() {
                self.mul(out, from, product);
                out.copy_from_slice(product);
                self.shift(coefficient, out);
            }
        });
        let apart = pieces.iter().map(|other| apart(own, other, order, range)).fold(0.0, f64::max);
        let radius = self.split_mut(out).1;
        *radius = up(*radius + apart + spline.rounding_jumps(order).unwrap_or(0.0));
    }
}

/// Largest difference between the derivatives of two pieces' cubics over the part of the range in the second one.
fn apart(own: &SplinePiece, other: &SplinePiece, order: u8, range: Interval) -> f64 {
    if own.number == other.number {
        return 0.0;
    }
    // The knot between both, on the side of `other`.
    let knot = if other.number > own.number { other.knot } else { other.end };
    let [a, b] = [own, other].map(|piece| cubic_derivative(cubic_about(piece.cubic, knot - piece.knot), order));
    let (from, to) = (range.lower().max(other.from), range.upper().min(other.to));
    let beyond = (Interval::new(from, to.max(from)) - knot).magnitude();
    let differences = a.into_iter().zip(b).map(|(a, b)| (a - b).magnitude());
    differences.rev().fold(0.0, |sum, difference| up(sum * beyond + difference))
}
