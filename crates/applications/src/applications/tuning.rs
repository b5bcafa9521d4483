//! Constants of all applications.

use symdiff::constants::Constant;

use super::{allocate, cost, design, explain, fit, verify};

/// Constants of the applications, one after the other.
pub fn tuning() -> Vec<Constant> {
    [
        fit::tuning::Tuning::constants(),
        allocate::tuning::Tuning::constants(),
        design::tuning::Tuning::constants(),
        cost::tuning::Tuning::constants(),
        verify::tuning::Tuning::constants(),
        explain::tuning::Tuning::constants(),
    ]
    .concat()
}
