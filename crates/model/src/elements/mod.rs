//! The elements of the language: one file each, and one line in a registry.

pub mod effects;
mod excitation;
mod form;
mod glyph;
pub mod joints;
pub mod meshing;
mod random;
pub mod shapes;
mod trajectory;
pub(crate) mod tuning;

pub use excitation::{Class, Excitation};
pub use form::{Bend, Form, Shape, SurfaceAt, Surroundings};
pub use glyph::Glyph;
pub use joints::JointKind;
pub use random::RandomFunction;
pub use trajectory::{Timing, Trajectory, Waypoint};
