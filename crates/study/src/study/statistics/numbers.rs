//! Reduced outputs: their distribution, by samples of the surrogate of their values.

use super::rows::Rows;
use crate::numerics::statistics::{Estimate, REPLICATES, Replicates};
use crate::results::{NumberStatistics, Uncertain};

/// Samples, at most.
const MOST: usize = 1 << 18;

/// Those whose surrogate is known.
///
/// # Errors
/// At an interruption.
pub(super) fn all(rows: &Rows) -> Result<Vec<NumberStatistics>, String> {
    let reduced = &rows.description.reduced;
    let Some(kept) = rows.kept.reduced(reduced.len()) else { return Ok(Vec::new()) };
    rows.stage("statistics of reduced outputs");
    let shares = &rows.description.statistics.quantiles;
    let fewer = rows.fewer(MOST / REPLICATES);
    let mut of_number = vec![Replicates::new(shares.len()); reduced.len()];
    for replicate in 0..REPLICATES {
        rows.progress(replicate, REPLICATES);
        let samples = rows.points(replicate, fewer);
        for (own, values) in of_number.iter_mut().zip(kept.values(&samples)) {
            rows.go_on()?;
            own.add(&mut { values }, shares);
        }
    }
    let number = |(index, own): (usize, Replicates)| {
        let error = kept.error(index);
        let with_error = |Estimate { value, sampling }: Estimate| Uncertain { value, sampling, error };
        NumberStatistics {
            name: reduced[index].name.clone(),
            unit: reduced[index].unit.clone(),
            display: rows.description.display.get(&reduced[index].name).cloned(),
            mean: with_error(own.mean()),
            deviation: with_error(own.deviation()),
            quantiles: own.quantiles().into_iter().map(with_error).collect(),
        }
    };
    Ok(of_number.into_iter().enumerate().map(number).collect())
}
