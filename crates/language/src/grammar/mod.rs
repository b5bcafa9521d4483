//! Grammar of model files: elements with their keys, quantities with units, names, and the reader, which records
//! locations.
//!
//! Nothing here depends on the model: names are those of a [`SymbolTable`], which the model fills as it is read.

mod any_unit;
mod beside_kind;
mod corners;
pub mod declared;
pub mod dimension;
pub mod display_unit;
mod element;
pub mod fits;
pub mod formulas;
mod friction;
mod image;
mod kinds;
pub mod mapping;
pub mod mentions;
mod mesh;
pub mod motions;
pub mod names;
mod notes;
mod on_joint;
mod own_names;
mod pairs;
mod places;
pub mod plane;
pub mod quantity;
mod range;
pub mod reader;
pub mod reference;
pub mod report;
mod requirement;
mod rotating;
mod rotation;
mod sensor;
mod standing;
mod suspicious;
mod symbols;
pub mod tolerance;
pub mod tuning;
pub mod unit;
mod unit_names;
pub mod unknown;
mod unread;
pub mod values;
mod vectors;

pub use crate::syntax::source::Span;
pub use crate::syntax::yaml::Node;
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
pub use reader::{Lengths, Reader};
pub use report::{Fields, Report};
pub use requirement::{Quantity, Requirement};
pub use rotating::Rotating;
pub use rotation::Rotation;
pub use symbols::*;
