//! The kernel of multibody dynamics: vectors, matrices, rotations, points, frames and bodies as expressions. It depends
//! on no model description.

mod body;
mod context;
mod error;
mod ids;
mod inertia;
mod matrix;
mod own_function;
mod pair;
mod point;
mod relative_displacement;
mod relative_motion;
pub mod rotation;
mod vector;
mod wrench;

pub use body::{ANGLE, Attitude, Body, DEGREES_OF_FREEDOM, EULER, RotationCoordinates};
pub use context::Context;
pub use error::BuildError;
pub use ids::{ConditionId, ConstraintId, CoordinateId, EquationId, OutputId};
pub use matrix::Matrix;
pub use own_function::OwnFunction;
pub use pair::Pair;
pub use point::{Frame, MaterialPoint};
pub use relative_displacement::RelativeDisplacement;
pub use relative_motion::{AxisMotion, DegreeOfFreedom, RelativeMotion};
pub use rotation::Quaternion;
pub use vector::Vector;
pub use wrench::Wrench;
