//! The steps that a tolerance of the bounds asks for.

use crate::simulate::Schedule;

/// Share of the tolerance that the steps may take; the surrogate has the rest.
const SHARE: f64 = 0.5;

/// The share that is aimed at, so that what is found is within that with some room.
const AIM: f64 = 0.4;

/// Steps are joined where they take less than this share.
const LITTLE: f64 = 0.1;

/// Most parts that a schedule's steps are divided into; beyond, it is left at what can be had.
const MOST_PARTS: usize = 32;

/// Schedules tried at most.
const MOST_TRIALS: usize = 10;

/// Divides or joins a schedule's steps until their error is within its share of the tolerance. The scheme is of second order,
/// so that the error goes as the step's square.
pub(super) struct StepSearch {
    base: Schedule,
    /// Steps between rows, where they are of equal length; then they can be joined too.
    per_row: Option<usize>,
    /// Steps for each of the base's; between rows where `per_row` is known.
    count: usize,
    /// Counts whose error is known.
    tried: Vec<(usize, f64)>,
}

impl StepSearch {
    /// Begins with the schedule as it is.
    pub fn new(base: &Schedule) -> Self {
        let per_row = base.steps_per_row();
        Self { base: base.clone(), per_row, count: per_row.unwrap_or(1), tried: Vec::new() }
    }

    /// The schedule to try.
    pub fn schedule(&self) -> Schedule {
        match self.per_row {
            Some(_) => self.base.with_steps_per_row(self.count),
            None => self.base.refined(self.count),
        }
    }

    /// Parts that each of the base's steps is divided into; 1 where steps of equal length are counted instead.
    pub fn parts(&self) -> usize {
        if self.per_row.is_some() { 1 } else { self.count }
    }

    /// Takes in the error of the schedule tried last, over the tolerance; whether another is to be tried.
    pub fn adjust(&mut self, error: f64) -> bool {
        self.tried.push((self.count, error));
        let most = MOST_PARTS * self.per_row.unwrap_or(1);
        let wanted = (self.count as f64 * (error / AIM).sqrt()).ceil().clamp(1.0, most as f64) as usize;
        let next = match error {
            error if error.is_nan() => (4 * self.count).min(most),
            error if error > SHARE => wanted.max(self.count + 1).min(most),
            // Once steps were too long, those that are not are taken.
            error if error < LITTLE && self.tried.iter().all(|&(_, error)| error <= SHARE) => wanted,
            _ => self.count,
        };
        let other = next != self.count && self.tried.len() < MOST_TRIALS;
        self.count = if other { next } else { self.count };
        other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps between rows that the search ends with, for an error of c/count².
    fn found(per_row: usize, c: f64) -> usize {
        let mut search = StepSearch::new(&Schedule::fixed(1.0, 0.1 / per_row as f64, 0.1));
        while search.adjust(c / (search.count as f64).powi(2)) {}
        assert_eq!(search.schedule().steps_before(1), search.count);
        search.count
    }

    #[test]
    fn steps_are_divided_and_joined() {
        for per_row in [1, 10, 40] {
            let count = found(per_row, 100.0);
            let error = 100.0 / (count as f64).powi(2);
            assert!((0.5 * AIM..=SHARE).contains(&error), "{per_row}: {count}");
        }
        assert_eq!(found(10, 1e-9), 1);
        assert_eq!(found(1, 1e9), MOST_PARTS);
    }

    #[test]
    fn what_fails_is_tried_with_smaller_steps() {
        let mut search = StepSearch::new(&Schedule::fixed(1.0, 0.1, 0.1));
        let mut tried = 0;
        while search.adjust(f64::NAN) {
            tried += 1;
        }
        assert!(search.count == MOST_PARTS && tried < 10);
    }
}
