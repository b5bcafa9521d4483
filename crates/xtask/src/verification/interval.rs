//! The confidence interval of a share.

/// Confidence of the intervals.
pub const CONFIDENCE: f64 = 0.95;

/// Clopper and Pearson's interval of the share with `count` successes in `of` trials: the shares that neither tail of
/// the binomial law refutes at half of the level. It contains the true share in at least that share of all samples,
/// however small they are.
pub fn clopper_pearson(count: u64, of: u64) -> [f64; 2] {
    let half = 0.5 * (1.0 - CONFIDENCE);
    // P(X ≥ count) rises with the share, P(X ≤ count) falls.
    let lower = if count == 0 { 0.0 } else { solve(|share| 1.0 - at_most(count - 1, of, share) < half) };
    let upper = if count == of { 1.0 } else { solve(|share| at_most(count, of, share) > half) };
    [lower, upper]
}

/// The share up to which a condition holds.
fn solve(holds: impl Fn(f64) -> bool) -> f64 {
    let [mut lower, mut upper] = [0.0, 1.0];
    for _ in 0..60 {
        let middle = 0.5 * (lower + upper);
        if holds(middle) { lower = middle } else { upper = middle }
    }
    0.5 * (lower + upper)
}

/// P(X ≤ count) of a binomial law. Terms are sums of logarithms, since powers of many trials underflow.
fn at_most(count: u64, of: u64, share: f64) -> f64 {
    let [success, failure] = [share.ln(), (-share).ln_1p()];
    let mut binomial = 0.0;
    let mut sum = 0.0;
    for i in 0..=count {
        if i > 0 {
            binomial += ((of - i + 1) as f64).ln() - (i as f64).ln();
        }
        sum += (binomial + i as f64 * success + (of - i) as f64 * failure).exp();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 5, to the four digits that it has.
    #[test]
    fn intervals_match_newcombes_table() {
        for (count, of, published) in [
            (81, 263, [0.2527, 0.3676]),
            (15, 148, [0.0578, 0.1617]),
            (0, 20, [0.0, 0.1684]),
            (1, 29, [0.0009, 0.1776]),
        ] {
            let found = clopper_pearson(count, of);
            for (found, published) in found.into_iter().zip(published) {
                assert!((found - published).abs() < 5.1e-5, "{count} of {of}: {found}, {published}");
            }
        }
    }

    /// None or all of n trials: 1 − (α/2)^(1/n).
    #[test]
    fn ends_have_their_closed_form() {
        for of in [1_u64, 7, 300, 5000, 20_000] {
            let exact = 1.0 - 0.025_f64.powf(1.0 / of as f64);
            let [none, all] = [clopper_pearson(0, of), clopper_pearson(of, of)];
            assert!(none[0] == 0.0 && (none[1] - exact).abs() < 1e-9 * exact.max(1e-3), "{of}: {none:?}");
            assert!(all[1] == 1.0 && (1.0 - all[0] - exact).abs() < 1e-9, "{of}: {all:?}");
        }
    }
}
