//! An output between two steps: the cubic through the values at four steps.

use std::ops::Range;

use super::tuning::TUNING;
use crate::numerics::bisected;

/// A point of a piece: the share of its length, and the value there.
pub(super) type PiecePoint = (f64, f64);

/// The values between two steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Time of the first step, s.
    pub start: f64,
    /// Time from the first step to the second, s.
    pub length: f64,
    /// Values at both.
    pub ends: [f64; 2],
    /// Coefficients of the powers of the share of the length.
    cubic: [f64; 4],
    /// The highest and the lowest point between the ends, if they are above or below both.
    peaks: [Option<PiecePoint>; 2],
}

impl Piece {
    /// The piece between points `first` and `first` + 1 of up to four (time, value), ascending in time.
    pub fn between(points: &[(f64, f64)], first: usize) -> Self {
        let [(start, a), (end, b)] = [points[first], points[first + 1]];
        let length = end - start;
        let share = |time: f64| (time - start) / length;
        let cubic = interpolated(points.iter().map(|&(time, value)| (share(time), value)));
        let mut piece = Self { start, length, ends: [a, b], cubic, peaks: [None; 2] };
        // A parabola on either side of a jump rises on one side of it only.
        let triples = (first.saturating_sub(1)..=first).filter_map(|begin| points.get(begin..begin + 3));
        let parabolas: Vec<[f64; 4]> =
            triples.map(|triple| interpolated(triple.iter().map(|&(time, value)| (share(time), value)))).collect();
        for (index, sign) in [1.0, -1.0].into_iter().enumerate() {
            piece.peaks[index] = piece.peak(sign, &parabolas);
        }
        piece
    }

    /// The value at a share of the length; at the ends those of the steps.
    pub fn at(&self, share: f64) -> f64 {
        match share {
            0.0 => self.ends[0],
            1.0 => self.ends[1],
            _ => value(&self.cubic, share),
        }
    }

    /// Time at a share of the length, s.
    pub fn time(&self, share: f64) -> f64 {
        self.start + share * self.length
    }

    /// The part of the piece between two times, as shares; `None` where nothing is.
    pub fn part(&self, from: f64, to: f64) -> Option<Range<f64>> {
        let share = |time: f64| ((time - self.start) / self.length).clamp(0.0, 1.0);
        let (begin, end) = (share(from), share(to));
        (begin < end).then_some(begin..end)
    }

    /// The greatest value of a part times `sign`, and where; of equals the first.
    pub fn greatest(&self, part: &Range<f64>, sign: f64) -> PiecePoint {
        let inside = self.peaks[usize::from(sign < 0.0)].filter(|(share, _)| part.contains(share));
        let [begin, end] = [part.start, part.end];
        let places = [Some((begin, self.at(begin))), inside, Some((end, self.at(end)))];
        let larger = |a: PiecePoint, b: PiecePoint| if sign * b.1 > sign * a.1 { b } else { a };
        places.into_iter().flatten().reduce(larger).unwrap_or((begin, f64::NAN))
    }

    /// First share of a part at which the value is not negative.
    pub fn first_above(&self, part: &Range<f64>) -> Option<f64> {
        if self.at(part.start) >= 0.0 {
            return Some(part.start);
        }
        let (top, height) = self.greatest(part, 1.0);
        (height >= 0.0).then(|| self.crossing(part.start, top))
    }

    /// Last share of a part at which the value is not negative.
    pub fn last_above(&self, part: &Range<f64>) -> Option<f64> {
        if self.at(part.end) >= 0.0 {
            return Some(part.end);
        }
        let (top, height) = self.greatest(part, 1.0);
        (height >= 0.0).then(|| self.crossing(part.end, top))
    }

    /// Share at which the value becomes positive, from one at which it is negative to one at which it is not.
    fn crossing(&self, below: f64, above: f64) -> f64 {
        bisected(below, above, TUNING.bisections_of_crossing, |share| self.at(share) >= 0.0)
    }

    /// The integral of a function of the value over a part, by Gauss' rule of four nodes: exact up to degree 7.
    pub fn integral(&self, part: &Range<f64>, function: impl Fn(f64) -> f64) -> f64 {
        const NODES: [(f64, f64); 2] =
            [(0.339_981_043_584_856_3, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_9)];
        let (middle, half) = (0.5 * (part.start + part.end), 0.5 * (part.end - part.start));
        let sum: f64 = NODES
            .iter()
            .map(|(node, weight)| {
                let [left, right] = [middle - half * node, middle + half * node].map(|share| value(&self.cubic, share));
                weight * (function(left) + function(right))
            })
            .sum();
        half * self.length * sum
    }

    /// The highest point of the cubic times `sign`, if it and both parabolas rise above the ends.
    fn peak(&self, sign: f64, parabolas: &[[f64; 4]]) -> Option<PiecePoint> {
        let ends = (sign * self.ends[0]).max(sign * self.ends[1]);
        let rise = |polynomial: &[f64; 4]| {
            let top = stationary(polynomial).into_iter().flatten().filter(|share| *share > 0.0 && *share < 1.0);
            let heights = top.map(|share| (share, sign * value(polynomial, share) - ends));
            heights.filter(|(_, rise)| *rise > 0.0).reduce(|a, b| if b.1 > a.1 { b } else { a })
        };
        let most = parabolas.iter().map(|parabola| rise(parabola).map_or(0.0, |(_, rise)| rise));
        let (least, most) =
            most.fold((f64::INFINITY, 0.0_f64), |(least, most), rise| (least.min(rise), most.max(rise)));
        if !(least > 0.0 && least.is_finite()) {
            return None;
        }
        let (share, rise) = rise(&self.cubic)?;
        Some((share, sign * (ends + rise.min(TUNING.rise_of_peak * most))))
    }
}

fn value([a, b, c, d]: &[f64; 4], share: f64) -> f64 {
    a + share * (b + share * (c + share * d))
}

/// Shares at which the derivative vanishes.
fn stationary(&[_, b, c, d]: &[f64; 4]) -> [Option<f64>; 2] {
    // b + 2 c s + 3 d s², solved without cancellation.
    let root = c * c - 3.0 * b * d;
    if root < 0.0 {
        return [None; 2];
    }
    let sum = -(c + root.sqrt().copysign(c));
    let finite = |share: f64| Some(share).filter(|share| share.is_finite());
    [finite(sum / (3.0 * d)), finite(b / sum)]
}

/// The polynomial through up to four points, by Newton's divided differences.
fn interpolated(points: impl Iterator<Item = (f64, f64)>) -> [f64; 4] {
    let (mut nodes, mut differences, mut count) = ([0.0; 4], [0.0; 4], 0);
    for (node, value) in points.take(4) {
        (nodes[count], differences[count]) = (node, value);
        count += 1;
    }
    for order in 1..count {
        for index in (order..count).rev() {
            differences[index] = (differences[index] - differences[index - 1]) / (nodes[index] - nodes[index - order]);
        }
    }
    let mut polynomial = [0.0; 4];
    for index in (0..count).rev() {
        // polynomial · (s − node) + difference
        for power in (1..4).rev() {
            polynomial[power] = polynomial[power - 1] - nodes[index] * polynomial[power];
        }
        polynomial[0] = differences[index] - nodes[index] * polynomial[0];
    }
    polynomial
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_through_uneven_steps() {
        let f = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 3.0 * t * t * t;
        let points = [0.1, 0.25, 0.3, 0.5].map(|t| (t, f(t)));
        let piece = Piece::between(&points, 1);
        for share in [0.0, 0.3, 0.8, 1.0] {
            assert!((piece.at(share) - f(piece.time(share))).abs() < 1e-14);
        }
        let exact = |t: f64| t - t * t + t * t * t / 6.0 - 0.75 * t * t * t * t;
        let integral = piece.integral(&(0.2..0.9), |value| value);
        assert!((integral - (exact(piece.time(0.9)) - exact(piece.time(0.2)))).abs() < 1e-15);
    }

    #[test]
    fn a_smooth_peak_is_refined_and_a_jump_is_not() {
        let points = [-1.3, -0.3, 0.7, 1.7].map(|t: f64| (t, symdiff::math::cos(0.1 * t)));
        let (share, height) = Piece::between(&points, 1).greatest(&(0.0..1.0), 1.0);
        // |f⁗| h⁴/4! times the largest |(s+1) s (s−1) (s−2)|, 9/16.
        assert!((height - 1.0).abs() < 1e-4 / 24.0 * 9.0 / 16.0 && (share - 0.3).abs() < 1e-3, "{share} {height}");
        let jump = [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)];
        assert_eq!(Piece::between(&jump, 1).greatest(&(0.0..1.0), 1.0).1, 1.0);
    }

    #[test]
    fn crossings_are_found_on_both_sides_of_a_hidden_peak() {
        // 0.01 − (t − 0.5)² between steps at which it is negative.
        let points = [-1.0, 0.0, 1.0, 2.0].map(|t: f64| (t, 0.01 - (t - 0.5) * (t - 0.5)));
        let piece = Piece::between(&points, 1);
        assert!((piece.first_above(&(0.0..1.0)).unwrap() - 0.4).abs() < 1e-12);
        assert!((piece.last_above(&(0.0..1.0)).unwrap() - 0.6).abs() < 1e-12);
        assert_eq!(piece.first_above(&(0.65..1.0)), None);
    }
}
