//! `mirror: y`: entries of an instance in the image that a mirror shows.
//!
//! M is the reflection at the plane through the instance's origin across the axis. A body at r with the rotation R is
//! at M r with M R M, so a polar vector v of any frame becomes M v, an axial one, of a rotation or a torque, −M v. Axes
//! of joints are reflected as polar vectors; so their angles count the other way, in the plane and in space. Decisions
//! 0077 and 0130.

use super::Writer;
use crate::elements::effects::EffectKind;
use crate::elements::joints::JointKind;
use crate::elements::shapes::ShapeKind;
use crate::grammar::mapping::Grammar;
use crate::grammar::{Image, KeyImage};
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::mirrors::Mirrors;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Images of the keys of a joint or an effect; none for an unknown kind, which its reader reports.
pub(super) fn images(keyword: &str) -> Vec<KeyImage> {
    EffectKind::images(keyword).or_else(|| JointKind::images(keyword)).unwrap_or_default()
}

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
        let images = images(&kind.key);
        if let Value::Sequence(_) = kind.value.value {
            // The short form, of which the axis may need to be said.
            let between =
                Entry { key: "between".to_owned(), key_span: kind.key_span.clone(), value: kind.value.clone() };
            kind.value.value = Value::Mapping(vec![between]);
        }
        let Value::Mapping(keys) = &mut kind.value.value else { return };
        for found in keys.iter() {
            if images.iter().any(|known| known.name == found.key && matches!(known.image, Image::Unknown)) {
                let message = format!("`{}` of a `{}` cannot be mirrored", found.key, kind.key);
                let help = "write the mirrored assembly out, or give the parts that differ to the model".to_owned();
                self.report.error(Code::BadPlacement, found.key_span.clone(), message, help);
            }
        }
        add_defaults(keys, &images, &kind.key_span);
        for axis in mirrors.axes() {
            image_of_keys(keys, &images, axis, is_turning);
        }
    }

    /// The image of a body.
    pub(super) fn image_of_body(&mut self, entry: &mut Entry, mirrors: Mirrors) {
        let Value::Mapping(keys) = &mut entry.value.value else { return };
        if let Some(beam) = keys.iter().find(|key| key.key == "beam" && mirrors.axes().next().is_some()) {
            self.report.error(Code::BadPlacement, beam.key_span.clone(), "a beam that bends cannot be mirrored", None);
        }
        let images = <keys::Body as Grammar>::images();
        mirrors.axes().for_each(|axis| image_of_keys(keys, &images, axis, None));
    }
}

/// The image of a shape of a body.
fn image_of_shape(shape: &mut Node, axis: usize) {
    let Value::Mapping(kinds) = &mut shape.value else { return };
    let [kind] = kinds.as_mut_slice() else { return };
    let Some(images) = ShapeKind::images(&kind.key) else { return };
    if let (Value::Sequence(_), Some(short)) = (&kind.value.value, ShapeKind::short(&kind.key)) {
        let only = Entry { key: short.to_owned(), key_span: kind.key_span.clone(), value: kind.value.clone() };
        kind.value.value = Value::Mapping(vec![only]);
    }
    let Value::Mapping(keys) = &mut kind.value.value else { return };
    add_defaults(keys, &images, &kind.key_span);
    image_of_keys(keys, &images, axis, None);
}

/// Whether the image of an effect differs if it is on a joint that turns.
pub(super) fn tells_turns(effect: &Entry) -> bool {
    has_image(effect, |image| matches!(image, Image::Turning | Image::Effort | Image::End(_)))
}

/// Whether a mirror changes the sign of the quantities that an effect measures on a joint that turns.
pub(super) fn measures_turns(effect: &Entry) -> bool {
    has_image(effect, |image| matches!(image, Image::Turning))
}

fn has_image(effect: &Entry, wanted: impl Fn(Image) -> bool) -> bool {
    let Value::Mapping(kinds) = &effect.value.value else { return false };
    kinds.first().is_some_and(|kind| images(&kind.key).into_iter().any(|known| wanted(known.image)))
}

/// Writes out defaults that have an image: directions, and factors.
fn add_defaults(keys: &mut Vec<Entry>, images: &[KeyImage], at: &Span) {
    for known in images.iter().filter(|known| !matches!(known.image, Image::Same | Image::Unknown)) {
        let default = known.default.as_ref().filter(|default| {
            matches!(default, serde_json::Value::String(_) | serde_json::Value::Array(_))
                || matches!(known.image, Image::Factors)
        });
        let value = default.and_then(|default| written(default, at));
        if let Some(value) = value.filter(|_| !keys.iter().any(|key| key.key == known.name)) {
            keys.push(Entry { key: known.name.to_owned(), key_span: at.clone(), value });
        }
    }
}

/// The images of the values of keys.
fn image_of_keys(keys: &mut [Entry], images: &[KeyImage], axis: usize, is_turning: Option<bool>) {
    for key in keys {
        let Some(known) = images.iter().find(|known| known.name == key.key) else { continue };
        if let Image::End(other) = known.image
            && is_turning != Some(false)
        {
            key.key = other.to_owned();
        }
        image_of_value(&mut key.value, known.image, axis, is_turning);
    }
}

/// The image of a value.
fn image_of_value(value: &mut Node, image: Image, axis: usize, is_turning: Option<bool>) {
    match image {
        Image::Same | Image::Unknown => {}
        Image::Polar => polar(value, axis),
        Image::Rotation => rotation(value, axis),
        Image::Factors => {
            if let Value::Scalar(_) = value.value {
                value.value = Value::Sequence(vec![value.clone(); 3]);
            }
            polar(value, axis);
        }
        Image::Axial if is_turning == Some(true) => negate(value),
        Image::Axial => axial(value, axis),
        Image::Polars => {
            if let Value::Sequence(items) = &mut value.value {
                items.iter_mut().for_each(|item| point_or_arc(item, axis));
            }
        }
        Image::Turning | Image::End(_) if is_turning == Some(false) => {}
        Image::Effort if is_turning != Some(true) => {}
        Image::Turning | Image::Effort | Image::End(_) => negate(value),
        Image::Along(own) if own != axis => {}
        Image::About(own) if own == axis => {}
        Image::Product(own) if !own.contains(&axis) => {}
        Image::Along(_) | Image::About(_) | Image::Product(_) => negate(value),
        Image::SixRows => six_rows(value, axis),
        Image::Keys(within) | Image::PolarOr(within) => {
            if let Value::Mapping(keys) = &mut value.value {
                image_of_keys(keys, &within(), axis, is_turning);
            } else if let Image::PolarOr(_) = image {
                polar(value, axis);
            }
        }
        Image::Named(image) => {
            if let Value::Mapping(entries) = &mut value.value {
                entries.iter_mut().for_each(|entry| image_of_value(&mut entry.value, *image, axis, is_turning));
            }
        }
        Image::Shapes => match &mut value.value {
            Value::Sequence(shapes) => shapes.iter_mut().for_each(|shape| image_of_shape(shape, axis)),
            _ => image_of_shape(value, axis),
        },
    }
}

/// Forces and displacements are polar, torques and rotations axial.
fn six_rows(node: &mut Node, axis: usize) {
    let counts_back = |index: usize| (index % 3 == axis) == (index < 3);
    let Value::Sequence(rows) = &mut node.value else { return };
    for (row, entries) in rows.iter_mut().enumerate() {
        let Value::Sequence(entries) = &mut entries.value else { continue };
        let changed = entries.iter_mut().enumerate().filter(|(column, _)| counts_back(row) != counts_back(*column));
        changed.for_each(|(_, entry)| negate(entry));
    }
}

/// A default as it would be written.
fn written(value: &serde_json::Value, at: &Span) -> Option<Node> {
    let value = match value {
        serde_json::Value::Array(items) => {
            Value::Sequence(items.iter().map(|item| written(item, at)).collect::<Option<_>>()?)
        }
        serde_json::Value::String(text) => Value::Scalar(Scalar::plain(text, None)),
        number => Value::Scalar(Scalar::plain(number.to_string(), None)),
    };
    Some(Node { span: at.clone(), value })
}

/// A point: its position, or its frame.
pub(super) fn point(node: &mut Node, axis: usize) {
    image_of_value(node, keys::POINT, axis, None);
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
                    .filter(|(index, _)| *index != axis)
                    .for_each(|(_, item)| negate(item));
            }
            _ => {}
        }
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
            items.iter_mut().enumerate().filter(|(index, _)| *index != axis).for_each(|(_, item)| negate(item));
        }
        _ if axis != 2 => negate(node),
        _ => {}
    }
}

/// An axis by its letter as a list.
pub(super) fn written_out(node: &mut Node) {
    let Some(index) = node.scalar().and_then(|scalar| ["x", "y", "z"].iter().position(|axis| *axis == scalar.text))
    else {
        return;
    };
    let one = |axis: usize| {
        let text = if axis == index { "1" } else { "0" };
        Node { span: node.span.clone(), value: Value::Scalar(Scalar::plain(text, None)) }
    };
    let last = if index == 2 { 3 } else { 2 };
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
