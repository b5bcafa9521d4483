//! Hash-consed expressions, symbolic derivatives, and staged tapes evaluated over tiles of samples.
//!
//! The way through: [`formula`] text → [`Formula`] → [`Expr`] in a [`Graph`] → derivatives → tapes → numbers.
//! The crate knows no mechanics.

mod derivative;
mod expr;
pub mod formula;
pub mod jet;
mod scalar;
pub mod sincos;

pub use derivative::SparseMatrix;
pub use expr::{Binary, Expr, Graph, Node, Unary};
pub use formula::{Formula, SyntaxError};
