//! `columns.json` and `contributions.columns.json`: meanings and units of the columns of `bounds.csv` and
//! `contributions.csv`.

use serde::Serialize;

use crate::grammar::display_unit::DisplayUnit;
use crate::results::Bounds;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Column {
    /// Its heading.
    column: String,
    /// Kind of its numbers: `time`, `nominal`, `lower`, `upper`, `error`, `unresolved`, `covered`.
    quantity: &'static str,
    /// SI unit; empty where dimensionless or unknown.
    unit: String,
    /// The unit in which plots and tables show it, where the model names one: `value / si` is in this unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    display: Option<DisplayUnit>,
    #[serde(skip_serializing_if = "Option::is_none")]
    output: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    method: Option<&'static str>,
}

/// The columns of `bounds.csv`, left to right, as a JSON array with an object for each: `column`, `quantity`, `unit`
/// and, if they have one, `display` (the unit in which people see it, and its value in SI), `output` and `method`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn columns_json(bounds: &Bounds) -> Result<Vec<u8>, serde_json::Error> {
    let whole = |column: &str, quantity, unit: &str| {
        let (column, unit) = (column.to_owned(), unit.to_owned());
        Column { column, quantity, unit, display: None, output: None, method: None }
    };
    let mut columns = vec![whole("t", "time", "s")];
    for output in &bounds.outputs {
        let of_output = |quantity, method: Option<&'static str>| {
            let between = method.map_or(String::new(), |method| format!("{method}."));
            let column = format!("{}.{between}{quantity}", output.name);
            let (name, display) = (Some(output.name.clone()), output.display.clone());
            Column { output: name, method, display, ..whole(&column, quantity, &output.unit) }
        };
        columns.push(of_output("nominal", None));
        for band in &output.bands {
            columns.extend(["lower", "upper", "error"].map(|quantity| of_output(quantity, Some(band.method.name()))));
        }
    }
    if bounds.outputs.iter().any(|output| !output.bands.is_empty()) {
        columns.push(whole("unresolved", "unresolved", ""));
    }
    if !bounds.covered.is_empty() {
        columns.push(whole("covered", "covered", ""));
    }
    let mut json = serde_json::to_vec_pretty(&columns)?;
    json.push(b'\n');
    Ok(json)
}

/// The columns of `contributions.csv` likewise: the shares `main` and `total` of an output's variance, and
/// `width_without`, in the output's unit, each of an `output` and a `parameter`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn contribution_columns_json(bounds: &Bounds) -> Result<Vec<u8>, serde_json::Error> {
    #[derive(Serialize)]
    struct OfParameter<'b> {
        #[serde(flatten)]
        column: Column,
        #[serde(skip_serializing_if = "Option::is_none")]
        parameter: Option<&'b str>,
    }
    let (unit, display) = ("s".to_owned(), None);
    let time = Column { column: "t".to_owned(), quantity: "time", unit, display, output: None, method: None };
    let mut columns = vec![OfParameter { column: time, parameter: None }];
    for (output, contributions) in bounds.outputs.iter().zip(&bounds.contributions) {
        for contribution in contributions {
            for (quantity, unit) in [("main", "1"), ("total", "1"), ("width_without", output.unit.as_str())] {
                let column = Column {
                    column: format!("{}.{}.{quantity}", output.name, contribution.parameter),
                    quantity,
                    unit: unit.to_owned(),
                    display: output.display.clone().filter(|_| quantity == "width_without"),
                    output: Some(output.name.clone()),
                    method: None,
                };
                columns.push(OfParameter { column, parameter: Some(&contribution.parameter) });
            }
        }
    }
    let mut json = serde_json::to_vec_pretty(&columns)?;
    json.push(b'\n');
    Ok(json)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::bounds_csv;
    use crate::numerics::BandError;
    use crate::results::{Band, Method, OutputBounds};

    #[test]
    fn columns_match_the_headings_of_the_table() {
        let error = BandError { total: vec![0.0], unresolved: vec![false], ..BandError::default() };
        let band = Band { method: Method::Scan, lower: vec![0.0], upper: vec![1.0], error };
        let output = |name: &str, bands| OutputBounds {
            name: name.into(),
            unit: "m".into(),
            display: None,
            nominal: vec![0.5],
            bands,
        };
        let whole = Bounds { times: vec![0.0], outputs: vec![output("x", vec![band])], ..Bounds::default() };
        let part = Bounds { covered: vec![0.5], outputs: vec![output("y", vec![])], ..whole.clone() };
        for bounds in [whole, part] {
            let columns: Vec<serde_json::Value> = serde_json::from_slice(&columns_json(&bounds).unwrap()).unwrap();
            let headings: Vec<&str> = columns.iter().map(|column| column["column"].as_str().unwrap()).collect();
            let table = String::from_utf8(bounds_csv(&bounds).unwrap()).unwrap();
            assert_eq!(table.lines().next(), Some(headings.join(",").as_str()));
            assert_eq!((&columns[0]["unit"], &columns[1]["unit"]), (&"s".into(), &"m".into()));
        }
    }
}
