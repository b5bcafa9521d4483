//! Trajectories → `Bounds`: which parameters to run, and bounds from their responses over the whole box.
//!
//! A method asks for samples of a [`ParameterBox`] in the coordinates ξ ∈ [−1, 1]^k and bounds the responses:
//!
//! - `ChebyshevBasis`: responses at its nodes → coefficients → [`PolynomialRange`];
//! - [`SparseGrid`]: responses at nodes that grow where they are needed → `SparseTransform` → coefficients in a
//!   [`SparseBasis`], for many parameters → [`SobolDecomposition`];
//! - [`GradientFit`]: responses and their derivatives at few samples → coefficients, for many parameters;
//! - [`TaylorRange`]: the response's jet → range;
//! - [`ScanBounds`]: responses on a [`TensorGrid`] → least and largest;
//! - [`SegmentMotions`]: responses cut at events;
//! - [`pave`]: polynomials and intervals for their values → parameters with which they have these;
//! - [`ExtremeSearch`]: a function that is cheap to evaluate → its extremes, for many parameters;
//! - [`best_step`]: linearised goals and limits → the step within a box at which the least goal is largest.

mod along;
mod bernstein;
mod bisection;
mod brink;
mod cheapest;
mod chebyshev;
mod chebyshev_series;
pub mod clock;
mod course;
mod decay;
mod design;
mod domain;
mod envelope;
mod error;
#[cfg(test)]
mod evaluation;
mod extent;
mod extremes;
mod functions_of_time;
mod gradient_fit;
mod interpolation;
pub mod iso286;
mod lattice;
mod lattices;
mod least_squares;
mod ledger;
mod leja;
mod linear_program;
mod observed_order;
mod paving;
mod peak;
mod point_set;
mod polynomial_range;
mod quadrature;
mod range;
mod ranked;
mod row_space;
mod samples;
mod scan;
mod scan_grid;
mod search;
mod segments;
mod separation;
mod sobol;
mod sparse_basis;
mod sparse_grid;
mod sparse_transform;
mod spectrum;
pub mod statistics;
mod surrogate;
mod taylor;
mod tensor;
mod thinning;
mod time_shift;
pub(crate) mod tuning;

pub use bisection::bisected;
pub use brink::to_brinks;
pub use cheapest::{Linear, Power, cheapest};
pub use chebyshev_series::ChebyshevSeries;
pub use course::{Course, Phase};
pub use decay::truncation;
pub use design::{Design, MOST_AXES};
pub use domain::{ParameterBox, Sample};
pub use error::{
    BandError, SAFETY_OF_STEPS, SAFETY_OF_SURROGATE, carries, held_beside, largest, step_error, surrogate_error,
    time_error, time_error_certified,
};
pub use extent::Extent;
pub use extremes::{ValuesAt, extremes, extremes_from, extremes_near};
pub use functions_of_time::{Cell, FunctionClass, Worst, value};
pub use gradient_fit::{Derivatives, GradientFit};
pub use interpolation::{Interpolation, row_weights};
pub use lattices::Lattices;
pub use least_squares::LeastSquares;
pub use ledger::Ledger;
pub use linear_program::best_step;
pub use observed_order::{Correction, Differences, corrections};
pub use paving::{Boxes, LeastExcess, Paving, PavingLimits, Tubes, least_excess, pave};
pub use point_set::{PointSet, Points, least_of_lines};
pub use polynomial_range::{PolynomialRange, RangeKind};
pub use quadrature::integrals;
pub use range::{EMPTY, Range, error_of_larger, larger, least, limits, most, union};
pub use row_space::{RowSpace, combined, dot};
pub use samples::{TensorGrid, corners, corners_by_slopes, spread, step_validation, validation};
pub use scan::ScanBounds;
pub use scan_grid::ScanGrid;
pub use search::{ExtremeSearch, Extremes};
pub use segments::{
    BoundaryMargins, BranchMotion, CutMotions, STEP_NODES, SegmentMotions, equispaced_weights, step_nodes, step_weights,
};
pub use separation::Separation;
pub use sobol::SobolDecomposition;
pub use sparse_basis::{SparseBasis, SparseWork};
pub use sparse_grid::{SparseGrid, expected};
pub use spectrum::{Bin, Spectrum};
pub use surrogate::{Surrogate, SurrogateWork};
pub use taylor::TaylorRange;
pub use thinning::Thinning;
pub use time_shift::{TimeShift, Turning};
pub use tuning::tuning;
