//! `effects:`.

use symdiff::Formula;

use super::description::{Effect, EffectKind};
use super::file;
use super::names::Context;
use super::quantity::Dimension;
use super::reader::{Fields, Reader};
use super::yaml::Entry;

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
            let acceleration = reader.pair(acceleration, Context::Effect, Dimension::ACCELERATION)?;
            Some(EffectKind::Gravity { acceleration })
        }
        "force" => {
            let fields = reader.fields::<file::Force>(node, at)?;
            let on = reader.required(&fields, "on").and_then(|node| reader.point_ref(node));
            let value =
                reader.required(&fields, "value").and_then(|node| reader.pair(node, Context::Effect, Dimension::FORCE));
            let in_body = match fields.get("frame") {
                Some(node) => reader.choice(node, &[("ground", false), ("body", true)]),
                None => Some(false),
            };
            Some(EffectKind::Force { on: on?, value: value?, in_body: in_body? })
        }
        "torque" => {
            let fields = reader.fields::<file::Torque>(node, at)?;
            let on = reader.required(&fields, "on").and_then(|node| reader.body_ref(node));
            let from = fields.get("from").map_or(Some(0), |node| reader.body_ref(node));
            let value = reader
                .required(&fields, "value")
                .and_then(|node| reader.formula(node, Context::Effect, Dimension::TORQUE));
            let (on, from) = (on?, from?);
            if on == from {
                let message = format!("the torque and its reaction both act on `{}`", reader.model.bodies[on].name);
                let key = if fields.get("from").is_some() { "from" } else { "on" };
                reader.error(fields.get(key)?.span.clone(), message, "name two different bodies".to_owned());
            }
            Some(EffectKind::Torque { on, from, value: value? })
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
        // `only` lets through the kinds of the grammar; this is the last.
        _ => {
            let fields = reader.fields::<file::TorsionalSpringDamper>(node, at)?;
            let between = reader.required(&fields, "between").and_then(|node| reader.between_bodies(node));
            let [stiffness, damping] =
                coefficients(reader, &fields, Dimension::TORSIONAL_STIFFNESS, Dimension::TORSIONAL_DAMPING);
            let free_angle = or_zero(reader, &fields, "free_angle", Dimension::ANGLE);
            Some(EffectKind::TorsionalSpringDamper {
                between: between?,
                stiffness: stiffness?,
                damping: damping?,
                free_angle: free_angle?,
            })
        }
    }
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
