//! The elements of a model, one file each: what it is made of and what follows from that alone.

mod index;
pub mod joints;

pub use index::{AngleOf, JointCoordinate, OnJoint, PointRef};
pub use joints::JointKind;
