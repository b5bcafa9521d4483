//! Names of a model with the locations of their definitions, for editors.

use super::names::Reader;
use crate::grammar::mentions::NameKind;
use crate::syntax::yaml::{Node, Value};

/// Sections whose keys are names.
const SECTIONS: [(&str, NameKind); 10] = [
    ("parameters", NameKind::Parameter),
    ("bodies", NameKind::Body),
    ("joints", NameKind::Joint),
    ("effects", NameKind::Effect),
    ("states", NameKind::State),
    ("outputs", NameKind::Output),
    ("requirements", NameKind::Requirement),
    ("tables", NameKind::Table),
    ("trajectories", NameKind::Trajectory),
    ("excitations", NameKind::Excitation),
];

/// Notes the names that a tree, which is written out, gives a meaning.
pub(super) fn note(reader: &Reader, root: &Node) {
    if reader.mentions.is_none() {
        return;
    }
    for (section, kind) in SECTIONS {
        let Some(Value::Mapping(entries)) = root.get(section).map(|node| &node.value) else { continue };
        for entry in entries {
            reader.defines(kind, &entry.key, entry);
            let points = entry.value.get("points").filter(|_| kind == NameKind::Body).map(|node| &node.value);
            if let Some(Value::Mapping(points)) = points {
                for point in points {
                    reader.defines(NameKind::Point, &format!("{}.{}", entry.key, point.key), point);
                }
            }
        }
    }
}
