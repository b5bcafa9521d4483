//! Torque on a body, or at a joint.
//!
//! ```text
//! τ(on) = +value, or R value where given in the body's axes,   τ(from) = −τ(on)          N m
//! at a joint:   τ = value a₁ on its second body, −τ on its first, a₁ the joint's axis
//! ```
//!
//! In the plane value is about z, counter-clockwise. A motor between two bodies; from the ground, the reaction is the
//! ground's. It has no potential.

use mbint_derive::Element;
use schemars::{Schema, SchemaGenerator};
use symdiff::Formula;

use super::force::ForceFrame;
use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::{
    BodyRef, Checked, Fields, Image, JointCoordinate, Node, OnJoint, Quantity, Reader, Reference, Span, SymbolTable,
    Value, plane, values,
};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;
use crate::syntax::yaml;

/// A torque on a body, or at a joint.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "torque",
    what = "a torque",
    equation = "τ(on) = value, τ(from) = −value",
    source = "Newton",
    example = "{ on: hinge, value: 2 - 0.1*arm.angular_velocity }",
    checked
)]
pub struct Torque {
    /// The body it acts on, or the joint: then on its second body about its axis, and back on its first.
    pub on: TorqueOn,
    /// The body its reaction acts on.
    #[key(otherwise = "the ground")]
    pub from: Option<BodyRef>,
    /// The torque, one number about z; may depend on t, positions and velocities.
    #[quantity(unit = "N*m")]
    #[key(in_ground)]
    pub value: AboutAxes,
    /// Whose axes the components are along.
    #[key(default = ForceFrame::Ground)]
    pub frame: ForceFrame,
}

/// Body or joint that a torque acts on, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorqueOn {
    /// A body.
    Body(usize),
    /// The second body of a joint, from the first.
    Joint(usize),
}

impl Torque {
    /// The body that its reaction acts on.
    pub fn reaction_on(&self) -> usize {
        self.from.map_or(0, |from| from.0)
    }
}

impl ForceElement for Torque {
    const GLYPH: Glyph = Glyph::Torque;
    const SENSORS: &'static [TypedSensor] = &[];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        match self.on {
            TorqueOn::Body(on) => {
                let mut torque = forces.vector(&self.value.0)?;
                if self.frame == ForceFrame::Body {
                    torque = forces.rotated(on, torque);
                }
                forces.torque(self.reaction_on(), on, torque);
                Ok(())
            }
            TorqueOn::Joint(joint) => {
                let torque = forces.value(&self.value.0[2])?;
                forces.effort(OnJoint::angle(joint), torque)
            }
        }
    }
}

impl Checked for Torque {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        match self.on {
            TorqueOn::Joint(_) => {
                for key in ["from", "frame"].into_iter().filter(|key| fields.get(key).is_some()) {
                    let message = format!(
                        "a torque at a joint has no `{key}`: it acts about the joint's axis, between its bodies"
                    );
                    reader.error(Code::MisplacedKey, fields.key_span(key), message, None);
                }
                if let Some(node) = fields.get("value").filter(|node| matches!(node.value, yaml::Value::Sequence(_))) {
                    reader.scalar(node, "a number or a formula");
                }
            }
            TorqueOn::Body(on) if on == self.reaction_on() => {
                let message = format!("the torque and its reaction both act on `{}`", reader.model.body_name(on));
                let key = if self.from.is_some() { "from" } else { "on" };
                let span = fields.get(key).map_or_else(|| fields.at.clone(), |node| node.span.clone());
                reader.error(Code::SameBody, span, message, "name two different bodies".to_owned());
            }
            TorqueOn::Body(_) => {}
        }
    }
}

impl Value for TorqueOn {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, _: &Quantity) -> Option<Self> {
        if reader.names_joint(node) {
            return reader.joint_ref(node, JointCoordinate::Angle).map(Self::Joint);
        }
        reader.body_ref(node).map(Self::Body)
    }

    fn schema(_: &mut SchemaGenerator) -> Schema {
        schemars::json_schema!({ "type": "string" })
    }

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        found.push(match self {
            Self::Body(body) => Reference::Body(body),
            Self::Joint(joint) => Reference::Joint(joint),
        });
    }
}

/// Components about x, y and z, or one number about z.
#[derive(Clone, Debug)]
pub struct AboutAxes(pub [Formula; 3]);

impl Value for AboutAxes {
    const IMAGE: Image = Image::Axial;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, quantity: &Quantity) -> Option<Self> {
        if matches!(node.value, yaml::Value::Sequence(_)) {
            if !reader.model.is_spatial() && plane::leaves_plane_about(node) {
                reader.leaves_the_plane(node);
            }
            return reader.three(node, quantity.context, quantity.dimension()).map(Self);
        }
        let [x, y] = [0.0; 2].map(Formula::number);
        Some(Self([x, y, reader.quantity(node, quantity)?]))
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<values::TorqueValue>()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(&self.0);
    }

    fn leaves_plane(node: &Node) -> bool {
        plane::leaves_plane_about(node)
    }
}
