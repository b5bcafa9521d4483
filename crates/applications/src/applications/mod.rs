//! Tasks that ask studies, each by itself.
//!
//! `allocate` searches tolerances, `design` nominal values, `fit` the parameters that agree with measured values;
//! `cost` runs a model with many settings to find the cost of accuracy, `verify` measures orders against manufactured
//! motions, and `explain` lists the parts of a compiled model.

mod allocate;
mod cost;
mod design;
mod explain;
mod fit;
mod tuning;
mod verify;

pub use allocate::{AllocateError, AllocateOptions, allocate};
pub use cost::{CostError, CostOptions, cost};
pub use design::{DesignError, DesignOptions, design};
pub use explain::{explain, language_costs};
pub use fit::{DataError, FitError, Measurements, NoiseBound, fit};
pub use tuning::tuning;
pub use verify::{VerifyError, verify};
