//! What the readers of robots' files share: XML with places and limits of size, numbers that may be parameters, frames
//! and masses.

pub mod algebra;
mod budget;
pub mod masses;
pub mod meshes;
pub mod names;
pub mod numbers;
mod prefixes;
pub mod xml;
