//! Attained ends: the samples at which outputs are least and largest.

use crate::numerics::{Range, Sample};

/// The samples at which each output is least and largest in each row, of those that were searched for them.
pub struct Attained {
    outputs: usize,
    samples: Vec<Sample>,
    /// By row and output, of both ends: the value and the number of its sample, once there is one.
    ends: Vec<[Option<(f64, usize)>; 2]>,
}

impl Attained {
    /// Ends of `rows` rows and `outputs` outputs, all unknown.
    pub fn new(rows: usize, outputs: usize) -> Self {
        Self { outputs, samples: Vec::new(), ends: vec![[None; 2]; rows * outputs] }
    }

    /// Takes in consecutive rows' values (row, output, sample) of samples.
    pub fn note(&mut self, first: usize, samples: &[Sample], values: &[f64]) {
        let mut numbers: Vec<Option<usize>> = vec![None; samples.len()];
        let Self { outputs, samples: kept, ends } = self;
        let known = ends.iter_mut().skip(first * *outputs);
        for (ends, values) in known.zip(values.chunks_exact(samples.len())) {
            for (number, &value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
                    if end.is_none_or(|(best, _)| sign * value > sign * best) {
                        let own = *numbers[number].get_or_insert_with(|| number_of(kept, &samples[number]));
                        *end = Some((value, own));
                    }
                }
            }
        }
    }

    /// Range of an output in a row.
    pub fn range(&self, row: usize, output: usize) -> Option<Range> {
        let [Some((lower, _)), Some((upper, _))] = self.ends[row * self.outputs + output] else { return None };
        Some(Range { lower, upper })
    }

    /// The value and the sample of an output's ends in a row, the least first.
    pub fn ends(&self, row: usize, output: usize) -> [Option<(f64, &Sample)>; 2] {
        self.ends[row * self.outputs + output].map(|end| end.map(|(value, number)| (value, &self.samples[number])))
    }
}

/// The number of a sample among those that are stored, to which it is added if it is new.
fn number_of(kept: &mut Vec<Sample>, sample: &Sample) -> usize {
    kept.iter().position(|known| known == sample).unwrap_or_else(|| {
        kept.push(sample.clone());
        kept.len() - 1
    })
}
