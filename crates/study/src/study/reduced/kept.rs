//! Reduced outputs and margins as functions of the parameters, stored after the run.

use std::ops::Range;
use std::sync::Arc;

use super::ensemble::Composition;
use super::tuning::TUNING;
use super::values::{ChannelValues, Selection};
use crate::methods::{Closure, KeptSurrogate};
use crate::numerics::{BandError, Points, largest, least_of_lines};

/// The surrogate of all reduced outputs, then of all margins of requirements.
#[derive(Clone, Debug)]
pub struct KeptReduced {
    pub(super) surrogate: KeptSurrogate,
    pub(super) values: Arc<ChannelValues>,
    /// Errors of the values.
    pub(super) errors: Vec<BandError>,
}

impl KeptReduced {
    /// Error of a value anywhere in the box; unknown if it cannot be relied on.
    pub fn value_error(&self, value: usize) -> f64 {
        self.errors[value].decisive(0).unwrap_or(f64::NAN)
    }

    /// Whether all values are within the tolerance.
    pub fn is_resolved(&self) -> bool {
        self.errors.iter().all(|error| !error.unresolved.contains(&true))
    }

    /// The first `count` values at samples of the subsystem's box, one after the other, sample by sample. In parallel,
    /// with the same bits for any number of threads.
    pub fn values(&self, count: usize, samples: Points) -> Vec<f64> {
        let wanted: Vec<usize> = (0..count).collect();
        let closures = self.closures();
        samples.lines(TUNING.samples_at_once, count, &|samples| self.surrogate.values(0, &wanted, samples, &closures))
    }

    /// Error of a requirement's margin anywhere in the box; unknown if it cannot be relied on.
    pub fn error(&self, requirement: usize) -> f64 {
        largest(self.values.parts(requirement).map(|part| self.value_error(part)))
    }

    /// The part of it that a better surrogate would not have.
    pub fn surrogate_error(&self, requirement: usize) -> f64 {
        largest(self.values.parts(requirement).map(|part| self.errors[part].surrogate))
    }

    /// Largest part of the steps in the errors of some values.
    pub(super) fn time_error(&self, values: Range<usize>) -> f64 {
        largest(values.map(|value| self.errors[value].time))
    }

    /// The margins of some requirements alone; they are numbered in this order.
    pub fn only(&self, requirements: &[usize]) -> Self {
        let Selection { values, of, channels } = self.values.only(requirements);
        let errors = of.iter().map(|&value| self.errors[value].clone()).collect();
        Self { surrogate: self.surrogate.only(&channels, &of), values: Arc::new(values), errors }
    }

    /// Margins of all `count` requirements at samples of the subsystem's box, requirement by requirement, sample by
    /// sample; NaN if one is unknown. In parallel, with the same bits for any number of threads.
    pub fn margins(&self, count: usize, samples: Points) -> Vec<f64> {
        let first = if count == 0 { self.values.count() } else { self.values.parts(0).start };
        let wanted: Vec<usize> = (first..self.values.count()).collect();
        let closures = self.closures();
        let of_chunk = |samples: Points| {
            let values = self.surrogate.values(0, &wanted, samples, &closures);
            let of_requirement = |requirement: usize| {
                let Range { start, end } = self.values.parts(requirement);
                least_of_lines(&values[(start - first) * samples.len()..(end - first) * samples.len()], samples.len())
            };
            (0..count).flat_map(of_requirement).collect()
        };
        samples.lines(TUNING.samples_at_once, count, &of_chunk)
    }

    /// Closures that compute values from channels.
    pub(super) fn closures(&self) -> Vec<Box<dyn Closure + '_>> {
        let closure =
            |independent| Box::new(Composition { values: &self.values, independent }) as Box<dyn Closure + '_>;
        self.surrogate.independent().into_iter().map(closure).collect()
    }
}
