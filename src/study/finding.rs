//! What is found of an output in a row: its range, the range's error, and who has which part in it.

use super::apportion::{Apportion, Parts};
use super::compose::{Halved, Known, Row, Seeker};
use super::probe::Table;
use crate::numerics::Range;

/// What is found of one output in one row.
#[derive(Clone, Debug)]
pub(super) struct Finding {
    pub range: Range,
    /// Of the surrogate, and of the time steps.
    pub error: f64,
    pub step_error: f64,
    /// Where they are asked for.
    pub parts: Option<Parts>,
}

/// How findings are made.
pub(super) struct Finder<'a> {
    pub seeker: &'a Seeker,
    /// ξ of samples that the surrogate is held against, and their motions.
    pub held_out: (&'a [Vec<f64>], &'a Table),
    /// Samples of the whole box that tell the time steps' errors, where those are asked for.
    pub halved: Option<Halved<'a>>,
    pub apportion: Option<Apportion>,
}

impl Finder<'_> {
    /// Of every output in a row, whose number among all is `place`.
    pub fn find(&self, row: &Row, place: usize, known: &mut Known) -> Vec<Finding> {
        let found = row.seek(self.seeker, known);
        let errors = row.errors(self.seeker, self.held_out, place, &found);
        let step_errors = match self.halved {
            Some(halved) => row.step_errors(self.seeker, halved, place, &found),
            None => vec![f64::NAN; found.len()],
        };
        let parts: Vec<Option<Parts>> = match &self.apportion {
            Some(apportion) => apportion.parts(row, &found).into_iter().map(Some).collect(),
            None => vec![None; found.len()],
        };
        let finding = |(((found, error), step_error), parts)| Finding { range: found, error, step_error, parts };
        found.iter().map(|found| found.range).zip(errors).zip(step_errors).zip(parts).map(finding).collect()
    }
}
