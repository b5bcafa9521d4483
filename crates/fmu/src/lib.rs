//! Units of FMI 2.0 and 3.0 (FMUs): the file and its description (`unit`), its library (`native`), and answers to
//! points, by co-simulation or by integrating its equations (`run`).
//!
//! A unit is native code that may do anything, and may end its process. So the room `run` is for a separate process,
//! which answers in the JSON lines of a black box. Standard: <https://fmi-standard.org>, 2.0.5 and 3.0.2.

#![deny(unsafe_code)]

#[cfg(any(unix, windows))]
mod native;
mod run;
mod unit;

use symdiff::constants::Constant;

#[cfg(any(unix, windows))]
pub use native::Fault;
#[cfg(any(unix, windows))]
pub use run::answer;
pub use run::{Access, STEP, Task, Unpacked};
pub use unit::{BaseUnit, Interface, NotRead, NumberType, Unit, Variable, Version, digest};

/// Constants of units, room by room.
pub fn tuning() -> Vec<Constant> {
    [unit::tuning::Tuning::constants(), run::tuning::Tuning::constants()].concat()
}
