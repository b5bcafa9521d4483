//! Whether a model stays in the plane: as the file says, or else by whether anything in it leaves the plane.
//!
//! Decided before anything else is read, on the text alone, because it says which coordinates a body has.

use super::description::Space;
use crate::elements::JointKind;
use crate::elements::effects::EffectKind;
use crate::grammar::motions::ATTITUDE;
use crate::grammar::plane::leaves_plane;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::syntax::yaml::{Entry, Node, Value};

/// Parts of names at the start that only bodies in space have.
const SPATIAL_STARTS: [&str; 5] = ["z", "vz", "orientation", "omega", "omega_body"];

/// Name, in messages, of a body's prescribed coordinates.
const HELD: &str = "what is held";

/// Reads `space:`, or decides.
pub fn read(reader: &mut Reader, fields: &Fields) -> Space {
    let planar = || Space { spatial: false, why: "nothing leaves the plane".to_owned() };
    if let Some(node) = fields.get("space") {
        let Some(spatial) = reader.choice(node, &[("planar", false), ("spatial", true)]) else { return planar() };
        return Space { spatial, why: "the model says so".to_owned() };
    }
    let entries = |key: &str| fields.get(key).map_or(&[][..], mapping);
    let bodies = entries("bodies").iter().find_map(|body| Some((body, body_leaves(&body.value)?)));
    let bodies = bodies.map(|(body, why)| match body.key.strip_suffix(".ground") {
        Some(instance) if why == HELD => format!("the place of instance `{instance}` leaves the plane"),
        _ => format!("{why} of body `{}` leaves the plane", body.key),
    });
    let joints = entries("joints").iter().find_map(|joint| Some((joint, joint_leaves(&joint.value)?)));
    let joints = joints.map(|(joint, why)| format!("{why} of joint `{}` leaves the plane", joint.key));
    let effects = entries("effects").iter().find_map(|effect| Some((effect, effect_leaves(&effect.value)?)));
    let effects = effects.map(|(effect, why)| format!("{why} of effect `{}` leaves the plane", effect.key));
    let start = ["initial", "guess"].into_iter().find_map(|section| {
        let names = entries(section).iter().map(|entry| entry.key.as_str());
        let leaves = |name: &str| {
            let parts = || name.split('.').skip(1);
            let motion = name.rsplit('.').next().unwrap_or_default();
            parts().any(|part| SPATIAL_STARTS.contains(&part)) || ATTITUDE.contains(&motion)
        };
        let name = names.into_iter().find(|name| leaves(name))?;
        Some(format!("`{name}` in `{section}` leaves the plane"))
    });
    match bodies.or(joints).or(effects).or(start) {
        Some(why) => Space { spatial: true, why },
        None => planar(),
    }
}

fn mapping(node: &Node) -> &[Entry] {
    match &node.value {
        Value::Mapping(entries) => entries,
        _ => &[],
    }
}

fn get<'n>(node: &'n Node, key: &str) -> Option<&'n Node> {
    mapping(node).iter().find(|entry| entry.key == key).map(|entry| &entry.value)
}

fn is(node: &Node, word: &str) -> bool {
    node.scalar().is_some_and(|scalar| scalar.text == word)
}

fn body_leaves(body: &Node) -> Option<String> {
    for point in get(body, "points").map_or(&[][..], mapping) {
        let position = get(&point.value, "position").unwrap_or(&point.value);
        if leaves_plane(position) || get(&point.value, "rotation").is_some() {
            return Some(format!("point `{}`", point.key));
        }
    }
    if get(body, "center_of_mass").is_some_and(leaves_plane) {
        return Some("the centre of mass".to_owned());
    }
    if get(body, "inertia").is_some_and(|inertia| matches!(inertia.value, Value::Sequence(_) | Value::Mapping(_))) {
        return Some("the inertia tensor".to_owned());
    }
    let listed = |node: &Node| matches!(&node.value, Value::Sequence(items) if items.iter().any(|item| is(item, "z") || is(item, "orientation")));
    if get(body, "coordinates").is_some_and(listed) {
        return Some("a coordinate".to_owned());
    }
    let held = get(body, "held")?;
    (get(held, "z").is_some() || get(held, "orientation").is_some()).then(|| HELD.to_owned())
}

fn joint_leaves(joint: &Node) -> Option<String> {
    let [kind] = mapping(joint) else { return None };
    JointKind::leaves_plane(&kind.key, &kind.value).map(|what| format!("the {what}"))
}

fn effect_leaves(effect: &Node) -> Option<String> {
    let [kind] = mapping(effect) else { return None };
    EffectKind::leaves_plane(&kind.key, &kind.value).map(|key| format!("`{key}`"))
}
