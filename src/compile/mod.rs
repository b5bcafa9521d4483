//! System → [`Program`]: tapes for the start, for one step of a scheme, and for what is observed.

mod elimination;
mod equation_tapes;
mod equations;
mod layout;
mod newton_matrix;
mod scheme;
mod sparse_lu;
mod start;
mod step;

pub use equation_tapes::{Entries, EquationsProgram, compile_equations};
pub use layout::Layout;
pub use scheme::{Coefficients, ConstraintLevel, Scheme};
pub use sparse_lu::{NoFactors, PIVOT_SAMPLES};
pub use start::{StartProgram, compile_start};
pub use step::{Mode, PivotSample, Program, Watched, WatchedPivot, compile};
