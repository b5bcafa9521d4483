//! Effects on many: `friction: { joint_friction: { on: all revolute, … } }`.

use std::sync::Arc;

use super::{Writer, patterns};
use crate::elements::JointKind;
use crate::expand::instance::{Instance, InstanceKind};
use crate::syntax::codes::Code;
use crate::syntax::scope::Scope;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Writes out the effects of which `on` names many.
pub(super) fn write_out(writer: &mut Writer) {
    let is_many = |entry: &Entry| on(&entry.value).is_some();
    if !writer.entries("effects").iter().any(is_many) {
        return;
    }
    let effects = writer.entries("effects").to_vec();
    let mut written = Vec::with_capacity(effects.len());
    for effect in effects {
        match on(&effect.value).cloned() {
            None => written.push(effect),
            Some(node) => written.extend(one_each(writer, &effect, &node)),
        }
    }
    if let Some(entries) = writer.section("effects", &(0..0)) {
        *entries = written;
    }
}

/// The `on` of an effect that acts on all subjects of a kind; `None` for any other.
fn on(effect: &Node) -> Option<&Node> {
    let Value::Mapping(kinds) = &effect.value else { return None };
    let [kind] = kinds.as_slice() else { return None };
    kind.value.get("on").filter(|node| node.scalar().is_some_and(|scalar| wanted(scalar).is_some()))
}

/// Text after `all`.
fn wanted(scalar: &Scalar) -> Option<&str> {
    scalar.text.trim().strip_prefix("all ").map(str::trim)
}

/// The effect for each of its subjects.
fn one_each(writer: &mut Writer, effect: &Entry, node: &Node) -> Vec<Entry> {
    let Some((scalar, wanted)) = node.scalar().and_then(|scalar| Some((scalar, wanted(scalar)?))) else {
        return Vec::new();
    };
    let scope = scalar.scope.clone();
    let prefix = scope.as_ref().map_or("", |scope| scope.prefix());
    let joints: Vec<String> = names(writer.entries("joints"), prefix, |joint| match &joint.value.value {
        _ if patterns::is_pattern(wanted) => true,
        Value::Mapping(kinds) => kinds.first().is_some_and(|kind| kind.key == wanted),
        _ => false,
    });
    let found: Vec<String> = if patterns::is_pattern(wanted) {
        let matching = |names: Vec<String>| -> Vec<String> {
            names.into_iter().filter(|name| patterns::matches(wanted, &name[prefix.len()..])).collect()
        };
        let joints = matching(joints);
        if joints.is_empty() { matching(names(writer.entries("bodies"), prefix, |_| true)) } else { joints }
    } else {
        joints
    };
    if found.is_empty() {
        let (message, help) = if patterns::is_pattern(wanted) {
            (format!("no joint or body is called `{}`", clip(wanted)), None)
        } else if JointKind::KEYWORDS.contains(&wanted) {
            (format!("there is no {wanted} joint"), None)
        } else {
            let help = suggest::help(wanted, "kinds of joints", JointKind::KEYWORDS.iter().copied());
            let help = help.map(|help| format!("{help}; or name joints by a pattern: `all hip_*`"));
            (format!("`{}` is not a kind of joint", clip(wanted)), help)
        };
        writer.report.error(Code::UnknownName, node.span.clone(), message, help);
        return Vec::new();
    }
    writer.parts.instances.push(Instance { name: effect.key.clone(), kind: InstanceKind::Effect });
    let each = |name: String| {
        let rest = &name[prefix.len()..];
        let value = with_on(&effect.value, rest, scope.as_ref());
        Entry { key: format!("{}.{rest}", effect.key), key_span: effect.key_span.clone(), value }
    };
    found.into_iter().map(each).collect()
}

fn names(entries: &[Entry], prefix: &str, is_one: impl Fn(&Entry) -> bool) -> Vec<String> {
    let within = entries.iter().filter(|entry| entry.key.starts_with(prefix) && is_one(entry));
    within.map(|entry| entry.key.clone()).collect()
}

/// The effect on one.
fn with_on(effect: &Node, name: &str, scope: Option<&Arc<Scope>>) -> Node {
    let mut effect = effect.clone();
    if let Value::Mapping(kinds) = &mut effect.value
        && let Some(kind) = kinds.first_mut()
        && let Value::Mapping(keys) = &mut kind.value.value
        && let Some(on) = keys.iter_mut().find(|key| key.key == "on")
    {
        let scalar = Scalar { scope: scope.map(Arc::clone), ..Scalar::plain(name, None) };
        on.value.value = Value::Scalar(scalar);
    }
    effect
}
