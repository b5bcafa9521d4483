//! `effects:`.

mod acting;
mod touching;

use crate::grammar::JointCoordinate;
use symdiff::Formula;

pub(super) use self::touching::impact;
use super::description::Effect;
use super::effect_kinds::{EffectKind, Twisted};
use super::file;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::reader::Fields;
use crate::model::names::Reader;
use crate::syntax::yaml::{Entry, Node, Value};

/// Reads the effects. A formula may speak of what its own effect and those before it measure.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "an effect");
        let nothing = [0.0; 3].map(Formula::number);
        let kind = EffectKind::Gravity { acceleration: nothing };
        reader.model.effects.push(Effect { name: entry.key.clone(), kind });
        let kind = effect(reader, entry);
        if let Some((effect, kind)) = reader.model.effects.last_mut().zip(kind) {
            effect.kind = kind;
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
            let spring = EffectKind::SpringDamper {
                between: between?,
                along: along?,
                stiffness: stiffness?,
                damping: damping?,
                free_length: free_length?,
                force: None,
            };
            let further = own_formula(reader, &fields, "force", Dimension::FORCE, &spring)?;
            let EffectKind::SpringDamper { between, along, stiffness, damping, free_length, .. } = spring else {
                return None;
            };
            Some(EffectKind::SpringDamper { between, along, stiffness, damping, free_length, force: further })
        }
        "torsional_spring_damper" => {
            let fields = reader.fields::<file::TorsionalSpringDamper>(node, at)?;
            let on = twisted(reader, &fields);
            let [stiffness, damping] =
                coefficients(reader, &fields, Dimension::TORSIONAL_STIFFNESS, Dimension::TORSIONAL_DAMPING);
            let free_angle = or_zero(reader, &fields, "free_angle", Dimension::ANGLE);
            let spring = EffectKind::TorsionalSpringDamper {
                on: on?,
                stiffness: stiffness?,
                damping: damping?,
                free_angle: free_angle?,
                torque: None,
            };
            let further = own_formula(reader, &fields, "torque", Dimension::TORQUE, &spring)?;
            let EffectKind::TorsionalSpringDamper { on, stiffness, damping, free_angle, .. } = spring else {
                return None;
            };
            Some(EffectKind::TorsionalSpringDamper { on, stiffness, damping, free_angle, torque: further })
        }
        "joint_friction" => touching::joint_friction(reader, node, at).map(EffectKind::JointFriction),
        "stop" => touching::stop(reader, node, at).map(EffectKind::Stop),
        "contact" => touching::contact(reader, node, at).map(EffectKind::Contact),
        "clearance_joint" => touching::clearance_joint(reader, node, at).map(EffectKind::ClearanceJoint),
        "servo" => acting::servo(reader, node, at).map(EffectKind::Servo),
        "drag" => acting::drag(reader, node, at).map(EffectKind::Drag),
        "cable" => acting::cable(reader, node, at).map(EffectKind::Cable),
        "backlash" => acting::backlash(reader, node, at).map(EffectKind::Backlash),
        "preload" => acting::preload(reader, node, at).map(EffectKind::Preload),
        "beam" => acting::beam(reader, node, at).map(EffectKind::Beam),
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
            let straight = [Dimension::STIFFNESS, Dimension::FORCE, Dimension::TORSIONAL_STIFFNESS];
            let stiffness_matrix = matrix(reader, &fields, "stiffness_matrix", straight);
            let rates = straight.map(|dimension| dimension.times(Dimension::TIME));
            let damping_matrix = matrix(reader, &fields, "damping_matrix", rates);
            Some(EffectKind::Bushing {
                between: between?,
                stiffness: stiffness?,
                damping: damping?,
                torsional_stiffness: torsional_stiffness?,
                torsional_damping: torsional_damping?,
                stiffness_matrix: stiffness_matrix?,
                damping_matrix: damping_matrix?,
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
            if !reader.model.space.spatial && crate::grammar::plane::leaves_plane_about(node) {
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

/// The formula of a key that may speak of what the effect itself measures; `kind` is the effect without it.
fn own_formula(
    reader: &mut Reader,
    fields: &Fields,
    key: &str,
    wanted: Dimension,
    kind: &EffectKind,
) -> Option<Option<Formula>> {
    let Some(node) = fields.get(key) else { return Some(None) };
    reader.model.effects.last_mut()?.kind = kind.clone();
    reader.formula(node, Context::Effect, wanted).map(Some)
}

/// Six rows of six; dimensions of force by displacement, of force by rotation and torque by displacement, of torque by
/// rotation.
#[allow(clippy::type_complexity)]
fn matrix(
    reader: &mut Reader,
    fields: &Fields,
    key: &str,
    dimensions: [Dimension; 3],
) -> Option<Option<Box<[[Formula; 6]; 6]>>> {
    let Some(node) = fields.get(key) else { return Some(None) };
    let rows = six(reader, node, "six rows of six numbers")?;
    let mut read = Vec::with_capacity(6);
    for (row, entries) in rows.iter().enumerate() {
        let mut line = Vec::with_capacity(6);
        for (column, entry) in six(reader, entries, "a row of six numbers")?.iter().enumerate() {
            let dimension = dimensions[usize::from(row >= 3) + usize::from(column >= 3)];
            line.push(reader.formula(entry, Context::Effect, dimension)?);
        }
        read.push(<[Formula; 6]>::try_from(line).ok()?);
    }
    <[[Formula; 6]; 6]>::try_from(read).ok().map(|matrix| Some(Box::new(matrix)))
}

fn six<'n>(reader: &mut Reader, node: &'n Node, wanted: &str) -> Option<&'n [Node]> {
    let found = match &node.value {
        Value::Sequence(items) if items.len() == 6 => return Some(items),
        Value::Sequence(items) => format!("a list of {}", items.len()),
        _ => node.kind().to_owned(),
    };
    reader.error(node.span.clone(), format!("{wanted} belong here, but here is {found}"), None);
    None
}

/// A formula of a key that must be there.
fn needed(reader: &mut Reader, fields: &Fields, key: &str, context: Context, wanted: Dimension) -> Option<Formula> {
    let node = reader.required(fields, key)?;
    reader.formula(node, context, wanted)
}

/// A number of parameters that is positive at every corner.
fn positive(reader: &mut Reader, fields: &Fields, key: &str, wanted: Dimension) -> Option<Formula> {
    let node = reader.required(fields, key)?;
    reader.formula_that(node, Context::Constant, wanted, |value| value > 0.0, "must be positive")
}

/// A number of parameters that is positive at every corner, or this one.
fn positive_or(
    reader: &mut Reader,
    fields: &Fields,
    key: &str,
    wanted: Dimension,
    default: Formula,
) -> Option<Formula> {
    match fields.get(key) {
        Some(_) => positive(reader, fields, key, wanted),
        None => Some(default),
    }
}

/// Stiffness and damping, of which one must be there.
fn coefficients(
    reader: &mut Reader,
    fields: &Fields,
    stiffness: Dimension,
    damping: Dimension,
) -> [Option<Formula>; 2] {
    let given = ["stiffness", "damping", if stiffness == Dimension::STIFFNESS { "force" } else { "torque" }];
    if given.iter().all(|key| fields.get(key).is_none()) {
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
