//! Description → [`System`]: the equations of motion as expressions.
//!
//! `build` reads like the derivation on paper: symbols and bodies (`mechanism`, `body`), constraints
//! (`joints`), applied forces (`applied_forces`), inertia, outputs, and where the motion starts (`start`, `placement` in the plane,
//! `pose` in space).
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
mod applied_forces;
mod body;
mod build;
mod carried;
mod coordinates;
mod flexible;
mod formulation;
mod inertia;
mod joints;
mod mechanism;
mod merging;
mod outputs;
mod placement;
mod pose;
mod recursion;
mod start;
mod system;
#[cfg(test)]
pub(crate) mod tests;
mod tree;

use crate::multibody::{error, rotation, space};

pub use build::{build, in_absolute_coordinates, in_joint_coordinates};
pub use error::BuildError;
pub use system::{ConstraintInfo, FormulationInfo, ResidualUnit, StartCondition, System};
