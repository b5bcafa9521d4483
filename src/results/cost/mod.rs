//! A work-precision study as data: what accuracy costs in time.

mod front;
mod study;

#[cfg(test)]
pub(crate) use study::tests;

pub use front::pareto;
pub use study::{CostMethod, CostPoint, CostReference, CostStudy, Deviation, cost_curves};
