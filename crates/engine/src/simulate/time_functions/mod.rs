//! Functions of the time in the equations of motion, enclosed over every step rather than sampled.
//!
//! A scheme sees a force that is prescribed as a function of the time at the ends of its steps only. A pulse between
//! them, or a force with the period of a step, is not seen, with halved steps neither. Here every such function's rate
//! of change is bounded over a whole step and the whole box of parameters, in interval arithmetic: where a function may
//! change by more than its own size within a step, or be switched twice, the step is divided.
//!
//! `terms` finds the functions, `enclosed` encloses one, `resolution` examines all over an interval of time,
//! `resolving_steps` steps along with them.

mod enclosed;
mod resolution;
mod resolving_steps;
mod terms;
pub(crate) mod tuning;

pub(in crate::simulate) use enclosed::Work;
pub use resolution::TimeFunctions;
pub(in crate::simulate) use resolving_steps::ResolvingSteps;
