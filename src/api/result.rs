//! Results of a study: named outputs with their bands, errors and flags.

use std::path::{Path, PathBuf};

use super::Error;
use crate::export;
use crate::methods::Method;
use crate::results::{
    self, Bounds, CostStudy, OutputBounds, Provenance, ReducedSummary, RequirementSummary, StatisticsResult, Summary,
    foremost,
};

/// Bounds of every output over time, with their errors.
#[derive(Clone, Debug)]
pub struct StudyResult {
    bounds: Bounds,
    summary: Summary,
}

/// One output: its nominal course and a band for each method. All slices run over [`StudyResult::times`].
#[derive(Clone, Copy, Debug)]
pub struct Output<'r>(&'r OutputBounds);

/// A method's bounds of an output, in the output's unit.
#[derive(Clone, Copy, Debug)]
pub struct Band<'r>(&'r results::Band);

impl StudyResult {
    pub(super) fn new(bounds: Bounds, summary: Summary) -> Self {
        Self { bounds, summary }
    }

    /// Output times, s, ascending.
    pub fn times(&self) -> &[f64] {
        &self.bounds.times
    }

    /// All outputs, in the model's order.
    pub fn outputs(&self) -> impl Iterator<Item = Output<'_>> {
        self.bounds.outputs.iter().map(Output)
    }

    /// The output with this name, if there is one.
    pub fn output(&self, name: &str) -> Option<Output<'_>> {
        self.outputs().find(|output| output.name() == name)
    }

    /// Whether every output has a reliable band at every time.
    pub fn is_reliable(&self) -> bool {
        let rows = 0..self.bounds.times.len();
        let reliable =
            |output: Output, row| output.bands().next().is_none() || output.bands().any(|band| band.is_reliable(row));
        self.failure().is_none() && rows.into_iter().all(|row| self.outputs().all(|output| reliable(output, row)))
    }

    /// Reason why the run stopped early, if it did, and the time up to which there are results.
    pub fn failure(&self) -> Option<&str> {
        self.summary.failure.as_deref()
    }

    /// Record of the run and its cost, as in `summary.json`.
    pub fn summary(&self) -> &Summary {
        &self.summary
    }

    /// Reduced outputs (maxima, ranges, times …) with their bounds.
    pub fn reduced(&self) -> &[ReducedSummary] {
        &self.summary.reduced
    }

    /// Requirements with their verdicts, margins and errors.
    pub fn verdicts(&self) -> &[RequirementSummary] {
        &self.summary.requirements
    }

    /// Quantiles, yields and contributions, if the model asks for `statistics:`.
    pub fn statistics(&self) -> Option<&StatisticsResult> {
        self.summary.statistics.as_deref()
    }

    /// Bounds in ten rows to five digits, the text that `mbint snapshot` stores and compares.
    pub fn snapshot(&self) -> String {
        export::snapshot_table(&self.bounds)
    }

    /// Writes `bounds.csv`, `summary.json` and plots into a folder, and returns their paths.
    ///
    /// # Errors
    /// [`Error::Write`]: the folder or a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        Ok(export::write_results(folder.as_ref(), &self.bounds, &self.summary, &Provenance::default(), false, None)?)
    }

    /// The data behind the outputs: those of `bounds.csv`, with all parts of the errors, in SI units.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }
}

/// Writes the settings of a study of costs, their curves and their plots into a folder, and returns their paths.
///
/// # Errors
/// [`Error::Write`]: the folder or a file cannot be written.
pub fn write_cost(study: &CostStudy, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
    Ok(export::write_cost(folder.as_ref(), study)?)
}

impl<'r> Output<'r> {
    /// Its name in the model.
    pub fn name(self) -> &'r str {
        &self.0.name
    }

    /// SI unit; empty if dimensionless or unknown.
    pub fn unit(self) -> &'r str {
        &self.0.unit
    }

    /// Values with every parameter at its nominal value.
    pub fn nominal(self) -> &'r [f64] {
        &self.0.nominal
    }

    /// The methods' bands, in the order of [`Method::ALL`].
    pub fn bands(self) -> impl Iterator<Item = Band<'r>> {
        self.0.bands.iter().map(Band)
    }

    /// A method's band, if the method ran.
    pub fn band(self, method: Method) -> Option<Band<'r>> {
        self.bands().find(|band| band.method() == method)
    }

    /// The first band that is reliable to the end, otherwise the first.
    pub fn best(self) -> Option<Band<'r>> {
        foremost(&self.0.bands, |band| !band.error.unresolved.contains(&true)).map(Band)
    }
}

impl<'r> Band<'r> {
    /// The method of the band.
    pub fn method(self) -> Method {
        self.0.method
    }

    /// Smallest values; NaN after the end of a run that failed.
    pub fn lower(self) -> &'r [f64] {
        &self.0.lower
    }

    /// Largest values.
    pub fn upper(self) -> &'r [f64] {
        &self.0.upper
    }

    /// Estimated errors of both, of the method and of the time steps together; NaN if unknown.
    pub fn errors(self) -> &'r [f64] {
        &self.0.error.total
    }

    /// Whether the bounds of a row are reliable.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn is_reliable(self, row: usize) -> bool {
        !self.0.error.unresolved[row]
    }

    /// The rows with unreliable bounds.
    pub fn unreliable(self) -> impl Iterator<Item = usize> {
        self.0.error.unresolved.iter().enumerate().filter_map(|(row, unresolved)| unresolved.then_some(row))
    }
}
