//! Errors of unknown names in formulas.

use super::motions::{ANGULAR_MOTIONS, JOINT_MOTIONS, MOTIONS, is_motion};
use super::names::{Context, ENERGIES, NameError, OF_TRAJECTORY, motions};
use super::quantity::Dimension;
use super::symbols::{Sensor, SymbolTable};
use crate::syntax::frame::PLACE;
use crate::syntax::suggest;

/// Error of a measure that an effect does not have.
pub fn no_measure(effect: &str, rest: &str, measures: &[(Sensor, Dimension)]) -> NameError {
    let names: Vec<&str> = measures.iter().map(|(measure, _)| measure.name()).collect();
    let after = effect.len() + 1;
    NameError {
        message: format!("effect `{}` has no `{}`", suggest::clip(effect), suggest::clip(rest)),
        part: after..after + rest.len(),
        help: (!names.is_empty()).then(|| format!("it has {}", suggest::list(&names))),
    }
}

/// Error of an unknown name.
pub fn unknown(table: &impl SymbolTable, name: &str, context: Context) -> NameError {
    let shown = suggest::clip(name);
    for (prefix, what) in [("link.", "link"), ("joint.", "joint")].into_iter().filter(|_| table.is_robot()) {
        if name.starts_with(prefix) {
            let message = format!("the URDF has nothing called `{shown}`");
            let help = format!("a {what} has numbers and a motion: `mbint check` shows the tree");
            return NameError { message, part: 0..name.len(), help: Some(help) };
        }
    }
    let instance =
        table.instances().filter(|known| name.starts_with(&format!("{known}."))).max_by_key(|known| known.len());
    if let Some(instance) = instance {
        return in_instance(table, name, instance, context);
    }
    match name.split_once('.') {
        None => unknown_word(table, name, &shown, context),
        Some((owner, rest)) => unknown_member(table, name, owner, rest, context),
    }
}

/// Whether the model declares a parameter, rather than the placement of an instance or the deviation of an excitation.
fn is_said(table: &impl SymbolTable, parameter: &str) -> bool {
    let owner = parameter.split('.').next().filter(|owner| owner.len() < parameter.len());
    !parameter.contains(PLACE) && owner.is_none_or(|owner| table.trajectory(owner).is_none())
}

/// Error of an unknown name in an instance.
fn in_instance(table: &impl SymbolTable, name: &str, instance: &str, context: Context) -> NameError {
    let is_owner =
        |owner: &str| table.body(owner).is_some() || table.joint(owner).is_some() || table.effect(owner).is_some();
    let dots = name.match_indices('.').map(|(dot, _)| dot).filter(|dot| *dot > instance.len());
    if let Some(dot) = dots.rev().find(|dot| is_owner(&name[..*dot])) {
        return unknown_member(table, name, &name[..dot], &name[dot + 1..], context);
    }
    let start = instance.len() + 1;
    let rest = &name[start..];
    let within = |known: &str| Some(known.strip_prefix(instance)?.strip_prefix('.')?.to_owned());
    let parameters = table.parameters().filter(|known| is_said(table, known)).filter_map(within);
    let known: Vec<String> = match context {
        Context::Constant => parameters.collect(),
        _ => parameters.chain(table.parts_of(instance)).chain(table.joints().filter_map(within)).collect(),
    };
    let word = rest.split('.').next().unwrap_or(rest);
    NameError {
        message: format!("instance `{}` has no `{}`", suggest::clip(instance), suggest::clip(word)),
        part: start..start + word.len(),
        help: suggest::help(word, "names in it", known.iter().map(String::as_str)),
    }
}

fn unknown_word(table: &impl SymbolTable, name: &str, shown: &str, context: Context) -> NameError {
    let part = 0..name.len();
    if table.body(name).is_some() {
        let help = match context {
            Context::Constant => "only parameters can stand here".to_owned(),
            _ if table.is_spatial() => format!("name one of its quantities: `{name}.x`, `{name}.omega.x`, …"),
            _ => format!("name one of its quantities: `{name}.x`, `{name}.y`, `{name}.angle`, …"),
        };
        return NameError { message: format!("`{shown}` is a body, not a number"), part, help: Some(help) };
    }
    if let Some(parts) = table.parts_of_beam(name) {
        let message = format!("`{shown}` is a beam, not a number");
        return NameError { message, part, help: Some(parts) };
    }
    if table.joint(name).is_some() {
        let help = (context == Context::Output)
            .then(|| format!("name one of its quantities: `{name}.force` or `{name}.torque`"));
        return NameError { message: format!("`{shown}` is a joint, not a number"), part, help };
    }
    let parameters = table.parameters().filter(|known| is_said(table, known));
    let mut others: Vec<&str> = Vec::new();
    if context == Context::Output {
        others.extend(table.black_box_outputs());
        others.extend(ENERGIES.iter().filter(|_| others.is_empty()).map(|(energy, _)| *energy).collect::<Vec<_>>());
    }
    let help = match name {
        "time" if context != Context::Constant => Some("the time is `t`".to_owned()),
        "PI" | "Pi" | "π" => Some("did you mean `pi`?".to_owned()),
        _ => suggest::help_beside(name, "parameters", parameters, &others),
    };
    let infinite = matches!(name.to_lowercase().as_str(), "inf" | "infinity" | "nan");
    let message =
        if infinite { format!("`{shown}` is not a finite number") } else { format!("unknown parameter `{shown}`") };
    NameError { message, part, help: if infinite { None } else { help } }
}

fn unknown_member(table: &impl SymbolTable, name: &str, owner: &str, rest: &str, context: Context) -> NameError {
    let known = |owner: &str| table.body(owner).is_some();
    if let Some((node, member)) = name.rsplit_once('.').filter(|(node, _)| *node != owner && known(node)) {
        return unknown_member(table, name, node, member, context);
    }
    let after = owner.len() + 1;
    match (table.body(owner), table.joint(owner).is_some()) {
        (Some(body), _) => unknown_in_body(table, name, owner, body, rest),
        (None, true) => NameError {
            message: format!("joint `{}` has no `{}`", suggest::clip(owner), suggest::clip(rest)),
            part: after..name.len(),
            help: Some(parts_of_joint(table, owner)),
        },
        (None, false) if table.effect(owner).is_some() => {
            let measures = table.effect(owner).map_or(Vec::new(), |effect| table.measures(effect));
            no_measure(owner, rest, &measures)
        }
        (None, false) if table.trajectory(owner).is_some() => NameError {
            message: format!("trajectory `{}` has no `{}`", suggest::clip(owner), suggest::clip(rest)),
            part: after..name.len(),
            help: Some(format!("it has {}", suggest::list(&OF_TRAJECTORY.map(|(name, _)| name)))),
        },
        (None, false) if known(name) => NameError {
            message: format!("`{name}` is a node of a beam, not a number"),
            part: 0..name.len(),
            help: Some(format!("name one of its quantities: `{name}.x`, `{name}.y`, `{name}.angle`, …")),
        },
        (None, false) if table.parts_of_beam(owner).is_some() => NameError {
            message: format!("beam `{}` has no `{}`", suggest::clip(owner), suggest::clip(rest)),
            part: after..name.len(),
            help: table.parts_of_beam(owner),
        },
        (None, false) => {
            let bodies = table.bodies().skip(1);
            let joints = table.joints();
            let (what, kind, joints) = match context {
                Context::Output => ("body or joint", "bodies and joints", Some(joints)),
                _ => ("body", "bodies", None),
            };
            NameError {
                message: format!("unknown {what} `{}`", suggest::clip(owner)),
                part: 0..owner.len(),
                help: suggest::help(owner, kind, bodies.chain(joints.into_iter().flatten())),
            }
        }
    }
}

/// Error of an unknown part of a body, given by name and index.
fn unknown_in_body(table: &impl SymbolTable, name: &str, owner: &str, body: usize, rest: &str) -> NameError {
    let after = owner.len() + 1;
    let points = table.points(body);
    let (member, part) = rest.split_once('.').unwrap_or((rest, ""));
    let point = points.clone().any(|point| point == member);
    if body == 0 && !point && MOTIONS.iter().any(|(motion, ..)| *motion == member) {
        let message = format!("the ground does not move: `{}` is always 0", suggest::clip(name));
        return NameError { message, part: 0..name.len(), help: None };
    }
    if point && part.is_empty() {
        let message = format!("`{}` is a point, not a number", suggest::clip(name));
        let help = Some(format!("name one of its quantities: `{name}.x` or `{name}.y`"));
        return NameError { message, part: 0..name.len(), help };
    }
    let along_z = matches!(part, "z" | "vz" | "az");
    if !table.is_spatial() && if point { along_z } else { is_motion(member) } {
        let message = format!("`{}` leaves the plane, but the model is planar", suggest::clip(name));
        let help = "write `space: spatial` for a mechanism that moves in space".to_owned();
        return NameError { message, part: 0..name.len(), help: Some(help) };
    }
    if point {
        let start = after + member.len() + 1;
        let message = format!("a point has no `{}`", suggest::clip(part));
        let lengths = motions(table, body).filter(|(_, coordinate, _)| coordinate.is_length());
        let help = suggest::help(part, "parts of its motion", lengths.map(|(motion, ..)| *motion));
        return NameError { message, part: start..name.len(), help };
    }
    if let Some((vector, ..)) = ANGULAR_MOTIONS.iter().find(|(vector, ..)| *vector == member) {
        let message = format!("`{vector}` is a vector: it has the parts x, y and z");
        let help = Some(format!("e.g. `{owner}.{vector}.z`; an output can be the vector itself, by its name alone"));
        return NameError { message, part: 0..name.len(), help };
    }
    if member == "angle" || member.starts_with("angular_") {
        let message = format!("body `{}` turns about more than z, so it has no `{member}`", suggest::clip(owner));
        let help = "the `angle` of a joint is one, and `omega.x`, `roll`, `pitch` and `yaw` are of the body";
        let part = after..after + member.len();
        return NameError { message, part, help: Some(help.to_owned()) };
    }
    let reactions: &[&str] = if table.joint(owner).is_some() { &["force", "torque"] } else { &[] };
    let known: Vec<&str> = if part.is_empty() {
        points.chain(reactions.iter().copied()).chain(motions(table, body).map(|(motion, ..)| *motion)).collect()
    } else {
        points.collect()
    };
    let what = if part.is_empty() { "has no" } else { "has no point" };
    NameError {
        message: format!("body `{}` {what} `{}`", suggest::clip(owner), suggest::clip(member)),
        part: after..after + member.len(),
        help: suggest::help(member, if part.is_empty() { "names in it" } else { "points of it" }, known),
    }
}

/// Help that lists the parts of a joint.
fn parts_of_joint(table: &impl SymbolTable, name: &str) -> String {
    let mut parts = if table.is_spatial() {
        vec!["force", "force.x", "force.y", "force.z", "torque", "torque.x", "torque.y", "torque.z"]
    } else {
        vec!["force", "force.x", "force.y", "torque"]
    };
    if let Some(joint) = table.joint(name) {
        if table.has_axis(joint) {
            parts.extend(["axial", "radial", "torque.axial"]);
        } else if table.has_axial_force(joint) {
            parts.push("axial");
        }
        if table.has_place(joint) {
            parts.extend(match table.is_spatial() {
                true => &["force_body.x", "torque_body.x", "torque_at.BODY.POINT.x"][..],
                false => &["force_body.x", "force_body.y", "torque_at.BODY.POINT"],
            });
        }
        let coordinates = JOINT_MOTIONS.iter().filter(|(_, coordinate, _)| table.has_coordinate(joint, *coordinate));
        parts.extend(coordinates.map(|(motion, ..)| *motion));
    }
    format!("a joint has {}", suggest::list(&parts))
}
