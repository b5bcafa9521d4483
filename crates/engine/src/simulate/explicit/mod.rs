//! Dormand and Prince's explicit method of order 8 on the equations of motion, with the constraints differentiated
//! twice.
//!
//! The accelerations follow from M w + Φ_qᵀ λ = Q and Φ̈ = 0 at every stage; after each step positions and velocities
//! are moved back onto the constraints, by less than the step's error. In joint coordinates of open chains there is
//! nothing to move.
//!
//! - `tableau`: the coefficients;
//! - `runge_kutta`: a step, its errors and its dense output, for states of samples and of jets alike;
//! - `movement`: how far the motion has gone, which errors count against;
//! - `controlling`: the samples that decide on the steps, and where their equations switch;
//! - `steps`: the steps that a tolerance asks for, and obstacles to the method;
//! - `tile`: samples, or a jet, over a schedule;
//! - `listed`: steps that end at given times, and `adjoint`: backwards over them.

mod adjoint;
mod controlling;
mod listed;
pub(in crate::simulate) mod movement;
pub(in crate::simulate) mod runge_kutta;
mod steps;
mod tableau;
mod tile;
pub(crate) mod tuning;

pub(in crate::simulate) use adjoint::{ExplicitAdjoints, ExplicitRow};
pub(in crate::simulate) use listed::ExplicitSteps;
pub use steps::{ExplicitObstacle, explicit_schedule};
pub(crate) use tableau::{DENSE, STAGES, TIMES, WEIGHTS, WITH_DENSE};
pub(in crate::simulate) use tile::{ExplicitJets, ExplicitRun};
