//! The kernel of multibody dynamics: vectors, matrices and rotations as expressions. It knows no model description.

mod matrix;
mod vector;

pub use matrix::Matrix;
pub use vector::Vector;
