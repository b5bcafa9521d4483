//! Description → [`System`]: the equations of motion as expressions.

mod system;

pub use system::{ConstraintInfo, CoordinateInfo, OutputInfo, Start, System, UncertainParameter};
