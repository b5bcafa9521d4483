//! Formats of robots' files: text → typed robot with the location of every number. Nothing here knows a model
//! (decision 0156).
//!
//! Both formats share XML with limits of size, numbers that may become parameters, frames and masses.

pub mod algebra;
mod budget;
pub mod masses;
pub mod meshes;
pub mod mjcf;
pub mod names;
pub mod number;
mod prefixes;
pub mod tuning;
pub mod urdf;
pub mod xml;
