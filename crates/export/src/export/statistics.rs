//! `statistics.csv`: the distributions of the outputs over time.

use csv::WriterBuilder;

use super::csv::number;
use crate::results::{StatisticsResult, Uncertain};

/// Statistics of reduced outputs as CSV, a line each: `name`, `unit`, `mean`, `deviation` and the quantiles `q0.05`, …,
/// each followed by its error.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn reduced_statistics_csv(statistics: &StatisticsResult) -> Result<Vec<u8>, csv::Error> {
    let quantiles = statistics.summary.quantiles.iter().map(|share| format!("q{}", number(*share)));
    let columns = ["mean".to_owned(), "deviation".to_owned()].into_iter().chain(quantiles);
    let headings = ["name", "unit"].map(str::to_owned).into_iter();
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(headings.chain(columns.flat_map(|name| [name.clone(), format!("{name}.error")])))?;
    for own in &statistics.summary.reduced {
        let values = [&own.mean, &own.deviation].into_iter().chain(&own.quantiles);
        let numbers = values.flat_map(|value| [number(value.value), number(value.total())]);
        writer.write_record([own.name.clone(), own.unit.clone()].into_iter().chain(numbers))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The table of all statistics as CSV. Columns: `t`, then for each output `x3.mean`, `x3.deviation`, `x3.q0.00135`, …
/// each followed by its error (`x3.mean.error`: half the 95 % confidence interval, plus possible errors of surrogate
/// and steps), `x3.linear` and `x3.rss`, and last `unresolved`, the outputs whose numbers are unreliable in the row.
/// Unknown values are `NaN`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn statistics_csv(statistics: &StatisticsResult) -> Result<Vec<u8>, csv::Error> {
    let mut headings = vec!["t".to_owned()];
    let mut columns: Vec<Vec<f64>> = vec![statistics.times.clone()];
    for output in &statistics.outputs {
        let mut add = |name: String, values: &[Uncertain]| {
            headings.extend([format!("{}.{name}", output.name), format!("{}.{name}.error", output.name)]);
            columns.push(values.iter().map(|value| value.value).collect());
            columns.push(values.iter().map(Uncertain::total).collect());
        };
        add("mean".to_owned(), &output.mean);
        add("deviation".to_owned(), &output.deviation);
        for (share, values) in statistics.summary.quantiles.iter().zip(&output.quantiles) {
            add(format!("q{}", number(*share)), values);
        }
        headings.extend([format!("{}.linear", output.name), format!("{}.rss", output.name)]);
        columns.extend([output.linear.clone(), output.rss.clone()]);
    }
    headings.push("unresolved".to_owned());
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(&headings)?;
    for row in 0..statistics.times.len() {
        let unresolved = statistics.outputs.iter().filter(|output| !output.resolved[row]);
        let names: Vec<&str> = unresolved.map(|output| output.name.as_str()).collect();
        writer.write_record(columns.iter().map(|column| number(column[row])).chain([names.join(" ")]))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}
