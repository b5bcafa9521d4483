//! The elements of a model, one file each: what it is made of and what follows from that alone.

pub mod joints;

pub use joints::JointKind;
