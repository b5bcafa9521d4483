//! Numbers of an instance that are written anew in the model's frame: as formulas of its parameters `at.model.x`, ….

use std::sync::Arc;

use super::mirror;
use super::placement::{AXES, scalar};
use crate::syntax::frame::{InstanceFrame, PLACE, Turned, about, product, signed};
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Value};

/// Turns a list of components; numbers and malformed lists stay as they are.
pub(super) fn turn(node: &mut Node, frame: InstanceFrame, scope: &Arc<Scope>) {
    let span = node.span.clone();
    let scope = scope_of(node, scope);
    let Value::Sequence(items) = &mut node.value else { return };
    let Some(mut parts) = texts(items).filter(|parts| (2..=3).contains(&parts.len())) else { return };
    let count = if frame.turned == Turned::InSpace { 3 } else { items.len() };
    let z = if parts.len() == 3 { parts.remove(2) } else { "0".to_owned() };
    let [x, y] = [parts.remove(0), parts.remove(0)];
    let turned = frame.turn(PLACE, &[x, y, z]);
    *items = turned.iter().take(count).map(|text| scalar(text, &scope, &span)).collect();
}

/// Turns an orientation.
pub(super) fn orient(node: &mut Node, frame: InstanceFrame, scope: &Arc<Scope>) {
    let Some(own) = quaternion(node) else { return };
    let scope = scope_of(node, scope);
    let span = node.span.clone();
    let p = product(&frame.quaternion(PLACE), &own).map(|p| scalar(&p, &scope, &span));
    *node = euler(p, &span);
}

/// A rotation by its Euler parameters.
pub(super) fn euler(p: [Node; 4], span: &Span) -> Node {
    let value = Node { span: span.clone(), value: Value::Sequence(p.into()) };
    let key = Entry { key: "quaternion".to_owned(), key_span: span.clone(), value };
    Node { span: span.clone(), value: Value::Mapping(vec![key]) }
}

/// The Euler parameters of a rotation, of any length; `None` if it is not well formed, which its reader reports.
pub(super) fn quaternion(node: &Node) -> Option<[String; 4]> {
    let list = |node: &Node| match &node.value {
        Value::Sequence(items) => texts(items),
        _ => None,
    };
    if let Some(p) = node.get("quaternion") {
        return list(p)?.try_into().ok();
    }
    if let Some(angles) = node.get("rpy") {
        let [roll, pitch, yaw]: [String; 3] = list(angles)?.try_into().ok()?;
        return Some(product(&about(2, &yaw), &product(&about(1, &pitch), &about(0, &roll))));
    }
    let angle = text(node.get("angle")?)?;
    let mut axis = node.get("axis")?.clone();
    if let Some(letter) = axis.scalar().and_then(|scalar| AXES.iter().position(|axis| *axis == scalar.text)) {
        return Some(about(letter, &angle));
    }
    mirror::written_out(&mut axis);
    let mut axis = list(&axis)?;
    axis.resize(3, "0".to_owned());
    let length = format!("sqrt(({})^2 + ({})^2 + ({})^2)", axis[0], axis[1], axis[2]);
    let part = |component: &String| format!("({component})*sin(({angle})/2)/{length}");
    Some([format!("cos(({angle})/2)"), part(&axis[0]), part(&axis[1]), part(&axis[2])])
}

/// The scope of the numbers of a node, without their signs; the instance's where they have none.
fn scope_of(node: &Node, instance: &Arc<Scope>) -> Arc<Scope> {
    fn found(node: &Node) -> Option<&Scope> {
        match &node.value {
            Value::Scalar(scalar) => scalar.scope.as_deref(),
            Value::Sequence(items) => items.iter().find_map(found),
            Value::Mapping(entries) => entries.iter().find_map(|entry| found(&entry.value)),
        }
    }
    // Numbers that a mirror wrote out by itself have no names, and no prefix.
    let own = found(node).filter(|scope| scope.prefix() == instance.prefix());
    Arc::new(own.unwrap_or(instance).with_sign(false))
}

/// The formula of a number, its sign included; `None` without a number, which its reader reports.
pub(super) fn text(node: &Node) -> Option<String> {
    let scalar = node.scalar()?;
    let is_negated = scalar.scope.as_ref().is_some_and(|scope| scope.is_negated());
    let text = if scalar.text.parse() == Ok(0.0) { "0" } else { scalar.text.trim() };
    Some(signed(text, is_negated))
}

fn texts(items: &[Node]) -> Option<Vec<String>> {
    items.iter().map(text).collect()
}

/// Writes another formula instead of a number.
pub(super) fn replace(node: &mut Node, text: &str, scope: &Arc<Scope>) {
    *node = scalar(text, &scope_of(node, scope), &node.span.clone());
}
