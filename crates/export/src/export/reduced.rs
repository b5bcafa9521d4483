//! `reduced.csv`: one row for each reduced output and method.

use super::csv::number;
use crate::results::ReducedSummary;

/// The table of reduced outputs as CSV: name, unit, nominal, method, lower, upper, error, unresolved. Without any
/// method, one row with the nominal value.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn reduced_csv(reduced: &[ReducedSummary]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(["name", "of", "unit", "nominal", "method", "lower", "upper", "error", "unresolved"])?;
    for own in reduced {
        let first = [own.name.clone(), own.of.clone(), own.unit.clone(), number(own.nominal)];
        if own.bands.is_empty() {
            writer.write_record(first.iter().map(String::as_str).chain([""; 5]))?;
        }
        for band in &own.bands {
            let numbers = [band.lower, band.upper, band.error].map(number);
            let unresolved = if band.unresolved { "true" } else { "false" };
            let rest = [band.method.as_str(), &numbers[0], &numbers[1], &numbers[2], unresolved];
            writer.write_record(first.iter().map(String::as_str).chain(rest))?;
        }
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}
