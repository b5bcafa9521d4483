//! Universal joint: two points coincide, and an axis of the first frame stays perpendicular to one of the second.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 1 row, a pure number
//!     ⎣ a₁ · b₂   ⎦
//! ```
//!
//! a₁ and b₂ are unit vectors along the arms of the cross. The first rows are those of the spherical joint. −Φ_qᵀ λ of
//! the last is the torque λ a₁ × b₂ on the second body and the opposite on the first. It fails where nothing else keeps
//! the arms from lying in each other's shaft: with the shafts at a right angle, the cross can turn on its own.

use mbint_derive::Element;

use crate::grammar::{Direction, PointRef};

use crate::multibody::Vector;

use super::rows::{Frames, coincident};
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// Two points coincide, and an axis of the first frame stays perpendicular to one of the second.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "universal",
    what = "a universal joint",
    equation = "r_A − r_B = 0",
    equation = "a₁ · b₂ = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "{ between: [shaft.P, fork.A], axes: [x, y] }",
    short = "between"
)]
pub struct Universal {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// The arms of the cross: one in the first point's frame, one in the second's.
    #[key(default = [Direction::along(0), Direction::along(1)])]
    pub axes: [Direction; 2],
}

impl JointElement for Universal {
    const SPATIAL: bool = true;
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "x, y, z",
            unit: "m",
            multiplier: "N: the force on the second body at B along the ground's axis",
        },
        RowDocs { name: "cross", unit: "1", multiplier: "N m: the torque on the second body about a₁ × b₂" },
    ];
}

impl Joint for Universal {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        let [first, second] = &self.axes;
        Some(Mobilizer::TwoRotations { axes: [first, second] })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::AboutAxis })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let mut rows = coincident(k, self.between);
        let frames = Frames::of(k, self.between);
        let [first, second] = &self.axes;
        let (first, second) = (k.unit_vector(first)?, k.unit_vector(second)?);
        let (first, second) = (frames.outward(first), frames.outward_of_second(second));
        let value = first.dot(second);
        let (force, torque) = (Vector::zero(k.graph()), first.cross(second));
        rows.push(Row { name: "cross", value, force, torque });
        Ok(rows)
    }
}
