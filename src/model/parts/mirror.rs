//! `mirror: y`: what the entries of an instance are in the image that a mirror shows.
//!
//! M is the reflection at the plane through the instance's origin across the axis. A body at r with the rotation R is at M r with M R M,
//! so a polar vector v of any frame becomes M v, an axial one, of a rotation or a torque, −M v. Axes of joints are reflected as polar vectors;
//! so their angles count the other way, in the plane and in space.

use super::Writer;
use crate::syntax::mirrors::Mirrors;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// What a value is to a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Image {
    /// A vector, or an axis by its letter.
    Polar,
    /// A vector of a torque; one number is about z.
    Axial,
    /// A list of polar vectors.
    Polars,
    /// A mapping with a polar vector `direction`.
    Directed,
    /// A number that counts the other way where the joint of `on` turns, or there is none.
    Turning,
    /// The name of its key changes place with the other's, and it counts the other way.
    End,
}

use Image::{Axial, Directed, End, Polar, Polars, Turning};

/// Kinds of joints and effects that can be mirrored, with the keys whose values have another image than themselves.
const KINDS: [(&str, &[(&str, Image)]); 41] = [
    ("revolute", &[("axis", Polar)]),
    ("prismatic", &[("axis", Polar), ("angle", Turning)]),
    ("spherical", &[]),
    ("distance", &[]),
    ("fixed", &[("angle", Turning)]),
    ("point_on_line", &[("axis", Polar)]),
    ("point_on_plane", &[("normal", Polar)]),
    ("planar", &[("normal", Polar)]),
    ("pin_in_slot", &[("axis", Polar)]),
    ("universal", &[("axes", Polars)]),
    ("motor", &[("position", Turning), ("speed", Turning), ("to", Turning), ("from", Turning)]),
    ("gear", &[("offset", Turning), ("helix_angle", Turning)]),
    ("rack", &[("radius", Turning), ("helix_angle", Turning)]),
    ("planetary", &[("offset", Turning)]),
    ("worm", &[("lead_angle", Turning), ("offset", Turning)]),
    // The wheel changes the side of a rail that keeps its direction.
    ("rolling", &[("axis", Axial), ("offset", Turning)]),
    ("rolling_on_plane", &[("normal", Polar), ("axle", Polar)]),
    ("tooth_friction", &[]),
    ("spring_damper", &[("along", Polar)]),
    ("cable", &[]),
    ("drag", &[("wind", Polar)]),
    ("force", &[("value", Polar)]),
    ("joint_friction", &[]),
    ("stop", &[("lower", End), ("upper", End)]),
    ("servo", &[("target", Turning), ("target_rate", Turning)]),
    ("torsional_spring_damper", &[("free_angle", Turning), ("torque", Turning)]),
    ("clearance_joint", &[("axis", Polar)]),
    ("torque", &[("value", Axial)]),
    ("bushing", &[]),
    ("gravity", &[]),
    ("preload", &[]),
    ("filter", &[]),
    ("delay", &[]),
    ("sampled", &[]),
    ("rate_limit", &[]),
    ("pid", &[("target", Turning), ("target_rate", Turning), ("initial", Turning)]),
    ("dc_motor", &[("voltage", Turning), ("initial", Turning)]),
    ("hydraulic_cylinder", &[]),
    ("gas_spring", &[]),
    ("tyre", &[("steer", Axial)]),
    (
        "contact",
        &[
            ("plane", Polar),
            ("axis", Polar),
            ("path", Polars),
            ("polygon", Polars),
            ("capsule", Polars),
            ("hull", Polars),
            ("corners", Polars),
            ("line", Polars),
            ("cylinder", Polars),
            ("polyhedron", Polars),
            ("friction_along", Directed),
        ],
    ),
];

/// Keys of which nobody says what their images are.
const REFUSED: [(&str, &str); 4] =
    [("contact", "height"), ("bushing", "stiffness_matrix"), ("bushing", "damping_matrix"), ("preload", "on")];

/// The image of a point, or of an arc to one, which turns the other way.
fn point_or_arc(item: &mut Node, axis: usize) {
    let Value::Mapping(keys) = &mut item.value else { return polar(item, axis) };
    for key in keys {
        match key.key.as_str() {
            "to" => polar(&mut key.value, axis),
            "radius" if axis < 2 => negate(&mut key.value),
            _ => {}
        }
    }
}

impl Writer<'_, '_> {
    /// The image of a joint or an effect; `is_turning` says whether it is on a joint that turns, if on one.
    pub(super) fn image_of_kind(&mut self, entry: &mut Entry, mirrors: Mirrors, is_turning: Option<bool>) {
        let Value::Mapping(kinds) = &mut entry.value.value else { return };
        let [kind] = kinds.as_mut_slice() else { return };
        let Some((_, images)) = KINDS.iter().find(|(keyword, _)| *keyword == kind.key) else {
            let message = format!("`{}` cannot be mirrored", clip(&kind.key));
            let help = "write the mirrored assembly out, or give the parts that differ to the model".to_owned();
            self.reader.error(kind.key_span.clone(), message, help);
            return;
        };
        if let Value::Sequence(_) = kind.value.value {
            // The short form, of which the axis may need to be said.
            let between =
                Entry { key: "between".to_owned(), key_span: kind.key_span.clone(), value: kind.value.clone() };
            kind.value.value = Value::Mapping(vec![between]);
        }
        let Value::Mapping(keys) = &mut kind.value.value else { return };
        for (_, key) in REFUSED.iter().filter(|(keyword, _)| *keyword == kind.key) {
            if let Some(found) = keys.iter().find(|known| known.key == *key) {
                let message = format!("`{key}` of a `{}` cannot be mirrored", kind.key);
                self.reader.error(found.key_span.clone(), message, None);
            }
        }
        let is_of_joint = kind.key == "torque" && is_turning == Some(true);
        let is_directed = matches!(kind.key.as_str(), "revolute" | "clearance_joint");
        let place = kind.key_span.clone();
        for axis in mirrors.axes() {
            for key in keys.iter_mut() {
                let Some((_, image)) = images.iter().find(|(known, _)| *known == key.key) else { continue };
                match image {
                    Axial if is_of_joint => negate(&mut key.value),
                    Turning | End if is_turning == Some(false) => {}
                    image => image_of_key(key, *image, axis),
                }
            }
            // An axis along z that is not written is reflected, too.
            if is_directed && axis == 2 && !keys.iter().any(|key| key.key == "axis") {
                let number = |text| Node { span: place.clone(), value: Value::Scalar(Scalar::plain(text, None)) };
                let value = Node { span: place.clone(), value: Value::Sequence(["0", "0", "-1"].map(number).into()) };
                keys.push(Entry { key: "axis".to_owned(), key_span: place.clone(), value });
            }
        }
    }

    /// The image of a body.
    pub(super) fn image_of_body(&mut self, entry: &mut Entry, mirrors: Mirrors) {
        let Value::Mapping(keys) = &mut entry.value.value else { return };
        if let Some(beam) = keys.iter().find(|key| key.key == "beam" && mirrors.axes().next().is_some()) {
            self.reader.error(beam.key_span.clone(), "a beam that bends cannot be mirrored", None);
        }
        for axis in mirrors.axes() {
            keys.iter_mut().for_each(|key| image_of_part(key, axis));
        }
    }
}

/// The image of what a key of a body says.
fn image_of_part(key: &mut Entry, axis: usize) {
    match (key.key.as_str(), &mut key.value.value) {
        ("center_of_mass", _) => polar(&mut key.value, axis),
        ("inertia", _) => products(&mut key.value, axis),
        ("points", Value::Mapping(points)) => points.iter_mut().for_each(|point| frame(&mut point.value, axis)),
        ("held", Value::Mapping(held)) => {
            for value in held {
                match value.key.as_str() {
                    "orientation" => rotation(&mut value.value, axis),
                    coordinate if counts_back(coordinate, axis) => negate(&mut value.value),
                    _ => {}
                }
            }
        }
        _ => {}
    }
}

/// Whether the image of an effect is another where it is on a joint that turns.
pub(super) fn tells_turns(effect: &Entry) -> bool {
    has_image(effect, &[Turning, End])
}

/// Whether what an effect measures along a joint that turns counts the other way in a mirror.
pub(super) fn measures_turns(effect: &Entry) -> bool {
    has_image(effect, &[Turning])
}

fn has_image(effect: &Entry, wanted: &[Image]) -> bool {
    let Value::Mapping(kinds) = &effect.value.value else { return false };
    let images = KINDS.iter().find(|(keyword, _)| kinds.first().is_some_and(|kind| kind.key == *keyword));
    images.is_some_and(|(_, images)| images.iter().any(|(_, image)| wanted.contains(image)))
}

/// The image of what stands behind a key.
fn image_of_key(key: &mut Entry, image: Image, axis: usize) {
    match image {
        Polar => polar(&mut key.value, axis),
        Axial => axial(&mut key.value, axis),
        Polars => {
            if let Value::Sequence(items) = &mut key.value.value {
                items.iter_mut().for_each(|item| point_or_arc(item, axis));
            }
        }
        Directed => {
            if let Value::Mapping(keys) = &mut key.value.value {
                let directions = keys.iter_mut().filter(|key| key.key == "direction");
                directions.for_each(|key| polar(&mut key.value, axis));
            }
        }
        Turning => negate(&mut key.value),
        End => {
            negate(&mut key.value);
            key.key = if key.key == "lower" { "upper" } else { "lower" }.to_owned();
        }
    }
}

/// Whether a coordinate of a body, or its rate, changes sign.
fn counts_back(coordinate: &str, axis: usize) -> bool {
    let letter = ["x", "y", "z"][axis];
    match coordinate {
        "angle" | "angular_velocity" => axis != 2,
        _ => coordinate.strip_prefix('v').unwrap_or(coordinate) == letter,
    }
}

/// A point: its place, or its frame.
pub(super) fn frame(node: &mut Node, axis: usize) {
    let Value::Mapping(keys) = &mut node.value else { return polar(node, axis) };
    for key in keys {
        match key.key.as_str() {
            "position" => polar(&mut key.value, axis),
            "rotation" => rotation(&mut key.value, axis),
            _ => {}
        }
    }
}

/// A rotation S becomes M S M: its axis is axial, its angle stays.
pub(super) fn rotation(node: &mut Node, axis: usize) {
    let Value::Mapping(keys) = &mut node.value else { return };
    for key in keys {
        match key.key.as_str() {
            "rpy" | "axis" => axial(&mut key.value, axis),
            "quaternion" => {
                let Value::Sequence(items) = &mut key.value.value else { continue };
                items
                    .iter_mut()
                    .skip(1)
                    .enumerate()
                    .filter(|(place, _)| *place != axis)
                    .for_each(|(_, item)| negate(item));
            }
            _ => {}
        }
    }
}

/// Products of inertia of which one axis is the mirror's.
fn products(node: &mut Node, axis: usize) {
    let Value::Mapping(keys) = &mut node.value else { return };
    let letter = ["x", "y", "z"][axis];
    for key in keys.iter_mut().filter(|key| matches!(key.key.as_str(), "xy" | "xz" | "yz") && key.key.contains(letter))
    {
        negate(&mut key.value);
    }
}

fn polar(node: &mut Node, axis: usize) {
    written_out(node);
    if let Value::Sequence(items) = &mut node.value
        && let Some(item) = items.get_mut(axis)
    {
        negate(item);
    }
}

pub(super) fn axial(node: &mut Node, axis: usize) {
    written_out(node);
    match &mut node.value {
        Value::Sequence(items) => {
            items.iter_mut().enumerate().filter(|(place, _)| *place != axis).for_each(|(_, item)| negate(item));
        }
        _ if axis != 2 => negate(node),
        _ => {}
    }
}

/// An axis by its letter as a list.
pub(super) fn written_out(node: &mut Node) {
    let Some(place) = node.scalar().and_then(|scalar| ["x", "y", "z"].iter().position(|axis| *axis == scalar.text))
    else {
        return;
    };
    let one = |axis: usize| {
        let text = if axis == place { "1" } else { "0" };
        Node { span: node.span.clone(), value: Value::Scalar(Scalar::plain(text, None)) }
    };
    let last = if place == 2 { 3 } else { 2 };
    node.value = Value::Sequence((0..last).map(one).collect());
}

/// The number with the other sign.
pub(super) fn negate(node: &mut Node) {
    if let Value::Scalar(scalar) = &mut node.value {
        // Zero stays as it is, so that it still is seen to be none.
        if scalar.text.parse() == Ok(0.0) {
            return;
        }
        scalar.negate();
    }
}
