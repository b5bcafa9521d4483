//! `joints:`.

use symdiff::Formula;

use super::description::Joint;
use super::names::Reader;
use crate::elements::JointKind;
use crate::elements::joints::Equation;
use crate::grammar::JointCoordinate;
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Value};

/// Notes the names of the joints, so that outputs can refer to them.
pub fn declare(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "a joint");
        // `read` replaces the kind.
        let kind = Equation { left: Formula::number(0.0), right: Formula::number(0.0) };
        reader.model.mechanism_mut().joints.push(Joint::new(entry.key.clone(), kind.into()));
    }
}

/// Reads the joints that were declared; those that refer to joints come after the others.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    let couples = |entry: &Entry| match &entry.value.value {
        Value::Mapping(kinds) => kinds.iter().any(|kind| JointKind::couples(&kind.key)),
        _ => false,
    };
    for coupling in [false, true] {
        for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| couples(entry) == coupling) {
            match JointKind::read(reader, &entry.value, entry.key_span.clone()) {
                Some(kind) => reader.model.mechanism_mut().joints[index].kind = kind,
                None => reader.unread_joints.push(entry.key.clone()),
            }
        }
    }
    if !reader.diagnostics.has_errors() {
        check_drives(reader, entries);
    }
}

/// Reports coordinates whose motion is prescribed twice: the second could only say the same, or contradict. Where there
/// are errors already, the motors may be others.
fn check_drives(reader: &mut Reader, entries: &[Entry]) {
    for second in 0..entries.len() {
        let joints = &reader.model.joints;
        let Some(on) = joints[second].kind.driven() else { continue };
        let Some(first) = joints[..second].iter().position(|joint| joint.kind.driven() == Some(on)) else { continue };
        let (joint, first) = (&joints[on.joint].name, &joints[first].name);
        let coordinate = match on.coordinate {
            JointCoordinate::Angle => "angle",
            JointCoordinate::Displacement => "displacement",
        };
        let message = format!("the {coordinate} of `{joint}` is prescribed by `{first}` already");
        let help = "leave one of them out, or drive another coordinate".to_owned();
        reader.error(Code::DrivenTwice, entries[second].key_span.clone(), message, help);
    }
}
