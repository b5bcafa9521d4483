//! System → [`Program`]: tapes for the start, for one step of a scheme, and for the outputs.
//!
//! - `equations`: the equations of motion and the constraints' rates as expressions;
//! - `scheme`: the integration schemes' coefficients;
//! - `newton_matrix`: residual, Newton matrix and new state of a step; `links`: derivatives of deep trees, link by
//!   link;
//! - `sparse_lu`: its factorisation, as expressions; `elimination`: frozen factors in one version or two;
//! - `step` → `program`: the tapes of a step, `first_correction` the correction with the values of a factorisation;
//!   `start`: the tapes of a consistent start (`start_equations`, `start_program`, `start_factors`), `at_sample` the
//!   numbers that it is planned by, `nearest` the least squares of an open start; `rounding`: how exactly constraints
//!   can be computed; `equation_tapes`: the equations alone, `equation_list` the same for certificates;
//! - `powers`: the balance of power as outputs;
//! - `switches`: where the equations switch, as at contacts; `combinations`: numbers through which several parameters
//!   act alone;
//! - `layout`: the memory that all of them share.

mod at_sample;
mod combinations;
mod elimination;
mod equation_list;
mod equation_tapes;
mod equations;
mod first_correction;
mod inertial_change;
mod layout;
mod links;
mod nearest;
mod newton_matrix;
mod powers;
mod program;
mod rounding;
mod scheme;
mod sparse_lu;
mod start;
mod start_equations;
mod start_factors;
mod start_program;
mod step;
mod switches;
mod tapes;
pub mod tuning;

pub use combinations::{Combination, combinations};
pub use equation_list::{AtStart, list_equations};
pub use equation_tapes::{Entries, EquationsProgram, compile_equations};
pub use equations::{ClosureRow, Equation, equations_of_motion, time_derivative};
pub use layout::Layout;
pub use nearest::OpenStart;
pub use powers::{OF_EFFECT, OF_WHOLE, observing_powers};
pub use program::{PivotSample, Program, WatchedPivots};
pub use scheme::{Coefficients, ConstraintLevel, Scheme};
pub use sparse_lu::NoFactors;
pub use start::{compile_nearest_start, compile_start};
pub use start_equations::Residual;
pub use start_program::{SampledValue, StartProgram};
pub use step::compile;
pub use switches::{Switch, SwitchProgram, compile_overlaps, compile_switches, has_kink, jumps};
pub use tapes::Tapes;
