//! `bounds.csv`: one row for each time, one column for each curve.

use csv::WriterBuilder;

use crate::results::{Band, Bounds};

/// The table of all bounds as CSV, RFC 4180 with `\n` line ends.
///
/// Columns: `t`, then for each output `x3.nominal`, and for each of its bands `x3.chebyshev.lower`, `.upper` and
/// `.error`; last `unresolved`, the names of the bands that are unreliable in the row (`x3.chebyshev x3.taylor`), if
/// there are bands, and `covered`, the share of the box that the row covers, if that may be less than all. Numbers are
/// the shortest decimals that read back as the same `f64`; unknown values are `NaN`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn bounds_csv(bounds: &Bounds) -> Result<Vec<u8>, csv::Error> {
    let columns = columns(bounds);
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let bands = bands(bounds);
    let unresolved_heading = (!bands.is_empty()).then(|| "unresolved".to_owned());
    let covered_heading = (!bounds.covered.is_empty()).then(|| "covered".to_owned());
    let headings = columns.iter().map(|column| column.name.clone());
    writer.write_record(headings.chain(unresolved_heading).chain(covered_heading))?;
    for row in 0..bounds.times.len() {
        let unresolved = (!bands.is_empty()).then(|| unresolved(&bands, row));
        let covered = bounds.covered.get(row).map(|&share| number(share));
        let numbers = columns.iter().map(|column| number(column.values[row]));
        writer.write_record(numbers.chain(unresolved).chain(covered))?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// A curve with its heading.
struct Column<'a> {
    name: String,
    values: &'a [f64],
}

/// The columns, left to right, with their names.
fn columns(bounds: &Bounds) -> Vec<Column<'_>> {
    let mut columns = vec![Column { name: "t".to_owned(), values: &bounds.times }];
    for output in &bounds.outputs {
        let mut add = |suffix: String, values| {
            columns.push(Column { name: format!("{}.{suffix}", output.name), values });
        };
        add("nominal".to_owned(), &output.nominal);
        for band in &output.bands {
            let method = band.method.name();
            add(format!("{method}.lower"), &band.lower);
            add(format!("{method}.upper"), &band.upper);
            add(format!("{method}.error"), &band.error.total);
        }
    }
    columns
}

/// All bands, with their names.
fn bands(bounds: &Bounds) -> Vec<(String, &Band)> {
    let outputs = bounds.outputs.iter().flat_map(|output| output.bands.iter().map(move |band| (output, band)));
    outputs.map(|(output, band)| (format!("{}.{}", output.name, band.method.name()), band)).collect()
}

/// Names of the unreliable bands of a row.
fn unresolved(bands: &[(String, &Band)], row: usize) -> String {
    let names = bands.iter().filter(|(_, band)| band.error.unresolved[row]).map(|(name, _)| name.as_str());
    names.collect::<Vec<_>>().join(" ")
}

/// The shortest decimal that reads back as `x`: `0.1`, `2`, `1e-7`, `NaN`, `inf`.
pub(super) fn number(x: f64) -> String {
    // Debug is the shortest form with an exponent where that is shorter to read; Display would write 1e-300 in full.
    let mut text = format!("{x:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Method, OutputBounds};

    #[test]
    fn a_column_for_each_curve_in_the_order_of_the_model() {
        let band = |method, lower, upper, error: [f64; 2], unresolved: [bool; 2]| {
            let error = BandError { total: error.to_vec(), unresolved: unresolved.to_vec(), ..BandError::default() };
            Band { method, lower: vec![lower; 2], upper: vec![upper; 2], error }
        };
        let bounds = Bounds {
            times: vec![0.0, 0.01],
            outputs: vec![
                OutputBounds {
                    name: "x3".into(),
                    unit: "m".into(),
                    display: None,
                    nominal: vec![0.71, f64::NAN],
                    bands: vec![
                        band(Method::Chebyshev, 0.7, 0.72, [1e-3, 0.5], [false, true]),
                        band(Method::Scan, 0.705, 0.715, [0.0, f64::NAN], [false, true]),
                    ],
                },
                OutputBounds {
                    name: "a,\"b\"".into(),
                    unit: String::new(),
                    display: None,
                    nominal: vec![1e-300, -2.0],
                    bands: vec![],
                },
            ],
            ..Bounds::default()
        };
        let text = String::from_utf8(bounds_csv(&bounds).unwrap()).unwrap();
        assert_eq!(
            text,
            "t,x3.nominal,x3.chebyshev.lower,x3.chebyshev.upper,x3.chebyshev.error,x3.scan.lower,x3.scan.upper,\
             x3.scan.error,\"a,\"\"b\"\".nominal\",unresolved\n\
             0,0.71,0.7,0.72,0.001,0.705,0.715,0,1e-300,\n\
             0.01,NaN,0.7,0.72,0.5,0.705,0.715,NaN,-2,x3.chebyshev x3.scan\n"
        );
    }

    #[test]
    fn numbers_are_read_back_exactly() {
        for x in [0.1, 1.0 / 3.0, f64::MIN_POSITIVE, f64::MAX, -0.0, 5e-324, 1e16, 123_456_789.25, f64::INFINITY] {
            let text = number(x);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), x.to_bits(), "{text}");
        }
        assert!(number(f64::NAN).parse::<f64>().unwrap().is_nan());
        assert_eq!(number(3.0), "3");
    }

    #[test]
    fn table_without_rows_has_headings() {
        assert_eq!(bounds_csv(&Bounds::default()).unwrap(), b"t\n");
    }
}
