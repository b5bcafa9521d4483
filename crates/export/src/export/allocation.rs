//! An allocation's files: `allocation.csv`, the overlay `allocation.yaml` and the plot `allocation.svg` of cost against
//! margin.

use std::path::{Path, PathBuf};

use super::csv::number;
use super::error::ExportError;
use super::figure::Caption;
use super::folder::AtomicFiles;
use super::rounded::rounded;
use super::sweep::{TradeAxis, TradeMark, trade_svg};
use crate::results::{AllocatedTolerance, Allocation, Criterion, ToleranceZone, TradePoint};

/// The overlay's file.
pub const OVERLAY: &str = "allocation.yaml";

/// Writes all files; the overlay and the plot where tolerances were found.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_allocation(dir: &Path, allocation: &Allocation) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("allocation.csv", &table(allocation)?)?;
    if allocation.not_met.is_empty() {
        files.add(OVERLAY, overlay(allocation).as_bytes())?;
    }
    if !allocation.trade.is_empty() {
        files.add("allocation.svg", plot(allocation).as_bytes())?;
    }
    files.put_in_place()
}

/// Columns: parameter, unit, then above, below, cost and share before and after, and the grade.
fn table(allocation: &Allocation) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    writer.write_record([
        "parameter",
        "unit",
        "before.above",
        "before.below",
        "before.cost",
        "before.share",
        "after.above",
        "after.below",
        "after.cost",
        "after.share",
        "grade",
    ])?;
    for own in &allocation.tolerances {
        let side = |zone: ToleranceZone, cost: Option<f64>, share: f64| {
            [zone.above, zone.below, cost.unwrap_or(f64::NAN), share].map(number)
        };
        let before = side(own.before, own.cost_before, own.share_before);
        let after = side(own.after, own.cost_after, own.share_after);
        let grade = own.grade.clone().unwrap_or_default();
        let row = [own.parameter.clone(), own.unit.clone()].into_iter().chain(before).chain(after).chain([grade]);
        writer.write_record(row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The parameters that were free, with their new tolerances.
fn overlay(allocation: &Allocation) -> String {
    let criterion = match allocation.criterion {
        Criterion::WorstCase => "every case meets all requirements".to_owned(),
        Criterion::Share(share) => format!("{} % meet all requirements", rounded(100.0 * share)),
    };
    let confirmed = if allocation.is_confirmed { "" } else { " (not confirmed)" };
    let mut text = format!(
        "# Tolerances of {}, allocated by mbint: {criterion}{confirmed}.\n# Use it with `--with`, or in a scene.\nparameters:\n",
        allocation.model
    );
    for own in allocation.tolerances.iter().filter(|own| own.is_free) {
        let grade = own.grade.as_ref().map_or_else(String::new, |grade| format!(" # {grade}"));
        text += &format!("  {}: {}{grade}\n", own.parameter, piece(own));
    }
    text
}

/// A tolerance in one piece with its nominal value.
pub(super) fn piece(own: &AllocatedTolerance) -> String {
    let (scale, unit) = shown_unit(own);
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let ToleranceZone { above, below } = own.after;
    let value = if own.nominal.is_nan() { String::new() } else { format!("{}{unit} ", rounded(scale * own.nominal)) };
    if (above - below).abs() <= 1e-9 * above.max(below) {
        return format!("{value}± {}{unit}", rounded(scale * above));
    }
    format!(
        "{value}+{}{} -{}{}",
        rounded(scale * above),
        side(&value, &unit),
        rounded(scale * below),
        side(&value, &unit)
    )
}

/// Unit of a deviation; empty if the deviation has no value.
fn side<'u>(value: &str, unit: &'u str) -> &'u str {
    if value.is_empty() { unit } else { "" }
}

/// Scale and unit in which a tolerance is shown, one SI unit being `scale` of it: lengths of machines in mm.
pub fn shown_unit(own: &AllocatedTolerance) -> (f64, &str) {
    if own.unit == "m" && own.after.above.max(own.after.below) < 0.1 { (1e3, "mm") } else { (1.0, &own.unit) }
}

/// Cost against the share of the nominal margins that is left.
pub(super) fn plot(allocation: &Allocation) -> String {
    let together = allocation.costs()[1].is_none();
    let percent = |point: &TradePoint| (100.0 * point.margin, point.cost);
    let line: Vec<(f64, f64)> = allocation.trade.iter().map(percent).collect();
    let mark = |label, point: &Option<TradePoint>| point.as_ref().map(|point| TradeMark { label, at: percent(point) });
    let marks = [mark("now", &allocation.trade_before), mark("allocated", &allocation.trade_after)];
    let marks: Vec<TradeMark> = marks.into_iter().flatten().collect();
    let cost = if together { "tightness (model's tolerances: 1)" } else { "cost" };
    let axes = [TradeAxis { name: "margin left, % of nominal", unit: "" }, TradeAxis { name: cost, unit: "" }];
    trade_svg(Caption { model: &allocation.model, prefix: "allocation" }, "cost against margin", axes, &line, &marks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_in_one_piece() {
        let own = |unit: &str, nominal: f64, above: f64, below: f64| {
            let zone = ToleranceZone { above, below };
            piece(&AllocatedTolerance {
                parameter: "a".into(),
                unit: unit.into(),
                nominal,
                before: zone,
                after: zone,
                grade: None,
                cost_before: None,
                cost_after: None,
                share_before: 1.0,
                share_after: 1.0,
                is_free: true,
                at_widest: false,
            })
        };
        assert_eq!(own("m", 0.3, 0.3e-3, 0.3e-3), "300 mm ± 0.3 mm");
        assert_eq!(own("m", 0.03, 0.1e-3, 0.2e-3), "30 mm +0.1 -0.2");
        assert_eq!(own("m", f64::NAN, 1e-5, 1e-5), "± 0.01 mm");
        assert_eq!(own("m", f64::NAN, 1e-5, 2e-5), "+0.01 mm -0.02 mm");
        assert_eq!(own("", 2.0, 0.1, 0.1), "2 ± 0.1");
        assert_eq!(own("N/m", 2e5, 100.0, 100.0), "200000 N/m ± 100 N/m");
    }
}
