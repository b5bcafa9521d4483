//! Cylindrical joint: the second point slides along an axis of the first frame, and the frames turn about it.
//!
//! ```text
//! Φ = ⎡ nᵢ · (r_B − r_A) ⎤ = 0          2 rows, m; 2 rows, rad (see `pair`)
//!     ⎣ 2 nᵢ · e         ⎦
//! ```
//!
//! The nᵢ are the axis' unit normals; it goes through A. −Φ_qᵀ λ of the first rows is the force −λ nᵢ at B on the
//! second body and the opposite on the first, at the same point; the others carry the torque across the axis.

use mbint_derive::Element;
use symdiff::Formula;

use crate::grammar::{Axis, PointRef};

use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, RowDocs, Rows, Separation};

/// The second point moves along an axis through the first, and the bodies turn about it.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "cylindrical",
    what = "a cylindrical joint",
    equation = "nᵢ · (r_B − r_A) = 0",
    equation = "2 nᵢ · e = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "{ between: [ground, shaft], axis: x }",
    short = "between"
)]
pub struct Cylindrical {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in both points' frames.
    #[key(default = Axis::z())]
    pub axis: Axis,
}

impl JointElement for Cylindrical {
    const SPATIAL: bool = true;
    const TURNS: bool = true;
    const ROWS: &'static [RowDocs] = &[
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

impl Joint for Cylindrical {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::RotationAndTranslation { axis: &self.axis })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        cylindrical(k, self.between, &self.axis)
    }
}

/// The rows of a cylindrical joint.
pub(super) fn cylindrical<'g>(k: &dyn Kinematics<'g>, between: [PointRef; 2], axis: &[Formula; 3]) -> Rows<'g> {
    let axis = k.unit_vector(axis)?;
    let frames = Frames::of(k, between);
    let mut rows = frames.on_line(axis).to_vec();
    rows.extend(frames.coaxial(axis));
    Ok(rows)
}
