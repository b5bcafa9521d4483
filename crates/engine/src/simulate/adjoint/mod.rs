//! Derivatives of outputs by all parameters at once: the discrete adjoint of a motion.
//!
//! A motion is a chain of maps: the start, steps, rows of output. Jets push derivatives forwards, one for each
//! parameter; here they are pulled backwards from one output in one row, whatever the number of parameters, by
//! following the same tapes in reverse ([`symdiff::Adjoints`]). So a gradient costs a few simulations. Each lane of a
//! tile is a gradient of its own.
//!
//! - `functional`: sums of outputs that are differentiated;
//! - `formulas`: formulas of parameters, which need no motion;
//! - `start`: fixed points of corrections, and the start;
//! - `path`: states between steps, in bounded memory;
//! - `steps`: the scheme, on one level or several; `explicit::adjoint` has the explicit method;
//! - `rows`: outputs of a row;
//! - `cells`: functions of the time that are inputs, and adjoints of these;
//! - `tiles`: gradients in lanes.

mod cells;
mod formulas;
mod functional;
mod path;
mod rows;
mod start;
mod steps;
mod tiles;
pub(crate) mod tuning;

pub use cells::CellFunctions;
pub(in crate::simulate) use cells::{TileInputs, TileKernel};
pub use functional::{Functional, Term, Wanted};
pub(in crate::simulate) use path::{Stepping, TilePath};
pub(in crate::simulate) use rows::{LaneTerm, RowAdjoints};
pub(in crate::simulate) use start::StartAdjoints;
pub use tiles::{Gradient, NoGradient, Under, gradients, gradients_under};

/// Adds values times a factor.
pub(in crate::simulate) fn add(to: &mut [f64], factor: f64, values: &[f64]) {
    to.iter_mut().zip(values).for_each(|(to, value)| *to += factor * value);
}
