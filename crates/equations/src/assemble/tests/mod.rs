//! Tests of the equations of motion against mechanics done another way: finite differences, virtual power, Lagrange's
//! equations, statics, closed forms.

mod beams;
mod bodies;
mod effects;
mod interaction;
mod joints;
pub mod model;
mod numbers;
mod power;
mod spatial;
mod start;
mod superelements;
mod systems;
