//! A gear pair whose teeth have play.
//!
//! ```text
//! x = θ₂ − ratio θ₁ − offset          rad, zero in the middle of the play b
//! τ = k [p(x − b/2) − p(−x − b/2)] + c ẋ [p'(x − b/2) + p'(−x − b/2)]          N m
//! −τ on the second wheel, +ratio τ on the first
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): within the play nothing acts, and only x is
//! computed. The reactions of the
//! shafts on their frames (the ground, or the joints' first bodies) carry the difference of the torques, as of a rigid gear.

use mbint_derive::Element;
use symdiff::{Binary, Formula};

use super::{ForceElement, Sensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::{JointCoordinate, Measure, OnJoint, Turning};

/// Angle over which teeth come to bear, over the play.
const BEARING: f64 = 1e-2;

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
    pub between: [Turning; 2],
    /// Angle of the second per angle of the first; negative for external gears.
    #[quantity(unit = "1", constant, nonzero)]
    pub ratio: Formula,
    /// Angle of the second where that of the first is zero.
    #[quantity(unit = "rad", constant, default = 0)]
    pub offset: Formula,
    /// Angle by which the second can turn while the first is held.
    #[quantity(unit = "rad", constant, positive)]
    pub backlash: Formula,
    /// Of the teeth at the second.
    #[quantity(unit = "N*m/rad")]
    pub stiffness: Formula,
    /// Of the teeth at the second.
    #[quantity(unit = "N*m*s/rad", default = 0)]
    pub damping: Formula,
    /// Angle over which teeth come to bear, either way.
    #[quantity(
        unit = "rad",
        constant,
        positive,
        default_with("a hundredth of `backlash`", Formula::number(BEARING).combined(Binary::Mul, &backlash))
    )]
    pub transition: Formula,
}

impl ForceElement for Backlash {
    const SENSORS: &'static [Sensor] = &[
        (Measure::ANGLE, Dimension::ANGLE),
        (Measure::RATE, Dimension::ANGULAR_VELOCITY),
        (Measure::TORQUE, Dimension::TORQUE),
    ];

    fn coordinates(&self) -> Vec<OnJoint> {
        let joint = |turning: &Turning| match turning {
            Turning::Joint(joint) => Some(OnJoint { joint: *joint, coordinate: JointCoordinate::Angle }),
            Turning::Body(_) => None,
        };
        self.between.iter().filter_map(joint).collect()
    }
}
