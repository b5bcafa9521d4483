//! Statistics of simulated motions in addition to their bounds, if no surrogate is stored: worst cases, linear sums and
//! root sum squares.

use super::intervals;
use super::motions;
use crate::methods::Method;
use crate::model::Description;
use crate::results::{Bounds, StatisticsResult};
use crate::study::Options;

/// Statistics of the first outputs, by simulated motions.
///
/// # Errors
/// In words, if motions cannot be simulated.
pub(super) fn of_motions(
    description: &Description,
    shown: usize,
    options: &Options,
    bounds: &Bounds,
) -> Result<StatisticsResult, String> {
    let mut found = motions::of_motions(description, shown, options)?;
    let rows = found.times.iter().zip(&bounds.times).take_while(|(own, of_bounds)| own == of_bounds).count();
    for output in &mut found.outputs {
        if let Some(sums) = stacks(description, bounds, &output.name) {
            let sums = output.linear.iter_mut().zip(&mut output.rss).zip(sums).take(rows);
            sums.for_each(|((linear, rss), sums)| (*linear, *rss) = (sums.0, sums.1));
        }
    }
    for summary in &mut found.summary.outputs {
        let row = found.times[..rows].iter().position(|time| *time == summary.time);
        let own = bounds.outputs.iter().find(|own| own.name == summary.output);
        let statistics = found.outputs.iter().find(|own| own.name == summary.output);
        let (Some(row), Some(own), Some(statistics)) = (row, own, statistics) else { continue };
        (summary.linear, summary.rss) = (statistics.linear[row], statistics.rss[row]);
        summary.nominal = own.nominal[row];
        if let Some(band) = own.bands.iter().find(|band| band.method == Method::Chebyshev) {
            summary.worst_case = [band.lower[row], band.upper[row]];
            summary.worst_case_error = band.error.total[row];
        }
    }
    Ok(found)
}

/// By row, an output's linear sum and root sum square about the nominal values; `None` if its derivatives are
/// unknown, or parameters lie in zones, which have other deviations than each of them.
fn stacks(description: &Description, bounds: &Bounds, name: &str) -> Option<Vec<(f64, f64)>> {
    let own = bounds.derivatives.iter().find(|own| bounds.outputs[own.output].name == name)?;
    let deviation = |[nominal, lower, upper]: [f64; 3]| (upper - nominal).max(nominal - lower);
    let deviations: Vec<f64> = intervals(description).map(|(_, ends)| deviation(ends)).collect();
    if !description.zones.is_empty() || deviations.is_empty() {
        return None;
    }
    let of_row = |slopes: &[f64]| {
        let moved = || slopes.iter().zip(&deviations).map(|(slope, deviation)| (slope * deviation).abs());
        (moved().sum(), moved().map(|moved: f64| moved * moved).sum::<f64>().sqrt())
    };
    Some(own.by_parameters.chunks_exact(deviations.len()).map(of_row).collect())
}
