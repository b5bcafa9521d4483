//! `statics.csv`, `modes.csv`, `response.csv`: a line for each output of one configuration, or for each frequency.

use csv::WriterBuilder;

use crate::results::{OutputBounds, ResponsePoint};

/// What every line begins or ends with.
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

/// A line for each method, or one where there is none.
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
