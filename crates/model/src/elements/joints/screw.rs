//! Screw joint: a cylindrical joint that advances as it turns.
//!
//! ```text
//! Φ = ⎡ the rows of the cylindrical joint           ⎤ = 0          4 rows; 1 row, m
//!     ⎣ a₁ · (r_B − r_A) − (pitch / 2π) φ           ⎦
//! ```
//!
//! a₁ is the axis, φ the joint's angle, never wrapped, and the pitch the advance in a turn, positive for a right-handed
//! thread. −Φ_qᵀ λ of the last row is the force −λ a₁ at B and the torque +λ (pitch / 2π) a₁ on the second body, and
//! the opposite on the first.

use mbint_derive::Element;
use symdiff::Formula;

use crate::grammar::formulas::Written;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Axis, Checked, Fields, JointCoordinate, OnJoint, PointRef, Reader, SymbolTable};
use crate::syntax::codes::Code;

use super::cylindrical::cylindrical;
use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Mobilizer, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// A cylindrical joint that advances as it turns.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "screw",
    what = "a screw joint",
    equation = "nᵢ · (r_B − r_A) = 0, 2 nᵢ · e = 0",
    equation = "a · (r_B − r_A) − pitch φ/2π = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 7",
    example = "{ between: [ground, nut], axis: x, pitch: 5 mm }",
    checked
)]
pub struct Screw {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in both points' frames.
    #[key(default = Axis::z())]
    pub axis: Axis,
    /// Advance of the second point in a turn; positive for a right-handed thread.
    #[quantity(unit = "m", nonzero, constant)]
    #[key(image = Turning)]
    pub pitch: Formula,
}

impl JointElement for Screw {
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
        RowDocs {
            name: "advance",
            unit: "m",
            multiplier: "N: −λ is the force on the second body at B along the axis, +λ pitch/2π the torque about it",
        },
    ];
}

impl Joint for Screw {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        Some(Mobilizer::Helix { axis: &self.axis, pitch: &self.pitch })
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::AboutAxis })
    }

    fn coordinates(&self, own: usize) -> Vec<OnJoint> {
        vec![OnJoint { joint: own, coordinate: JointCoordinate::Angle }]
    }

    fn rows<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let mut rows = cylindrical(k, self.between, &self.axis)?;
        let axis = k.unit_vector(&self.axis)?;
        let pitch = k.number(&self.pitch)?;
        let advance = std::f64::consts::TAU.recip() * pitch;
        let frames = Frames::of(k, self.between);
        let angle = k.coordinate(OnJoint { joint: own, coordinate: JointCoordinate::Angle });
        let value = frames.displacement(axis) - advance * angle;
        let along = frames.outward(axis);
        rows.push(Row { name: "advance", value, force: -along, torque: advance * along });
        Ok(rows)
    }
}

impl Checked for Screw {
    /// `5 mm/rev` is read as a length a radian like any other, and would be taken for that in a turn.
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let Some(node) = fields.get("pitch") else { return };
        let per_angle = match reader.written(node) {
            Some(Written::Quantity { unit, .. }) => unit.dimension.is_per_angle(),
            Some(Written::Formula(formula)) => {
                reader.kind(node, &formula, 0).dimension().is_some_and(Dimension::is_per_angle)
            }
            None => false,
        };
        if per_angle {
            let help = "a pitch is the advance in a turn: write `5 mm` for 5 mm/rev".to_owned();
            reader.error(
                Code::WrongDimension,
                node.span.clone(),
                "a length an angle stands where a length (m) belongs",
                help,
            );
        }
    }
}
