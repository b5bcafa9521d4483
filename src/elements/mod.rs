//! The elements of the language: one file each, and one line in a registry.

pub mod effects;
pub mod joints;

pub use joints::JointKind;
