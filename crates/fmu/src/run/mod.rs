//! A motion of a unit at a point, and answers to points. A browser loads no libraries: there, nobody answers the task
//! of a unit.

#[cfg(any(unix, windows))]
mod co_simulation;
#[cfg(any(unix, windows))]
mod model_exchange;
#[cfg(any(unix, windows))]
mod steps;
mod task;
pub(crate) mod tuning;
#[cfg(any(unix, windows))]
mod worker;

pub use task::{Access, STEP, Task, Unpacked};
#[cfg(any(unix, windows))]
pub use worker::answer;
