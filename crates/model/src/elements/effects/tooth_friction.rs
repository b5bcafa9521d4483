//! Friction between teeth, proportional to the transmitted force.
//!
//! ```text
//! gear, rack, planetary    f = −(1 − η)/(1 + η) |λ| R(u) u          on each rim, along its speed u
//! worm                     F = −μ N R(u) u,   N = |λ|/(r₂ cos α cos γ)
//!                          on the worm along its thread, u the speed of sliding there
//! ```
//!
//! R is that of `dry_friction`. Teeth that roll take their share from both rims: the one that drives gives (1 + c)|λ
//! u|, the driven one gets (1 − c)|λ u|, c = (1 − η)/(1 + η), which is η of it whichever drives. The multiplier λ of
//! the joint's constraint is the transmitted torque or force, so Q depends on it. |λ| is √(λ² + ε²), ε = 10⁻⁶ N m or N.
//! Teeth are where they are by the constraint: on a worm the force acts at the pitch point and on the bearings; that of
//! teeth that roll acts along the rims alone.

use mbint_derive::Element;
use schemars::{Schema, SchemaGenerator, json_schema};
use symdiff::{Formula, Scalar};

use super::laws::dry_friction::Resistance;
use super::{DryFriction, ForceElement, Forces, TypedSensor};
use crate::elements::meshing::{Flanks, Meshing, Rim};
use crate::elements::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::{
    Checked, Fields, Group, JointCoordinate, Key, MeshKind, Node, Reader, Reference, Requirement, Sensor, SymbolTable,
};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

const SHARE: Requirement =
    Requirement { holds: |value| value > 0.0 && value <= 1.0, message: "must be above 0 and at most 1" };

const LOSS: Sensor = Sensor::of_force("loss");

/// Friction between the teeth of a gear, rack, planetary set or worm gear, proportional to the transmitted force.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "tooth_friction",
    what = "a tooth friction",
    equation = "f = −(1 − η)/(1 + η) |λ| u/√(u² + u₀²) on each rim",
    equation = "of a worm: F = −μ N u/√(u² + u₀²) along the thread",
    source = "Niemann & Winter, Maschinenelemente II and III (1986); Müller, Die Umlaufgetriebe (1998)",
    example = "{ on: mesh, efficiency: 0.97 }",
    checked
)]
pub struct ToothFriction {
    /// The joint.
    #[group]
    pub on: Teeth,
    /// Output power over input power, at speed; for a planetary set that of both meshes together, with the carrier
    /// fixed.
    #[quantity(unit = "1", constant, requires = SHARE)]
    #[key(otherwise = "needed, but for a worm gear")]
    pub efficiency: Option<Formula>,
    /// Coefficient of friction between the flanks of a worm gear while sliding.
    #[quantity(unit = "1", constant, nonnegative)]
    #[key(otherwise = "needed for a worm gear, and for nothing else")]
    pub coefficient: Option<Formula>,
    /// How it depends on the speed: of the second member (rad/s, a rack m/s), of the sun against the carrier, along a
    /// worm's thread (m/s).
    #[group]
    pub dry: DryFriction,
}

/// A joint with teeth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Teeth {
    /// Index of the joint.
    pub joint: usize,
    /// How they rub.
    pub kind: MeshKind,
}

impl ForceElement for ToothFriction {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = &[(LOSS, Dimension::POWER)];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let meshing = forces.meshing(self.on.joint)?;
        let (Some(meshing), Some(lambda)) = (meshing, forces.multiplier(self.on.joint)) else {
            forces.sensor(LOSS, forces.graph().number(0.0));
            return Ok(());
        };
        let load = (lambda * lambda + TUNING.no_load_of_teeth * TUNING.no_load_of_teeth).sqrt();
        let loss = match meshing {
            Meshing::Rolling(rims) => self.along_rims(forces, &rims, load)?,
            Meshing::Sliding(flanks) => self.along_thread(forces, &flanks, load)?,
        };
        forces.sensor(LOSS, loss);
        Ok(())
    }
}

impl ToothFriction {
    /// The power that is lost, W.
    fn along_rims<'g>(
        &self,
        forces: &mut dyn Forces<'g>,
        rims: &[Rim<'g>],
        load: Scalar<'g>,
    ) -> Result<Scalar<'g>, BuildError> {
        let efficiency = self.efficiency.clone().unwrap_or_else(|| Formula::number(1.0));
        let dry = Resistance::of(forces, &efficiency, &self.dry)?;
        let share = (1.0 - dry.coefficient) / (1.0 + dry.coefficient);
        let mut loss = forces.graph().number(0.0);
        for rim in rims {
            let mut speed = forces.graph().number(0.0);
            for &(member, radius) in rim {
                speed += radius * forces.member_rate(member)?;
            }
            let effort = -(share * load * dry.by_speed(speed * speed) * speed);
            for &(member, radius) in rim {
                forces.member_effort(member, radius * effort)?;
            }
            loss -= effort * speed;
        }
        Ok(loss)
    }

    /// The power that is lost, W.
    fn along_thread<'g>(
        &self,
        forces: &mut dyn Forces<'g>,
        flanks: &Flanks<'g>,
        load: Scalar<'g>,
    ) -> Result<Scalar<'g>, BuildError> {
        let coefficient = self.coefficient.clone().unwrap_or_else(|| Formula::number(0.0));
        let dry = Resistance::of(forces, &coefficient, &self.dry)?;
        let [thread, other] = flanks.bodies.map(|body| forces.point_at(body, flanks.at));
        let speed = flanks.along.dot(thread.velocity - other.velocity);
        let force = dry.coefficient * flanks.load * load * dry.by_speed(speed * speed) * speed;
        forces.between(&thread, &other, force * flanks.along);
        Ok(force * speed)
    }
}

impl Checked for ToothFriction {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let (needed, other, what) = match self.on.kind {
            MeshKind::Rolling => ("efficiency", "coefficient", "teeth that roll have an `efficiency`"),
            MeshKind::Sliding => ("coefficient", "efficiency", "a worm gear has a `coefficient` of friction"),
        };
        if fields.get(other).is_some() {
            reader.error(Code::MisplacedKey, fields.key_span(other), what, format!("give `{needed}` instead"));
        } else {
            reader.required(fields, needed);
        }
    }
}

impl Group for Teeth {
    fn key_names() -> Vec<&'static str> {
        vec!["on"]
    }

    fn keys(_: &mut SchemaGenerator) -> Vec<Key> {
        let schema: Schema = json_schema!({ "type": "string" });
        let doc = "A gear, rack, planetary set or worm gear.";
        vec![Key {
            name: "on",
            doc,
            unit: "",
            required: true,
            default: None,
            default_in_words: None,
            schema,
            requirement: None,
            keys: Vec::new(),
        }]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _: usize) -> Option<Self> {
        let node = reader.required(fields, "on")?;
        let scalar = reader.scalar(node, "the name of a joint")?;
        let Some(joint) = reader.model.joint(&scalar.name()) else {
            // Reports that it is unknown.
            reader.joint_ref(node, JointCoordinate::Angle);
            return None;
        };
        reader.mentions_node(Some(NameKind::Joint), node);
        let Some(kind) = reader.model.mesh_kind(joint) else {
            let message = format!("`{}` has no teeth", reader.model.joint_name(joint));
            let help = "tooth friction acts in joints `gear`, `rack`, `planetary` and `worm`".to_owned();
            reader.error(Code::UnsuitableJoint, node.span.clone(), message, help);
            return None;
        };
        Some(Self { joint, kind })
    }

    fn formulas<'a>(&'a self, _: &mut Vec<&'a Formula>) {}

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        found.push(Reference::Joint(&mut self.joint));
    }

    fn leaves_plane(_: &Node) -> Option<&'static str> {
        None
    }
}
