//! Torsional spring and damper between two bodies' angles, or on the angle of a joint.
//!
//! ```text
//! τ = k (φ − φ₀) + c φ̇,   φ = θ₂ − θ₁ or the joint's angle,   V = ½ k (φ − φ₀)²          N m, J
//! −τ about the axis on the second body, +τ on the first
//! ```
//!
//! Angles are never wrapped: the spring winds up over many turns. A further torque is a formula of the spring's own
//! angle φ and rate. With one, or where k or φ₀ depend on the motion, there is no potential and none is counted.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{
    BodyRef, Checked, Fields, JointCoordinate, OnJoint, Reader, Rotating, RotatingJoint, Sensor, SymbolTable, TimeOrder,
};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// A spring and damper between the angles of two bodies, or on the angle of a joint.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "torsional_spring_damper",
    what = "`torsional_spring_damper`",
    equation = "τ = k (φ − φ₀) + c φ̇ + torque(φ, φ̇), turns back",
    source = "Hooke; Kelvin and Voigt",
    example = "{ on: hinge, stiffness: 5, damping: 0.1, free_angle: 0.3 }",
    checked
)]
pub struct TorsionalSpringDamper {
    /// Two bodies, by their angles about z.
    pub between: Option<[BodyRef; 2]>,
    /// Instead of `between`: a joint.
    pub on: Option<RotatingJoint>,
    /// Torque by twist.
    #[quantity(unit = "N*m/rad", default = 0)]
    pub stiffness: Formula,
    /// Torque by rate of twist.
    #[quantity(unit = "N*m*s/rad", default = 0)]
    pub damping: Formula,
    /// Twist without torque.
    #[quantity(unit = "rad", default = 0)]
    #[key(image = Turning)]
    pub free_angle: Formula,
    /// Further torque against the twist; may depend on the spring's own `NAME.angle` and `NAME.rate`.
    #[quantity(unit = "N*m")]
    #[key(image = Turning)]
    pub torque: Option<Formula>,
}

impl ForceElement for TorsionalSpringDamper {
    const GLYPH: Glyph = Glyph::TorsionSpring;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::ANGLE, Dimension::ANGLE),
        (Sensor::RATE, Dimension::ANGULAR_VELOCITY),
        (Sensor::TORQUE, Dimension::TORQUE),
    ];

    fn coordinates(&self) -> Vec<OnJoint> {
        self.on.iter().map(|joint| OnJoint { joint: joint.0, coordinate: JointCoordinate::Angle }).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let stiffness = forces.value(&self.stiffness)?;
        let damping = forces.value(&self.damping)?;
        let free_angle = forces.value(&self.free_angle)?;
        let bodies = self.between.map(|bodies| bodies.map(|body| body.0));
        let [angle, rate] = match (bodies, self.on) {
            (Some([first, second]), None) => [TimeOrder::Position, TimeOrder::Velocity].map(|order| {
                forces.angle(Rotating::of_body(second), order) - forces.angle(Rotating::of_body(first), order)
            }),
            (_, Some(joint)) => forces.coordinate_and_rate(OnJoint::angle(joint.0)),
            (None, None) => return Ok(()),
        };
        let twist = angle - free_angle;
        let mut torque = stiffness * twist + damping * rate;
        if let Some(further) = &self.torque {
            torque += forces.value_with(further, &[(Sensor::ANGLE, angle), (Sensor::RATE, rate)])?;
        }
        forces.sensors([(Sensor::ANGLE, angle), (Sensor::RATE, rate), (Sensor::TORQUE, torque)]);
        match (bodies, self.on) {
            (Some([first, second]), None) => {
                let zero = forces.graph().number(0.0);
                forces.torque(second, first, [zero, zero, torque].into());
            }
            (_, Some(joint)) => forces.effort(OnJoint::angle(joint.0), -torque)?,
            (None, None) => {}
        }
        let potential = 0.5 * (stiffness * (twist * twist));
        if self.torque.is_none() {
            forces.potential(&[stiffness, free_angle], potential);
        }
        Ok(())
    }
}

impl Checked for TorsionalSpringDamper {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.lacks("on") {
            reader.required(fields, "between");
        }
        reader.exclude(fields, ["on", "between"]);
        if fields.lacks_all(&["stiffness", "damping", "torque"]) {
            reader.error(
                Code::IncompleteElement,
                fields.at.clone(),
                "a spring and damper needs `stiffness` or `damping`",
                None,
            );
        }
    }

    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let bodies = self.between.iter().flatten().filter(|_| self.on.is_none());
        let free = bodies.into_iter().find(|body| reader.model.has_orientation(body.0));
        if let (Some(body), Some(node)) = (free, fields.get("between")) {
            let message = format!("`{}` turns about more than z, so it has no angle", reader.model.body_name(body.0));
            let help = "write `on` with the joint whose angle it acts on, or make it a `bushing`";
            reader.error(Code::NoAngle, node.span.clone(), message, help.to_owned());
        }
    }
}
