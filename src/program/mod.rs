//! System → [`Program`]: tapes for the start, for one HHT-I3 step, and for what is observed.

mod compile;
mod equations;
mod layout;
mod newton_matrix;
mod sparse_lu;
mod start;

pub use compile::{Probe, Program, WatchedPivot, compile};
pub use equations::{Entries, EquationsProgram, compile_equations};
pub use layout::Layout;
pub use newton_matrix::Coefficients;
pub use sparse_lu::{PROBES, Singular};
pub use start::{StartProgram, compile_start};
