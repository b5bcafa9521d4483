//! Functions of real numbers with the same bits on every processor and system: those of formulas and tapes.
//!
//! The standard library takes its functions from the system, which chooses other code, with other last digits, if the
//! processor can fuse a multiplication with an addition.

use super::sincos;

/// sin x.
pub fn sin(x: f64) -> f64 {
    sincos::sin_cos(x).0
}

/// cos x.
pub fn cos(x: f64) -> f64 {
    sincos::sin_cos(x).1
}

/// sin x and cos x.
pub fn sin_cos(x: f64) -> (f64, f64) {
    sincos::sin_cos(x)
}

/// arccos x, between 0 and π.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// The angle of (x, y) to the first axis, between −π and π.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// √(x² + y²).
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// xʸ.
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// ∛x.
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// eˣ.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// The natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// ln(1 + x).
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// The complementary error function.
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// The logarithm of Γ(x), x > 0.
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// The logarithm to base 2.
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// The logarithm to base 10.
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_match_the_standard_library_but_last_digits() {
        for x in [1e-9_f64, 0.3, 0.7429, 1.0, 2.5, 40.0, 1e6] {
            let close =
                |a: f64, b: f64| assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(1e-300), "{x}: {a} {b}");
            let of_std = [x.sin(), x.cos(), x.atan2(0.7), x.hypot(0.7), x.powf(0.3), x.cbrt(), x.log2(), x.log10()];
            let ours = [sin(x), cos(x), atan2(x, 0.7), hypot(x, 0.7), pow(x, 0.3), cbrt(x), log2(x), log10(x)];
            ours.into_iter().zip(of_std).for_each(|(a, b)| close(a, b));
        }
    }
}
