//! What a model file is made of: elements with their keys, quantities with units, names, and the reader that keeps places.
//!
//! Nothing here knows what a model is: names are those of a [`SymbolTable`], which the model fills as it is read.

pub(crate) mod dimension;
pub(crate) mod mapping;
pub(crate) mod motions;
pub(crate) mod names;
mod places;
pub(crate) mod plane;
pub(crate) mod quantity;
pub(crate) mod reader;
mod symbols;
pub(crate) mod values;
mod vectors;

pub use symbols::*;
