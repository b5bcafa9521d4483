//! Whether values leave the plane, determined from the text alone, before anything is read.

use crate::syntax::yaml::{Node, Value};

/// Whether a list of components has a third that is not just 0.
pub fn leaves_plane(node: &Node) -> bool {
    let Value::Sequence(items) = &node.value else { return false };
    let zero = |node: &Node| node.scalar().is_some_and(|scalar| scalar.text.parse() == Ok(0.0));
    items.get(2).is_some_and(|third| !zero(third))
}

/// Whether a torque has components that turn out of the plane.
pub fn leaves_plane_about(torque: &Node) -> bool {
    let Value::Sequence(items) = &torque.value else { return false };
    let zero = |node: &Node| node.scalar().is_some_and(|scalar| scalar.text.parse() == Ok(0.0));
    !items.iter().take(2).all(zero)
}

/// Whether moving along the direction leaves the plane.
pub fn points_out(direction: &Node) -> bool {
    is(direction, "z") || leaves_plane(direction)
}

/// Whether a rotation about the axis leaves the plane.
pub fn rotates_out(axis: &Node) -> bool {
    match &axis.value {
        Value::Sequence(items) => !items.iter().take(2).all(|item| is(item, "0")),
        _ => !is(axis, "z"),
    }
}

fn is(node: &Node, word: &str) -> bool {
    node.scalar().is_some_and(|scalar| scalar.text == word)
}
