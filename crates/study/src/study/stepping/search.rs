//! The steps that a tolerance of the bounds asks for.

use symdiff::math;

use crate::simulate::{Integration, Schedule};
use crate::study::stepping::tuning::TUNING;

/// Divides or joins a schedule's steps until their error is within its share of the tolerance. The scheme is of second
/// order, so that the error goes as the step's square; of higher order if steps are extrapolated, which is tried if it
/// would take fewer.
pub struct StepSearch {
    base: Schedule,
    /// Steps between rows, if they are of equal length; then they can be joined too.
    per_row: Option<usize>,
    /// Steps for each of the base's; between rows where `per_row` is known.
    count: usize,
    /// Counts whose error is known.
    tried: Vec<(usize, f64)>,
    /// Whether levels of extrapolation may be chosen.
    may_extrapolate: bool,
    integration: Integration,
    /// Error of the plain steps that were given up.
    plain: f64,
}

impl StepSearch {
    /// Begins with the schedule as it is.
    pub fn new(base: &Schedule, may_extrapolate: bool) -> Self {
        let per_row = base.steps_per_row();
        Self {
            base: base.clone(),
            per_row,
            count: per_row.unwrap_or(1),
            tried: Vec::new(),
            may_extrapolate,
            integration: base.integration,
            plain: f64::NAN,
        }
    }

    /// The schedule to try.
    pub fn schedule(&self) -> Schedule {
        let steps = match self.per_row {
            Some(_) => self.base.with_steps_per_row(self.count),
            None => self.base.refined(self.count),
        };
        steps.taken(self.integration)
    }

    /// Parts that each of the base's steps is divided into; 1 if steps of equal length are counted instead.
    pub fn parts(&self) -> usize {
        if self.per_row.is_some() { 1 } else { self.count }
    }

    /// Takes in the error of the schedule tried last, over the tolerance; whether another is to be tried.
    pub fn adjust(&mut self, error: f64) -> bool {
        self.tried.push((self.count, error));
        if self.choose_levels(error) {
            return true;
        }
        let most = TUNING.parts * self.per_row.unwrap_or(1);
        let wanted = (self.count as f64 * self.parts_for(error)).ceil().clamp(1.0, most as f64) as usize;
        let next = match error {
            error if error.is_nan() => (4 * self.count).min(most),
            error if error > TUNING.share => wanted.max(self.count + 1).min(most),
            // Once steps were too long, those that are not are taken.
            error if error < TUNING.little && self.tried.iter().all(|&(_, error)| error <= TUNING.share) => wanted,
            _ => self.count,
        };
        let other = next != self.count && self.tried.len() < TUNING.trials;
        self.count = if other { next } else { self.count };
        other
    }

    /// Parts that would bring an error down, or up, to the target.
    fn parts_for(&self, error: f64) -> f64 {
        match self.integration.order() {
            2 => (error / TUNING.aim).sqrt(),
            order => math::pow(error / TUNING.aim, 1.0 / order as f64),
        }
    }

    /// Whether the same steps are to be tried on other levels.
    fn choose_levels(&mut self, error: f64) -> bool {
        if !self.may_extrapolate {
            return false;
        }
        let parts = self.parts_for(error);
        // NaN gains nothing either.
        let gains = TUNING.gain * error < self.plain || error <= TUNING.share;
        match self.integration {
            Integration::Plain if error > TUNING.share && parts > TUNING.worth_levels => {
                self.plain = error;
                self.integration = Integration::of_levels(TUNING.first_levels);
            }
            Integration::Extrapolated { .. } if !gains => {
                self.may_extrapolate = false;
                self.integration = Integration::Plain;
                let most = TUNING.parts * self.per_row.unwrap_or(1);
                let wanted = self.count as f64 * self.parts_for(self.plain);
                self.count = wanted.ceil().clamp(1.0, most as f64) as usize;
            }
            Integration::Extrapolated { levels }
                if levels == TUNING.first_levels && error > TUNING.share && parts > TUNING.worth_fourth =>
            {
                self.integration = Integration::of_levels(TUNING.first_levels + 1);
            }
            _ => return false,
        }
        self.tried.clear();
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps between rows that the search ends with, for an error of c/count².
    fn found(per_row: usize, c: f64) -> usize {
        let mut search = StepSearch::new(&Schedule::fixed(1.0, 0.1 / per_row as f64, 0.1), false);
        while search.adjust(c / (search.count as f64).powi(2)) {}
        assert_eq!(search.schedule().steps_before(1), search.count);
        search.count
    }

    #[test]
    fn steps_are_divided_and_joined() {
        for per_row in [1, 10, 40] {
            let count = found(per_row, 100.0);
            let error = 100.0 / (count as f64).powi(2);
            assert!((0.5 * TUNING.aim..=TUNING.share).contains(&error), "{per_row}: {count}");
        }
        assert_eq!(found(10, 1e-9), 1);
        assert_eq!(found(1, 1e9), TUNING.parts);
    }

    /// Levels are chosen if they take fewer steps, and dropped if they gain nothing.
    #[test]
    fn levels_are_chosen_if_they_save_steps() {
        let search = |error: &dyn Fn(Integration, f64) -> f64| {
            let mut search = StepSearch::new(&Schedule::fixed(1.0, 0.01, 0.1), true);
            while search.adjust(error(search.integration, search.count as f64 / 10.0)) {}
            (search.integration, search.count)
        };
        // Each order gains a factor of 20.
        let smooth = |c: f64| {
            move |how: Integration, parts: f64| {
                let order = how.order() as i32;
                c * 0.05_f64.powi(order - 2) / parts.powi(order)
            }
        };
        let of_levels = Integration::of_levels;
        assert_eq!(search(&smooth(2.0)), (of_levels(1), 23), "a few more steps are cheaper");
        assert_eq!(search(&smooth(5.0)).0, of_levels(3));
        assert_eq!(search(&smooth(1e4)).0, of_levels(4));
        let kinked = |_: Integration, parts: f64| 5.0 / parts.powi(2);
        assert_eq!(search(&kinked), (of_levels(1), 36));
    }

    #[test]
    fn failed_run_is_retried_with_smaller_steps() {
        let mut search = StepSearch::new(&Schedule::fixed(1.0, 0.1, 0.1), false);
        let mut tried = 0;
        while search.adjust(f64::NAN) {
            tried += 1;
        }
        assert!(search.count == TUNING.parts && tried < 10);
    }
}
