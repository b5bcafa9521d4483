//! The text of a snapshot: a table for each output.

use std::path::{Path, PathBuf};

use crate::export::error::ExportError;
use crate::export::folder::write_pages;
use crate::export::tuning::TUNING;
use crate::results::{Bounds, OutputBounds};

/// A snapshot's table: for each output its name with the unit, headings, and ten rows at equal distances to the end of
/// the run.
///
/// Columns: `t`, `nominal`, and for each method `METHOD.lower`, `.upper` and `.error`. Bounds have five digits of the
/// output's span, errors two digits.
pub fn snapshot_table(bounds: &Bounds) -> String {
    let rows = rows(bounds.times.len());
    let times = times(&bounds.times);
    let mut text = String::new();
    for output in &bounds.outputs {
        let decimals = decimals(output);
        let unit = if output.unit.is_empty() { String::new() } else { format!(" [{}]", output.unit) };
        text += &format!("{}{unit}\n{:>8} {:>12}", output.name, "t", "nominal");
        for band in &output.bands {
            let method = band.method.name();
            for column in ["lower", "upper", "error"] {
                text += &format!(" {:>15}", format!("{method}.{column}"));
            }
        }
        text += "\n";
        for &row in &rows {
            let time = format!("{:.times$}", bounds.times[row]);
            text += &format!("{time:>8} {:>12}", number(output.nominal[row], decimals));
            for band in &output.bands {
                let [lower, upper] = [&band.lower, &band.upper].map(|values| number(values[row], decimals));
                for value in [lower, upper, format!("{:.1e}", band.error.total[row])] {
                    text += &format!(" {value:>15}");
                }
            }
            text += "\n";
        }
        text += "\n";
    }
    text
}

/// A snapshot as a file, in the format of the crate insta: its subject between lines of hyphens, then the table.
pub fn snapshot_file(of: &str, table: &str) -> String {
    let of = of.replace('\\', "\\\\").replace('"', "\\\"");
    format!("---\ndescription: \"{of}\"\n---\n{}\n", table.trim_end())
}

/// Writes a snapshot's file into a folder, which is created if it does not exist.
///
/// # Errors
/// If it cannot be written; an older one then stays unchanged.
pub fn write_snapshot(folder: &Path, name: &str, file: &str) -> Result<Vec<PathBuf>, ExportError> {
    write_pages(folder, &[(name.to_owned(), file.to_owned())])
}

/// Indices of the rows that are shown.
fn rows(count: usize) -> Vec<usize> {
    let Some(last) = count.checked_sub(1) else { return Vec::new() };
    let mut rows: Vec<usize> =
        (1..=TUNING.times_of_snapshot).map(|index| index * last / TUNING.times_of_snapshot).collect();
    rows.dedup();
    rows
}

/// Decimals that distinguish the times shown.
fn times(times: &[f64]) -> usize {
    let duration = times.last().copied().unwrap_or(1.0);
    if duration > 0.0 { (2 - exponent(duration)).max(4) as usize } else { 4 }
}

/// Decimals that show `TUNING.digits_of_span` digits of the output's whole range.
fn decimals(output: &OutputBounds) -> usize {
    let bands = output.bands.iter().flat_map(|band| band.lower.iter().chain(&band.upper));
    let values = output.nominal.iter().chain(bands).filter(|value| value.is_finite());
    let ends = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), &value| (least.min(value), greatest.max(value)));
    let (span, largest) = (ends.1 - ends.0, ends.0.abs().max(ends.1.abs()));
    let finest = |size: f64, digits: i32| digits - 1 - exponent(size);
    let decimals = match (span, largest) {
        _ if !(largest > 0.0 && largest.is_finite()) => 0,
        (0.0, _) => finest(largest, TUNING.digits_of_span),
        _ => finest(span, TUNING.digits_of_span).min(finest(largest, TUNING.most_digits_of_value)),
    };
    decimals.max(0) as usize
}

/// The power of ten of a positive number's first digit.
fn exponent(value: f64) -> i32 {
    // The form with an exponent always has one.
    format!("{value:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// A value with `decimals` decimals; a rounded zero has no sign.
fn number(value: f64, decimals: usize) -> String {
    let number = format!("{value:.decimals$}");
    let zero = number.trim_start_matches('-').bytes().all(|digit| matches!(digit, b'0' | b'.'));
    if zero { number.trim_start_matches('-').to_owned() } else { number }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Band, Method};

    /// An output with one band of this width.
    pub fn bounds(nominal: &[f64], width: f64, error: f64) -> Bounds {
        let rows = nominal.len();
        let error = BandError { total: vec![error; rows], unresolved: vec![false; rows], ..BandError::default() };
        let [lower, upper] = [-0.5, 0.5].map(|side| nominal.iter().map(|value| value + side * width).collect());
        let bands = vec![Band { method: Method::Scan, lower, upper, error }];
        let output =
            OutputBounds { name: "x".into(), unit: "m".into(), display: None, nominal: nominal.to_vec(), bands };
        Bounds { times: (0..rows).map(|row| 0.1 * row as f64).collect(), outputs: vec![output], ..Bounds::default() }
    }

    #[test]
    fn short_runs_have_fewer_rows() {
        let text = snapshot_table(&bounds(&[1.0, -1e-9, f64::NAN], 0.25, 1e-3));
        let expected = "\
x [m]
       t      nominal      scan.lower      scan.upper      scan.error
  0.0000       1.0000          0.8750          1.1250          1.0e-3
  0.1000       0.0000         -0.1250          0.1250          1.0e-3
  0.2000          NaN             NaN             NaN          1.0e-3

";
        assert_eq!(text, expected);
        assert_eq!(snapshot_table(&bounds(&[], 0.0, 0.0)).lines().count(), 3, "no rows");
    }

    #[test]
    fn constant_outputs_have_digits() {
        let decimals = |nominal: &[f64], width| decimals(&bounds(nominal, width, 0.0).outputs[0]);
        assert_eq!(decimals(&[0.0, 0.0], 0.0), 0);
        assert_eq!(decimals(&[9.81, 9.81], 0.0), 4);
        assert_eq!(decimals(&[9.81, 9.81], 4e-15), 12, "rounding errors are no span");
        assert_eq!(decimals(&[1e300, f64::INFINITY], 0.0), 0);
        assert_eq!(decimals(&[2.0, 3.0], 0.0), 4);
    }
}
