//! Planar joint: the second point moves in a plane fixed in the first body, and the frames turn about its normal.
//!
//! ```text
//! Φ = ⎡ n₁ · (r_B − r_A) ⎤ = 0          1 row, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 nᵢ · e         ⎦
//! ```
//!
//! n₁ is the plane's unit normal, through A, and the nᵢ are normal to it. −Φ_qᵀ λ of the first row is the force −λ n₁
//! at B on the second body and the opposite on the first, at the same point; the others carry the torque across the
//! normal. Its angle is that of the second frame against the first about the normal.

use mbint_derive::Element;

use crate::grammar::{Direction, PointRef};

use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves in a plane through the first, and the bodies turn about its normal.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "planar",
    what = "a planar joint",
    equation = "n₁ · (r_B − r_A) = 0",
    equation = "2 nᵢ · e = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "[ground, puck]",
    short = "between"
)]
pub struct Planar {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in both points' frames.
    #[key(default = Direction::along(2))]
    pub normal: Direction,
}

impl JointElement for Planar {
    const SPATIAL: bool = true;
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "normal",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along the normal",
        },
        RowDocs {
            name: "tilt_1, tilt_2",
            unit: "rad",
            multiplier: "N m: −λ is the torque on the second body across the axis",
        },
    ];
}

impl Joint for Planar {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::PlanarMotion { normal: &self.normal })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let normal = k.unit_vector(&self.normal)?;
        let frames = Frames::of(k, self.between);
        let mut rows = vec![frames.normal_row("normal", normal)];
        rows.extend(frames.coaxial(normal));
        Ok(rows)
    }
}
