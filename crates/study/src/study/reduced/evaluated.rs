//! Values of reduced outputs and margins in samples, with the methods' bounds of them.

use super::ensemble::{Store, steps_of};
use crate::numerics::Sample;
use crate::study::bounding::Bounded;
use crate::study::problem::Study;

/// Bounds of all values, and the samples that show them.
pub struct Evaluated<'a> {
    pub bounded: &'a Bounded,
    /// Whether something makes all bounds unreliable.
    pub unreliable: bool,
    /// Samples of the box that reached the end so far, with their values.
    pub samples: Vec<(Sample, Vec<f64>)>,
}

impl<'a> Evaluated<'a> {
    /// Evaluated values, with the samples that are stored now.
    pub fn new(study: &Study, bounded: &'a Bounded, unreliable: bool, store: &Store) -> Self {
        let whole = |(sample, channels): (Sample, Vec<f64>)| {
            let is_whole = study.domain.contains(&sample) && channels.iter().all(|value| value.is_finite());
            let mut values = Vec::new();
            store.plan.values.evaluate(&channels, &sample, &mut values);
            is_whole.then_some((sample, values))
        };
        let all = store.samples(steps_of(&bounded.plan.schedule));
        Self { bounded, unreliable, samples: all.into_iter().filter_map(whole).collect() }
    }
}
