//! Expressions: a graph of nodes, built with operators, differentiated and integrated.

mod derivative;
mod folding;
mod graph;
mod integral;
mod node;
mod passes;
mod scalar;
mod spline;
mod spline_error;
mod spline_pieces;
mod spline_range;
mod visits;

pub use derivative::SparseMatrix;
pub use graph::Graph;
pub use node::{Binary, Expr, Node, Unary};
pub(crate) use passes::Choice;
pub use scalar::{Builder, Scalar};
pub use spline::Spline;
pub use spline_error::SplineError;
pub(crate) use spline_range::{SplinePiece, cubic_about, cubic_derivative};
