//! The order at which three steps of different length agree: a check of the error by halving.
//!
//! With an error C hᵠ, steps h, h/2 and r h give differences in the ratio ρ = (2⁻ᵠ − rᵠ)/(1 − 2⁻ᵠ). Where q is not near
//! 2, the error is not that of a second-order scheme: steps are too long for the motion that they resolve, or the
//! motion is not smooth.

use symdiff::math;

use super::envelope::envelope;
use super::tuning::TUNING;

/// Order of the scheme. Where steps are not quite short enough, it looks a little lower.
const SCHEME: f64 = 2.0;

/// Order of a step in which the equations switch.
const OF_A_SWITCH: f64 = 1.0;

/// Differences of an output at some samples in one row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Differences {
    /// Between steps h and h/2.
    pub halved: f64,
    /// Between steps h/2 and r h.
    pub finer: f64,
    /// Between steps h and r h.
    pub all: f64,
}

/// Correction of a row's error by halving, which assumes order 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// It is multiplied by this, 1 or more,
    pub factor: f64,
    /// and is at least this.
    pub least: f64,
}

impl Correction {
    /// No correction.
    pub const NONE: Self = Self { factor: 1.0, least: 0.0 };

    /// The corrected error.
    pub fn of(self, error: f64) -> f64 {
        let scaled = self.factor * error;
        if scaled < self.least { self.least } else { scaled }
    }
}

/// Corrections of every row from the differences in all of them; `ratio` is r < 1/2. From row `switched_from` on, steps
/// have switches of the equations inside them: where in a step they lie is a matter of chance, so that the order is
/// that of a single such step, 1.
pub fn corrections(rows: &[Differences], ratio: f64, switched_from: Option<usize>) -> Vec<Correction> {
    let pick = |pick: fn(&Differences) -> f64| envelope(&rows.iter().map(pick).collect::<Vec<f64>>());
    let (halved, finer, all) = (pick(|row| row.halved), pick(|row| row.finer), pick(|row| row.all));
    let of_row = |row: usize| {
        let seen = order(finer[row] / halved[row], ratio);
        let has_switched = switched_from.is_some_and(|from| row >= from);
        // `min` passes over NaN.
        let order = if has_switched { seen.min(OF_A_SWITCH) } else { seen };
        if order.is_nan() || order >= SCHEME {
            return Correction::NONE;
        }
        let factor = (1.0 - 0.25) / (1.0 - math::pow(0.5, order.max(TUNING.no_order)));
        let disagree = order < TUNING.least_order;
        Correction {
            factor,
            least: if disagree { TUNING.of_differences * halved[row].max(finer[row]).max(all[row]) } else { 0.0 },
        }
    };
    (0..rows.len()).map(of_row).collect()
}

/// The order q at which (2⁻ᵠ − rᵠ)/(1 − 2⁻ᵠ) is `found`, which falls with q; between 0 and 8, NaN if `found` is.
fn order(found: f64, ratio: f64) -> f64 {
    if found.is_nan() {
        return f64::NAN;
    }
    let of = |q: f64| (math::pow(0.5, q) - math::pow(ratio, q)) / (1.0 - math::pow(0.5, q));
    let (mut low, mut high) = (1e-3, 8.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if of(middle) > found {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differences(q: f64, ratio: f64) -> Vec<Differences> {
        let (coarse, half, fine) = (1.0, math::pow(0.5, q), math::pow(ratio, q));
        vec![Differences { halved: coarse - half, finer: half - fine, all: coarse - fine }; 3]
    }

    #[test]
    fn the_order_is_found() {
        for q in [0.5, 1.0, 1.9, 3.0] {
            let row = differences(q, 0.37)[0];
            assert!((order(row.finer / row.halved, 0.37) - q).abs() < 1e-6);
        }
        assert!(order(f64::NAN, 0.37).is_nan());
    }

    #[test]
    fn a_lower_order_makes_the_error_larger() {
        assert_eq!(corrections(&differences(2.0, 0.37), 0.37, None), [Correction::NONE; 3]);
        let [first, ..] = corrections(&differences(1.0, 0.37), 0.37, None)[..] else { unreachable!() };
        // The error is 1, halving changes 0.5, and 4/3 of that is 2/3.
        assert!((first.of(2.0 / 3.0) - 1.0).abs() < 1e-6, "{first:?}");
        // No convergence at all.
        let wrong_alike = Differences { halved: 1e-6, finer: 0.3, all: 0.3 };
        assert_eq!(corrections(&[wrong_alike; 2], 0.37, None)[0].of(1e-6), TUNING.of_differences * 0.3);
    }

    #[test]
    fn a_switch_inside_a_step_makes_it_first_order() {
        let found = corrections(&differences(2.0, 0.37), 0.37, Some(1));
        assert_eq!(found[0], Correction::NONE);
        assert!(found[1].factor == 1.5 && found[1].least > 1.2, "{found:?}");
    }

    #[test]
    fn unknown_and_exact_rows_need_no_correction() {
        let unknown = Differences { halved: f64::NAN, ..Differences::default() };
        assert_eq!(corrections(&[unknown, Differences::default()], 0.37, None), [Correction::NONE; 2]);
    }
}
