//! `cost.csv`: one row for each setting.

use std::path::{Path, PathBuf};

use csv::WriterBuilder;

use super::plot::cost_svg;
use crate::export::csv::number;
use crate::export::error::ExportError;
use crate::export::folder::AtomicFiles;
use crate::model::Stepping;
use crate::results::{CostPoint, CostStudy, Deviation};

/// Headings of the table.
const COLUMNS: [&str; 15] = [
    "of",
    "method",
    "order",
    "points",
    "step",
    "tolerance",
    "simulations",
    "steps",
    "seconds",
    "over_width",
    "under_coverage",
    "error",
    "below_reference",
    "front",
    "failure",
];

/// The table of all settings as CSV: those that bound, then those that simulate the nominal sample. Fields that do not
/// apply are empty; a setting without a result has the error `inf`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn cost_csv(study: &CostStudy) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for (of, points) in [("bounds", &study.bounds), ("trajectory", &study.trajectories)] {
        for point in points {
            writer.write_record(record(of, point))?;
        }
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

fn record(of: &str, point: &CostPoint) -> [String; COLUMNS.len()] {
    let whole = |count: Option<usize>| count.map_or_else(String::new, |count| count.to_string());
    let (step, tolerance) = match point.step {
        Stepping::Fixed(step) => (number(step), String::new()),
        Stepping::Tolerance(tolerance) => (String::new(), number(tolerance)),
    };
    let (over_width, under_coverage) = match point.deviation {
        Deviation::Bounds { over_width, under_coverage } => (number(over_width), number(under_coverage)),
        Deviation::Trajectory(_) => (String::new(), String::new()),
    };
    [
        of.to_owned(),
        point.method.name(),
        whole(point.order),
        whole(point.points),
        step,
        tolerance,
        point.simulations.to_string(),
        point.steps.to_string(),
        number(point.seconds),
        over_width,
        under_coverage,
        number(point.deviation.largest()),
        point.limited.to_string(),
        point.front.to_string(),
        point.failure.clone().unwrap_or_default(),
    ]
}

/// Writes `cost.csv` and `cost.svg` into `dir`, each completely or not at all. They contain seconds, and so differ from
/// run to run.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_cost(dir: &Path, study: &CostStudy) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("cost.csv", &cost_csv(study)?)?;
    files.add("cost.svg", cost_svg(study).as_bytes())?;
    files.put_in_place()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::cost_example::SCAN;
    use crate::results::cost_example::sample;

    #[test]
    fn each_setting_has_a_row() {
        let mut study = sample();
        study.bounds.truncate(1);
        study.bounds.push(CostPoint {
            points: Some(5),
            failure: Some("a, b".into()),
            ..CostPoint::without_result(SCAN, Stepping::Fixed(0.01))
        });
        study.bounds[0].front = true;
        let text = String::from_utf8(cost_csv(&study).unwrap()).unwrap();
        assert_eq!(
            text,
            "of,method,order,points,step,tolerance,simulations,steps,seconds,over_width,under_coverage,error,below_reference,front,failure\n\
             bounds,chebyshev.interval,5,,0.001,,36,2000,0.01,0.4,0,0.4,false,true,\n\
             bounds,scan,,5,0.01,,0,0,inf,inf,inf,inf,false,false,\"a, b\"\n\
             trajectory,hht(-0.1),,,,1e-6,0,0,0.002,,,0.0005,false,false,\n\
             trajectory,trapezoidal,,,,1e-6,0,0,0.001,,,0.0002,false,false,\n"
        );
    }
}
