//! Progress of a run.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Progress of a run, in simulations times rows.
pub(in crate::study) struct Progress<'a> {
    done: AtomicUsize,
    total: usize,
    report: &'a (dyn Fn(f64) + Sync),
}

impl<'a> Progress<'a> {
    /// Progress before the first simulation.
    pub fn new(total: usize, report: &'a (dyn Fn(f64) + Sync)) -> Self {
        Self { done: AtomicUsize::new(0), total, report }
    }

    pub fn advance(&self, work: usize) {
        let done = self.done.fetch_add(work, Ordering::Relaxed) + work;
        (self.report)((done as f64 / self.total as f64).min(1.0));
    }
}
