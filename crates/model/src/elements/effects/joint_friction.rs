//! Friction in a revolute, prismatic or cylindrical joint, proportional to the joint's own reaction.
//!
//! ```text
//! load            N = |F_λ|, or |F₊| + |F₋| with F± = F_λ/2 ± (M_λ × a)/L in a bearing of length L          N
//! turning         τ = −[(C + μ r N) R(ω) + c] ω             N m, about the axis on the second body
//! sliding         f = −[(C + μ N) R(ṡ) + c] ṡ               N, along the axis
//! both            f = −[(C + μ N) R(u) + c] ṡ,   τ = −[(C + μ N) R(u) + c] r² ω,   u = (ṡ, r ω)
//! ```
//!
//! F_λ, M_λ are the joint's reaction on the second body, a its axis, R that of `dry_friction`, C a part of the dry
//! friction that has nothing to do with the load, c viscous. The opposites act on the first body. Q so depends on λ,
//! and the Newton matrix has its block −∂Q/∂λ. |F| is √(F² + ε²), ε = 1 µN, for |F| has no derivative at 0. Where
//! friction is so large that the reaction it needs grows faster than the load it resists, the mechanism jams (Painlevé)
//! and there is no motion to be found.

use mbint_derive::Element;
use schemars::{Schema, SchemaGenerator, json_schema};
use symdiff::{Formula, Scalar};

use super::laws::dry_friction::Resistance;
use super::{DryFriction, ForceElement, Forces, TypedSensor};
use crate::elements::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::{
    Checked, Fields, FrictionMode, Group, JointCoordinate, Key, Node, OnJoint, Reader, Reference, Sensor, SymbolTable,
};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

/// Friction in a revolute, prismatic or cylindrical joint, proportional to the joint's reaction.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "joint_friction",
    what = "a joint friction",
    equation = "f = −[(C + μ N) s(u)/√(u² + u₀²) + c] u, N the joint's own reaction",
    equation = "s(u) = 1 + (b − 1) exp(−(u/u_s)²)",
    source = "Oden & Martins, Comput. Methods Appl. Mech. Eng. 52 (1985) 527; Armstrong-Hélouvry, Control of Machines with Friction (1991)",
    example = "{ on: hinge, coefficient: 0.15, radius: 10 mm }",
    checked
)]
pub struct JointFriction {
    /// The joint.
    #[group]
    pub on: FrictionJoint,
    /// Dry friction over the joint's reaction while sliding.
    #[quantity(unit = "1", nonnegative, default = 0)]
    pub coefficient: Formula,
    /// How it depends on the speed: rad/s where the joint only turns, else m/s at the surface.
    #[group]
    pub dry: DryFriction,
    /// Dry friction that does not depend on the reaction.
    #[quantity(unit = "N or N*m", default = 0)]
    pub coulomb: Formula,
    /// Force by speed.
    #[quantity(unit = "N*s/m or N*m*s/rad", default = 0)]
    pub viscous: Formula,
    /// Radius of the pin; needed where something turns and has a `coefficient`.
    #[quantity(unit = "m", constant, positive)]
    pub radius: Option<Formula>,
    /// Length of the bearing along its axis; with it, the torque across the axis presses on the bearing's ends.
    #[quantity(unit = "m", constant, positive)]
    pub length: Option<Formula>,
}

/// A joint with friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionJoint {
    /// Index of the joint.
    pub joint: usize,
    /// Motions of the joint that friction resists.
    pub mode: FrictionMode,
}

impl ForceElement for JointFriction {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] =
        &[(Sensor::LOAD, Dimension::FORCE), (Sensor::FORCE, Dimension::FORCE), (Sensor::TORQUE, Dimension::TORQUE)];

    fn sensors(&self) -> Vec<TypedSensor> {
        let measured = |measure: Sensor| match self.on.mode {
            FrictionMode::Rotating => measure != Sensor::FORCE,
            FrictionMode::Sliding => measure != Sensor::TORQUE,
            FrictionMode::Both => true,
        };
        Self::SENSORS.iter().copied().filter(|(measure, _)| measured(*measure)).collect()
    }

    fn loading_joint(&self) -> Option<(usize, &Formula)> {
        Some((self.on.joint, &self.coefficient))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let joint = self.on.joint;
        let dry = Resistance::of(forces, &self.coefficient, &self.dry)?;
        let constant = forces.value(&self.coulomb)?;
        let viscous = forces.value(&self.viscous)?;
        let radius = match &self.radius {
            Some(radius) => forces.value(radius)?,
            None => forces.graph().number(0.0),
        };
        let load = self.load(forces)?;
        let mut bound = dry.coefficient * load;
        if self.on.mode == FrictionMode::Rotating {
            bound = radius * bound;
        }
        let bound = constant + bound;

        let rate = |coordinate| forces.rate(OnJoint { joint, coordinate });
        let velocity = match self.on.mode {
            FrictionMode::Rotating => vec![rate(JointCoordinate::Angle)?],
            FrictionMode::Sliding => vec![rate(JointCoordinate::Displacement)?],
            FrictionMode::Both => {
                let spin = rate(JointCoordinate::Angle)?;
                vec![rate(JointCoordinate::Displacement)?, radius * spin]
            }
        };
        let square = velocity.iter().fold(forces.graph().number(0.0), |sum, &velocity| sum + velocity * velocity);
        let resistance = bound * dry.by_speed(square) + viscous;
        let against: Vec<Scalar> = velocity.iter().map(|&velocity| -(resistance * velocity)).collect();
        let efforts = match self.on.mode {
            FrictionMode::Rotating => vec![(JointCoordinate::Angle, against[0])],
            FrictionMode::Sliding => vec![(JointCoordinate::Displacement, against[0])],
            FrictionMode::Both => {
                vec![(JointCoordinate::Displacement, against[0]), (JointCoordinate::Angle, radius * against[1])]
            }
        };
        forces.sensor(Sensor::LOAD, load);
        for (coordinate, effort) in efforts {
            forces.effort(OnJoint { joint, coordinate }, effort)?;
            forces.sensor(Sensor::of_effort(coordinate), effort);
        }
        Ok(())
    }
}

impl JointFriction {
    /// N.
    fn load<'g>(&self, forces: &dyn Forces<'g>) -> Result<Scalar<'g>, BuildError> {
        let joint = self.on.joint;
        let [force, torque] = forces.reaction(joint);
        let Some(length) = &self.length else { return Ok(magnitude(force)) };
        let length = forces.value(length)?;
        let coordinate = match self.on.mode {
            FrictionMode::Rotating => JointCoordinate::Angle,
            FrictionMode::Sliding | FrictionMode::Both => JointCoordinate::Displacement,
        };
        let couple = torque.cross(forces.axis(OnJoint { joint, coordinate })?) / length;
        let half = 0.5 * force;
        Ok(magnitude(half + couple) + magnitude(half - couple))
    }
}

/// √(F² + ε²).
fn magnitude(force: Vector<'_>) -> Scalar<'_> {
    (force.dot(force) + TUNING.no_load_of_joint * TUNING.no_load_of_joint).sqrt()
}

impl Checked for JointFriction {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = |key: &str| fields.get(key).is_some();
        if fields.lacks_all(&["coefficient", "coulomb", "viscous"]) && given("on") {
            let message = "a joint friction needs `coefficient`, `coulomb` or `viscous`";
            reader.error(Code::IncompleteElement, fields.at.clone(), message, None);
        }
    }

    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let by_radius = match self.on.mode {
            FrictionMode::Rotating => fields.get("coefficient").is_some(),
            FrictionMode::Sliding => false,
            FrictionMode::Both => true,
        };
        if by_radius {
            reader.required(fields, "radius");
        }
    }
}

impl Group for FrictionJoint {
    fn key_names() -> Vec<&'static str> {
        vec!["on"]
    }

    fn keys(_: &mut SchemaGenerator) -> Vec<Key> {
        let schema: Schema = json_schema!({ "type": "string" });
        let doc = "A revolute, prismatic or cylindrical joint.";
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
        let Some(mode) = reader.model.friction_mode(joint) else {
            let message = format!("joint friction does not know how `{}` rubs", reader.model.joint_name(joint));
            let help = "it acts in revolute, prismatic and cylindrical joints".to_owned();
            reader.error(Code::UnsuitableJoint, node.span.clone(), message, help);
            return None;
        };
        Some(Self { joint, mode })
    }

    fn units(read: Option<&Self>) -> Option<usize> {
        // A joint that is unknown is taken for a revolute one, as in other effects on joints.
        let slides = read.is_some_and(|on| on.mode != FrictionMode::Rotating);
        let coordinate = if slides { JointCoordinate::Displacement } else { JointCoordinate::Angle };
        Some(coordinate.unit_choice())
    }

    fn formulas<'a>(&'a self, _: &mut Vec<&'a Formula>) {}

    fn references<'a>(&'a mut self, found: &mut Vec<Reference<'a>>) {
        found.push(Reference::Joint(&mut self.joint));
    }

    fn leaves_plane(_: &Node) -> Option<&'static str> {
        None
    }
}
