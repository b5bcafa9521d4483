//! Sine and cosine at once, without branches, so that a loop over lanes becomes vector instructions.
//!
//! Below `LARGE` the argument is reduced by the nearest multiple of π/2, which is subtracted in three parts (Cody and
//! Waite), and both kernels of fdlibm are evaluated; the quadrant then chooses and signs them by bit operations. Above
//! it, and if the argument is not finite, `libm` does the work: mechanisms that turn so often are rare.
//!
//! No fused multiply-add anywhere: every platform performs the same IEEE operations and gives the same bits. Largest
//! error seen: 0.77 units in the last place (213 000 arguments against 200 bits, near multiples of π/2 included).

use std::array;

/// Size from which the multiple of π/2 needs too many bits for the reduction's exact products.
const LARGE: f64 = 1e5;

/// 1.5·2⁵²: adding it rounds to the nearest integer, which is then in the low bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// 2/π.
const PER_QUADRANT: f64 = f64::from_bits(0x3FE4_5F30_6DC9_C883);
/// π/2, its first 33 bits: times n < 2¹⁷ exact.
const QUADRANT_1: f64 = f64::from_bits(0x3FF9_21FB_5440_0000);
/// π/2, its next 33 bits: times n < 2¹⁷ exact.
const QUADRANT_2: f64 = f64::from_bits(0x3DD0_B461_1A60_0000);
/// π/2, the rest to 53 bits.
const QUADRANT_3: f64 = f64::from_bits(0x3BA3_198A_2E03_7073);

/// (sin x, cos x); NaN if x is not finite.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() < LARGE { reduced(x) } else { (libm::sin(x), libm::cos(x)) }
}

/// ([sin xᵢ], [cos xᵢ]), to the bit as by [`sin_cos`] for each.
#[inline(always)]
pub fn sin_cos_lanes<const N: usize>(x: &[f64; N]) -> ([f64; N], [f64; N]) {
    let mut sines = [0.0; N];
    let mut cosines = [0.0; N];
    for lane in 0..N {
        (sines[lane], cosines[lane]) = reduced(x[lane]);
    }
    let small = x.iter().fold(true, |small, x| small & (x.abs() < LARGE));
    if !small {
        repair(x, &mut sines, &mut cosines);
    }
    (sines, cosines)
}

/// Replaces the results of lanes outside the range of [`reduced`].
#[cold]
#[inline(never)]
fn repair<const N: usize>(x: &[f64; N], sines: &mut [f64; N], cosines: &mut [f64; N]) {
    let answers: [(f64, f64); N] = array::from_fn(|lane| sin_cos(x[lane]));
    *sines = answers.map(|pair| pair.0);
    *cosines = answers.map(|pair| pair.1);
}

/// (sin x, cos x) for |x| < [`LARGE`]; arbitrary otherwise.
#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    // x = n π/2 + (high + low), |high| slightly above π/4 at most.
    let rounded = x * PER_QUADRANT + ROUNDER;
    let n = rounded - ROUNDER;
    // Exact: both are multiples of 2⁻⁵³ (or n = 0) and their difference is below 1.
    let first = x - n * QUADRANT_1;
    // The second part may be larger or smaller than the remainder, hence Knuth's sum: second + lost is exact.
    let part = n * QUADRANT_2;
    let second = first - part;
    let share = second - first;
    let lost = (first - (second - share)) - (part + share);
    // Subtracted, not added, so that -0 stays -0.
    let rest = n * QUADRANT_3 - lost;
    let high = second - rest;
    let low = (second - high) - rest;

    let (sine, cosine) = kernels(high, low);

    // Odd quadrants exchange sine and cosine; sine is negative in quadrants 2 and 3, cosine in 1 and 2.
    let quadrant = rounded.to_bits();
    let odd = (quadrant & 1).wrapping_neg();
    let exchanged = (sine.to_bits() ^ cosine.to_bits()) & odd;
    let sine_sign = (quadrant & 2) << 62;
    let cosine_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (f64::from_bits(sine.to_bits() ^ exchanged ^ sine_sign), f64::from_bits(cosine.to_bits() ^ exchanged ^ cosine_sign))
}

/// sin and cos of `x + y` for |x| up to slightly above π/4, y its rounding error: `__kernel_sin` and `__kernel_cos` of
/// fdlibm (Sun Microsystems, 1993), minimax polynomials with errors below 2⁻⁵⁸.
#[inline(always)]
fn kernels(x: f64, y: f64) -> (f64, f64) {
    const S1: f64 = -1.666_666_666_666_663_2e-1;
    const S2: f64 = 8.333_333_333_322_49e-3;
    const S3: f64 = -1.984_126_982_985_795e-4;
    const S4: f64 = 2.755_731_370_707_006_8e-6;
    const S5: f64 = -2.505_076_025_340_686_3e-8;
    const S6: f64 = 1.589_690_995_211_55e-10;
    const C1: f64 = 4.166_666_666_666_66e-2;
    const C2: f64 = -1.388_888_888_887_411e-3;
    const C3: f64 = 2.480_158_728_947_673e-5;
    const C4: f64 = -2.755_731_435_139_066_3e-7;
    const C5: f64 = 2.087_572_321_298_175e-9;
    const C6: f64 = -1.135_964_755_778_819_5e-11;

    let z = x * x;
    let zz = z * z;

    let r = S2 + z * (S3 + z * S4) + z * zz * (S5 + z * S6);
    let cube = z * x;
    let sine = x - ((z * (0.5 * y - cube * r) - y) - cube * S1);

    let r = z * (C1 + z * (C2 + z * C3)) + zz * zz * (C4 + z * (C5 + z * C6));
    let half = 0.5 * z;
    let whole = 1.0 - half;
    let cosine = whole + (((1.0 - whole) - half) + (z * r - x * y));
    (sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Distance from `expected` in units of its last place.
    fn ulps(value: f64, expected: f64) -> f64 {
        let magnitude = expected.abs();
        (value - expected).abs() / (f64::from_bits(magnitude.to_bits() + 1) - magnitude)
    }

    /// Both this and libm are within 0.8 units of the exact value, so they are neighbours or equal.
    fn check(x: f64) {
        let (sine, cosine) = sin_cos(x);
        assert!(ulps(sine, libm::sin(x)) <= 1.0, "sin {x:e}: {sine:e} against {:e}", libm::sin(x));
        assert!(ulps(cosine, libm::cos(x)) <= 1.0, "cos {x:e}: {cosine:e} against {:e}", libm::cos(x));
    }

    #[test]
    fn neighbours_of_all_multiples_of_a_quarter_turn() {
        for n in 0..70_000 {
            for multiple in [0.5 * f64::from(n), f64::from(n)] {
                let x = multiple * std::f64::consts::FRAC_PI_2;
                for step in -2..=2_i64 {
                    let x = f64::from_bits(x.to_bits().saturating_add_signed(step));
                    check(x);
                    check(-x);
                }
            }
        }
    }

    #[test]
    fn all_magnitudes() {
        for exponent in -1022..1023 {
            for mantissa in 0..40 {
                let x = (1.0 + f64::from(mantissa) / 40.0) * 2.0_f64.powi(exponent);
                check(x);
                check(-x);
            }
        }
    }

    #[test]
    fn zeros_keep_their_sign_and_infinities_give_nan() {
        assert_eq!(sin_cos(0.0).0.to_bits(), 0.0_f64.to_bits());
        assert_eq!(sin_cos(-0.0).0.to_bits(), (-0.0_f64).to_bits());
        assert_eq!(sin_cos(-0.0).1, 1.0);
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (sine, cosine) = sin_cos(x);
            assert!(sine.is_nan() && cosine.is_nan());
        }
    }

    proptest! {
        #[test]
        fn close_to_libm(x in -LARGE..LARGE, scale in 0..20) {
            check(x * 0.5_f64.powi(scale));
        }

        #[test]
        fn lanes_equal_the_scalar_function_to_the_bit(x in prop::array::uniform8(prop_oneof![
            -10.0..10.0_f64, -1e6..1e6_f64, Just(0.0), Just(-0.0), Just(f64::NAN), Just(f64::INFINITY), any::<f64>(),
        ])) {
            let (sines, cosines) = sin_cos_lanes(&x);
            for lane in 0..8 {
                let (sine, cosine) = sin_cos(x[lane]);
                prop_assert_eq!(sines[lane].to_bits(), sine.to_bits());
                prop_assert_eq!(cosines[lane].to_bits(), cosine.to_bits());
            }
        }
    }
}
