//! The kernel of multibody dynamics: vectors, matrices, rotations, points and frames as expressions. It knows no model description.

mod context;
pub(crate) mod error;
mod matrix;
mod pair;
mod point;
pub(crate) mod rotation;
pub(crate) mod space;
mod vector;

pub use context::Context;
pub use error::BuildError;
pub use matrix::Matrix;
pub use pair::Pair;
pub use point::{Frame, MaterialPoint};
pub use vector::Vector;
