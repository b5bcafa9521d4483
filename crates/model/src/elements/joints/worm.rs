//! Worm gear: a worm and its wheel about axes that cross at right angles, apart from one another.
//!
//! ```text
//! Φ = φ₂ − i φ₁ − offset = 0,   i = −σ ratio      1 row, rad
//!     σ = sign(γ) sign(a₂ · t), of angles against the common body
//! r₁ = d κ/(1 + κ),   r₂ = d/(1 + κ),   κ = ratio/tan |γ|          pitch radii, d the axes' distance, m
//! F = f a₁ − f tan γ t + |f| (tan α/cos γ) e,   f r₂ = ± λ         on the wheel at the pitch point, N
//! N = |f|/(cos α cos γ)                                            between the flanks, N
//! ```
//!
//! e leads from the worm's axis a₁ to the wheel's, a₂, where they are nearest, t = a₁ × e. The thread runs along cos γ
//! t + sin γ a₁: a right-handed worm (γ > 0) that turns about a₁ pushes the wheel's teeth along −a₁. α is the pressure
//! angle across the thread. Without friction the worm drives the wheel as well as the wheel the worm; with an effect
//! `tooth_friction` the worm's efficiency is tan γ/tan(γ + ρ), the wheel's tan(γ − ρ)/tan γ, tan ρ = μ/cos α, and where
//! γ < ρ the wheel cannot drive.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::elements::meshing::{Flanks, Meshing};
use crate::grammar::{JointCoordinate, MeshKind, OnJoint, Requirement, RotatingJoint};
use crate::multibody::{BuildError, Vector};

use super::teeth::{Mesh, PRESSURE, ToothForce};
use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows};
use crate::elements::tuning::TUNING;

const LEAD: Requirement = Requirement {
    holds: |value| value != 0.0 && value.abs() < std::f64::consts::FRAC_PI_2,
    message: "must be below 90 deg, and not zero",
};

/// A worm and its wheel: angle of the wheel = ±ratio * angle of the worm + offset, by the hand of the thread.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "worm",
    what = "a worm gear",
    equation = "φ₂ − i φ₁ − offset = 0, |i| = ratio",
    equation = "F = f a₁ − f tan γ t + |f| tan α/cos γ e at the pitch point, f = τ₂/r₂",
    source = "Norton, Machine Design (2014), ch. 13; Niemann & Winter, Maschinenelemente III (1986)",
    example = "{ worm: thread, wheel: axle, ratio: 2/40, lead_angle: 12 deg }"
)]
pub struct Worm {
    /// Revolute joint that holds the worm.
    worm: RotatingJoint,
    /// Revolute joint that holds the wheel, on the same body, at right angles to the worm's and apart from it.
    wheel: RotatingJoint,
    /// Turns of the wheel for one of the worm: the worm's starts over the wheel's teeth.
    #[quantity(unit = "1", positive, constant)]
    ratio: Formula,
    /// Lead angle of the thread against the plane across the worm's axis; positive for a right-handed worm.
    #[quantity(unit = "rad", constant, requires = LEAD)]
    #[key(image = Turning)]
    lead_angle: Formula,
    /// Pressure angle of the flanks across the thread.
    #[quantity(unit = "rad", constant, requires = PRESSURE)]
    #[key(otherwise = "20 deg")]
    pressure_angle: Option<Formula>,
    /// Angle of the wheel where that of the worm is zero.
    #[quantity(unit = "rad", default = 0, constant)]
    #[key(image = Turning)]
    offset: Formula,
}

/// Where worm and wheel touch, in the frame of the body that holds both.
struct PitchPoint<'g, 'k> {
    mesh: Mesh<'g, 'k>,
    at: Vector<'g>,
    /// t and e.
    across: Vector<'g>,
    outward: Vector<'g>,
    /// r₂
    wheel_radius: Scalar<'g>,
    /// sin γ, cos γ
    lead: [Scalar<'g>; 2],
    /// i over the ratio: 1 or −1.
    sense: f64,
    /// Force along a₁ on the wheel over λ, times r₂: 1 or −1.
    push: f64,
}

impl Worm {
    fn on(&self) -> [OnJoint; 2] {
        [self.worm, self.wheel].map(|joint| OnJoint { joint: joint.0, coordinate: JointCoordinate::Angle })
    }

    fn pressure<'g>(&self, k: &dyn Kinematics<'g>) -> Result<Scalar<'g>, BuildError> {
        match &self.pressure_angle {
            Some(angle) => k.number(angle),
            None => Ok(k.graph().number(TUNING.pressure_of_worm.to_radians())),
        }
    }

    fn pitch_point<'g, 'k>(&self, own: usize, k: &'k dyn Kinematics<'g>) -> Result<PitchPoint<'g, 'k>, BuildError> {
        let mesh = Mesh::of(k, own, self.on())?;
        let [worm, wheel] = mesh.toothed;
        if mesh.nominal(worm.axis.dot(wheel.axis)).abs() > TUNING.aligned {
            return Err(mesh.refused("the axes of worm and wheel do not cross at right angles"));
        }
        let offset = wheel.center - worm.center;
        let along = offset.dot(worm.axis);
        let apart = offset - along * worm.axis - offset.dot(wheel.axis) * wheel.axis;
        let distance = apart.norm();
        if mesh.nominal(distance) <= 0.0 {
            return Err(mesh
                .refused("the axes of worm and wheel intersect: they have to be the sum of their pitch radii apart"));
        }
        let outward = apart / distance;
        let angle = k.number(&self.lead_angle)?;
        let hand = mesh.nominal(angle).signum();
        let lead = [angle.sin(), angle.cos()];
        let share = k.number(&self.ratio)? * lead[1] / (hand * lead[0]);
        let wheel_radius = distance / (1.0 + share);
        let across = worm.axis.cross(outward);
        // Whether the wheel's rim moves along a₁ where the wheel turns about a₂.
        let rim = mesh.nominal(wheel.axis.dot(across)).signum();
        Ok(PitchPoint {
            at: worm.center + along * worm.axis + share * wheel_radius * outward,
            across,
            outward,
            wheel_radius,
            lead,
            sense: -rim * hand * worm.sign * wheel.sign,
            push: -rim * wheel.sign,
            mesh,
        })
    }
}

impl JointElement for Worm {
    const SPATIAL: bool = true;
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] =
        &[RowDocs {
            name: "", unit: "rad", multiplier: "N m: −λ is the torque on the wheel, i λ that on the worm"
        }];
}

impl Joint for Worm {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        self.on().to_vec()
    }

    fn tooth_force<'g>(
        &self,
        own: usize,
        k: &dyn Kinematics<'g>,
        lambda: Scalar<'g>,
    ) -> Result<Option<ToothForce<'g>>, BuildError> {
        let PitchPoint { mesh, at, across, outward, wheel_radius, lead: [sin, cos], sense, push } =
            self.pitch_point(own, k)?;
        let [worm, wheel] = mesh.toothed;
        let pressure = self.pressure(k)?;
        let along = push * lambda / wheel_radius;
        let opening = pressure.sin() / (pressure.cos() * cos);
        let force = along * worm.axis - along * (sin / cos) * across + opening * along.abs() * outward;
        let [on_worm, on_wheel] = self.on();
        Ok(Some(ToothForce {
            bodies: [worm.body, wheel.body],
            at: k.place(mesh.common, at),
            force: k.rotated(mesh.common, force),
            magnitude: along.abs() / (pressure.cos() * cos),
            instead: [(on_worm, sense * k.number(&self.ratio)? * lambda), (on_wheel, -lambda)],
        }))
    }

    fn mesh_kind(&self) -> Option<MeshKind> {
        Some(MeshKind::Sliding)
    }

    fn meshing<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Result<Option<Meshing<'g>>, BuildError> {
        let PitchPoint { mesh, at, across, wheel_radius, lead: [sin, cos], .. } = self.pitch_point(own, k)?;
        let [worm, wheel] = mesh.toothed;
        let pressure = self.pressure(k)?;
        Ok(Some(Meshing::Sliding(Flanks {
            bodies: [worm.body, wheel.body],
            at: k.place(mesh.common, at),
            along: k.rotated(mesh.common, cos * across + sin * worm.axis),
            load: 1.0 / (wheel_radius * pressure.cos() * cos),
        })))
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (ratio, offset) = (k.number(&self.ratio)?, k.number(&self.offset)?);
        let sense = self.pitch_point(own, k)?.sense;
        let [worm, wheel] = self.on();
        let value = k.coordinate(wheel) - sense * ratio * k.coordinate(worm) - offset;
        Ok(vec![Row { name: "", value, force: Vector::zero(k.graph()), torque: -k.axis(wheel)? }])
    }
}
