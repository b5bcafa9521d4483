//! Sums of outputs that are differentiated.

/// A gradient that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Number of the sample.
    pub sample: usize,
    /// Row of output.
    pub row: usize,
    /// Number of the output.
    pub output: usize,
}

/// A weighted sum of outputs in rows of a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Functional {
    /// Number of the sample.
    pub sample: usize,
    /// Its terms, one at least.
    pub terms: Vec<Term>,
}

/// An output in a row, with its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Row of output.
    pub row: usize,
    /// Number of the output.
    pub output: usize,
    /// Its factor in the sum.
    pub weight: f64,
}

impl From<Wanted> for Functional {
    fn from(Wanted { sample, row, output }: Wanted) -> Self {
        Self { sample, terms: vec![Term { row, output, weight: 1.0 }] }
    }
}

impl Functional {
    /// The last row that it needs.
    pub(super) fn last_row(&self) -> usize {
        self.terms.iter().map(|term| term.row).max().unwrap_or(0)
    }
}
