//! Outputs over time at chosen samples.

use std::ops::Range;

/// File format of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFormat {
    /// An archive of NumPy's arrays.
    Npz,
    /// A table.
    Csv,
}

/// Properties of samples before they are simulated.
pub struct SampleTable<'t> {
    /// Number of samples.
    pub count: usize,
    /// Names and units of the uncertain parameters.
    pub parameters: Vec<(String, String)>,
    /// Parameters of some of the samples.
    pub points: &'t dyn Fn(Range<usize>) -> Vec<Vec<f64>>,
    /// Names and units of the outputs.
    pub outputs: Vec<(String, String)>,
    /// Times of the rows, s.
    pub times: Vec<f64>,
}
