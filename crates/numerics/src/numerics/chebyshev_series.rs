//! A smooth function of the time as a sum of Chebyshev polynomials, with its derivatives.

use std::f64::consts::PI;

use symdiff::math;

use super::least_squares::LeastSquares;

/// Σ cₖ Tₖ(τ), τ ∈ [−1, 1] over a span.
#[derive(Clone, Debug, PartialEq)]
pub struct ChebyshevSeries {
    span: [f64; 2],
    coefficients: Vec<f64>,
}

impl ChebyshevSeries {
    /// Points through which a series of this degree is determined: the extremes of the last polynomial, both ends
    /// among them, ascending.
    pub fn nodes(span: [f64; 2], degree: usize) -> Vec<f64> {
        let [begin, end] = span;
        let at = |node: usize| match node {
            0 => begin,
            _ if node == degree => end,
            _ => 0.5 * (begin + end) - 0.5 * (end - begin) * math::cos(PI * node as f64 / degree as f64),
        };
        (0..=degree).map(at).collect()
    }

    /// The series through values at [`nodes`](Self::nodes), at least two.
    pub fn through(span: [f64; 2], values: &[f64]) -> Self {
        let degree = values.len() - 1;
        let half = |index: usize| if index == 0 || index == degree { 0.5 } else { 1.0 };
        let cosines: Vec<f64> = (0..2 * degree).map(|index| math::cos(PI * index as f64 / degree as f64)).collect();
        let coefficient = |k: usize| {
            let term = |(node, value): (usize, &f64)| {
                // The nodes ascend, τ = −cos(π node/degree).
                half(node) * value * cosines[k * (degree - node) % (2 * degree)]
            };
            half(k) * 2.0 / degree as f64 * values.iter().enumerate().map(term).sum::<f64>()
        };
        Self { span, coefficients: (0..=degree).map(coefficient).collect() }
    }

    /// The series of this degree nearest to each function's values at times within the span, by least squares; `None`
    /// if the times do not determine it.
    pub fn fitted(span: [f64; 2], degree: usize, times: &[f64], functions: &[Vec<f64>]) -> Option<Vec<Self>> {
        let terms: Vec<Vec<f64>> = times.iter().map(|&time| polynomials(scaled(span, time), degree)).collect();
        let squares = LeastSquares::new(&terms, vec![1.0; times.len()])?;
        let fit = |values: &Vec<f64>| Some(Self { span, coefficients: squares.fit(values)?.0 });
        functions.iter().map(fit).collect()
    }

    /// Its coefficients, from that of the constant on.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Its value, by Clenshaw's recurrence.
    pub fn at(&self, time: f64) -> f64 {
        let twice = 2.0 * scaled(self.span, time);
        let (mut next, mut last) = (0.0, 0.0);
        for &coefficient in self.coefficients.iter().skip(1).rev() {
            (next, last) = (coefficient + twice * next - last, next);
        }
        self.coefficients[0] + 0.5 * twice * next - last
    }

    /// Its derivative by the time.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let [begin, end] = self.span;
        let count = self.coefficients.len();
        let mut slopes = vec![0.0; count + 1];
        for k in (1..count).rev() {
            slopes[k - 1] = slopes[k + 1] + 2.0 * k as f64 * self.coefficients[k];
        }
        slopes.truncate(count.max(2) - 1);
        slopes[0] *= 0.5;
        slopes.iter_mut().for_each(|slope| *slope *= 2.0 / (end - begin));
        Self { span: self.span, coefficients: slopes }
    }

    /// Largest coefficient.
    pub fn size(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |most: f64, own| most.max(own.abs()))
    }

    /// Largest coefficient of the last quarter, an estimate of the missing ones.
    pub fn tail(&self) -> f64 {
        let last = &self.coefficients[self.coefficients.len() * 3 / 4..];
        last.iter().fold(0.0, |most: f64, own| most.max(own.abs()))
    }

    /// Removes the last coefficients that do not exceed `least`; the constant stays.
    #[must_use]
    pub fn chopped(mut self, least: f64) -> Self {
        let kept = self.coefficients.iter().rposition(|own| own.abs() > least).map_or(1, |last| last + 1);
        self.coefficients.truncate(kept);
        self
    }
}

/// τ of a time.
fn scaled([begin, end]: [f64; 2], time: f64) -> f64 {
    ((time - begin) - (end - time)) / (end - begin)
}

/// T₀ … of these degrees at τ.
fn polynomials(tau: f64, degree: usize) -> Vec<f64> {
    let mut found = vec![1.0, tau];
    for k in 2..=degree {
        found.push(2.0 * tau * found[k - 1] - found[k - 2]);
    }
    found.truncate(degree + 1);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPAN: [f64; 2] = [0.5, 2.5];

    #[test]
    fn a_series_has_the_function_and_its_derivatives() {
        let values: Vec<f64> = ChebyshevSeries::nodes(SPAN, 40).iter().map(|t| (3.0 * t).sin()).collect();
        let series = ChebyshevSeries::through(SPAN, &values);
        assert!(series.tail() < 1e-15);
        let series = series.chopped(1e-15);
        let (first, second) = (series.derivative(), series.derivative().derivative());
        for step in 0..=50 {
            let t = 0.5 + 0.04 * f64::from(step);
            assert!((series.at(t) - (3.0 * t).sin()).abs() < 1e-14);
            assert!((first.at(t) - 3.0 * (3.0 * t).cos()).abs() < 1e-12);
            assert!((second.at(t) + 9.0 * (3.0 * t).sin()).abs() < 1e-10);
        }
    }

    #[test]
    fn fit_of_a_polynomial_is_exact() {
        let times: Vec<f64> = (0..9).map(|row| 0.5 + 0.25 * f64::from(row)).collect();
        let values: Vec<f64> = times.iter().map(|t| 1.0 - t + 2.0 * t * t * t).collect();
        let line: Vec<f64> = times.iter().map(|t| 2.0 * t).collect();
        let [series, other] = &ChebyshevSeries::fitted(SPAN, 3, &times, &[values.clone(), line]).unwrap()[..] else {
            panic!("two functions have two series")
        };
        assert!((other.at(0.9) - 1.8).abs() < 1e-13);
        assert!((series.at(0.9) - (0.1 + 2.0 * 0.729)).abs() < 1e-13);
        assert!((series.derivative().at(0.9) - (-1.0 + 6.0 * 0.81)).abs() < 1e-12);
        assert!(ChebyshevSeries::fitted(SPAN, 9, &times, &[values]).is_none());
    }

    #[test]
    fn a_constant_has_no_slope() {
        let series = ChebyshevSeries::through(SPAN, &[2.0, 2.0, 2.0]).chopped(1e-12);
        assert_eq!((series.at(0.7), series.derivative().at(0.7)), (2.0, 0.0));
    }
}
