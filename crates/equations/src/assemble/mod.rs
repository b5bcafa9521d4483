//! Description → [`System`]: the equations of motion as expressions.
//!
//! `build` reads like the derivation on paper: symbols and bodies (`mechanism`, `construction`), constraints
//! (`joints`), applied forces (`applied_forces`), inertial forces (`recursion`; `links` their propagation), outputs
//! (`symbols`), and the start of the motion (`start`, `placement` in the plane, `pose` in space, `nearest` for an open
//! start); the model's size (`extent`), and counts of its parts (`inventory`).
//!
//! | symbol  | meaning                                   | unit                       |
//! |---------|-------------------------------------------|----------------------------|
//! | q, v, w | coordinates, velocities, accelerations    | m and rad, per s, per s²   |
//! | λ       | multipliers: M w = Q − Φ_qᵀ λ             | N, N m                     |
//! | r₀, θ   | origin and angle of a body's frame        | m, rad                     |
//! | p, R, ω | Euler parameters, rotation, its velocity  | 1, 1, rad/s                |
//! | s, R s  | point in the body's, in the ground's axes | m                          |
//! | ã b, a⊥ | a × b;  (−a_y, aₓ), a turned by π/2       |                            |

mod acting;
mod analysis;
mod applied_forces;
mod at_guess;
mod build;
mod child;
mod child_guesses;
mod constraints;
mod construction;
mod coordinates;
mod cuts;
mod extent;
mod flexible;
mod formulation;
mod formulation_info;
mod ids;
mod inputs;
mod inventory;
mod joints;
mod links;
mod massless;
mod mechanism;
mod merging;
mod mobilizers;
mod names;
mod nearest;
mod number_formulas;
mod placement;
mod pose;
mod power_balance;
mod powers;
mod questions;
mod reaction;
mod recursion;
mod start;
mod start_conditions;
mod states;
mod sum_of_thrusts;
mod superelement;
mod superelement_inertia;
mod superelement_motion;
mod symbols;
mod system;
mod teeth;
#[cfg(test)]
pub(crate) mod tests;
mod thrust;
mod tree;
pub mod tuning;

pub use crate::multibody::{BuildError, ConditionId, ConstraintId, CoordinateId, EquationId, OutputId};
pub use build::{
    build, closes_loops, has_joints_of_several_axes, in_absolute_coordinates, in_joint_coordinates, joint_elimination,
};
pub use cuts::{cuts_of_several_axes, other_cuts};
pub use formulation_info::FormulationInfo;
pub use inputs::{InputInfo, RandomInput};
pub use inventory::Inventory;
pub use number_formulas::NumberFormulas;
pub use powers::{EffectPower, PowerBalance};
pub use questions::Questions;
pub use system::{
    ConditionOf, ConstraintInfo, CoordinateInfo, Distance, OutputInfo, Overlap, ResidualUnit, SampledState, Start,
    StartCondition, System, UncertainParameter,
};
