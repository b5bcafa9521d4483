//! `witnesses.csv` and `witnesses.points.csv`: samples with the least and the largest outputs.

use csv::WriterBuilder;

use super::csv::number;
use crate::results::{Bounds, ParameterSummary, Witness};

/// The samples' file, which `mbint sample --points` reads.
pub const POINTS: &str = "witnesses.points.csv";

/// The table: `t`, `output`, `end` (`lower` or `upper`), `value`, `point`, and the value of each parameter, in SI.
/// `point` is the number of the sample in [`points_csv`], counted from 1.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn witnesses_csv(bounds: &Bounds, parameters: &[ParameterSummary]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let names = parameters.iter().map(|parameter| parameter.name.as_str());
    writer.write_record(["t", "output", "end", "value", "point"].into_iter().chain(names))?;
    let points = points(&bounds.witnesses);
    for own in &bounds.witnesses {
        let point = 1 + points.iter().position(|point| *point == own.parameters).unwrap_or(points.len());
        let end = if own.is_upper { "upper" } else { "lower" };
        let output = bounds.outputs[own.output].name.clone();
        let first = [number(bounds.times[own.row]), output, end.to_owned(), number(own.value), point.to_string()];
        writer.write_record(first.into_iter().chain(own.parameters.iter().map(|&value| number(value))))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Each sample once, a column a parameter, in SI.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn points_csv(bounds: &Bounds, parameters: &[ParameterSummary]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(parameters.iter().map(|parameter| parameter.name.as_str()))?;
    for point in points(&bounds.witnesses) {
        writer.write_record(point.iter().map(|&value| number(value)))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The samples, each once, in the order of their first rows.
fn points(witnesses: &[Witness]) -> Vec<&[f64]> {
    let mut points: Vec<&[f64]> = Vec::new();
    for own in witnesses {
        if !points.contains(&&own.parameters[..]) {
            points.push(&own.parameters);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::OutputBounds;

    #[test]
    fn each_sample_is_listed_once() {
        let output = OutputBounds { name: "x".into(), unit: "m".into(), display: None, nominal: vec![], bands: vec![] };
        let witness = |row: usize, is_upper: bool, value: f64, parameter: f64| Witness {
            row,
            output: 0,
            is_upper,
            value,
            parameters: vec![parameter],
        };
        let witnesses = vec![witness(0, false, 1.0, 0.9), witness(0, true, 2.0, 1.1), witness(1, false, 3.0, 1.1)];
        let bounds = Bounds { times: vec![0.0, 0.5], outputs: vec![output], witnesses, ..Bounds::default() };
        let parameter = ParameterSummary {
            name: "m".into(),
            unit: "kg".into(),
            display: None,
            nominal: 1.0,
            lower: 0.9,
            upper: 1.1,
        };
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let table = text(witnesses_csv(&bounds, std::slice::from_ref(&parameter)).unwrap());
        assert_eq!(table, "t,output,end,value,point,m\n0,x,lower,1,1,0.9\n0,x,upper,2,2,1.1\n0.5,x,lower,3,2,1.1\n");
        assert_eq!(text(points_csv(&bounds, &[parameter]).unwrap()), "m\n0.9\n1.1\n");
    }
}
