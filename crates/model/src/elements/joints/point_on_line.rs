//! Point on line: the second point slides along a line fixed in the first body; the bodies may turn in any way.
//!
//! ```text
//! Φ = nᵢ · (r_B − r_A) = 0          2 rows, m; in the plane, where it is a pin in a slot, 1
//! ```
//!
//! The nᵢ are the line's unit normals; it goes through A and does not end. −Φ_qᵀ λ is the force −λ nᵢ at B on the
//! second body and the opposite on the first, at the same point.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{Direction, PointRef};

use super::rows::point_on_line;
use super::{Joint, JointElement, Kinematics, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves along a line through the first, fixed in the first body.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "point_on_line",
    what = "a point on a line",
    equation = "nᵢ · (r_B − r_A) = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "{ between: [ground, bead], axis: x }"
)]
pub struct PointOnLine {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction of the line in the first body's frame.
    pub axis: Direction,
}

impl JointElement for PointOnLine {
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along the line's normal; in the plane",
        },
        RowDocs {
            name: "normal_1, normal_2",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along a normal of the line",
        },
    ];
}

impl Joint for PointOnLine {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Free })
    }

    fn reaction_axis(&self) -> Option<&[Formula; 3]> {
        Some(&self.axis)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Slot
    }

    fn direction(&self) -> Option<&[Formula; 3]> {
        Some(&self.axis)
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        point_on_line(k, self.between, &self.axis)
    }
}
