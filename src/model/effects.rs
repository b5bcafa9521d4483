//! `effects:`.

use symdiff::Formula;

use super::description::Effect;
use super::file;
use super::kinds::{EffectKind, JointCoordinate, Twisted};
use super::names::Context;
use super::quantity::Dimension;
use super::reader::{Fields, Reader};
use super::yaml::{Entry, Value};

/// Reads the effects.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "an effect");
        if let Some(kind) = effect(reader, entry) {
            reader.model.effects.push(Effect { name: entry.key.clone(), kind });
        }
    }
}

fn effect(reader: &mut Reader, entry: &Entry) -> Option<EffectKind> {
    let kind = reader.only::<file::Effect>(&entry.value, entry.key_span.clone())?;
    let (node, at) = (&kind.value, kind.key_span.clone());
    match kind.key.as_str() {
        "gravity" => {
            let fields = reader.fields::<file::Gravity>(node, at)?;
            let acceleration = reader.required(&fields, "acceleration")?;
            let acceleration = reader.components(acceleration, Context::Effect, Dimension::ACCELERATION)?;
            Some(EffectKind::Gravity { acceleration })
        }
        "force" => {
            let fields = reader.fields::<file::Force>(node, at)?;
            let on = reader.required(&fields, "on").and_then(|node| reader.point_ref(node));
            let value = reader
                .required(&fields, "value")
                .and_then(|node| reader.components(node, Context::Effect, Dimension::FORCE));
            let in_body = in_body(reader, &fields);
            Some(EffectKind::Force { on: on?, value: value?, in_body: in_body? })
        }
        "torque" => {
            let fields = reader.fields::<file::Torque>(node, at)?;
            torque(reader, &fields)
        }
        "spring_damper" => {
            let fields = reader.fields::<file::SpringDamper>(node, at)?;
            let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
            let along = match fields.get("along") {
                Some(node) => reader.direction(node).map(Some),
                None => Some(None),
            };
            let [stiffness, damping] = coefficients(reader, &fields, Dimension::STIFFNESS, Dimension::DAMPING);
            let free_length = or_zero(reader, &fields, "free_length", Dimension::LENGTH);
            Some(EffectKind::SpringDamper {
                between: between?,
                along: along?,
                stiffness: stiffness?,
                damping: damping?,
                free_length: free_length?,
            })
        }
        "torsional_spring_damper" => {
            let fields = reader.fields::<file::TorsionalSpringDamper>(node, at)?;
            let on = twisted(reader, &fields);
            let [stiffness, damping] =
                coefficients(reader, &fields, Dimension::TORSIONAL_STIFFNESS, Dimension::TORSIONAL_DAMPING);
            let free_angle = or_zero(reader, &fields, "free_angle", Dimension::ANGLE);
            Some(EffectKind::TorsionalSpringDamper {
                on: on?,
                stiffness: stiffness?,
                damping: damping?,
                free_angle: free_angle?,
            })
        }
        // `only` lets through the kinds of the grammar; this is the last.
        _ => {
            let fields = reader.fields::<file::Bushing>(node, at)?;
            let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
            let mut per_axis = |key: &str, dimension: Dimension| match fields.get(key) {
                Some(node) if matches!(node.value, Value::Sequence(_)) => {
                    reader.three(node, Context::Effect, dimension)
                }
                Some(node) => {
                    reader.formula(node, Context::Effect, dimension).map(|all| [all.clone(), all.clone(), all])
                }
                None => Some([0.0; 3].map(Formula::number)),
            };
            let stiffness = per_axis("stiffness", Dimension::STIFFNESS);
            let damping = per_axis("damping", Dimension::DAMPING);
            let torsional_stiffness = per_axis("torsional_stiffness", Dimension::TORSIONAL_STIFFNESS);
            let torsional_damping = per_axis("torsional_damping", Dimension::TORSIONAL_DAMPING);
            Some(EffectKind::Bushing {
                between: between?,
                stiffness: stiffness?,
                damping: damping?,
                torsional_stiffness: torsional_stiffness?,
                torsional_damping: torsional_damping?,
            })
        }
    }
}

fn in_body(reader: &mut Reader, fields: &Fields) -> Option<bool> {
    match fields.get("frame") {
        Some(node) => reader.choice(node, &[("ground", false), ("body", true)]),
        None => Some(false),
    }
}

fn torque(reader: &mut Reader, fields: &Fields) -> Option<EffectKind> {
    let on = reader.required(fields, "on");
    if let Some(joint) = on.filter(|node| reader.names_joint(node)) {
        for key in ["from", "frame"].into_iter().filter(|key| fields.get(key).is_some()) {
            let message =
                format!("a torque at a joint has no `{key}`: it acts about the joint's axis, between its bodies");
            reader.error(fields.key_span(key), message, None);
        }
        let joint = reader.joint_ref(joint, JointCoordinate::Angle);
        let value = reader.required(fields, "value");
        let value = value.and_then(|node| reader.formula(node, Context::Effect, Dimension::TORQUE));
        return Some(EffectKind::JointTorque { joint: joint?, value: value? });
    }
    let on = on.and_then(|node| reader.body_ref(node));
    let from = fields.get("from").map_or(Some(0), |node| reader.body_ref(node));
    let value = reader.required(fields, "value").and_then(|node| match node.value {
        Value::Sequence(_) => {
            if !reader.model.space.spatial && super::space::leaves_plane_about(node) {
                reader.leaves_the_plane(node);
            }
            reader.three(node, Context::Effect, Dimension::TORQUE)
        }
        _ => {
            let [x, y] = [0.0; 2].map(Formula::number);
            Some([x, y, reader.formula(node, Context::Effect, Dimension::TORQUE)?])
        }
    });
    let in_body = in_body(reader, fields);
    let (on, from) = (on?, from?);
    if on == from {
        let message = format!("the torque and its reaction both act on `{}`", reader.model.bodies[on].name);
        let key = if fields.get("from").is_some() { "from" } else { "on" };
        reader.error(fields.get(key)?.span.clone(), message, "name two different bodies".to_owned());
    }
    Some(EffectKind::Torque { on, from, value: value?, in_body: in_body? })
}

/// Two bodies' angles, or a joint's.
fn twisted(reader: &mut Reader, fields: &Fields) -> Option<Twisted> {
    if let Some(node) = fields.get("on") {
        if fields.get("between").is_some() {
            reader.error(fields.key_span("on"), "`on` and `between` exclude each other", None);
        }
        return reader.joint_ref(node, JointCoordinate::Angle).map(Twisted::Joint);
    }
    let node = reader.required(fields, "between")?;
    let bodies = reader.between_bodies(node)?;
    if let Some(&body) = bodies.iter().find(|&&body| reader.model.bodies[body].has_orientation()) {
        let name = reader.model.bodies[body].name.clone();
        let help = "write `on` with the joint whose angle it acts on, or make it a `bushing`".to_owned();
        reader.error(node.span.clone(), format!("`{name}` turns about more than z, so it has no angle"), help);
    }
    Some(Twisted::Bodies(bodies))
}

/// Stiffness and damping, of which one must be there.
fn coefficients(
    reader: &mut Reader,
    fields: &Fields,
    stiffness: Dimension,
    damping: Dimension,
) -> [Option<Formula>; 2] {
    if fields.get("stiffness").is_none() && fields.get("damping").is_none() {
        reader.error(fields.at.clone(), "a spring and damper needs `stiffness` or `damping`", None);
    }
    [or_zero(reader, fields, "stiffness", stiffness), or_zero(reader, fields, "damping", damping)]
}

fn or_zero(reader: &mut Reader, fields: &Fields, key: &str, dimension: Dimension) -> Option<Formula> {
    match fields.get(key) {
        Some(node) => reader.formula(node, Context::Effect, dimension),
        None => Some(Formula::number(0.0)),
    }
}
