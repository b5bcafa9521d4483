//! The elements of the language: one file each, and one line in a registry.

pub mod effects;
mod glyph;
pub mod joints;
pub mod meshing;
mod trajectory;

pub use glyph::Glyph;
pub use joints::JointKind;
pub use trajectory::{Timing, Trajectory, Waypoint};
