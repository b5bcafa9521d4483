//! Hash-consed expressions, symbolic derivatives, and staged tapes evaluated over tiles of samples.
//!
//! The way through: [`formula`] text → [`Formula`] → [`Expr`] in a [`Graph`] → derivatives → [`lower`] → [`Tape`]s →
//! numbers in a [`Tile`]. The crate knows no mechanics.

mod blocks;
mod builder;
mod derivative;
mod expr;
pub mod formula;
mod integral;
pub mod interval;
pub mod jet;
mod jet_memory;
mod lanes;
mod model_memory;
mod scalar;
mod schedule;
pub mod sincos;
mod slots;
mod spline;
mod stages;
mod steps;
mod tape;
pub mod taylor_model;
mod vectorised;

pub use builder::{Builder, Scalar};
pub use derivative::SparseMatrix;
pub use expr::{Binary, Expr, Graph, Node, Unary};
pub use formula::{Formula, SyntaxError};
pub use interval::Interval;
pub use jet_memory::JetMemory;
pub use lanes::{Tile, WIDTHS};
pub use model_memory::ModelMemory;
pub use schedule::{Lowered, Outputs, lower, lower_where};
pub use spline::{Spline, SplineError};
pub use stages::{Input, Stages};
pub use tape::{Guard, Op, Operands, Tape};
pub use vectorised::{Vectorise, vectorised};
