//! A work-precision study as data: what accuracy costs in time.

mod front;
mod method;
mod study;

#[cfg(test)]
pub(crate) use study::tests;

pub use front::pareto;
pub use method::{CostMethod, Integrator};
pub use study::{CostPoint, CostReference, CostStudy, Deviation, cost_curves};
