//! Rolling on a plane: a disc or a ball rolls without slip, in space.
//!
//! ```text
//! Φ = n · (r_B − r_A) − radius |w| = 0                               1 row, m
//! Ψ = ⎡ t₁ · (v_B + ω_B × s − v_A − ω_A × (r_B + s − r_A)) ⎤ = 0       2 rows, m/s
//!     ⎣ t₂ · (v_B + ω_B × s − v_A − ω_A × (r_B + s − r_A)) ⎦
//! w = n − (n · u) u,   s = −radius w/|w|                             ball: w = n
//! ```
//!
//! B is the centre, u the axle and n the normal of the plane through A. t₁ = u × n/|w| is the way the disc rolls, t₂ =
//! n × t₁; of a ball they are any two directions in the plane. s goes from the centre to the lowest point of the rim,
//! which has no velocity against the plane. Ψ is no derivative of positions: a disc that is rolled about comes back
//! elsewhere, so that it may be put anywhere on the plane, at any angle, and moves from there in three ways.
//!
//! The forces −λ n, −λ₁ t₁ and −λ₂ t₂ are on the disc where it touches: −Φ_qᵀ λ − Ψ_vᵀ (λ₁, λ₂). The plane's body has
//! the opposites there. All hold whatever their size: `friction` of a `contact` says when a wheel slips or leaves the
//! plane. A disc that lies flat has no lowest point.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::grammar::{Direction, PointRef};
use crate::multibody::{BuildError, Vector};

use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// A disc or a ball rolls without slip on a plane, in space.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "rolling_on_plane",
    what = "a disc that rolls on a plane",
    equation = "n · (r_B − r_A) − radius |n − (n · u) u| = 0",
    equation = "t₁ · (v_B + ω_B × s − v_A − ω_A × (r_B + s − r_A)) = 0, s from the centre to where it touches",
    equation = "t₂ · (v_B + ω_B × s − v_A − ω_A × (r_B + s − r_A)) = 0",
    source = "Neimark & Fufaev, Dynamics of Nonholonomic Systems (1972), ch. 1",
    example = "{ between: [ground, disc], axle: y, radius: 0.1 }"
)]
pub struct RollingOnPlane {
    /// A point of the plane, then the centre of the disc; each `body.point` or `body`.
    between: [PointRef; 2],
    /// Normal of the plane in the first body's frame; the disc is on the side to which it points.
    #[key(default = Direction::along(2))]
    normal: Direction,
    /// Axle of the disc in the second body's frame; without it, a ball rolls.
    axle: Option<Direction>,
    /// Radius of the disc.
    #[quantity(unit = "m", positive, constant)]
    radius: Formula,
}

impl JointElement for RollingOnPlane {
    const SPATIAL: bool = true;
    const ROWS: &'static [RowDocs] = &[
        RowDocs { name: "normal", unit: "m", multiplier: "N: −λ is the force on the disc away from the plane" },
        RowDocs {
            name: "along, across",
            unit: "m/s",
            multiplier: "N: −λ is the force on the disc where they touch, along the way it rolls and across it in the plane",
        },
    ];
}

/// Where the disc touches.
struct Touch<'g> {
    /// The plane's normal, in the ground's axes.
    normal: Vector<'g>,
    /// Two directions in the plane.
    tangents: [Vector<'g>; 2],
    /// Height of the centre over the plane.
    height: Scalar<'g>,
    /// Vector from the centre to the lowest point.
    arm: Vector<'g>,
}

impl RollingOnPlane {
    fn touch<'g>(&self, k: &dyn Kinematics<'g>) -> Result<Touch<'g>, BuildError> {
        let radius = k.number(&self.radius)?;
        let frames = Frames::of(k, self.between);
        let axis = k.unit_vector(&self.normal)?;
        let normal = frames.outward(axis);
        let Some(axle) = &self.axle else {
            let tangents = frames.normals(axis).map(|tangent| frames.outward(tangent));
            return Ok(Touch { normal, tangents, height: radius, arm: -radius * normal });
        };
        let axle = frames.outward_of_second(k.unit_vector(axle)?);
        let up = normal - normal.dot(axle) * axle;
        let steepness = up.norm();
        let along = (1.0 / steepness) * axle.cross(normal);
        let tangents = [along, normal.cross(along)];
        Ok(Touch { normal, tangents, height: radius * steepness, arm: -(radius / steepness) * up })
    }
}

impl Joint for RollingOnPlane {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Unknown, orientation: Orientation::Free })
    }

    fn reaction_axis(&self) -> Option<&[Formula; 3]> {
        Some(&self.normal)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Plane
    }

    fn direction(&self) -> Option<&[Formula; 3]> {
        Some(&self.normal)
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let Touch { normal, height, arm, .. } = self.touch(k)?;
        let [a, b] = k.points(self.between);
        let value = normal.dot(b - a) - height;
        Ok(vec![Row { name: "normal", value, force: -normal, torque: -arm.cross(normal) }])
    }

    fn is_nonholonomic(&self) -> bool {
        true
    }

    fn velocity_rows<'g>(&self, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let Touch { tangents, arm, .. } = self.touch(k)?;
        let [a, b] = k.points(self.between);
        let arms = [b + arm - a, arm];
        let [on_plane, on_disc] = [0, 1].map(|end| {
            let point = self.between[end];
            k.velocity(point) + k.angular_velocity(point.body).cross(arms[end])
        });
        let row = |(name, tangent): (&'static str, Vector<'g>)| Row {
            name,
            value: tangent.dot(on_disc - on_plane),
            force: -tangent,
            torque: -arm.cross(tangent),
        };
        Ok(["along", "across"].into_iter().zip(tangents).map(row).collect())
    }
}
