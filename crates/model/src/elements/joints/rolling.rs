//! Rolling: a wheel rolls without slip along a straight rail, in the plane.
//!
//! ```text
//! Φ = ⎡ n · (r_B − r_A) − radius                        ⎤ = 0          2 rows, m
//!     ⎣ t · (r_B − r_A) + radius (θ_B − θ_A) − offset   ⎦
//! ```
//!
//! B is the wheel's centre. The rail goes through A along t, and does not end; n is t turned by a right angle, so that
//! a wheel on a rail along x is above it. −Φ_qᵀ λ of the first row is the force −λ n on the wheel, that of the second
//! the force −λ t where it touches: at B with the torque −λ radius. The rail has the opposites there. Both hold
//! whatever their size: `friction` of a `contact` says when a wheel slips or leaves its rail.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{Checked, Direction, Fields, PointRef, Reader, SymbolTable};
use crate::multibody::Vector;
use crate::syntax::codes::Code;

use super::rows::planar_normal;
use super::{Joint, JointElement, Kinematics, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// A wheel rolls without slip along a straight rail, in the plane.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "rolling",
    what = "a rolling wheel",
    equation = "n · (r_B − r_A) − radius = 0",
    equation = "t · (r_B − r_A) + radius (θ_B − θ_A) − offset = 0",
    source = "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed. (2002), sec. 2.4",
    example = "{ between: [ground.beside, disc], axis: x, radius: 0.1 }",
    checked
)]
pub struct Rolling {
    /// A point of the rail, then the wheel's centre; each `body.point` or `body`.
    between: [PointRef; 2],
    /// Direction of the rail in the first body's frame; the wheel is on its left.
    #[key(image = Axial)]
    axis: Direction,
    /// Radius of the wheel.
    #[quantity(unit = "m", positive, constant)]
    radius: Formula,
    /// How far along the rail the wheel is where its angle is the rail's. It gets there by turning clockwise.
    #[quantity(unit = "m", default = 0, constant)]
    #[key(image = Turning)]
    offset: Formula,
}

impl Checked for Rolling {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if reader.model.is_spatial() {
            let help = "in space `rolling_on_plane` rolls a disc; on a rail a `rack` couples the angle of an axle to the way of its carriage";
            reader.error(
                Code::NotPlanar,
                fields.at.clone(),
                "a `rolling` wheel is one of the plane, but the model is spatial",
                help.to_owned(),
            );
        }
    }
}

impl JointElement for Rolling {
    const ROWS: &'static [RowDocs] = &[
        RowDocs { name: "normal", unit: "m", multiplier: "N: −λ is the force on the wheel away from the rail" },
        RowDocs {
            name: "slip",
            unit: "m",
            multiplier: "N: −λ is the force on the wheel along the rail, where they touch",
        },
    ];
}

impl Joint for Rolling {
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
        Glyph::Gear
    }

    fn direction(&self) -> Option<&[Formula; 3]> {
        Some(&self.axis)
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (radius, offset) = (k.number(&self.radius)?, k.number(&self.offset)?);
        let height = planar_normal(k, self.between, &self.axis)?;
        let along = k.rotated(self.between[0].body, k.unit_vector(&self.axis)?);
        let [a, b] = k.points(self.between);
        let [of_rail, of_wheel] = self.between.map(|point| k.angle(point.body));
        let value = along.dot(b - a) + radius * (of_wheel - of_rail) - offset;
        let torque = -radius * Vector::along(k.graph(), 2);
        Ok(vec![Row { value: height.value - radius, ..height }, Row { name: "slip", value, force: -along, torque }])
    }
}
