//! The kernel of multibody dynamics: vectors, matrices, rotations, points and frames as expressions. It knows no model description.

mod context;
pub(crate) mod error;
#[allow(dead_code)] // for the assembly of equations, which does not use it yet
mod matrix;
mod pair;
mod point;
pub(crate) mod rotation;
pub(crate) mod space;
mod vector;

pub use context::Context;
pub use error::BuildError;
#[allow(unused_imports)] // as above
pub use matrix::Matrix;
pub use pair::Pair;
pub use point::{Frame, MaterialPoint};
pub use vector::Vector;
