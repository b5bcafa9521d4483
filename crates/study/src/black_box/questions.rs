//! Questions that every point has in common, and whether answers are to them.

use super::trouble::Trouble;
use super::tuning::TUNING;

/// Questions that every point has in common.
#[derive(Clone, Debug)]
pub struct Questions {
    /// Names of the numbers that the program is given.
    pub parameters: Vec<String>,
    /// Names of its outputs, each with the size of its unit in SI.
    pub outputs: Vec<(String, f64)>,
    /// Times of the rows, s.
    pub times: Vec<f64>,
}

impl Questions {
    /// Whether the row of an answer is of the time that was asked for.
    ///
    /// # Errors
    /// If it is of another.
    pub(super) fn check_time(&self, row: usize, found: f64) -> Result<(), Trouble> {
        let wanted = self.times.get(row).copied().unwrap_or(f64::NAN);
        let spacing =
            if row > 0 { wanted - self.times[row - 1] } else { self.times.get(1).map_or(1.0, |t| t - wanted) };
        let is_same = (found - wanted).abs() <= TUNING.same_time * spacing.abs();
        if is_same || self.times.len() == 1 { Ok(()) } else { Err(Trouble::Time { row, found, wanted }) }
    }

    /// A value of an output in a row, in SI.
    ///
    /// # Errors
    /// If it is no number.
    pub(super) fn value(&self, row: usize, output: usize, value: Option<f64>) -> Result<f64, Trouble> {
        let (name, si) = &self.outputs[output];
        let number = value.map(|value| if *si == 1.0 { value } else { value * si }).filter(|value| value.is_finite());
        number.ok_or_else(|| Trouble::NotFinite { name: name.clone(), time: self.times[row] })
    }
}
