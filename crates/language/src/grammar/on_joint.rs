//! `on` and `coordinate`: keys that name a joint's coordinate.

use schemars::{SchemaGenerator, json_schema};
use symdiff::Formula;

use super::element::{Group, Key};
use super::kinds::name;
use super::reader::Reader;
use super::report::Fields;
use super::symbols::{JointCoordinate, OnJoint, Reference, SymbolTable};
use crate::syntax::codes::Code;
use crate::syntax::yaml::Node;

/// `on` and `coordinate`: a joint's coordinate. Units that depend on it are listed for a displacement, then for an
/// angle.
impl Group for OnJoint {
    fn key_names() -> Vec<&'static str> {
        vec!["on", "coordinate"]
    }

    fn keys(_: &mut SchemaGenerator) -> Vec<Key> {
        let key = |name, doc, required, words, schema| Key {
            name,
            doc,
            unit: "",
            required,
            default: None,
            default_in_words: words,
            schema,
            requirement: None,
            keys: Vec::new(),
        };
        let words = json_schema!({
            "oneOf": [
                { "description": "About the joint's axis.", "type": "string", "const": "angle" },
                { "description": "Along it.", "type": "string", "const": "displacement" }
            ]
        });
        let usual = Some("the displacement of a prismatic joint, the angle of others");
        vec![
            key("on", "A revolute, prismatic, cylindrical or screw joint.", true, None, name()),
            key("coordinate", "Which of the joint's.", false, usual, words),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        reader.on_joint(fields)
    }

    fn units(read: Option<&Self>) -> Option<usize> {
        Some(read.map_or(JointCoordinate::Angle, |on| on.coordinate).unit_choice())
    }

    fn formulas<'a>(&'a self, _: &mut Vec<&'a Formula>) {}

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        found.push(Reference::Joint(&mut self.joint));
    }

    fn leaves_plane(_: &Node) -> Option<&'static str> {
        None
    }
}

/// `on` and `coordinate`, which may be absent.
impl Group for Option<OnJoint> {
    fn key_names() -> Vec<&'static str> {
        OnJoint::key_names()
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        OnJoint::keys(generator).into_iter().map(|key| Key { required: false, ..key }).collect()
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        if fields.get("on").is_some() {
            return reader.on_joint(fields).map(Some);
        }
        if fields.get("coordinate").is_some() {
            reader.error(
                Code::MisplacedKey,
                fields.key_span("coordinate"),
                "`coordinate` goes with `on`, a joint",
                None,
            );
        }
        Some(None)
    }

    fn units(read: Option<&Self>) -> Option<usize> {
        read?.as_ref().map(|on| on.coordinate.unit_choice())
    }

    fn formulas<'a>(&'a self, _: &mut Vec<&'a Formula>) {}

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        found.extend(self.as_mut().map(|on| Reference::Joint(&mut on.joint)));
    }

    fn leaves_plane(_: &Node) -> Option<&'static str> {
        None
    }
}

impl JointCoordinate {
    /// Index of its unit among those of a key: `m or rad`.
    pub fn unit_choice(self) -> usize {
        match self {
            Self::Displacement => 0,
            Self::Angle => 1,
        }
    }
}
