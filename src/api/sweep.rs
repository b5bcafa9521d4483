//! A model's results for values of one or two parameters.

use std::path::{Path, PathBuf};

use super::Error;
use crate::export::{self, SweepAxis, write_sweep};
use crate::results::Summary;

/// Values of a parameter, in its unit, and the tolerance of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    name: String,
    values: Vec<f64>,
    behind: String,
}

/// Results for each combination of values; those of the last parameter change fastest.
pub struct Sweep(export::Sweep);

impl Axis {
    /// Values of a parameter, in the model's unit, without a tolerance.
    pub fn new(name: &str, values: &[f64]) -> Self {
        Self { name: name.to_owned(), values: values.to_vec(), behind: String::new() }
    }

    /// Sets the text after each value: a unit, a tolerance, or both, such as `"mm ± 1%"`.
    #[must_use]
    pub fn with(mut self, behind: &str) -> Self {
        behind.clone_into(&mut self.behind);
        self
    }

    /// Name of the parameter.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Number of values.
    pub(crate) fn count(&self) -> usize {
        self.values.len()
    }

    /// Its heading in files and plots.
    pub(crate) fn heading(&self) -> SweepAxis {
        let unit = self.behind.split('±').next().unwrap_or_default().trim().to_owned();
        SweepAxis { name: self.name.clone(), unit, values: self.values.clone() }
    }

    /// Settings of a combination of values: each parameter with its value.
    pub(crate) fn settings(axes: &[Self], values: &[f64]) -> Vec<(String, String)> {
        let of = |(axis, value): (&Self, &f64)| {
            (axis.name.clone(), format!("{value:?} {}", axis.behind).trim_end().to_owned())
        };
        axes.iter().zip(values).map(of).collect()
    }

    /// All combinations of values; those of the last parameter change fastest.
    pub(crate) fn combinations(axes: &[Self]) -> Vec<Vec<f64>> {
        let longer = |all: Vec<Vec<f64>>, axis: &Self| {
            let with = |values: &Vec<f64>| {
                let begun = values.clone();
                axis.values.iter().map(move |value| [&begun[..], &[*value]].concat()).collect::<Vec<_>>()
            };
            all.iter().flat_map(with).collect()
        };
        axes.iter().fold(vec![Vec::new()], longer)
    }
}

impl Sweep {
    /// A sweep without points.
    pub(super) fn new(model: &str, axes: &[Axis]) -> Self {
        let axes = axes.iter().map(Axis::heading).collect();
        Self(export::Sweep { model: model.to_owned(), axes, points: Vec::new() })
    }

    /// Adds results; `None` for a run that failed.
    pub(super) fn add(&mut self, values: Vec<f64>, summary: Option<Summary>) {
        self.0.points.push(export::SweepPoint { values, summary });
    }

    /// Values of the parameters, one for each, with the run's record; `None` if it failed.
    pub fn points(&self) -> impl Iterator<Item = (&[f64], Option<&Summary>)> {
        self.0.points.iter().map(|point| (point.values.as_slice(), point.summary.as_ref()))
    }

    /// Writes `sweep.csv` and a plot of each reduced output into a folder, and returns their paths.
    ///
    /// # Errors
    /// [`Error::Write`]: the folder or a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        Ok(write_sweep(folder.as_ref(), &self.0)?)
    }
}
