//! Shapes of bodies, for pictures: nothing of the motion depends on them.
//!
//! To add one: its file here, and its line in the registry below. Keys, schema and documentation follow from the file.

mod registry;

use mbint_derive::Element;
use symdiff::Formula;

use self::registry::shapes;
use super::form::{Form, Shape};
use crate::grammar::{Element, FromNumber, Rotation, SpacePoint};

shapes! {
    cuboid::Cuboid,
    cylinder::Cylinder,
    sphere::Sphere,
    capsule::Capsule,
    outline::Outline,
    mesh::MeshShape,
}

/// A kind of shape; its field `place` is its frame in the body's.
pub trait ShapeElement: Element {
    /// Its form, in its frame.
    fn form(&self) -> Form<Formula>;
}

/// The frame of a shape.
#[derive(Clone, Debug, Element)]
pub struct ShapeFrame {
    /// Position of its frame in the body's frame; z may be given in the plane, too.
    #[quantity(unit = "m", constant)]
    #[key(default = SpacePoint::from_number(0.0))]
    pub position: SpacePoint,
    /// Rotation of its frame against the body's.
    #[key(otherwise = "none")]
    pub rotation: Option<Rotation>,
}
