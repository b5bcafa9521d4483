//! Ends of outputs over functions of the time: results of a search over excitations of which only limits are known.

use std::sync::Arc;

use crate::numerics::{Cell, Range, Sample, largest};

/// An end that a function attains.
#[derive(Clone, Copy, Debug)]
pub struct FunctionEnd {
    /// The output under the worst function found; NaN if none could be simulated.
    pub value: f64,
    /// Possible distance from here to the true end: the gain that the gradient at that function still promises, and the
    /// error of the cells.
    pub open: f64,
}

/// The function under which an output goes furthest.
#[derive(Clone, Debug)]
pub struct WorstFunction {
    /// Row of output.
    pub row: usize,
    /// The output there.
    pub value: f64,
    /// The parameters.
    pub sample: Sample,
    /// Cells of each input of the equations.
    pub cells: Vec<Vec<Cell>>,
    /// Times at which cells end, s.
    pub ends: Arc<[f64]>,
}

/// Result of a search over functions.
#[derive(Clone, Debug)]
pub struct FunctionEnds {
    outputs: usize,
    /// By row and output, the lower end first.
    ends: Vec<[FunctionEnd; 2]>,
    /// Error of the steps, by row and output, if it was measured.
    steps: Vec<Option<f64>>,
    /// By output, the furthest function with its distance from the middle of all limits.
    pub worst: Vec<Option<(f64, WorstFunction)>>,
    /// By output, the functions under which it is least and greatest in some row.
    pub extremes: Vec<[Option<WorstFunction>; 2]>,
    /// By row and output: displacement of the output by each parameter, then each input, to first order from the middle
    /// of all limits.
    parts: Vec<Vec<f64>>,
    /// The excitation that each input is, by index of its trajectory.
    pub inputs: Vec<usize>,
    /// Ends of reduced outputs and margins, as outputs of one row, if there are any.
    pub of_values: Option<Box<Self>>,
}

impl FunctionEnds {
    /// Ends of `rows` rows and `outputs` outputs, all unknown.
    pub fn new(rows: usize, outputs: usize, inputs: Vec<usize>) -> Self {
        let unknown = FunctionEnd { value: f64::NAN, open: f64::NAN };
        let (ends, steps) = (vec![[unknown; 2]; rows * outputs], vec![None; rows * outputs]);
        Self {
            outputs,
            ends,
            steps,
            worst: vec![None; outputs],
            extremes: vec![[None, None]; outputs],
            parts: vec![Vec::new(); rows * outputs],
            inputs,
            of_values: None,
        }
    }

    /// Notes an end.
    pub fn note(&mut self, row: usize, output: usize, is_upper: bool, end: FunctionEnd) {
        self.ends[row * self.outputs + output][usize::from(is_upper)] = end;
    }

    /// Adds how far parameters and inputs move an output one way.
    pub fn note_parts(&mut self, row: usize, output: usize, parts: &[f64]) {
        let known = &mut self.parts[row * self.outputs + output];
        known.resize(parts.len(), 0.0);
        known.iter_mut().zip(parts).for_each(|(known, own)| *known += own);
    }

    /// Displacements of an output by parameters and inputs.
    pub fn parts(&self, row: usize, output: usize) -> &[f64] {
        &self.parts[row * self.outputs + output]
    }

    /// Notes the error of the steps of an output in a row; the largest counts.
    pub fn note_steps(&mut self, row: usize, output: usize, error: f64) {
        let known = &mut self.steps[row * self.outputs + output];
        *known = Some(largest(known.iter().copied().chain([error])));
    }

    /// Notes a function that moves an output this far from the middle of all limits, if none moves it further.
    pub fn note_worst(&mut self, output: usize, gain: f64, function: impl FnOnce() -> WorstFunction) {
        let worst = &mut self.worst[output];
        if worst.as_ref().is_none_or(|(known, _)| gain > *known) {
            *worst = Some((gain, function()));
        }
    }

    /// Notes a function under which an output has a value, if it has no value further that way under another.
    pub fn note_extreme(
        &mut self,
        output: usize,
        is_upper: bool,
        function: impl FnOnce() -> WorstFunction,
        value: f64,
    ) {
        let known = &mut self.extremes[output][usize::from(is_upper)];
        let further = |known: &WorstFunction| if is_upper { value > known.value } else { value < known.value };
        if known.as_ref().is_none_or(further) {
            *known = Some(function());
        }
    }

    /// An end of an output in a row, and the distance that it may still be off.
    pub fn end(&self, row: usize, output: usize, is_upper: bool) -> FunctionEnd {
        self.ends[row * self.outputs + output][usize::from(is_upper)]
    }

    /// Gives each row the largest of the steps' errors that are measured in it and in the rows next to it on both
    /// sides: a difference that changes its sign gives no information where it is small.
    pub fn spread_steps(&mut self) {
        let rows = self.ends.len() / self.outputs.max(1);
        for output in 0..self.outputs {
            let at = |row: usize| row * self.outputs + output;
            let measured: Vec<(usize, f64)> =
                (0..rows).filter_map(|row| self.steps[at(row)].map(|error| (row, error))).collect();
            for row in 0..rows {
                let after = measured.partition_point(|(own, _)| *own <= row);
                let before = measured.partition_point(|(own, _)| *own < row);
                let around = &measured[before.saturating_sub(1)..(after + 1).min(measured.len())];
                let worst = (!around.is_empty()).then(|| largest(around.iter().map(|(_, error)| *error)));
                self.steps[at(row)] = Some(worst.unwrap_or(f64::NAN));
            }
        }
    }

    /// Range of an output in a row.
    pub fn range(&self, row: usize, output: usize) -> Range {
        let [lower, upper] = self.ends[row * self.outputs + output];
        Range { lower: lower.value, upper: upper.value }
    }

    /// Largest distance that one of them may still be off; NaN if it is unknown for either.
    pub fn open(&self, row: usize, output: usize) -> f64 {
        largest(self.ends[row * self.outputs + output].map(|end| end.open))
    }

    /// Error of the steps under such functions.
    pub fn steps(&self, row: usize, output: usize) -> f64 {
        self.steps[row * self.outputs + output].unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_end_is_not_covered_by_the_other_end() {
        for known in [false, true] {
            let mut ends = FunctionEnds::new(1, 1, Vec::new());
            ends.note(0, 0, known, FunctionEnd { value: 1.0, open: 0.5 });
            assert!(ends.open(0, 0).is_nan(), "{known}");
            ends.note(0, 0, !known, FunctionEnd { value: -1.0, open: 0.25 });
            assert_eq!(ends.open(0, 0), 0.5);
        }
    }
}
