//! Prismatic joint: the second point slides along a line fixed in the first body, without relative rotation.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 3 rows, rad (see `pair`)
//!     ⎣ 2 e              ⎦
//! in the plane ⎡ n₁ · (r_B − r_A)  ⎤ = 0          1 row, m; 1 row, rad
//!              ⎣ θ₂ − θ₁ − angle   ⎦
//! ```
//!
//! The nᵢ are the line's unit normals, fixed in the first body, in the plane n₁ = R₁ (axis/|axis|)⊥; the line goes
//! through A; the second frame is turned by `angle` about the first's z. −Φ_qᵀ λ of the first rows is the force −λ nᵢ
//! at B on the second body and the opposite on the first, at the same point, for B slides: its arm on the first body is
//! r_B − r₁. That of the others is a torque −λ on the second body and +λ on the first. An axis of length zero has no
//! normal: the rows are not numbers then.

use mbint_derive::Element;
use symdiff::Formula;

use crate::grammar::{Direction, PointRef};

use super::rows::{Frames, planar_angle, planar_normal};
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves along a line through the first, without turning against the first body.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "prismatic",
    what = "a prismatic joint",
    equation = "nᵢ · (r_B − r_A) = 0",
    equation = "2 e = 0 (in the plane θ₂ − θ₁ − angle = 0)",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4 and 7",
    example = "{ between: [ground, slider], axis: x }"
)]
pub struct Prismatic {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction of the line in the first body's frame.
    pub axis: Direction,
    /// Angle of the second body against the first.
    #[quantity(unit = "rad", default = 0, constant)]
    #[key(image = Turning)]
    pub angle: Formula,
}

impl JointElement for Prismatic {
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "normal",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along the line's normal; in the plane",
        },
        RowDocs { name: "angle", unit: "rad", multiplier: "N m: −λ is the torque on the second body; in the plane" },
        RowDocs {
            name: "normal_1, normal_2",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along a normal of the line",
        },
        RowDocs {
            name: "turn_x, turn_y, turn_z",
            unit: "rad",
            multiplier: "N m: −λ is the torque on the second body about the axes of the turned first frame",
        },
    ];
}

impl Joint for Prismatic {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Translation { axis: &self.axis, twist: &self.angle })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Fixed(&self.angle) })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        if !k.is_spatial() {
            return Ok(vec![planar_normal(k, self.between, &self.axis)?, planar_angle(k, self.between, &self.angle)?]);
        }
        let axis = k.unit_vector(&self.axis)?;
        let angle = k.number(&self.angle)?;
        let frames = Frames::of(k, self.between);
        let mut rows = frames.on_line(axis).to_vec();
        rows.extend(frames.turned(angle).parallel());
        Ok(rows)
    }
}
