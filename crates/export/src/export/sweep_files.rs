//! A sweep's files: `sweep.csv`, and a plot of each reduced output's bounds over the swept parameter.

use std::path::{Path, PathBuf};

use super::csv::number;
use super::error::ExportError;
use super::figure::Caption;
use super::folder::AtomicFiles;
use super::rounded::rounded;
use super::stems::unique_stems;
use super::sweep::{Swept, SweptBounds, sweep_svg};
use crate::grammar::unit::Unit;
use crate::numerics::BandError;
use crate::results::{Band, Method, OutputBounds, ReducedBand, ReducedSummary, RequirementSummary, Summary, foremost};

/// A parameter that is swept.
pub struct SweepAxis {
    /// Name of the parameter.
    pub name: String,
    /// Unit on the command line; empty for the model's own.
    pub unit: String,
    /// Its values, in the unit.
    pub values: Vec<f64>,
}

/// Results for one value of each axis.
pub struct SweepPoint {
    /// One value per axis, in the unit of the axis.
    pub values: Vec<f64>,
    /// Absent if the run failed.
    pub summary: Option<Summary>,
}

/// A sweep; the last axis runs fastest.
pub struct Sweep {
    /// Name of the model.
    pub model: String,
    /// Parameters that are swept.
    pub axes: Vec<SweepAxis>,
    /// One point per combination of values.
    pub points: Vec<SweepPoint>,
}

impl Sweep {
    /// Simulations of all runs.
    pub fn simulations(&self) -> usize {
        let all = self.points.iter().filter_map(|point| point.summary.as_ref());
        all.flat_map(|summary| &summary.methods).map(|method| method.simulations).sum()
    }

    /// The first run that did not fail.
    fn first(&self) -> Option<&Summary> {
        self.points.iter().find_map(|point| point.summary.as_ref())
    }
}

/// Writes `sweep.csv` and `sweep.NAME.svg` of each reduced output.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_sweep(dir: &Path, sweep: &Sweep) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("sweep.csv", &table(sweep)?)?;
    let reduced = sweep.first().map_or(&[][..], |summary| &summary.reduced);
    let stems = unique_stems(reduced.iter().map(|own| own.name.as_str()));
    for (index, stem) in stems.iter().enumerate() {
        files.add(&format!("sweep.{stem}.svg"), plot(sweep, index)?.as_bytes())?;
    }
    files.put_in_place()
}

/// Columns: the parameters; for each reduced output nominal, lower, upper, error and method; for each requirement
/// margin, error and verdict.
fn table(sweep: &Sweep) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let mut headings: Vec<String> = sweep.axes.iter().map(|axis| axis.name.clone()).collect();
    let (reduced, requirements) =
        sweep.first().map_or((&[][..], &[][..]), |first| (&first.reduced[..], &first.requirements[..]));
    for own in reduced {
        headings
            .extend(["nominal", "lower", "upper", "error", "method"].map(|column| format!("{}.{column}", own.name)));
    }
    for own in requirements {
        headings.extend(["margin", "error", "verdict"].map(|column| format!("{}.{column}", own.name)));
    }
    writer.write_record(&headings)?;
    for point in &sweep.points {
        let mut row: Vec<String> = point.values.iter().map(|&value| number(value)).collect();
        match &point.summary {
            Some(summary) => {
                summary.reduced.iter().for_each(|own| row.extend(of_reduced(own)));
                summary.requirements.iter().for_each(|own| row.extend(of_requirement(own)));
            }
            None => row.resize(headings.len(), "NaN".to_owned()),
        }
        writer.write_record(&row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

fn foremost_of(own: &ReducedSummary) -> Option<&ReducedBand> {
    foremost(&own.bands, |band: &ReducedBand| !band.unresolved)
}

fn of_reduced(own: &ReducedSummary) -> [String; 5] {
    let band = foremost_of(own);
    let [lower, upper, error] = band.map_or([f64::NAN; 3], |band| [band.lower, band.upper, band.error]).map(number);
    [number(own.nominal), lower, upper, error, band.map_or_else(String::new, |band| band.method.clone())]
}

fn of_requirement(own: &RequirementSummary) -> [String; 3] {
    [number(own.margin), number(own.error), own.verdict.name().to_owned()]
}

/// Bounds of one reduced output over the first parameter, for each value of the second one.
fn plot(sweep: &Sweep, reduced: usize) -> Result<String, serde_json::Error> {
    let inner = sweep.axes.get(1).map_or(1, |axis| axis.values.len());
    let axis = &sweep.axes[0];
    let si = Unit::parse(&axis.unit).map_or(1.0, |unit| unit.to_si(1.0));
    let mut rows: Vec<(String, Vec<f64>, OutputBounds)> = Vec::new();
    for row in 0..inner {
        let of_point = |point: &SweepPoint| {
            let own = point.summary.as_ref().and_then(|summary| summary.reduced.get(reduced)).cloned();
            own.map(|own| (si * point.values[0], own))
        };
        let mut points: Vec<(f64, ReducedSummary)> =
            sweep.points.iter().skip(row).step_by(inner).filter_map(of_point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, first)) = points.first() else { continue };
        let label = sweep.axes.get(1).map_or_else(String::new, |second| {
            format!("{} = {} {}", second.name, rounded(second.values[row]), second.unit).trim_end().to_owned()
        });
        let band = |index: usize| {
            let column = |of: fn(&ReducedBand) -> f64| {
                points.iter().map(|(_, own)| own.bands.get(index).map_or(f64::NAN, of)).collect()
            };
            let unresolved = points.iter().map(|(_, own)| own.bands.get(index).is_none_or(|band| band.unresolved));
            let error = BandError {
                total: column(|band| band.error),
                unresolved: unresolved.collect(),
                ..BandError::default()
            };
            let method = Method::ALL.into_iter().find(|method| method.name() == first.bands[index].method)?;
            Some(Band { method, lower: column(|band| band.lower), upper: column(|band| band.upper), error })
        };
        let output = OutputBounds {
            name: first.name.clone(),
            unit: first.unit.clone(),
            display: first.display.clone(),
            nominal: points.iter().map(|(_, own)| own.nominal).collect(),
            bands: (0..first.bands.len()).filter_map(band).collect(),
        };
        rows.push((label, points.iter().map(|point| point.0).collect(), output));
    }
    let swept = Swept { name: &axis.name, unit: &axis.unit, si };
    let rows: Vec<SweptBounds> =
        rows.iter().map(|(label, values, output)| SweptBounds { label, values, output }).collect();
    let requirements = sweep.first().map_or(&[][..], |first| &first.requirements);
    sweep_svg(Caption { model: &sweep.model, prefix: "sweep" }, swept, &rows, requirements)
}
