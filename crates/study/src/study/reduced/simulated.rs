//! Reduced outputs and margins of samples that were simulated.

use super::ensemble::steps_of;
use crate::numerics::Sample;
use crate::simulate::Schedule;
use crate::study::problem::Study;

/// Reduced outputs of each sample, then the margins of requirements; NaN of a sample that does not reach the end.
/// Empty lists if the model reduces and requires nothing.
pub fn values_of_samples(study: &Study, schedule: &Schedule, samples: &[Sample]) -> Vec<Vec<f64>> {
    let Some(store) = study.store.get() else { return vec![Vec::new(); samples.len()] };
    let (steps, values) = (steps_of(schedule), &store.plan.values);
    let (reduced, required) = (study.description.reduced.len(), study.description.requirements.len());
    let of_sample = |sample: &Sample| {
        let Some(channels) = store.get(steps, sample).filter(|own| own.iter().all(|value| !value.is_nan())) else {
            return vec![f64::NAN; reduced + required];
        };
        let mut all = Vec::new();
        values.evaluate(&channels, sample, &mut all);
        let margins = (0..required).map(|requirement| values.margin(requirement, |value| all[value]));
        all[..reduced].iter().copied().chain(margins).collect()
    };
    samples.iter().map(of_sample).collect()
}
