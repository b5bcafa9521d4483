//! Answers of one call, as far as they have come.

use super::Answer;
use super::trouble::Trouble;

/// Answers of one call.
#[derive(Debug)]
pub(super) struct Answers {
    found: Vec<Option<Answer>>,
    open: usize,
}

impl Answers {
    /// Answers of `count` points, none of which is known yet.
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
