//! Revolute joint: two points coincide, and the frames turn about an axis against one another.
//!
//! ```text
//! Φ = ⎡ r_A − r_B ⎤ = 0          3 rows, m; 2 rows, rad (n₁, n₂ normal to the axis; see `pair`)
//!     ⎣ 2 nᵢ · e  ⎦              in the plane 2 rows, m
//! ```
//!
//! A on the first, B on the second body. −Φ_qᵀ λ of the first rows is the force +λ at B on the second body and −λ at A
//! on the first: λ is the pin's force on the second body, in the ground's axes. The others carry the torque across the
//! axis. Nothing fails; with both points on prescribed coordinates a row vanishes.

use mbint_derive::Element;

use crate::grammar::{Axis, PointRef};

use super::rows::{Frames, coincident};
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// Two points coincide, and the bodies turn about an axis against one another.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "revolute",
    what = "a revolute joint",
    equation = "r_A − r_B = 0",
    equation = "2 nᵢ · e = 0, nᵢ normal to the axis (in space)",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4 and 7",
    example = "[ground, crank.A]",
    short = "between"
)]
pub struct Revolute {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in both points' frames.
    #[key(default = Axis::z())]
    pub axis: Axis,
}

impl JointElement for Revolute {
    const TURNS: bool = true;
    const ROWS: &'static [RowDocs] = &[
        RowDocs {
            name: "x, y, z",
            unit: "m",
            multiplier: "N: the force on the second body at B along the ground's axis",
        },
        RowDocs {
            name: "tilt_1, tilt_2",
            unit: "rad",
            multiplier: "N m: −λ is the torque on the second body across the axis",
        },
    ];
}

impl Joint for Revolute {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Rotation { axis: &self.axis })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Coincident, orientation: Orientation::AboutAxis })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let mut rows = coincident(k, self.between);
        if k.is_spatial() {
            let axis = k.unit_vector(&self.axis)?;
            rows.extend(Frames::of(k, self.between).coaxial(axis));
        }
        Ok(rows)
    }
}
