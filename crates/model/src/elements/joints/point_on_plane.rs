//! Point on plane: the second point moves in a plane fixed in the first body; the bodies may turn in any way.
//!
//! ```text
//! Φ = n₁ · (r_B − r_A) = 0          1 row, m
//! ```
//!
//! n₁ is the plane's unit normal; the plane goes through A. −Φ_qᵀ λ is the force −λ n₁ at B on the second body and the
//! opposite on the first, at the same point.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{Direction, PointRef};

use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves in a plane through the first, fixed in the first body.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "point_on_plane",
    what = "a point on a plane",
    equation = "n₁ · (r_B − r_A) = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "{ between: [ground, foot.P], normal: y }",
    short = "between"
)]
pub struct PointOnPlane {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in both points' frames.
    #[key(default = Direction::along(2))]
    pub normal: Direction,
}

impl JointElement for PointOnPlane {
    const ROWS: &'static [RowDocs] =
        &[RowDocs {
            name: "", unit: "m", multiplier: "N: −λ is the force on the second body at B along the normal"
        }];
}

impl Joint for PointOnPlane {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Free })
    }

    fn reaction_axis(&self) -> Option<&[Formula; 3]> {
        Some(&self.normal)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Plane
    }

    fn direction(&self) -> Option<&[Formula; 3]> {
        Some(&self.normal)
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let normal = k.unit_vector(&self.normal)?;
        Ok(vec![Frames::of(k, self.between).normal_row("", normal)])
    }
}
