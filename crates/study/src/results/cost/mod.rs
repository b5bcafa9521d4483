//! A work-precision study as data: computing time against accuracy.

#[doc(hidden)]
pub mod example;
mod front;
mod method;
mod study;

pub use front::pareto;
pub use method::{CostMethod, Integrator};
pub use study::{CostPoint, CostReference, CostStudy, Deviation, cost_curves};
