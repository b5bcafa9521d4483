//! A model's results for values of one or two parameters.

use std::path::{Path, PathBuf};

use super::{Error, Model, Study};
use crate::export::{self, SweepAxis, write_sweep};
use crate::results::Summary;

/// Values of a parameter, in its unit, and the tolerance that each has.
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

    /// What stands behind each value: a unit, a tolerance, or both, as `"mm ± 1%"`.
    #[must_use]
    pub fn with(mut self, behind: &str) -> Self {
        behind.clone_into(&mut self.behind);
        self
    }
}

impl Sweep {
    /// Runs the study that `ask` makes, for each combination of values.
    pub(super) fn of(
        model: &Model,
        axes: &[Axis],
        ask: impl Fn(Study<'static>) -> Study<'static>,
    ) -> Result<Self, Error> {
        let headings = axes.iter().map(|axis| {
            let unit = axis.behind.split('±').next().unwrap_or_default().trim().to_owned();
            SweepAxis { name: axis.name.clone(), unit, values: axis.values.clone() }
        });
        let mut sweep = export::Sweep { model: model.name().to_owned(), axes: headings.collect(), points: Vec::new() };
        let runs: usize = axes.iter().map(|axis| axis.values.len()).product();
        for run in 0..runs {
            let mut rest = run;
            let mut values = vec![0.0; axes.len()];
            for (value, axis) in values.iter_mut().zip(axes).rev() {
                *value = axis.values[rest % axis.values.len()];
                rest /= axis.values.len();
            }
            let mut own = model.clone();
            for (axis, value) in axes.iter().zip(&values) {
                own = own.with(&axis.name, format!("{value:?} {}", axis.behind).trim_end())?;
            }
            // A position of the axes without a motion leaves the others.
            let summary = match ask(own.study()).run() {
                Ok(result) => Some(result.summary().clone()),
                Err(Error::Run(_)) => None,
                Err(error) => return Err(error),
            };
            sweep.points.push(export::SweepPoint { values, summary });
        }
        Ok(Self(sweep))
    }

    /// Values of the parameters, one for each, and the run's record there; `None` where it failed.
    pub fn points(&self) -> impl Iterator<Item = (&[f64], Option<&Summary>)> {
        self.0.points.iter().map(|point| (point.values.as_slice(), point.summary.as_ref()))
    }

    /// Writes `sweep.csv` and a plot of each reduced output into a folder, and gives their paths.
    ///
    /// # Errors
    /// [`Error::Write`]: the folder or a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        Ok(write_sweep(folder.as_ref(), &self.0)?)
    }
}
