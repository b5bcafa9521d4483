//! A motion of a unit at a point, and answers to points.

mod co_simulation;
mod model_exchange;
mod steps;
mod task;
mod worker;

pub use task::{Access, STEP, Task, Unpacked};
pub use worker::answer;
