//! A constant tension between two points, or a constant force or torque of a joint.
//!
//! ```text
//! F_A = F (r_B − r_A)/ℓ,   F_B = −F_A,   V = F ℓ          N, J
//! at a joint: F pushes its coordinate s up,   V = −F s          N or N m
//! ```
//!
//! Points that coincide have no line between them.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Forces, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, OnJoint, PointRef, Reader, Sensor, SymbolTable, TimeOrder};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// A constant tension between two points, or a constant force or torque of a joint.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "preload",
    what = "a preload",
    equation = "F constant, along the line between two points or on a joint's coordinate",
    source = "Newton",
    example = "{ between: [arm.tip, cart.hook], value: 15 N }",
    checked
)]
pub struct Preload {
    /// Two points, each `body.point` or `body`, that it pulls together.
    pub between: Option<[PointRef; 2]>,
    /// Instead of `between`: a joint's coordinate that it pushes up.
    #[group]
    pub on: Option<OnJoint>,
    /// The force or torque; may depend on t and the motion.
    #[quantity(unit = "N or N*m")]
    #[key(image = Effort)]
    pub value: Formula,
}

impl ForceElement for Preload {
    const SENSORS: &'static [TypedSensor] = &[(Sensor::AXIAL, Dimension::FORCE)];

    fn sensors(&self) -> Vec<TypedSensor> {
        Self::SENSORS.iter().copied().filter(|_| self.between.is_some()).collect()
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        self.on.into_iter().collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let force = forces.value(&self.value)?;
        let potential = match (self.between, self.on) {
            (Some(between), None) => {
                let [a, b] = between.map(|point| forces.point(point));
                let line = b.position - a.position;
                let length = line.norm();
                forces.between(&b, &a, force / length * line);
                forces.sensor(Sensor::AXIAL, force);
                force * length
            }
            (_, Some(on)) => {
                forces.effort(on, force)?;
                -(force * forces.coordinate(on, TimeOrder::Position))
            }
            (None, None) => return Ok(()),
        };
        forces.potential(&[force], potential);
        Ok(())
    }
}

impl Checked for Preload {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        match [fields.get("on"), fields.get("between")] {
            [None, None] => {
                reader.required(fields, "between");
            }
            [Some(_), Some(_)] => {
                reader.error(
                    Code::ExclusiveKeys,
                    fields.key_span("between"),
                    "`on` and `between` exclude each other",
                    None,
                );
            }
            _ => {}
        }
    }
}
