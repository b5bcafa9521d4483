//! A controlled drive: proportional and derivative control of a joint's coordinate, with a limit.
//!
//! ```text
//! f = sat(k_p (target − s) + k_d (d target/dt − ṡ))          N or N m, pushes s up
//! sat(x) = ½ [√((x + L)² + ε²) − √((x − L)² + ε²)],   ε = L/100
//! ```
//!
//! sat is x well within the limit L (its derivative there is 1 − 5·10⁻⁵), L beyond, and smooth between. d target/dt is
//! `target_rate` if that is given.

use mbint_derive::Element;
use symdiff::Formula;

use super::laws::goal::{check_rate, goal};
use super::laws::saturation::saturated;
use super::{ForceElement, Forces, TypedSensor, effort};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, OnJoint, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;

/// A drive that controls a joint's coordinate, with a limit.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "servo",
    what = "a servo",
    equation = "f = sat(k_p (target − s) + k_d (d target/dt − ṡ))",
    source = "Åström & Murray, Feedback Systems, 2nd ed. (2021)",
    example = "{ on: hinge, target: 0.5*sin(2*t), proportional: 200, derivative: 8, limit: 30 N*m }",
    checked
)]
pub struct Servo {
    /// The joint's coordinate.
    #[group]
    on: OnJoint,
    /// Target value of the coordinate; may depend on t, states, positions and velocities.
    #[quantity(unit = "m or rad")]
    #[key(image = Turning)]
    target: Formula,
    /// How fast the target changes, if it depends on more than t.
    #[quantity(unit = "m/s or rad/s", otherwise = "the target's derivative by t")]
    #[key(image = Turning)]
    target_rate: Option<Formula>,
    /// Force by error.
    #[quantity(unit = "N/m or N*m/rad")]
    proportional: Formula,
    /// Force by rate of error.
    #[quantity(unit = "N*s/m or N*m*s/rad", default = 0)]
    derivative: Formula,
    /// Largest force or torque; the corner is round, and half a per cent below where the sum before it reaches the
    /// limit.
    #[quantity(unit = "N or N*m", constant, positive, otherwise = "none")]
    limit: Option<Formula>,
}

impl ForceElement for Servo {
    const GLYPH: Glyph = Glyph::Motor;
    const SENSORS: &'static [TypedSensor] = &[(Sensor::FORCE, Dimension::FORCE), (Sensor::TORQUE, Dimension::TORQUE)];

    fn sensors(&self) -> Vec<TypedSensor> {
        vec![effort(self.on)]
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let [target, target_rate] = goal(forces, &self.target, self.target_rate.as_ref())?;
        let proportional = forces.value(&self.proportional)?;
        let derivative = forces.value(&self.derivative)?;
        let [place, rate] = forces.coordinate_and_rate(self.on);
        let mut effort = proportional * (target - place) + derivative * (target_rate - rate);
        if let Some(limit) = &self.limit {
            effort = saturated(effort, forces.value(limit)?);
        }
        forces.sensor(Sensor::of_effort(self.on.coordinate), effort);
        forces.effort(self.on, effort)
    }
}

impl Checked for Servo {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        check_rate(reader, fields, &self.target, &["derivative"]);
    }
}
