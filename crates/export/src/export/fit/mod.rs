//! A fit's files: `fit.csv` with all rows, `fit.json`, the overlay `fit.yaml`, figures, and the page `fit.html`.

mod figures;
mod page;

use std::path::{Path, PathBuf};

use super::csv::number;
use super::error::ExportError;
use super::folder::AtomicFiles;
use super::rounded::rounded;
use super::stems::unique_stems;
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Fit, FitParameter};

/// The overlay's file.
pub const FIT_OVERLAY: &str = "fit.yaml";

/// Writes all files; the overlay only if a parameter is consistent.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_fit(dir: &Path, fit: &Fit) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("fit.csv", &table(fit)?)?;
    let mut json = serde_json::to_vec_pretty(fit)?;
    json.push(b'\n');
    files.add("fit.json", &json)?;
    if fit.set.is_some() {
        files.add(FIT_OVERLAY, overlay(fit).as_bytes())?;
    }
    let mut drawn = Vec::new();
    let stems = unique_stems(fit.outputs.iter().map(|output| output.name.as_str()));
    for (index, stem) in stems.iter().enumerate() {
        drawn.push((format!("{stem}.fit.svg"), figures::residuals(fit, index)));
    }
    let pairs = fit.set.iter().flat_map(|set| &set.projections).map(|projection| {
        let [first, second] = projection.parameters.map(|index| fit.parameters[index].name.as_str());
        (format!("{first}-{second}"), projection)
    });
    let pairs: Vec<_> = pairs.collect();
    let stems = unique_stems(pairs.iter().map(|(name, _)| name.as_str()));
    for (stem, (_, projection)) in stems.iter().zip(&pairs) {
        drawn.push((format!("{stem}.set.svg"), figures::projected(fit, projection)));
    }
    for (name, svg) in &drawn {
        files.add(name, svg.as_bytes())?;
    }
    files.add("fit.html", page::page(fit, drawn.into_iter().map(|(_, svg)| svg)).as_bytes())?;
    files.put_in_place()
}

/// Columns: line, t, output, measured, noise, fitted, residual, error, in SI.
fn table(fit: &Fit) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(["line", "t", "output", "measured", "noise", "fitted", "residual", "error"])?;
    for row in &fit.rows {
        let values = [row.measured, row.noise, row.fitted, row.measured - row.fitted, row.error].map(number);
        let output = fit.outputs[row.output].name.clone();
        writer.write_record([row.line.to_string(), number(row.time), output].into_iter().chain(values))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The middle of the consistent set, and its hull as intervals.
fn overlay(fit: &Fit) -> String {
    let mut text = format!(
        "# Parameters of {} that agree with {} measured values, fitted by mbint.\n\
         # Use it with `--with`, or in a scene.\nparameters:\n",
        fit.model,
        fit.rows.len()
    );
    for own in &fit.parameters {
        if let (Some(hull), Some(middle)) = (own.hull, own.middle) {
            text += &format!("  {}: {}\n", own.name, piece(own, hull, middle));
        }
    }
    text
}

/// A value with deviations, in one piece, at least as large as those of the hull.
fn piece(own: &FitParameter, hull: [f64; 2], middle: f64) -> String {
    let unit = ShownUnit::of(&own.display, &own.unit);
    let [lower, upper] = hull.map(|end| unit.of_si(end));
    let digit = 10_f64.powi(
        symdiff::math::log10((upper - lower).max(f64::MIN_POSITIVE)).floor() as i32 + 1 - TUNING.digits_of_deviations,
    );
    let text = rounded((unit.of_si(middle) / digit).round() * digit);
    let value: f64 = text.parse().unwrap_or(middle);
    // A part in a million of the last digit covers the rounding of the differences.
    let [above, below] = [upper - value, value - lower].map(|side| ((side / digit + 1e-6).ceil() * digit).max(0.0));
    let behind = if unit.text.is_empty() { String::new() } else { format!(" {}", unit.text) };
    format!("{text}{behind} +{} -{}", rounded(above), rounded(below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_in_the_file_is_not_smaller_than_the_hull() {
        let own = FitParameter {
            name: "l".into(),
            unit: "m".into(),
            display: None,
            prior: [0.1, 0.2],
            estimate: 0.15,
            deviation: 0.01,
            hull: None,
            inner: None,
            middle: None,
        };
        // The digits follow the width: 0.0765.
        assert_eq!(piece(&own, [0.123_456_78, 0.2], 0.15), "0.15 m +0.05001 -0.02655");
    }
}
