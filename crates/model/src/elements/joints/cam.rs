//! Cam: a follower stays on a profile that turns with the first body.
//!
//! ```text
//! roller   Φ = (|d| − b − s(α)) / N = 0          α = phase − θ,  θ the polar angle of d          1 row, m
//! flat     Φ = n · d − b − s(α) = 0              α = phase − θ,  θ the angle of n                1 row, m
//! ```
//!
//! d = r_B − r_A in the plane normal to the first frame's z, angles being counted from that frame's x, α between 0 and
//! 2π; b is the base radius and s the lift. B is the roller's centre, so that b + s is the pitch curve in polar
//! coordinates, or a point of the flat face, whose normal n is fixed in the second frame and points away from the cam:
//! b + s is then the profile's support function. A follower that moves radially by b + s(φ) while the cam turns by φ
//! has exactly this profile.
//!
//! N = √(1 + (s'/|d|)²) makes ∂Φ/∂r_B the unit normal of the pitch curve, (d + s' z × d/|d|)/(N |d|), so λ is the
//! contact force, N: −Φ_qᵀ λ pushes the roller's centre with −λ along that normal; its pressure angle is atan(s'/|d|).
//! The flat face is pushed with −λ n at the contact, s' from the foot of the perpendicular from A: at B that has the
//! torque −λ (z × n · d + s'). λ < 0 is contact; the follower is guided on both sides, so that λ > 0 says where a
//! single profile would lose it. It fails at d = 0, and where b + s + s″ ≤ 0 a flat face cannot touch the profile.
//!
//! A table is a function of the formula: `lift: rise(angle)`. It has to join smoothly where α goes from 2π to 0.

use mbint_derive::{Choice, Element};
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::{Direction, OfAngle, PointRef};
use crate::multibody::Vector;

use super::rows::Frames;
use super::{Joint, JointElement, Kinematics, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// A follower stays on a profile that turns with the first body.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "cam",
    what = "a cam",
    equation = "roller: |d| − base − s(phase − θ) = 0, d = r_B − r_A, θ its polar angle in the first frame",
    equation = "flat: n · d − base − s(phase − θ) = 0, n the face's normal, θ its angle in the first frame",
    source = "Norton, Cam Design and Manufacturing Handbook (2009), ch. 7",
    example = "{ between: [wheel, follower], base: 30 mm, lift: 0.005*(1 - cos(angle)) }"
)]
pub struct Cam {
    /// The cam's centre, then the roller's centre or a point of the flat face; each `body.point` or `body`.
    between: [PointRef; 2],
    /// Kind of follower.
    #[key(default = Follower::Roller)]
    follower: Follower,
    /// Distance of the follower from the centre where the lift is zero; of a roller's centre: with its radius.
    #[quantity(unit = "m", positive, constant)]
    base: Formula,
    /// Rise of the follower over `base`: a formula of `angle`, from 0 to 2π in a turn of the cam.
    #[quantity(unit = "m")]
    lift: OfAngle,
    /// Angle from the first frame's x to the follower where the lift's `angle` is zero.
    #[quantity(unit = "rad", default = 0, constant)]
    phase: Formula,
    /// Normal of the flat face in the second frame, away from the cam.
    #[key(default = Direction::along(1))]
    normal: Direction,
}

/// Follower of a cam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Choice)]
pub enum Follower {
    /// A roller about the second point, or a knife edge there.
    Roller,
    /// A flat face through the second point.
    Flat,
}

impl JointElement for Cam {
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "m",
        multiplier: "N: −λ is the contact's force on the follower along the normal away from the cam",
    }];
}

impl Joint for Cam {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Distance(&self.base), orientation: Orientation::Free })
    }

    /// Contact.
    fn axial_by_multiplier(&self) -> Option<f64> {
        Some(-1.0)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let g = k.graph();
        let (base, phase) = (k.number(&self.base)?, k.number(&self.phase)?);
        let frames = Frames::of(k, self.between);
        let [x, y, z] = [0, 1, 2].map(|axis| frames.outward(Vector::along(g, axis)));
        let offset = frames.offset();
        // Components of `pointer` in the first frame, seen from `phase`: the cosine and sine of −α.
        let angle_of = |pointer: Vector<'g>| {
            let (along, across) = (x.dot(pointer), y.dot(pointer));
            let (cos, sin) = (phase.cos(), phase.sin());
            let (from, beside) = (cos * along + sin * across, cos * across - sin * along);
            std::f64::consts::PI + beside.atan2(-from)
        };
        let row = match self.follower {
            Follower::Roller => {
                let planar = offset - z.dot(offset) * z;
                let distance = planar.norm();
                let [lift, derivative] = k.of_angle(&self.lift, angle_of(planar))?;
                let tangent = derivative / distance;
                let scale = (1.0 + tangent * tangent).sqrt();
                let radial = planar / distance;
                let normal = (radial + tangent * z.cross(radial)) / scale;
                let value = (distance - base - lift) / scale;
                Row { name: "", value, force: -normal, torque: Vector::zero(g) }
            }
            Follower::Flat => {
                let normal = frames.outward_of_second(k.unit_vector(&self.normal)?);
                let [lift, derivative] = k.of_angle(&self.lift, angle_of(normal))?;
                let value = normal.dot(offset) - base - lift;
                let arm = z.cross(normal).dot(offset) + derivative;
                Row { name: "", value, force: -normal, torque: -(arm * z) }
            }
        };
        Ok(vec![row])
    }
}
