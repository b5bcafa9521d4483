//! Answers of one call, as far as they have come.

use super::trouble::Trouble;
use super::{Answer, Questions};

/// Times that differ by less than this share of the time between rows are the same.
const SAME_TIME: f64 = 1e-6;

/// Answers of one call.
#[derive(Debug)]
pub(super) struct Answers {
    found: Vec<Option<Answer>>,
    open: usize,
}

impl Answers {
    /// Of so many points, none of which has one.
    pub fn of(count: usize) -> Self {
        Self { found: (0..count).map(|_| None).collect(), open: count }
    }

    /// Whether every point has one.
    pub fn is_complete(&self) -> bool {
        self.open == 0
    }

    /// Whether a point waits for its answer: it was asked, and has none.
    pub fn waits(&self, point: usize) -> bool {
        self.found.get(point).is_some_and(Option::is_none)
    }

    /// A point's answer; points that do not wait keep theirs.
    pub fn set(&mut self, point: usize, answer: Answer) {
        if self.waits(point) {
            self.found[point] = Some(answer);
            self.open -= 1;
        }
    }

    /// Answers; the points without one have none for this reason, which is theirs together.
    pub fn finish(self, why: Option<Trouble>) -> Vec<Result<Answer, Trouble>> {
        let missing = why.unwrap_or_else(|| Trouble::Said { text: "nothing about this point".to_owned() });
        self.found.into_iter().map(|found| found.ok_or_else(|| missing.clone())).collect()
    }
}

impl Questions {
    /// Whether the row of an answer is of the time that was asked for.
    ///
    /// # Errors
    /// Where it is of another.
    pub(super) fn check_time(&self, row: usize, found: f64) -> Result<(), Trouble> {
        let wanted = self.times.get(row).copied().unwrap_or(f64::NAN);
        let spacing =
            if row > 0 { wanted - self.times[row - 1] } else { self.times.get(1).map_or(1.0, |t| t - wanted) };
        let is_same = (found - wanted).abs() <= SAME_TIME * spacing.abs();
        if is_same || self.times.len() == 1 { Ok(()) } else { Err(Trouble::Time { row, found, wanted }) }
    }

    /// A value of an output in a row, in SI.
    ///
    /// # Errors
    /// Where it is no number.
    pub(super) fn value(&self, row: usize, output: usize, value: Option<f64>) -> Result<f64, Trouble> {
        let (name, si) = &self.outputs[output];
        let number = value.map(|value| if *si == 1.0 { value } else { value * si }).filter(|value| value.is_finite());
        number.ok_or_else(|| Trouble::NotFinite { name: name.clone(), time: self.times[row] })
    }
}
