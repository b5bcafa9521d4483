//! `statics.csv`, `modes.csv`, `response.csv`: a line for each output of one configuration, or for each frequency; and
//! plots of responses.

use csv::WriterBuilder;

use super::csv::number;
use super::figure::Caption;
use super::sweep::{Swept, SweptBounds, sweep_svg};
use crate::numerics::BandError;
use crate::results::{Band, Contribution, OutputBounds, ResponsePoint};

/// Last columns of every table.
const BOUNDS: [&str; 4] = ["method", "lower", "upper", "error"];

/// Every output of one configuration: `output,unit,nominal,method,lower,upper,error`, a line for each method.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn configuration_csv(outputs: &[OutputBounds]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(["output", "unit", "nominal"].into_iter().chain(BOUNDS))?;
    for output in outputs {
        let begin = vec![output.name.clone(), output.unit.clone()];
        lines(&mut writer, &begin, output, 0)?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// Every response at every frequency and time: `response,t,frequency,quantity,unit,nominal,method,lower,upper,error`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn response_csv(times: &[f64], points: &[ResponsePoint]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let begin = ["response", "t", "frequency", "quantity", "unit", "nominal"];
    writer.write_record(begin.into_iter().chain(BOUNDS))?;
    for (row, time) in times.iter().enumerate() {
        for point in points {
            for (quantity, output) in [("amplitude", &point.amplitude), ("phase", &point.phase)] {
                let (time, frequency) = (time.to_string(), point.frequency.to_string());
                let begin = [point.name.clone(), time, frequency, quantity.to_owned(), output.unit.clone()];
                lines(&mut writer, &begin, output, row)?;
            }
        }
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// The tolerances that matter for every response at every frequency and time:
/// `response,t,frequency,quantity,parameter,main,total,width_without`, as in `contributions.csv`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn response_contributions_csv(times: &[f64], points: &[ResponsePoint]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(["response", "t", "frequency", "quantity", "parameter", "main", "total", "width_without"])?;
    for (row, time) in times.iter().enumerate() {
        for point in points {
            for (quantity, contributions) in ["amplitude", "phase"].into_iter().zip(&point.contributions) {
                for Contribution { parameter, main, total, width_without } in contributions {
                    let numbers = [main[row], total[row], width_without[row]].map(number);
                    let [time, frequency] = [time, &point.frequency].map(f64::to_string);
                    let begin = [point.name.clone(), time, frequency, quantity.to_owned(), parameter.clone()];
                    writer.write_record(begin.into_iter().chain(numbers))?;
                }
            }
        }
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// Amplitude and phase of every response over the frequency, with bounds: the name of each, `drive` and `drive.phase`,
/// and its document.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn response_svgs(
    caption: Caption,
    times: &[f64],
    points: &[ResponsePoint],
) -> Result<Vec<(String, String)>, serde_json::Error> {
    let mut names: Vec<&str> = points.iter().map(|point| point.name.as_str()).collect();
    names.dedup();
    let mut plots = Vec::with_capacity(2 * names.len());
    for name in names {
        let own: Vec<&ResponsePoint> = points.iter().filter(|point| point.name == name).collect();
        let frequencies: Vec<f64> = own.iter().map(|point| point.frequency).collect();
        for (suffix, of) in [("", amplitude as fn(&ResponsePoint) -> &OutputBounds), (".phase", phase)] {
            let outputs: Vec<OutputBounds> =
                (0..times.len()).map(|row| over_frequencies(format!("{name}{suffix}"), &own, of, row)).collect();
            let labels: Vec<String> = times
                .iter()
                .map(|time| if times.len() > 1 { format!("t = {time} s") } else { String::new() })
                .collect();
            let rows: Vec<SweptBounds> = labels
                .iter()
                .zip(&outputs)
                .map(|(label, output)| SweptBounds { label, values: &frequencies, output })
                .collect();
            let swept = Swept { name: "frequency", unit: "Hz", si: 1.0 };
            plots.push((format!("{name}{suffix}"), sweep_svg(caption, swept, &rows, &[])?));
        }
    }
    Ok(plots)
}

fn amplitude(point: &ResponsePoint) -> &OutputBounds {
    &point.amplitude
}

fn phase(point: &ResponsePoint) -> &OutputBounds {
    &point.phase
}

/// A quantity of a response at one time, over the frequencies.
fn over_frequencies(
    name: String,
    points: &[&ResponsePoint],
    of: fn(&ResponsePoint) -> &OutputBounds,
    row: usize,
) -> OutputBounds {
    let column = |pick: &dyn Fn(&OutputBounds) -> f64| points.iter().map(|point| pick(of(point))).collect::<Vec<f64>>();
    let methods = points.first().map_or(&[][..], |point| &of(point).bands);
    let band = |(index, first): (usize, &Band)| Band {
        method: first.method,
        lower: column(&|output| output.bands[index].lower[row]),
        upper: column(&|output| output.bands[index].upper[row]),
        error: BandError {
            total: column(&|output| output.bands[index].error.total[row]),
            unresolved: points.iter().map(|point| of(point).bands[index].error.unresolved[row]).collect(),
            ..BandError::default()
        },
    };
    OutputBounds {
        name,
        unit: points.first().map_or_else(String::new, |point| of(point).unit.clone()),
        display: points.first().and_then(|point| of(point).display.clone()),
        nominal: column(&|output| output.nominal[row]),
        bands: methods.iter().enumerate().map(band).collect(),
    }
}

/// Writes a line for each method, or one line without bounds if there is no method.
fn lines(
    writer: &mut csv::Writer<Vec<u8>>,
    begin: &[String],
    output: &OutputBounds,
    row: usize,
) -> Result<(), csv::Error> {
    let nominal = output.nominal[row].to_string();
    let start = || begin.iter().cloned().chain([nominal.clone()]);
    if output.bands.is_empty() {
        return writer.write_record(start().chain(std::iter::repeat_n(String::new(), BOUNDS.len())));
    }
    for band in &output.bands {
        let numbers = [band.lower[row], band.upper[row], band.error.total[row]].map(|number| number.to_string());
        writer.write_record(start().chain([band.method.name().to_owned()]).chain(numbers))?;
    }
    Ok(())
}
