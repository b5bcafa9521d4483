//! What a model file is made of: elements with their keys, quantities with units, names, and the reader that keeps
//! places.
//!
//! Nothing here knows what a model is: names are those of a [`SymbolTable`], which the model fills as it is read.

mod any_unit;
pub(crate) mod declared;
pub(crate) mod dimension;
pub(crate) mod display_unit;
mod element;
pub(crate) mod formulas;
mod friction;
mod image;
mod kinds;
pub(crate) mod mapping;
mod mesh;
pub(crate) mod motions;
pub(crate) mod names;
mod on_joint;
mod own_names;
mod pairs;
mod places;
pub(crate) mod plane;
pub(crate) mod quantity;
mod range;
pub(crate) mod reader;
pub mod reference;
mod requirement;
mod rotating;
mod standing;
mod suspicious;
mod symbols;
pub(crate) mod tolerance;
pub(crate) mod unit;
mod unit_names;
pub(crate) mod unknown;
mod unread;
pub(crate) mod values;
mod vectors;

pub(crate) use crate::syntax::source::Span;
pub(crate) use crate::syntax::yaml::Node;
pub use element::{
    Checked, Element, ElementDocs, FromNumber, Group, Key, KeyDocs, Value, kind_schema, kinds_schema, not_negative,
    object_schema, one_of, ordered,
};
pub use friction::{FrictionMode, MeshKind};
pub use image::{Image, KeyImage};
pub use kinds::{
    Axis, BodyRef, Components, Direction, Factors, OfAngle, OfPlace, PerAxis, RotatingJoint, SlidingJoint, SpaceAxis,
    SpacePoint,
};
pub use mesh::Mesh;
pub use names::Context;
pub use reader::{Fields, Lengths, Reader};
pub use requirement::{Quantity, Requirement};
pub use rotating::Rotating;
pub use symbols::*;
