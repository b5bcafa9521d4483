//! The cheapest sizes under linearised constraints: min Σ cᵢ/fᵢ subject to gⱼ + Σᵢ hⱼᵢ (fᵢᵖ − aᵢᵖ) ≥ 0 and leastᵢ ≤ fᵢ
//! ≤ mostᵢ.
//!
//! The problem is convex and separable, so that its dual is a concave function of one multiplier for each constraint,
//! whose minimisers follow from closed forms (C. Fleury, Structural weight optimization by dual methods of convex
//! programming, Int. J. Numer. Meth. Eng. 14 (1979) 1761).

use super::tuning::TUNING;
use symdiff::math;

/// A constraint about the sizes at which it was linearised.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Its value there; a negative one is not fulfilled.
    pub value: f64,
    /// Derivatives with respect to the p-th powers of the sizes.
    pub slopes: Vec<f64>,
}

/// The power of the sizes in which constraints are linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// Worst cases add up sizes.
    First,
    /// Variances add up squares.
    Second,
}

impl Power {
    fn of(self, size: f64) -> f64 {
        match self {
            Self::First => size,
            Self::Second => size * size,
        }
    }

    /// The size at which −c/f² = p s fᵖ⁻¹ for s < 0.
    fn stationary(self, cost: f64, slope: f64) -> f64 {
        match self {
            Self::First => (cost / -slope).sqrt(),
            Self::Second => math::cbrt(cost / (-2.0 * slope)),
        }
    }

    /// The multiplier of a slope s < 0 with which this size is stationary.
    fn multiplier(self, cost: f64, slope: f64, size: f64) -> f64 {
        match self {
            Self::First => cost / (-slope * size * size),
            Self::Second => cost / (-2.0 * slope * size * size * size),
        }
    }
}

/// The cheapest sizes. Where no sizes fulfil all constraints, those that come near.
pub fn cheapest(
    costs: &[f64],
    power: Power,
    at: &[f64],
    constraints: &[Linear],
    least: &[f64],
    most: &[f64],
) -> Vec<f64> {
    let sizes = |multipliers: &[f64]| -> Vec<f64> {
        let of = |i: usize| {
            let slope: f64 = multipliers.iter().zip(constraints).map(|(m, constraint)| m * constraint.slopes[i]).sum();
            if slope >= 0.0 { most[i] } else { power.stationary(costs[i], slope).clamp(least[i], most[i]) }
        };
        (0..costs.len()).map(of).collect()
    };
    let value = |constraint: &Linear, sizes: &[f64]| {
        let moved = |i: usize| constraint.slopes[i] * (power.of(sizes[i]) - power.of(at[i]));
        constraint.value + (0..sizes.len()).map(moved).sum::<f64>()
    };
    // A constraint that smaller sizes do not help counts for nothing.
    let largest = |constraint: &Linear| {
        let enough = |i: usize| match constraint.slopes[i] {
            slope if slope < 0.0 => power.multiplier(costs[i], slope, least[i]),
            _ => 0.0,
        };
        TUNING.largest_multiplier * (0..costs.len()).map(enough).filter(|most| most.is_finite()).fold(0.0, f64::max)
    };
    let most_of: Vec<f64> = constraints.iter().map(largest).collect();
    let mut multipliers = vec![0.0; constraints.len()];
    for _ in 0..TUNING.rounds_of_cheapest {
        let mut moved = 0.0_f64;
        for (index, constraint) in constraints.iter().enumerate() {
            let before = multipliers[index];
            let mut with = |multiplier: f64| {
                multipliers[index] = multiplier;
                value(constraint, &sizes(&multipliers))
            };
            let most = most_of[index];
            let found = if most == 0.0 || with(0.0) >= 0.0 { 0.0 } else { root(&mut with, before, most) };
            multipliers[index] = found;
            moved = moved.max((found - before).abs() / found.max(before).max(f64::MIN_POSITIVE));
        }
        if moved < TUNING.settled_multipliers {
            break;
        }
    }
    sizes(&multipliers)
}

/// The multiplier up to `most` at which a constraint is just fulfilled; its value does not decrease with the
/// multiplier.
fn root(with: &mut dyn FnMut(f64) -> f64, before: f64, most: f64) -> f64 {
    let guess = if before > 0.0 { before } else { most.min(1.0) };
    let (mut low, mut high) = (guess, guess);
    while with(high) < 0.0 && high < most {
        high = (4.0 * high).min(most);
    }
    while with(low) >= 0.0 && low > TUNING.smallest_multiplier * guess {
        low *= 0.25;
    }
    for _ in 0..TUNING.halvings_of_multiplier {
        let middle = (low * high).sqrt();
        if with(middle) < 0.0 { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lagranges_solution_of_a_stack() {
        // Σ |s| f ≤ L: f ~ √(c/|s|). Σ s² f² ≤ L²: f ~ ∛(c/s²).
        let (costs, s) = ([1.0, 4.0, 2.0], [1.0, 0.5, 3.0]);
        for power in [Power::First, Power::Second] {
            let slopes = s.map(|s: f64| if power == Power::First { -s } else { -s * s }).to_vec();
            let limit = 2.0;
            let found = cheapest(&costs, power, &[0.0; 3], &[Linear { value: limit, slopes }], &[1e-3; 3], &[1e3; 3]);
            let shape: [f64; 3] = std::array::from_fn(|i| match power {
                Power::First => (costs[i] / s[i]).sqrt(),
                Power::Second => (costs[i] / (s[i] * s[i])).cbrt(),
            });
            let used: f64 = (0..3).map(|i| power.of(s[i].powi(1)) * power.of(shape[i])).sum();
            let scale = match power {
                Power::First => limit / used,
                Power::Second => (limit / used).sqrt(),
            };
            for (found, shape) in found.iter().zip(shape) {
                assert!((found / (scale * shape) - 1.0).abs() < 1e-7, "{found} {shape}");
            }
        }
    }

    #[test]
    fn several_constraints_and_ends() {
        let constraints =
            [Linear { value: 1.0, slopes: vec![-1.0, -1.0] }, Linear { value: 1.0, slopes: vec![-4.0, 0.0] }];
        let found = cheapest(&[1.0, 1.0], Power::First, &[0.0, 0.0], &constraints, &[0.01; 2], &[10.0; 2]);
        assert!((found[0] - 0.25).abs() < 1e-8 && (found[1] - 0.75).abs() < 1e-8, "{found:?}");
        let found = cheapest(&[1.0, 1.0], Power::First, &[0.0, 0.0], &constraints, &[0.01; 2], &[10.0, 0.5]);
        assert!((found[0] - 0.25).abs() < 1e-8 && found[1] == 0.5, "{found:?}");
        // A constraint that sizes do not change, or hardly change, leaves the others as they are.
        for slope in [0.0, -0.0, -1e-300] {
            let with_flat = [constraints[0].clone(), Linear { value: -1.0, slopes: vec![slope; 2] }];
            let found = cheapest(&[1.0, 1.0], Power::First, &[0.0, 0.0], &with_flat, &[0.01; 2], &[10.0, 0.5]);
            assert!(found.iter().all(|size| (0.01..=10.0).contains(size)), "{slope} {found:?}");
            if slope == 0.0 {
                assert!((found[0] - 0.5).abs() < 1e-8 && found[1] == 0.5, "{found:?}");
            }
        }
        let impossible = [Linear { value: -1.0, slopes: vec![-1.0, -1.0] }];
        let found = cheapest(&[1.0, 1.0], Power::First, &[0.0, 0.0], &impossible, &[0.01; 2], &[10.0; 2]);
        assert_eq!(found, [0.01, 0.01]);
    }
}
