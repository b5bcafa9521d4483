//! Pin in slot: the second point slides along a line fixed in the first body, and may turn about the frames' z.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 e_x, 2 e_y     ⎦              in the plane 1 row, m
//! ```
//!
//! The nᵢ are the slot's unit normals; the slot goes through A and does not end. −Φ_qᵀ λ of the first rows is the force
//! −λ nᵢ at B on the second body (the pin) and the opposite on the first (the slot), at the same point. In the plane
//! the first row of the prismatic joint.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{Direction, PointRef};

use crate::multibody::Vector;

use super::rows::{Frames, point_on_line};
use super::{Joint, JointElement, Kinematics, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves along a line through the first, fixed in the first body; it may turn about z.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "pin_in_slot",
    what = "a pin in a slot",
    equation = "nᵢ · (r_B − r_A) = 0",
    equation = "2 e_x = 2 e_y = 0 (in space)",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4",
    example = "{ between: [link.S, crank.P], axis: x }"
)]
pub struct PinInSlot {
    /// A point of the slot's line, then the pin; each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction of the slot in the first body's frame.
    pub axis: Direction,
}

impl JointElement for PinInSlot {
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "",
            unit: "m",
            multiplier: "N: −λ is the force on the pin along the slot's normal; in the plane",
        },
        RowDocs {
            name: "normal_1, normal_2",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along a normal of the line",
        },
        RowDocs {
            name: "tilt_1, tilt_2",
            unit: "rad",
            multiplier: "N m: −λ is the torque on the second body across the axis",
        },
    ];
}

impl Joint for PinInSlot {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
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
        let mut rows = point_on_line(k, self.between, &self.axis)?;
        if k.is_spatial() {
            let z = Vector::along(k.graph(), 2);
            rows.extend(Frames::of(k, self.between).coaxial(z));
        }
        Ok(rows)
    }
}
