//! The cubics of a spline between its knots.

use std::sync::OnceLock;

/// Cubics: below the first knot, between each two, above the last.
pub(super) struct Pieces {
    pub knots: Vec<f64>,
    /// Coefficients of powers of x − knot; the knot before the piece, except for the first piece.
    pub cubics: Vec<[f64; 4]>,
    /// Whether the spline repeats beyond its first and last knots.
    pub periodic: bool,
    /// See [`Spline::rounding_jumps`](super::Spline::rounding_jumps), for orders 0 to 3.
    pub jumps: OnceLock<[Option<f64>; 4]>,
}

impl Pieces {
    /// The second derivatives m solve hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (slopeᵢ − slopeᵢ₋₁), m = 0 at the
    /// ends.
    pub fn natural(points: &[(f64, f64)]) -> Self {
        let n = points.len();
        let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        let slopes: Vec<f64> = points.windows(2).zip(&widths).map(|(pair, h)| (pair[1].1 - pair[0].1) / h).collect();
        // Thomas' elimination: diagonal and right side.
        let (mut diagonal, mut right) = (vec![1.0; n], vec![0.0; n]);
        for i in 1..n - 1 {
            let factor = if i > 1 { widths[i - 1] / diagonal[i - 1] } else { 0.0 };
            diagonal[i] = 2.0 * (widths[i - 1] + widths[i]) - factor * widths[i - 1];
            right[i] = 6.0 * (slopes[i] - slopes[i - 1]) - factor * right[i - 1];
        }
        let mut second = vec![0.0; n];
        for i in (1..n - 1).rev() {
            second[i] = (right[i] - widths[i] * second[i + 1]) / diagonal[i];
        }
        Self::with_second(points, &second, false)
    }

    /// As for natural ones, but m₀ = mₙ₋₁, and the equation of inner knots holds there too: the matrix is cyclic. Given
    /// m₀, the others solve a tridiagonal system with m₀ as a factor on the right side; the row of knot 0 determines
    /// it.
    pub fn periodic(points: &[(f64, f64)]) -> Self {
        let n = points.len();
        let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
        let slopes: Vec<f64> = points.windows(2).zip(&widths).map(|(pair, h)| (pair[1].1 - pair[0].1) / h).collect();
        // Rows of knots 1 to n − 2, each with two right sides: of the data, and of m₀ = mₙ₋₁.
        let (mut diagonal, mut data, mut of_first) = (vec![1.0; n], vec![0.0; n], vec![0.0; n]);
        for i in 1..n - 1 {
            let factor = if i > 1 { widths[i - 1] / diagonal[i - 1] } else { 0.0 };
            diagonal[i] = 2.0 * (widths[i - 1] + widths[i]) - factor * widths[i - 1];
            let ends = if i == 1 { -widths[0] } else { 0.0 } + if i == n - 2 { -widths[n - 2] } else { 0.0 };
            data[i] = 6.0 * (slopes[i] - slopes[i - 1]) - factor * data[i - 1];
            of_first[i] = ends - factor * of_first[i - 1];
        }
        let (mut of_data, mut per_first) = (vec![0.0; n], vec![0.0; n]);
        for i in (1..n - 1).rev() {
            of_data[i] = (data[i] - widths[i] * of_data[i + 1]) / diagonal[i];
            per_first[i] = (of_first[i] - widths[i] * per_first[i + 1]) / diagonal[i];
        }
        // hₙ₋₂ mₙ₋₂ + 2 (hₙ₋₂ + h₀) m₀ + h₀ m₁ = 6 (slope₀ − slopeₙ₋₂), m₁ = mₙ₋₁ for two points.
        let (h, last) = (widths[0], widths[n - 2]);
        let right = 6.0 * (slopes[0] - slopes[n - 2]) - last * of_data[n - 2] - h * of_data[1];
        let first = if n > 2 { right / (2.0 * (last + h) + last * per_first[n - 2] + h * per_first[1]) } else { 0.0 };
        let mut second: Vec<f64> = of_data.iter().zip(&per_first).map(|(own, per)| own + per * first).collect();
        (second[0], second[n - 1]) = (first, first);
        Self::with_second(points, &second, true)
    }

    /// The pieces from second derivatives at the knots.
    pub fn with_second(points: &[(f64, f64)], second: &[f64], periodic: bool) -> Self {
        let n = points.len();
        let mut cubics = Vec::with_capacity(n + 1);
        for i in 0..n - 1 {
            let (h, m, next) = (points[i + 1].0 - points[i].0, second[i], second[i + 1]);
            let slope = (points[i + 1].1 - points[i].1) / h - h * (2.0 * m + next) / 6.0;
            if i == 0 {
                cubics.push([points[0].1, slope, 0.0, 0.0]);
            }
            cubics.push([points[i].1, slope, 0.5 * m, (next - m) / (6.0 * h)]);
        }
        let (h, m) = (points[n - 1].0 - points[n - 2].0, second[n - 2]);
        let slope = (points[n - 1].1 - points[n - 2].1) / h;
        cubics.push([points[n - 1].1, slope + h * m / 6.0, 0.0, 0.0]);
        Self { knots: points.iter().map(|point| point.0).collect(), cubics, periodic, jumps: OnceLock::new() }
    }
}
