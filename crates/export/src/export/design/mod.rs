//! A design's files: `design.csv` with all points, `front.csv` with cost against margin, `design.json`, the overlay
//! `design.yaml`, profiles of the objective, and the page `design.html`.

mod front;
mod page;
mod profile;

use std::path::{Path, PathBuf};

use super::allocation;
use super::csv::number;
use super::error::ExportError;
use super::folder::AtomicFiles;
use super::rounded::rounded;
use super::stems::unique_stems;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{AllocatedTolerance, Criterion, DesignKind, DesignPoint, DesignStudy};

/// The overlay's file.
pub const DESIGN_OVERLAY: &str = "design.yaml";

/// Writes all files.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_design(dir: &Path, design: &DesignStudy) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("design.csv", &table(design)?)?;
    let mut json = serde_json::to_vec_pretty(design)?;
    json.push(b'\n');
    files.add("design.json", &json)?;
    files.add(DESIGN_OVERLAY, overlay(design).as_bytes())?;
    let names = design.profiles.iter().map(|own| design.parameters[own.parameter].name.as_str());
    let mut drawn = Vec::new();
    for (stem, own) in unique_stems(names).iter().zip(&design.profiles) {
        let svg = profile::drawn(design, own)?;
        files.add(&format!("{stem}.design.svg"), svg.as_bytes())?;
        drawn.push(svg);
    }
    let of_best = design.allocation.as_ref().filter(|own| !own.trade.is_empty());
    let trade = match design.front.is_empty() {
        true => of_best.map(allocation::plot),
        false => Some(front::drawn(design)),
    };
    if !design.front.is_empty() {
        files.add("front.csv", &front::table(design)?)?;
    }
    if let Some(svg) = trade {
        files.add("cost.design.svg", svg.as_bytes())?;
        drawn.push(svg);
    }
    files.add("design.html", page::page(design, drawn).as_bytes())?;
    files.put_in_place()
}

/// All points with their names.
fn points(design: &DesignStudy) -> impl Iterator<Item = (String, &DesignPoint)> {
    let own = design.model_point.iter().chain(&design.nominal_point).map(|point| (name(point, 0), point));
    own.chain(design.optima.iter().enumerate().map(|(index, point)| (name(point, index), point)))
}

fn name(point: &DesignPoint, index: usize) -> String {
    match (point.kind, index) {
        (DesignKind::Model, _) => "model".to_owned(),
        (DesignKind::Nominal, _) => "without tolerances".to_owned(),
        (DesignKind::Optimum, 0) => "optimum".to_owned(),
        (DesignKind::Optimum, _) => format!("optimum {}", index + 1),
    }
}

/// Columns: point, a column for each parameter, nominal, worst, error, feasible, in SI.
fn table(design: &DesignStudy) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let names = design.parameters.iter().map(|own| own.name.as_str());
    writer.write_record(["point"].into_iter().chain(names).chain(["nominal", "worst", "error", "feasible"]))?;
    for (name, point) in points(design) {
        let numbers = point.values.iter().copied().chain([point.nominal, point.worst, point.error]).map(number);
        let feasible = point.is_feasible.to_string();
        writer.write_record(std::iter::once(name).chain(numbers).chain([feasible]))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Criterion of the design, in words.
fn criterion(design: &DesignStudy) -> String {
    match design.criterion {
        Criterion::WorstCase => "every case within the tolerances".to_owned(),
        Criterion::Share(share) => format!("{} % of the production", rounded(100.0 * share)),
    }
}

/// The best nominal values with their tolerances, and other tolerances that were chosen with them.
fn overlay(design: &DesignStudy) -> String {
    let Some(best) = design.best() else { return String::new() };
    let met = if best.is_feasible { "" } else { " (requirements are not met)" };
    let mut text = format!(
        "# Nominal values of {}, designed by mbint: {}, {}{met}.\n# Use it with `--with`, or in a scene.\nparameters:\n",
        design.model,
        design.objective.text,
        criterion(design)
    );
    for (index, own) in design.parameters.iter().enumerate() {
        text += &format!("  {}: {}\n", own.name, piece(design, best, index));
    }
    let chosen = design.allocation.iter().filter(|_| design.is_priced()).flat_map(|own| &own.tolerances);
    let is_other =
        |own: &&AllocatedTolerance| own.is_free && design.parameters.iter().all(|free| free.name != own.parameter);
    for own in chosen.filter(is_other) {
        text += &format!("  {}: {}\n", own.parameter, allocation::piece(own));
    }
    text
}

/// A nominal value with its deviations, in one piece.
fn piece(design: &DesignStudy, point: &DesignPoint, parameter: usize) -> String {
    let own = &design.parameters[parameter];
    let unit = ShownUnit::of(&own.display, &own.unit);
    let number = |value: f64| rounded(unit.of_si(value));
    let [above, below] = point.deviations[parameter];
    let behind = if unit.text.is_empty() { String::new() } else { format!(" {}", unit.text) };
    let value = format!("{}{behind}", number(point.values[parameter]));
    match (above.max(below) > 0.0, (above - below).abs() <= 1e-9 * above.max(below)) {
        (false, _) => value,
        (true, true) => format!("{value} ± {}{behind}", number(above)),
        (true, false) => format!("{value} +{} -{}", number(above), number(below)),
    }
}

/// A value in the parameter's unit.
fn shown(design: &DesignStudy, parameter: usize, value: f64) -> String {
    let own = &design.parameters[parameter];
    super::rounded::shown(ShownUnit::of(&own.display, &own.unit), value)
}
