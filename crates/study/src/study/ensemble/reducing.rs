//! Motions whose outputs are reduced to one number.

use super::Motions;
use crate::numerics::Sample;
use crate::simulate::Channel;
use crate::study::reduced::{Store, steps_of};

impl<'a> Motions<'a> {
    /// The same, which also reduces outputs to one number.
    pub fn keeping(self, store: Option<&'a Store>) -> Self {
        Self { store, channels: store.map_or(&[], |store| &store.plan.channels), ..self }
    }

    /// The same, which reduces outputs to one number by these channels, for others to keep.
    pub fn reducing(self, channels: &'a [Channel]) -> Self {
        Self { channels, ..self }
    }

    /// By what outputs are reduced to one number.
    pub fn channels(&self) -> &'a [Channel] {
        self.channels
    }

    /// Keeps what outputs of samples were reduced to elsewhere.
    pub fn keep_reduced(&self, samples: &[Sample], reduced: &[f64]) {
        if let Some(store) = self.store.filter(|_| !reduced.is_empty()) {
            store.keep(steps_of(self.schedule), samples, reduced);
        }
    }
}
