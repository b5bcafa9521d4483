//! Reduced outputs: their distribution, by samples of the surrogate of their values.

use super::control_variates::Moments;
use super::rows::Rows;
use super::tuning::TUNING;
use crate::numerics::statistics::{REPLICATES, Replicates};
use crate::results::NumberStatistics;

/// Statistics of reduced outputs whose surrogate is known.
///
/// # Errors
/// At an interruption.
pub(super) fn all(rows: &Rows) -> Result<Vec<NumberStatistics>, String> {
    let reduced = &rows.description.reduced;
    let Some(kept) = rows.kept.reduced(reduced.len()) else { return Ok(Vec::new()) };
    rows.stage("statistics of reduced outputs");
    let shares = rows.shares(true);
    let at_products = rows.products.as_ref().map(|products| (products, kept.values(products.samples.points())));
    let fewer = rows.fewer(TUNING.most_samples_of_numbers / REPLICATES);
    let mut of_number = vec![Replicates::new(&shares); reduced.len()];
    for replicate in 0..REPLICATES {
        rows.progress(replicate, REPLICATES);
        let samples = rows.points(replicate, fewer);
        for (own, values) in of_number.iter_mut().zip(kept.values(samples)) {
            rows.go_on()?;
            own.add(&mut { values });
        }
    }
    let number = |(index, own): (usize, Replicates)| {
        let moments = match &at_products {
            None => Moments::of(&own, kept.error(index)),
            Some((products, values)) => {
                let variate = products.of_reduced(index, &values[index]);
                variate.corrected(&own, kept.error(index), kept.time_error(index))
            }
        };
        NumberStatistics {
            name: reduced[index].name.clone(),
            unit: reduced[index].unit.clone(),
            display: rows.description.display.get(&reduced[index].name).cloned(),
            mean: moments.mean,
            deviation: moments.deviation,
            quantiles: moments.quantiles,
        }
    };
    Ok(of_number.into_iter().enumerate().map(number).collect())
}
