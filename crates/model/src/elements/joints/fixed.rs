//! Fixed joint: two bodies are welded.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 3 rows, rad (see `pair`)
//!     ⎣ 2 e       ⎦
//! in the plane ⎡ r_A − r_B        ⎤ = 0          2 rows, m; 1 row, rad
//!              ⎣ θ₂ − θ₁ − angle  ⎦
//! ```
//!
//! The second frame is turned by `angle` about the first's z. The first rows are those of the spherical joint: λ is the
//! force on the second body, at B. −Φ_qᵀ λ of the others is a torque −λ on the second body and +λ on the first, in the
//! axes of the turned first frame.

use mbint_derive::Element;
use symdiff::Formula;

use crate::grammar::PointRef;

use super::rows::{Frames, coincident, planar_angle};
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// Two points coincide and the bodies do not turn against one another.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "fixed",
    what = "a fixed joint",
    equation = "r_A − r_B = 0",
    equation = "2 e = 0 (in the plane θ₂ − θ₁ − angle = 0)",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4 and 7",
    example = "{ between: [ground, frame], angle: 30 deg }",
    short = "between"
)]
pub struct Fixed {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Angle of the second body against the first.
    #[quantity(unit = "rad", default = 0, constant)]
    #[key(image = Turning)]
    pub angle: Formula,
}

impl JointElement for Fixed {
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "x, y, z",
            unit: "m",
            multiplier: "N: the force on the second body at B along the ground's axis",
        },
        RowDocs { name: "angle", unit: "rad", multiplier: "N m: −λ is the torque on the second body; in the plane" },
        RowDocs {
            name: "turn_x, turn_y, turn_z",
            unit: "rad",
            multiplier: "N m: −λ is the torque on the second body about the axes of the turned first frame",
        },
    ];
}

impl Joint for Fixed {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Weld { twist: &self.angle })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::Fixed(&self.angle) })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let mut rows = coincident(k, self.between);
        if k.is_spatial() {
            let angle = k.number(&self.angle)?;
            rows.extend(Frames::of(k, self.between).turned(angle).parallel());
        } else {
            rows.push(planar_angle(k, self.between, &self.angle)?);
        }
        Ok(rows)
    }
}
