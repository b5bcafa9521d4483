//! Reduced outputs: their distribution, by samples of the surrogate of their values.

use super::rows::Rows;
use super::tuning::TUNING;
use crate::numerics::statistics::{Estimate, REPLICATES, Replicates};
use crate::results::{NumberStatistics, Uncertain};

/// Those whose surrogate is known.
///
/// # Errors
/// At an interruption.
pub(super) fn all(rows: &Rows) -> Result<Vec<NumberStatistics>, String> {
    let reduced = &rows.description.reduced;
    let Some(kept) = rows.kept.reduced(reduced.len()) else { return Ok(Vec::new()) };
    rows.stage("statistics of reduced outputs");
    let (around, shares) = rows.shares(true);
    let at_products = rows.residuals.as_ref().map(|residuals| (residuals, kept.values(&residuals.samples)));
    let fewer = rows.fewer(TUNING.most_samples_of_numbers / REPLICATES);
    let mut of_number = vec![Replicates::new(shares.len()); reduced.len()];
    for replicate in 0..REPLICATES {
        rows.progress(replicate, REPLICATES);
        let samples = rows.points(replicate, fewer);
        for (own, values) in of_number.iter_mut().zip(kept.values(&samples)) {
            rows.go_on()?;
            own.add(&mut { values }, &shares);
        }
    }
    let number = |(index, own): (usize, Replicates)| {
        let (mut mean, quantiles) = (own.mean(), own.quantiles());
        let mut errors = vec![kept.error(index); 2 + quantiles.len() / around];
        if let Some((residuals, values)) = &at_products {
            let residual = residuals.of_reduced(index, &values[index]);
            mean = residual.corrected(mean);
            errors = residual.errors(&quantiles, kept.error(index), kept.time_error(index));
        }
        let with_error = |own: Estimate, error: f64| Uncertain { value: own.value, sampling: own.sampling, error };
        let asked = quantiles.into_iter().step_by(around).zip(&errors[2..]);
        NumberStatistics {
            name: reduced[index].name.clone(),
            unit: reduced[index].unit.clone(),
            display: rows.description.display.get(&reduced[index].name).cloned(),
            mean: with_error(mean, errors[0]),
            deviation: with_error(own.deviation(), errors[1]),
            quantiles: asked.map(|(own, &error)| with_error(own, error)).collect(),
        }
    };
    Ok(of_number.into_iter().enumerate().map(number).collect())
}
