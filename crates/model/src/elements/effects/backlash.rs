//! A gear pair whose teeth have play.
//!
//! ```text
//! x = θ₂ − ratio θ₁ − offset          rad, zero in the middle of the play b
//! τ = k [p(x − b/2) − p(−x − b/2)] + c ẋ [p'(x − b/2) + p'(−x − b/2)]          N m
//! −τ on the second wheel, +ratio τ on the first
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): within the play nothing acts, and only x is
//! computed. Without play, b = 0, τ = k x + c ẋ. The reactions of the
//! shafts on their frames (the ground, or the joints' first bodies) carry the difference of the torques, as of a rigid
//! gear.

use mbint_derive::Element;
use symdiff::{Binary, Formula};

use super::laws::positive_part::PositivePart;
use super::{ForceElement, Forces, TypedSensor};
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::{JointCoordinate, OnJoint, Rotating, Sensor, TimeOrder};
use crate::multibody::BuildError;

/// A gear pair whose teeth have play.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "backlash",
    what = "a backlash",
    equation = "τ = k [p(x − b/2) − p(−x − b/2)] + c ẋ [p' + p'], x = θ₂ − ratio θ₁ − offset",
    source = "Nordin & Gutman, Automatica 38 (2002) 1633",
    example = "{ between: [pinion, wheel], ratio: -0.5, backlash: 0.2 deg, stiffness: 2e3, damping: 0.5 }"
)]
pub struct Backlash {
    /// Two bodies (their angles about z) or two joints.
    pub between: [Rotating; 2],
    /// Angle of the second per angle of the first; negative for external gears.
    #[quantity(unit = "1", constant, nonzero)]
    pub ratio: Formula,
    /// Angle of the second where that of the first is zero.
    #[quantity(unit = "rad", constant, default = 0)]
    #[key(image = Turning)]
    pub offset: Formula,
    /// Angle by which the second can turn while the first is fixed.
    #[quantity(unit = "rad", constant, nonnegative)]
    pub backlash: Formula,
    /// Stiffness of the teeth, referred to the second.
    #[quantity(unit = "N*m/rad")]
    pub stiffness: Formula,
    /// Damping of the teeth, referred to the second.
    #[quantity(unit = "N*m*s/rad", default = 0)]
    pub damping: Formula,
    /// Angle over which teeth come to bear, either way.
    #[quantity(
        unit = "rad",
        constant,
        positive,
        default_with(
            "a hundredth of `backlash`, at least 1e-7 rad",
            Formula::number(TUNING.bearing_of_teeth).combined(Binary::Mul, &backlash).combined(Binary::Max, &Formula::number(TUNING.sharpest_bearing))
        )
    )]
    pub transition: Formula,
}

impl ForceElement for Backlash {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::ANGLE, Dimension::ANGLE),
        (Sensor::RATE, Dimension::ANGULAR_VELOCITY),
        (Sensor::TORQUE, Dimension::TORQUE),
    ];

    fn coordinates(&self) -> Vec<OnJoint> {
        let joint = |rotating: &Rotating| match rotating {
            Rotating::Joint(joint) => Some(OnJoint { joint: *joint, coordinate: JointCoordinate::Angle }),
            Rotating::Body { .. } => None,
        };
        self.between.iter().filter_map(joint).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let (ratio, offset) = (forces.value(&self.ratio)?, forces.value(&self.offset)?);
        let (play, corner) = (forces.value(&self.backlash)?, forces.value(&self.transition)?);
        let (stiffness, damping) = (forces.value(&self.stiffness)?, forces.value(&self.damping)?);
        let [place, rate] = [TimeOrder::Position, TimeOrder::Velocity].map(|order| {
            let [first, second] = self.between.map(|of| forces.angle(of, order));
            second - ratio * first
        });
        let place = place - offset;
        let half = 0.5 * play;
        let (ahead, behind) = (place - half, -place - half);
        if play.is_zero() {
            let torque = stiffness * place + damping * rate;
            forces.torque_about(self.between[0], ratio * torque)?;
            forces.torque_about(self.between[1], -torque)?;
            forces.potential(&[stiffness, ratio, offset], 0.5 * stiffness * (place * place));
            forces.sensors([(Sensor::ANGLE, place), (Sensor::RATE, rate), (Sensor::TORQUE, torque)]);
            return Ok(());
        }
        // |x| − b/2 + ε
        let bearing_at = place.abs() - (half - corner);
        forces.only_where(bearing_at);
        let [ahead, behind] = [ahead, behind].map(|depth| PositivePart::of(depth, corner));
        let torque = stiffness * (ahead.value - behind.value) + damping * (ahead.derivative + behind.derivative) * rate;
        let (back, forth) = (-torque, ratio * torque);
        forces.torque_about(self.between[0], forth)?;
        forces.torque_about(self.between[1], back)?;
        let torque = torque.only_where(bearing_at);
        let potential = (stiffness * (ahead.integral + behind.integral)).only_where(bearing_at);
        forces.potential(&[stiffness, play, corner, ratio, offset], potential);
        forces.sensors([(Sensor::ANGLE, place), (Sensor::RATE, rate), (Sensor::TORQUE, torque)]);
        Ok(())
    }
}
