//! Hash-consed expressions, symbolic derivatives, and tapes of instructions evaluated over tiles of samples.
//!
//! The data flow: text → [`Formula`] → [`Expr`] in a [`Graph`] → derivatives → [`lower`] → [`Tape`]s → numbers in a
//! [`Tile`], with twice the digits in a [`DoubleDoubleMemory`], polynomials in a [`JetMemory`], or enclosures in a
//! [`ModelMemory`].
//!
//! ```
//! use symdiff::{Builder, Input, Tile, lower};
//!
//! // ∂/∂x (x² sin y), symbolically.
//! let builder = Builder::new();
//! let [x, y] = ["x", "y"].map(|name| builder.variable(name));
//! let derivative = (x * x * y.sin()).derivative(x);
//!
//! // As a tape, over four samples at once: x and y stand in the first two registers.
//! let inputs = [(x, 0), (y, 1)].map(|(symbol, register)| Input { symbol: symbol.expr(), stage: 0, register });
//! let lowered = lower(&builder.graph(), &inputs, 0, 2, &[vec![(derivative.expr(), None)]]);
//! let mut tile = Tile::new(4, lowered.registers, &lowered.constants);
//! tile.lane_mut(0).copy_from_slice(&[0.0, 1.0, 2.0, 3.0]);
//! tile.lane_mut(1).fill(std::f64::consts::FRAC_PI_2);
//! tile.run(&lowered.kernels[0]);
//! assert_eq!(tile.lane(lowered.outputs[0][0] as usize), [0.0, 2.0, 4.0, 6.0]);
//! ```

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

pub mod constants;
pub mod eval;
mod expr;
pub mod formula;
mod lower;
mod slopes;
pub mod tuning;

pub use eval::double_double::{DoubleDouble, DoubleDoubleMemory};
pub use eval::interval::Interval;
pub use eval::jet::JetMemory;
pub use eval::taylor_model::ModelMemory;
pub use eval::tile::{Tile, WIDTHS};
pub use eval::{
    Adjoints, LaneWork, Ranges, Vectorise, in_lanes, instruction_set, interval, jet, lanes, lanes_mut, math, sincos,
    taylor_model, vectorised,
};
pub use expr::{Binary, Builder, Expr, Graph, Node, Scalar, SparseMatrix, Spline, SplineError, Unary};
pub use formula::{Formula, SyntaxError};
pub use lower::{
    CWriter, Guard, Input, Lowered, Op, Operands, Outputs, Stages, Tape, c_number, lower, lower_where, with_reciprocals,
};
pub use slopes::slopes;
