//! Spherical joint: two points coincide.
//!
//! ```text
//! Φ = r_A − r_B = 0          3 rows, m; in the plane, where it is the pin of a revolute joint, 2
//! ```
//!
//! λ is the force on the second body, at B, in the ground's axes. No torque.

use mbint_derive::Element;

use crate::grammar::PointRef;

use super::rows::coincident;
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// Two points coincide.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "spherical",
    what = "a spherical joint",
    equation = "r_A − r_B = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "[arm.P, rod.A]",
    short = "between"
)]
pub struct Spherical {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
}

impl JointElement for Spherical {
    const SPATIAL: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "x, y, z",
        unit: "m",
        multiplier: "N: the force on the second body at B along the ground's axis",
    }];
}

impl Joint for Spherical {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::FreeRotation)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::Free })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        Ok(coincident(k, self.between))
    }
}
