//! The least and the largest value of every output in every row, over all samples that a run has simulated under one
//! schedule.

use std::sync::{Mutex, PoisonError};

use super::range::{EMPTY, Range, limits};

/// Ends of all simulated values. Whoever simulates notes them; the order does not matter.
#[derive(Debug, Default)]
pub struct Ledger {
    outputs: usize,
    /// By row and output.
    ends: Mutex<Vec<Range>>,
}

impl Ledger {
    /// Ledger of `rows` rows and `outputs` outputs, without any value yet.
    pub fn new(rows: usize, outputs: usize) -> Self {
        Self { outputs, ends: Mutex::new(vec![EMPTY; rows * outputs]) }
    }

    /// Takes in consecutive rows' values, line by line, sample by sample; the outputs are the last of `lines` lines.
    /// NaN, of samples that stopped, does not count, nor do infinite values.
    pub fn note(&self, first: usize, lines: usize, samples: usize, values: &[f64]) {
        let mut ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
        let known = ends.chunks_exact_mut(self.outputs.max(1)).skip(first);
        for (row, ends) in values.chunks_exact((lines * samples).max(1)).zip(known) {
            let outputs = row[(lines - self.outputs) * samples..].chunks_exact(samples);
            ends.iter_mut().zip(outputs).for_each(|(end, values)| widen(end, limits(values)));
        }
    }

    /// Takes in the range of an output's values in a row.
    pub fn note_range(&self, row: usize, output: usize, range: Range) {
        let mut ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
        ends.get_mut(row * self.outputs + output).into_iter().for_each(|end| widen(end, (range.lower, range.upper)));
    }

    /// Range of an output's values in a row; empty if it has no value.
    pub fn range(&self, row: usize, output: usize) -> Range {
        let ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
        ends.get(row * self.outputs + output).copied().unwrap_or(EMPTY)
    }
}

fn widen(end: &mut Range, (lower, upper): (f64, f64)) {
    if lower.is_finite() && upper.is_finite() {
        *end = Range { lower: end.lower.min(lower), upper: end.upper.max(upper) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_contain_all_values_and_ignore_nan() {
        let ledger = Ledger::new(3, 2);
        // A line of the motion, then two outputs, of two samples in two rows.
        let rows = [9.0, 9.0, 1.0, 2.0, -1.0, f64::NAN, 9.0, 9.0, f64::NAN, f64::NAN, 5.0, 4.0];
        ledger.note(1, 3, 2, &rows);
        ledger.note_range(1, 0, Range { lower: 1.5, upper: 3.0 });
        ledger.note_range(1, 1, Range::UNKNOWN);
        let range = |lower, upper| Range { lower, upper };
        assert_eq!([ledger.range(0, 0), ledger.range(2, 0), ledger.range(7, 1)], [EMPTY; 3]);
        assert_eq!(ledger.range(1, 0), range(1.0, 3.0));
        assert_eq!([ledger.range(1, 1), ledger.range(2, 1)], [range(-1.0, -1.0), range(4.0, 5.0)]);
        assert_eq!(Ledger::default().range(0, 0), EMPTY);
    }
}
