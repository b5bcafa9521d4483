//! The pieces of a spline over a range, and the jumps between them.

use super::spline::Spline;
use crate::eval::interval::Interval;
use crate::tuning::TUNING;

/// A cubic and its range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SplinePiece {
    /// Number of the piece, ascending with x.
    pub number: i64,
    /// Origin of the cubic's powers.
    pub knot: Interval,
    /// The knot behind it; all numbers for the last piece.
    pub end: Interval,
    /// Coefficients, lowest first.
    pub cubic: [f64; 4],
    /// Lower end of its range, rounded outward.
    pub from: f64,
    /// Upper end of its range, rounded outward.
    pub to: f64,
}

impl Spline {
    /// The pieces with a part in a range, ascending; empty if they are more than `most`, or the range is too far away.
    pub(crate) fn pieces_over(self, range: Interval, most: usize) -> Vec<SplinePiece> {
        let (knots, _, is_periodic) = self.pieces();
        if !range.magnitude().is_finite() {
            return Vec::new();
        }
        let (first, last) = if is_periodic {
            let per_period = knots.len() as i64 - 1;
            let [first, last] = [knots[0], knots[knots.len() - 1]];
            let periods = [range.lower(), range.upper()].map(|x| ((x - first) / (last - first)).floor());
            if periods.iter().any(|count| count.abs() > TUNING.most_periods) {
                return Vec::new();
            }
            // One more period on either side, since quotients are rounded.
            ((periods[0] as i64 - 1) * per_period, (periods[1] as i64 + 2) * per_period - 1)
        } else {
            let [first, last] = [range.lower().next_down(), range.upper()];
            [first, last].map(|x| knots.partition_point(|knot| *knot <= x) as i64).into()
        };
        let pieces = (first..=last).map(|number| self.piece_of(number));
        let mut found = Vec::new();
        for piece in pieces.filter(|piece| piece.to >= range.lower() && piece.from <= range.upper()) {
            if found.len() == most {
                return Vec::new();
            }
            found.push(piece);
        }
        found
    }

    /// A piece by its number: from 0 below the first knot, or in the first period.
    fn piece_of(self, number: i64) -> SplinePiece {
        let (knots, cubics, is_periodic) = self.pieces();
        if !is_periodic {
            let index = number as usize;
            let at = |knot: usize| knots.get(knot).copied().map_or(Interval::ENTIRE, Interval::point);
            let from = if index == 0 { f64::NEG_INFINITY } else { knots[index - 1] };
            let (knot, end) = (at(index.max(1) - 1), at(index));
            return SplinePiece { number, knot, end, cubic: cubics[index], from, to: end.upper() };
        }
        let per_period = knots.len() as i64 - 1;
        let index = number.rem_euclid(per_period) as usize;
        let period = Interval::point(knots[per_period as usize]) - Interval::point(knots[0]);
        let shift = period * Interval::point(number.div_euclid(per_period) as f64);
        let [knot, end] = [index, index + 1].map(|knot| Interval::point(knots[knot]) + shift);
        SplinePiece { number, knot, end, cubic: cubics[index + 1], from: knot.lower(), to: end.upper() }
    }

    /// Sum of the jumps, over the knots of a period, that rounding of the cubics leaves in the derivative of this
    /// order; `None` for a derivative that jumps.
    pub fn rounding_jumps(self, order: u8) -> Option<f64> {
        // All derivatives of higher order are zero.
        let known = self.jumps().get_or_init(|| [0, 1, 2, 3].map(|order| self.sum_of_jumps(order)));
        known.get(order as usize).copied().unwrap_or(Some(0.0))
    }

    fn sum_of_jumps(self, order: u8) -> Option<f64> {
        let (knots, cubics, is_periodic) = self.pieces();
        let (mut sum, mut size) = (0.0, 0.0_f64);
        for join in 0..knots.len() {
            let [before, after] = match (is_periodic, join) {
                (true, 0) => continue,
                (true, _) if join + 1 == knots.len() => [join, 1],
                _ => [join, join + 1],
            };
            let length = Interval::point(knots[join]) - Interval::point(knots[before.max(1) - 1]);
            let [end, ..] = cubic_derivative(cubic_about(cubics[before], length), order);
            let [start, ..] = cubic_derivative(cubics[after].map(Interval::point), order);
            sum += (end - start).magnitude();
            size = size.max(end.magnitude()).max(start.magnitude());
        }
        (sum <= TUNING.jump_of_rounding * size).then_some(sum * (1.0 + 1e-9))
    }
}

/// Coefficients of a cubic's derivative of this order, lowest first.
pub(crate) fn cubic_derivative(cubic: [Interval; 4], order: u8) -> [Interval; 4] {
    let step =
        |[_, b, c, d]: [Interval; 4]| [b, Interval::point(2.0) * c, Interval::point(3.0) * d, Interval::point(0.0)];
    (0..order).fold(cubic, |cubic, _| step(cubic))
}

/// Taylor coefficients of a cubic about a point.
pub(crate) fn cubic_about(cubic: [f64; 4], point: Interval) -> [Interval; 4] {
    let ([a, b, c, d], s) = (cubic.map(Interval::point), point);
    let [two, three] = [2.0, 3.0].map(Interval::point);
    [a + s * (b + s * (c + s * d)), b + s * (two * c + three * s * d), c + three * s * d, d]
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [(f64, f64); 4] = [(0.5, 1.0), (1.0, -2.0), (2.25, 0.3), (3.0, 1.0)];

    #[test]
    fn pieces_cover_a_range_and_have_its_values() {
        for spline in [Spline::through(&POINTS), Spline::periodic(&POINTS), Spline::linear(&POINTS)].map(Result::unwrap)
        {
            for (lower, width) in [(0.6, 0.1), (2.9, 0.3), (-7.1, 0.9), (40.3, 2.4), (3.0, 0.2), (1.7, 3.0)] {
                let pieces = spline.pieces_over(Interval::new(lower, lower + width), 64);
                for part in 0..=100 {
                    let x = lower + width * f64::from(part) / 100.0;
                    let near = pieces.iter().filter(|piece| piece.from <= x && x <= piece.to);
                    let off = |piece: &SplinePiece| {
                        let s = x - piece.knot.middle();
                        let [a, b, c, d] = piece.cubic;
                        (a + s * (b + s * (c + s * d)) - spline.derivative(0, x)).abs()
                    };
                    let least = near.map(off).fold(f64::INFINITY, f64::min);
                    assert!(least < 1e-12 * (1.0 + x.abs()), "{spline:?} at {x}: {least:e}");
                }
            }
        }
    }

    #[test]
    fn range_of_too_many_pieces_is_empty() {
        let spline = Spline::periodic(&POINTS).unwrap();
        assert!(spline.pieces_over(Interval::new(0.0, 100.0), 64).is_empty());
        assert!(spline.pieces_over(Interval::new(1e300, 1e300), 64).is_empty());
        assert!(spline.pieces_over(Interval::ENTIRE, 64).is_empty());
    }

    #[test]
    fn spline_derivatives_are_continuous_to_rounding() {
        for spline in [Spline::through(&POINTS), Spline::periodic(&POINTS)].map(Result::unwrap) {
            for order in 0..=2 {
                assert!(spline.rounding_jumps(order).unwrap() < 1e-13, "order {order}");
            }
            assert_eq!(spline.rounding_jumps(3), None);
        }
        let lines = Spline::linear(&POINTS).unwrap();
        assert!(lines.rounding_jumps(0).unwrap() < 1e-14);
        assert_eq!(lines.rounding_jumps(1), None);
    }
}
