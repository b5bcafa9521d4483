//! Proportional, integral and derivative control of a joint's coordinate, with a filtered derivative, a limit and
//! anti-windup.
//!
//! ```text
//! e = target − s,   u = k_p e + I + k_d d,   f = sat(u)          N or N m, pushes s up
//! İ = k_i e + (f − u)/T_t                                        T_t = k_p/k_i unless given
//! d = ė, or with a filter of the time constant T_f:   ḋ = (ė − d)/T_f
//! ```
//!
//! sat is that of a servo. While it limits, (f − u)/T_t takes the integral back (Åström & Murray, *Feedback Systems*,
//! 2nd ed. (2021), sec. 11.4). I begins at `initial`, d at 0.

use std::sync::LazyLock;

use mbint_derive::Element;
use symdiff::Formula;

use super::laws::goal::{check_rate, goal};
use super::laws::saturation::saturated;
use super::{ForceElement, Forces, StateVariable, TypedSensor, effort};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, JointCoordinate, OnJoint, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;

/// I.
const INTEGRAL: Sensor = Sensor::of_motion("integral").along_joint();

/// d.
const FILTERED_RATE: Sensor = Sensor::of_motion("filtered_rate").along_joint();

static ZERO: LazyLock<Formula> = LazyLock::new(|| Formula::number(0.0));

/// A controller with an integral.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "pid",
    what = "a PID controller",
    equation = "f = sat(u),  u = k_p e + I + k_d d,  e = target − s,  İ = k_i e + (f − u)/T_t,  ḋ = (ė − d)/T_f",
    source = "Åström & Murray, Feedback Systems, 2nd ed. (2021), sec. 11.4",
    example = "{ on: hinge, target: 0.5, proportional: 200, integral: 400, derivative: 8, filter: 5 ms, limit: 30 N*m }",
    checked
)]
pub struct Pid {
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
    #[quantity(unit = "N/m or N*m/rad", positive)]
    proportional: Formula,
    /// How fast the force grows, by error.
    #[quantity(unit = "N/m/s or N*m/rad/s", positive)]
    integral: Formula,
    /// Force by rate of error.
    #[quantity(unit = "N*s/m or N*m*s/rad", default = 0)]
    derivative: Formula,
    /// Time constant by which the rate of error lags.
    #[quantity(unit = "s", constant, positive, otherwise = "no lag")]
    filter: Option<Formula>,
    /// Largest force or torque; the corner is round, and half a per cent below where the sum before it reaches the
    /// limit.
    #[quantity(unit = "N or N*m", constant, positive, otherwise = "none")]
    limit: Option<Formula>,
    /// Time in which the integral follows the limit.
    #[quantity(unit = "s", constant, positive, otherwise = "proportional/integral")]
    tracking: Option<Formula>,
    /// The integral's part of the force at the start.
    #[quantity(unit = "N or N*m", constant, default = 0)]
    #[key(image = Turning)]
    initial: Formula,
}

impl ForceElement for Pid {
    const GLYPH: Glyph = Glyph::Motor;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::TORQUE, Dimension::TORQUE),
        (INTEGRAL.of_unknown_unit(), Dimension::FORCE),
        (FILTERED_RATE.of_unknown_unit(), Dimension::VELOCITY),
    ];

    fn sensors(&self) -> Vec<TypedSensor> {
        let (of_effort, of_rate) = match self.on.coordinate {
            JointCoordinate::Angle => (Dimension::TORQUE, Dimension::ANGULAR_VELOCITY),
            JointCoordinate::Displacement => (Dimension::FORCE, Dimension::VELOCITY),
        };
        let filtered = self.filter.iter().map(|_| (FILTERED_RATE, of_rate));
        [effort(self.on), (INTEGRAL, of_effort)].into_iter().chain(filtered).collect()
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        let integral = StateVariable { sensor: INTEGRAL, initial: &self.initial, period: None };
        let filtered =
            self.filter.iter().map(|_| StateVariable { sensor: FILTERED_RATE, initial: &ZERO, period: None });
        [integral].into_iter().chain(filtered).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let [target, target_rate] = goal(forces, &self.target, self.target_rate.as_ref())?;
        let proportional = forces.value(&self.proportional)?;
        let gain = forces.value(&self.integral)?;
        let derivative = forces.value(&self.derivative)?;
        let [place, rate] = forces.coordinate_and_rate(self.on);
        let (error, error_rate) = (target - place, target_rate - rate);
        let felt_rate = match &self.filter {
            None => error_rate,
            Some(filter) => {
                let filtered = forces.state(1);
                let change = (error_rate - filtered) / forces.value(filter)?;
                forces.state_rate(1, change);
                filtered
            }
        };
        let wanted = proportional * error + forces.state(0) + derivative * felt_rate;
        let mut effort = wanted;
        let mut change = gain * error;
        if let Some(limit) = &self.limit {
            effort = saturated(wanted, forces.value(limit)?);
            let tracking = match &self.tracking {
                Some(tracking) => forces.value(tracking)?,
                None => proportional / gain,
            };
            change += (effort - wanted) / tracking;
        }
        forces.state_rate(0, change);
        forces.sensor(Sensor::of_effort(self.on.coordinate), effort);
        forces.effort(self.on, effort)
    }
}

impl Checked for Pid {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        check_rate(reader, fields, &self.target, &["derivative", "filter"]);
    }
}
