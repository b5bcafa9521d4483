//! Types of values of keys: formulas, vectors, directions, references, groups of them.

use std::ops::Deref;

use schemars::{Schema, SchemaGenerator, json_schema};
use symdiff::Formula;

use super::element::{FromNumber, Key, Value, number_as_json};
use super::image::Image;
use super::plane;
use super::quantity::Dimension;
use super::reader::Reader;
use super::requirement::Quantity;
use super::rotating::Rotating;
use super::rotation::Rotation;
use super::symbols::{JointCoordinate, PointRef, Reference, SymbolTable};
use super::values;
use crate::syntax::source::Span;
use crate::syntax::yaml::{self, Node};

impl Value for Formula {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _at: Span, quantity: &Quantity) -> Option<Self> {
        reader.quantity(node, quantity)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<values::Number>()
    }

    fn to_json(&self) -> Option<serde_json::Value> {
        self.as_number().map(number_as_json)
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.push(self);
    }
}

impl FromNumber for Formula {
    fn from_number(value: f64) -> Self {
        Self::number(value)
    }
}

/// Formulas of parameters and of a variable of the element.
macro_rules! of_variable {
    ($($(#[$doc:meta])* $name:ident, $variable:literal, $dimension:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name(pub Formula);

        impl $name {
            /// The name of the variable in the formula.
            pub const VARIABLE: &'static str = $variable;
        }

        impl Value for $name {
            const IMAGE: Image = Image::Unknown;

            fn read<S: SymbolTable>(
                reader: &mut Reader<'_, S>,
                node: &Node,
                _at: Span,
                quantity: &Quantity,
            ) -> Option<Self> {
                reader.variable = Some((Self::VARIABLE, $dimension));
                let formula = reader.quantity(node, quantity);
                reader.variable = None;
                formula.map(Self)
            }

            fn schema(generator: &mut SchemaGenerator) -> Schema {
                Formula::schema(generator)
            }

            fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
                found.push(&self.0);
            }
        }
    )*};
}

of_variable! {
    /// A formula of parameters and of the element's own `angle`, rad.
    OfAngle, "angle", Dimension::ANGLE;
    /// A formula of parameters and of the element's own `x`, m.
    OfPlace, "x", Dimension::LENGTH;
}

impl<T: Value> Value for Option<T> {
    const IMAGE: Image = T::IMAGE;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span, quantity: &Quantity) -> Option<Self> {
        T::read(reader, node, at, quantity).map(Some)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        T::schema(generator)
    }

    fn keys() -> Vec<Key> {
        T::keys()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        self.iter().for_each(|value| value.formulas(found));
    }

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        self.iter_mut().for_each(|value| value.references(found));
    }

    fn leaves_plane(node: &Node) -> bool {
        T::leaves_plane(node)
    }
}

/// Vectors that are read in different ways.
macro_rules! vector {
    ($($(#[$doc:meta])* $name:ident, image $image:ident, schema $schema:ty, leaves $leaves:path, read $read:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name(pub [Formula; 3]);

        impl Deref for $name {
            type Target = [Formula; 3];

            fn deref(&self) -> &[Formula; 3] {
                &self.0
            }
        }

        impl FromNumber for $name {
            fn from_number(value: f64) -> Self {
                Self([value; 3].map(Formula::number))
            }
        }

        impl Value for $name {
            const IMAGE: Image = Image::$image;

            fn read<S: SymbolTable>(
                reader: &mut Reader<'_, S>,
                node: &Node,
                _at: Span,
                quantity: &Quantity,
            ) -> Option<Self> {
                let read: fn(&mut Reader<'_, S>, &Node, &Quantity) -> Option<[Formula; 3]> = $read;
                read(reader, node, quantity).map(Self)
            }

            fn schema(generator: &mut SchemaGenerator) -> Schema {
                generator.subschema_for::<$schema>()
            }

            fn to_json(&self) -> Option<serde_json::Value> {
                vector_as_json(&self.0)
            }

            fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
                found.extend(&self.0);
            }

            fn leaves_plane(node: &Node) -> bool {
                $leaves(node)
            }
        }
    )*};
}

vector! {
    /// Components along x and y, and in space along z.
    Components, image Polar, schema values::Components, leaves plane::points_out,
    read |reader, node, quantity| reader.components(node, quantity.context, quantity.dimension());
    /// A direction along which something moves, of any length but zero.
    Direction, image Polar, schema values::Direction, leaves plane::points_out,
    read |reader, node, _| reader.direction(node);
    /// An axis about which something turns, of any length but zero.
    Axis, image Polar, schema values::Direction, leaves plane::rotates_out,
    read |reader, node, _| reader.rotation_axis(node);
    /// A number for each axis of a frame, or one for all.
    PerAxis, image Same, schema values::PerAxis, leaves nothing_leaves,
    read |reader, node, quantity| match node.value {
        yaml::Value::Sequence(_) => reader.three(node, quantity.context, quantity.dimension()),
        _ => reader.quantity(node, quantity).map(|all| [all.clone(), all.clone(), all]),
    };
    /// Components along x and y, and along z also in a planar model.
    SpacePoint, image Polar, schema values::Components, leaves nothing_leaves,
    read |reader, node, quantity| reader.components_in_space(node, quantity.context, quantity.dimension());
    /// An axis of a shape: any axis, also in a planar model.
    SpaceAxis, image Polar, schema values::Direction, leaves nothing_leaves,
    read |reader, node, _| reader.axis(node);
    /// Factors along the axes of a frame, or one for all; negative ones reflect.
    Factors, image Factors, schema values::PerAxis, leaves nothing_leaves,
    read |reader, node, quantity| match node.value {
        yaml::Value::Sequence(_) => reader.three(node, quantity.context, quantity.dimension()),
        _ => reader.quantity(node, quantity).map(|all| [all.clone(), all.clone(), all]),
    };
}

impl SpaceAxis {
    /// z.
    pub fn z() -> Self {
        Self(unit_vector(2))
    }
}

/// Rotation of a shape: any rotation, also in a planar model.
impl Value for Rotation {
    const IMAGE: Image = Image::Rotation;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span, _quantity: &Quantity) -> Option<Self> {
        reader.rotation_in_space(node, at)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<values::Rotation>()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        match self {
            Self::RollPitchYaw(angles) => found.extend(angles),
            Self::AxisAngle(axis, angle) => found.extend(axis.iter().chain([angle])),
            Self::Quaternion(parameters) => found.extend(parameters),
        }
    }
}

fn nothing_leaves(_: &Node) -> bool {
    false
}

/// JSON of a vector: the axis of a unit vector, the number of equal components, else a list; `None` if a component is
/// not a number.
fn vector_as_json(vector: &[Formula; 3]) -> Option<serde_json::Value> {
    let [x, y, z] = [vector[0].as_number()?, vector[1].as_number()?, vector[2].as_number()?];
    Some(match [x, y, z] {
        [1.0, 0.0, 0.0] => "x".into(),
        [0.0, 1.0, 0.0] => "y".into(),
        [0.0, 0.0, 1.0] => "z".into(),
        _ if x == y && y == z => number_as_json(x),
        all => all.map(number_as_json).to_vec().into(),
    })
}

/// The unit vector along an axis, 0 to 2.
fn unit_vector(axis: usize) -> [Formula; 3] {
    std::array::from_fn(|other| Formula::number(f64::from(u8::from(axis == other))))
}

impl Direction {
    /// The unit vector along an axis, 0 to 2.
    pub fn along(axis: usize) -> Self {
        Self(unit_vector(axis))
    }
}

/// A direction in the first point's frame, and one in the second's.
impl Value for [Direction; 2] {
    const IMAGE: Image = Image::Polars;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _at: Span, _quantity: &Quantity) -> Option<Self> {
        let [first, second] = reader.two(node, "a list of two directions")?.map(|node| reader.direction(node));
        Some([Direction(first?), Direction(second?)])
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<[values::Direction; 2]>()
    }

    fn to_json(&self) -> Option<serde_json::Value> {
        self.iter().map(|direction| vector_as_json(&direction.0)).collect()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(self.iter().flat_map(|direction| &direction.0));
    }

    fn leaves_plane(node: &Node) -> bool {
        matches!(&node.value, yaml::Value::Sequence(items) if items.iter().any(plane::points_out))
    }
}

impl Axis {
    /// z.
    pub fn z() -> Self {
        Self(unit_vector(2))
    }
}

/// References, each by a method of the reader.
macro_rules! reference {
    ($($ty:ty, $schema:expr, $read:expr, |$value:ident, $found:ident| $visit:expr;)*) => {$(
        impl Value for $ty {
            fn read<S: SymbolTable>(
                reader: &mut Reader<'_, S>,
                node: &Node,
                _at: Span,
                _quantity: &Quantity,
            ) -> Option<Self> {
                let read: fn(&mut Reader<'_, S>, &Node) -> Option<Self> = $read;
                read(reader, node)
            }

            fn schema(_: &mut SchemaGenerator) -> Schema {
                $schema
            }

            fn references<'a>(&'a mut self, $found: &mut Vec<Reference<'a>>) {
                let $value = self;
                $visit;
            }
        }
    )*};
}

pub(super) fn name() -> Schema {
    json_schema!({ "type": "string" })
}

fn two_names() -> Schema {
    json_schema!({ "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 })
}

/// A body, by index; 0 is the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyRef(pub usize);

/// A joint with an angle, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RotatingJoint(pub usize);

/// A joint with a displacement, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlidingJoint(pub usize);

reference! {
    PointRef, name(), |reader, node| reader.point_ref(node), |point, found| found.push(Reference::Point(point));
    BodyRef, name(), |reader, node| reader.body_ref(node).map(BodyRef), |body, found| found.push(Reference::Body(&mut body.0));
    RotatingJoint, name(), |reader, node| reader.joint_ref(node, JointCoordinate::Angle).map(RotatingJoint),
        |joint, found| found.push(Reference::Joint(&mut joint.0));
    SlidingJoint, name(), |reader, node| reader.joint_ref(node, JointCoordinate::Displacement).map(SlidingJoint),
        |joint, found| found.push(Reference::Joint(&mut joint.0));
    [PointRef; 2], two_names(), |reader, node| reader.between_points(node),
        |points, found| found.extend(points.iter_mut().map(Reference::Point));
    Vec<PointRef>, json_schema!({ "type": "array", "items": { "type": "string" }, "minItems": 1 }),
        |reader, node| reader.points(node), |points, found| found.extend(points.iter_mut().map(Reference::Point));
    [BodyRef; 2], two_names(), |reader, node| reader.between_bodies(node).map(|bodies| bodies.map(BodyRef)),
        |bodies, found| found.extend(bodies.iter_mut().map(|body| Reference::Body(&mut body.0)));
    [Rotating; 2], two_names(), |reader, node| reader.two_rotating(node),
        |pair, found| for rotating in pair {
            match rotating {
                Rotating::Body { body, ground: 0 } => found.push(Reference::Body(body)),
                Rotating::Body { body, ground } => found.extend([Reference::Body(body), Reference::Body(ground)]),
                Rotating::Joint(joint) => found.push(Reference::Joint(joint)),
            }
        };
}
