//! Time that a run takes unasked, and its end if the estimate was too low.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use super::{Price, in_words};
use crate::study::price::tuning::TUNING;

use crate::methods::Budget;
use crate::numerics::clock::Instant;

/// Longest duration of a run that nobody has allowed to take long: three times its estimate, and no less than three
/// times the longest estimate with which a run begins unasked.
#[derive(Debug)]
pub struct Allowance {
    begun: Instant,
    /// Sum of the estimates of all rounds, ms.
    expected: AtomicU64,
    /// Whether it went on for longer. Stays.
    spent: AtomicBool,
    /// The estimate by which it was, s.
    estimate: OnceLock<f64>,
}

impl Allowance {
    /// An allowance from now on.
    pub(in crate::study) fn begin() -> Self {
        Self {
            begun: Instant::now(),
            expected: AtomicU64::new(0),
            spent: AtomicBool::new(false),
            estimate: OnceLock::new(),
        }
    }

    /// Adds the estimate of another round, of which the model allows so much.
    pub(in crate::study) fn expect(&self, price: &Price, budget: &Budget) {
        let is_allowed = budget.simulations > Budget::default().simulations;
        let seconds = if is_allowed { TUNING.for_ever } else { price.at_most() + budget.seconds.unwrap_or(0.0) };
        self.expected.fetch_add((1e3 * seconds) as u64, Ordering::Relaxed);
    }

    /// Lets the run take as long as it does.
    pub(in crate::study) fn lift(&self) {
        self.expected.fetch_add((1e3 * TUNING.for_ever) as u64, Ordering::Relaxed);
    }

    /// Whether the run is to end.
    pub(in crate::study) fn is_spent(&self) -> bool {
        self.is_spent_after(self.begun.elapsed())
    }

    fn is_spent_after(&self, elapsed: Duration) -> bool {
        if self.spent.load(Ordering::Relaxed) {
            return true;
        }
        let expected = Duration::from_millis(self.expected.load(Ordering::Relaxed));
        let is_spent = elapsed > TUNING.times * expected.max(Duration::from_secs_f64(TUNING.seconds));
        if is_spent {
            self.estimate.get_or_init(|| expected.as_secs_f64());
            self.spent.store(true, Ordering::Relaxed);
        }
        is_spent
    }

    /// Why it ended, if it did.
    pub(in crate::study) fn ended(&self) -> Option<String> {
        let estimate = self.estimate.get()?;
        let limit = TUNING.times as f64 * estimate.max(TUNING.seconds);
        Some(format!(
            "ended after {}: {} were estimated; what is finished is kept; allow it to take longer with --yes \
             (in Rust `allow_costly`, in Python `costly=True`)",
            in_words(&limit),
            in_words(estimate)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expecting(seconds: &[f64], budget: Budget) -> Allowance {
        let allowance = Allowance::begin();
        seconds.iter().for_each(|&seconds| allowance.expect(&Price::of_seconds(seconds), &budget));
        allowance
    }

    #[test]
    fn a_run_ends_after_three_times_its_estimate() {
        let after = |allowance: &Allowance, seconds| allowance.is_spent_after(Duration::from_secs(seconds));
        let short = expecting(&[1.0], Budget::default());
        assert!(!after(&short, 179) && short.ended().is_none());
        assert!(
            after(&short, 181) && short.ended().unwrap().starts_with("ended after 3.0 min: 1000 ms were estimated")
        );
        assert!(short.is_spent(), "it does not go on");
        // Rounds add up.
        let long = expecting(&[200.0, 100.0], Budget::default());
        assert!(!after(&long, 899) && after(&long, 901));
        // If the model names the time, or allows many simulations, it has allowed them.
        let timed = expecting(&[1.0], Budget { seconds: Some(600.0), ..Budget::default() });
        assert!(!after(&timed, 1801) && after(&timed, 1804));
        let many = expecting(&[1.0], Budget { simulations: 100_000, ..Budget::default() });
        assert!(!after(&many, 100_000));
    }
}
