//! A DC motor behind a gear: its current is a state.
//!
//! ```text
//! L di/dt = U − R i − k N ṡ          f = k N i          N or N m, pushes s up
//! ```
//!
//! k is the rotor's torque by current and its voltage by speed, N m/A = V s/rad; N is how far the rotor turns, rad, by
//! the joint's coordinate. Without L the current is (U − k N ṡ)/R. Electric quantities are bare numbers, in V, A, Ω and
//! H.

use mbint_derive::Element;
use symdiff::Formula;

use super::laws::saturation::saturated;
use super::{ForceElement, Forces, StateVariable, TypedSensor, effort};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{OnJoint, Sensor};
use crate::multibody::BuildError;

/// i, A.
const CURRENT: Sensor = Sensor::of_motion("current").of_unknown_unit().along_joint();

/// The same where it follows from the forces, and is no state.
const STEADY_CURRENT: Sensor = Sensor::of_force("current").of_unknown_unit().along_joint();

/// A drive by a voltage.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "dc_motor",
    what = "a DC motor",
    equation = "L di/dt = U − R i − k N ṡ,  f = k N i",
    source = "Åström & Murray, Feedback Systems, 2nd ed. (2021)",
    example = "{ on: hinge, voltage: 12, resistance: 0.8, inductance: 4e-3, constant: 0.05, ratio: 20 }"
)]
pub struct DcMotor {
    /// The joint's coordinate.
    #[group]
    on: OnJoint,
    /// V, a number or a formula of t, positions, velocities and states.
    #[quantity(unit = "1")]
    #[key(image = Turning)]
    voltage: Formula,
    /// Largest voltage, V; the corner is round, as that of a servo.
    #[quantity(unit = "1", constant, positive, otherwise = "none")]
    limit: Option<Formula>,
    /// Resistance of the coils, Ω.
    #[quantity(unit = "1", constant, positive)]
    resistance: Formula,
    /// Inductance of the coils, H.
    #[quantity(unit = "1", constant, positive, otherwise = "none: the current follows at once")]
    inductance: Option<Formula>,
    /// Torque by current, N m/A, and voltage by speed, V s/rad.
    #[quantity(unit = "1", constant, positive)]
    constant: Formula,
    /// How far the rotor turns, rad, by the joint's coordinate, rad or m.
    #[quantity(unit = "1", constant, default = 1)]
    ratio: Formula,
    /// The current at the start, A.
    #[quantity(unit = "1", constant, default = 0)]
    #[key(image = Turning)]
    initial: Formula,
}

impl ForceElement for DcMotor {
    const GLYPH: Glyph = Glyph::Motor;
    const SENSORS: &'static [TypedSensor] =
        &[(Sensor::FORCE, Dimension::FORCE), (Sensor::TORQUE, Dimension::TORQUE), (CURRENT, Dimension::NUMBER)];

    fn sensors(&self) -> Vec<TypedSensor> {
        let current = if self.inductance.is_some() { CURRENT } else { STEADY_CURRENT };
        vec![effort(self.on), (current, Dimension::NUMBER)]
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        self.inductance
            .iter()
            .map(|_| StateVariable { sensor: CURRENT, initial: &self.initial, period: None })
            .collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let mut voltage = forces.value(&self.voltage)?;
        if let Some(limit) = &self.limit {
            voltage = saturated(voltage, forces.value(limit)?);
        }
        let resistance = forces.value(&self.resistance)?;
        let geared = forces.value(&self.constant)? * forces.value(&self.ratio)?;
        let [_, rate] = forces.coordinate_and_rate(self.on);
        let left = voltage - geared * rate;
        let current = match &self.inductance {
            None => {
                let current = left / resistance;
                forces.sensor(STEADY_CURRENT, current);
                current
            }
            Some(inductance) => {
                let current = forces.state(0);
                let change = (left - resistance * current) / forces.value(inductance)?;
                forces.state_rate(0, change);
                current
            }
        };
        let effort = geared * current;
        forces.sensor(Sensor::of_effort(self.on.coordinate), effort);
        forces.effort(self.on, effort)
    }
}
