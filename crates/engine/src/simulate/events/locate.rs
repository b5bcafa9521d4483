//! Where a function of the time changes its sign within a step.

use super::tuning::TUNING;
use crate::numerics::bisected;

/// A switch that changed its sign in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// When it first did, as a share of the step.
    pub share: f64,
    /// Whether the ends of the step do not show it: it changed back.
    pub hidden: bool,
}

impl Crossing {
    /// Whether the step ends with it, so that nothing that it begins is stepped over.
    pub fn is_at_the_end(&self) -> bool {
        !self.hidden && self.share >= TUNING.at_the_end
    }
}

/// First change of sign of the cubic through (value, rate) at both ends of a step; of the line if rates are unknown. A
/// value of zero has the sign that follows.
pub fn crossing([start, start_rate]: [f64; 2], [end, end_rate]: [f64; 2], h: f64) -> Option<Crossing> {
    if !start.is_finite() || !end.is_finite() || start == 0.0 {
        return None;
    }
    let changes = start * end <= 0.0;
    if !(start_rate.is_finite() && end_rate.is_finite()) {
        return changes.then(|| Crossing { share: start / (start - end), hidden: false });
    }
    // Without a change of sign at the ends, it has to approach zero first and to leave it last.
    let approaches = start * start_rate < 0.0 && end * end_rate > 0.0;
    if !(changes || approaches) {
        return None;
    }
    let cubic = |s: f64| {
        let rest = 1.0 - s;
        rest * rest * ((1.0 + 2.0 * s) * start + s * h * start_rate)
            + s * s * ((3.0 - 2.0 * s) * end - rest * h * end_rate)
    };
    let changed = |s: f64| cubic(s) * start <= 0.0;
    let first = (1..=TUNING.root_points).map(|point| point as f64 / TUNING.root_points as f64).find(|&s| changed(s))?;
    let share = bisected(first - 1.0 / TUNING.root_points as f64, first, TUNING.root_bisections, changed);
    Some(Crossing { share, hidden: !changes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_of_parabolas_are_exact() {
        // y = 1 − 4 t²/2 over 1 s.
        let found = crossing([1.0, 0.0], [-1.0, -4.0], 1.0).unwrap();
        assert!((found.share - 0.5_f64.sqrt()).abs() < 1e-12 && !found.hidden);
        // (s − 0.3) (s − 0.5), touched between two ends of the same sign.
        let found = crossing([0.15, -0.8], [0.35, 1.2], 1.0).unwrap();
        assert!((found.share - 0.3).abs() < 1e-12 && found.hidden);
    }

    #[test]
    fn function_without_sign_change_has_no_crossing() {
        assert_eq!(crossing([1.0, -1.0], [1.0, 1.0], 1.0), None);
        assert_eq!(crossing([0.0, -1.0], [-1.0, -1.0], 1.0), None);
        assert_eq!(crossing([f64::NAN, 0.0], [1.0, 0.0], 1.0), None);
        assert_eq!(crossing([1.0, f64::NAN], [2.0, f64::NAN], 1.0), None);
    }
}
