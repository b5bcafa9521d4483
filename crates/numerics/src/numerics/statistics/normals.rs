//! Independent normal numbers by count, and the law of their length.

use symdiff::math;

use super::points::mixed;
use super::special::{normal_cdf, normal_quantile};

/// Standard normal numbers, the same on every machine.
#[derive(Clone, Debug)]
pub struct Normals {
    stream: u64,
    drawn: u64,
}

impl Normals {
    /// The numbers of one stream.
    pub fn new(stream: usize) -> Self {
        Self { stream: mixed(stream as u64 ^ 0x5bd1_e995_9d1c_a3f7), drawn: 0 }
    }

    /// A number in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
        self.drawn += 1;
        (mixed(self.stream.wrapping_mul(0x2545_f491_4f6c_dd1d).wrapping_add(self.drawn)) as f64 + 0.5) * UNIT
    }

    /// `k` normal numbers.
    pub fn draw(&mut self, k: usize) -> Vec<f64> {
        (0..k).map(|_| normal_quantile(self.uniform())).collect()
    }
}

/// The share of points in k dimensions that lie farther out than r: of χ² with k degrees of freedom above r² (M.
/// Abramowitz & I. A. Stegun, Handbook of Mathematical Functions, 26.4.4 and 26.4.5).
pub fn farther_than(r: f64, k: usize) -> f64 {
    if r <= 0.0 {
        return 1.0;
    }
    let half = 0.5 * r * r;
    let is_even = k.is_multiple_of(2);
    let mut sum = if is_even { 0.0 } else { 2.0 * normal_cdf(-r) };
    // xᵃ e⁻ˣ / Γ(a + 1) for a = 0, 1, … or ½, 3/2, …
    let mut order = if is_even { 0.0 } else { 0.5 };
    let mut term = math::exp(-half);
    if !is_even {
        term *= r * (2.0 / std::f64::consts::PI).sqrt();
    }
    while 2.0 * order < k as f64 - 1.0 {
        sum += term;
        order += 1.0;
        term *= half / order;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_chi_squares() {
        // χ² above 3.841 (1), 5.991 (2), 9.488 (4), 31.41 (20) and 18.307 (10) is 5 %; 4 degrees above 30 are (1 + 15)
        // e⁻¹⁵.
        for (k, squared) in [(1, 3.841_459), (2, 5.991_465), (4, 9.487_729), (20, 31.410_43), (10, 18.307_04)] {
            assert!((farther_than(f64::sqrt(squared), k) - 0.05).abs() < 1e-7, "{k}");
        }
        assert!((farther_than(30.0_f64.sqrt(), 4) / (16.0 * (-15.0_f64).exp()) - 1.0).abs() < 1e-12);
        assert!((farther_than(3.0, 3) - 0.029_290_9).abs() < 1e-6);
    }

    #[test]
    fn numbers_are_normal() {
        let all = Normals::new(3).draw(40_000);
        let moment = |power: i32| all.iter().map(|x| x.powi(power)).sum::<f64>() / all.len() as f64;
        assert!(moment(1).abs() < 0.02 && (moment(2) - 1.0).abs() < 0.03 && (moment(4) - 3.0).abs() < 0.2);
        assert!(all[..9] != Normals::new(4).draw(9)[..]);
    }
}
