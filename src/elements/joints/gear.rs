//! Gear: two angles in a fixed ratio.
//!
//! ```text
//! Φ = φ₂ − ratio φ₁ − offset = 0          1 row, rad
//! ```
//!
//! φ is the angle of a body about z, or of a joint about its axis. An external pair has a negative ratio. −Φ_qᵀ λ is the
//! torque −λ on the second and +ratio λ on the first; the difference is carried by whatever holds the axles, so this is no
//! pair of action and reaction. A torque on a joint's angle acts on its second body, and the opposite on its first. Where
//! teeth touch and at which angle is not told: the motion does not depend on it, but the reactions of the bearings do, and
//! are refused where something asks for them.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{JointCoordinate, OnJoint, Rotating};
use crate::multibody::Vector;

use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows, Toothed};

/// Angles in a fixed ratio: angle of the second = ratio * angle of the first + offset.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "gear",
    what = "a gear",
    equation = "φ₂ − ratio φ₁ − offset = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4",
    example = "{ between: [pinion, wheel], ratio: -0.5 }"
)]
pub struct Gear {
    /// Two bodies (their angles about z) or two joints.
    pub between: [Rotating; 2],
    /// Angle of the second per angle of the first; negative for external gears.
    #[quantity(unit = "1", nonzero, constant)]
    pub ratio: Formula,
    /// Angle of the second where that of the first is zero.
    #[quantity(unit = "rad", default = 0, constant)]
    pub offset: Formula,
}

impl JointElement for Gear {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "rad",
        multiplier: "N m: −λ is the torque on the second, +ratio λ that on the first",
    }];
}

/// The coordinate of an angle that is a joint's.
fn of_joint(angle: Rotating) -> Option<OnJoint> {
    match angle {
        Rotating::Joint(joint) => Some(OnJoint { joint, coordinate: JointCoordinate::Angle }),
        Rotating::Body(_) => None,
    }
}

impl Joint for Gear {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        self.between.into_iter().filter_map(of_joint).collect()
    }

    fn toothed(&self) -> Toothed {
        let mut toothed = Toothed::default();
        for angle in self.between {
            match angle {
                Rotating::Joint(joint) => toothed.joints.push(joint),
                Rotating::Body(body) => toothed.bodies.push(body),
            }
        }
        toothed
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (ratio, offset) = (k.number(&self.ratio)?, k.number(&self.offset)?);
        let [first, second] = self.between.map(|angle| match angle {
            Rotating::Body(body) => k.angle(body),
            Rotating::Joint(joint) => k.coordinate(OnJoint { joint, coordinate: JointCoordinate::Angle }),
        });
        let value = second - ratio * first - offset;
        let axis = match of_joint(self.between[1]) {
            Some(on) => k.axis(on)?,
            None => Vector::along(k.graph(), 2),
        };
        Ok(vec![Row { name: "", value, force: Vector::zero(k.graph()), torque: -axis }])
    }
}
