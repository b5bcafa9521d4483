//! The force between teeth: on the second gear, at the pitch point, with its transmitted, radial and axial components.
//!
//! ```text
//! F = F_t t + |F_t| (tan αₙ / cos β) m − h F_t tan β g          N
//!     on the second gear at P, the opposite on the first
//! F_t = τ₂/ρ₂,   |F| = |F_t| / (cos αₙ cos β)
//! ```
//!
//! P is where the pitch surfaces touch, g their common line there, t the way in which the first gear's teeth move
//! across it for a positive angle, m the normal of both, from P towards the axis of the smaller gear if that is the
//! second, and away from it otherwise. ρᵢ = (aᵢ × (P − cᵢ)) · t is the gear's radius with a sign, τ₂ the torque that
//! the constraint's multiplier is; αₙ is the pressure angle across the teeth and β the helix angle, h = ±1 of the first
//! gear's hand. Teeth touch on one flank or the other: the middle part presses the gears apart whichever way torque
//! goes.
//!
//! ```text
//! parallel axes        P = c₁ + x e,   x = κ d/(κ − 1),   g = a₁
//!                      κ = (a₁ · a₂) ψ̇₂/ψ̇₁, e from c₁ to c₂, d apart
//! intersecting axes    P = O + R g,    g ∥ a₁ − (ψ̇₂/ψ̇₁) a₂               R the mean cone distance
//! rack                 P = c₁ + x e,   e = s × a₁,   x = ṡ/ψ̇₁              s along the rack
//! ```
//!
//! Angles ψ are those against the body that both bearings have in common; all of this is fixed in its frame. The
//! constraint equates angles, so its multiplier acts as torques about the axes: the force at P stands for `instead`.
//! The difference does no work, and is carried by the bearings. (Norton, *Machine Design* (2014), ch. 12 and 13.)

use mbint_derive::Element;
use schemars::Schema;
use symdiff::{Formula, Scalar};

use crate::grammar::{Checked, Fields, OnJoint, Reader, Requirement, SymbolTable};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

use super::Kinematics;
use crate::elements::tuning::TUNING;

const BELOW_RIGHT: Requirement =
    Requirement { holds: |value| value.abs() < std::f64::consts::FRAC_PI_2, message: "must be below 90 deg" };
pub(super) const PRESSURE: Requirement = Requirement {
    holds: |value| (0.0..std::f64::consts::FRAC_PI_2).contains(&value),
    message: "must be at least 0 and below 90 deg",
};

/// How teeth touch.
#[derive(Clone, Debug, Element)]
#[element(checked)]
pub struct ToothContact {
    /// Pressure angle of the teeth across their direction, e.g. `20 deg`; with it, bearings feel the teeth.
    #[quantity(unit = "rad", constant, requires = PRESSURE)]
    #[key(otherwise = "the torque alone is known, and bearings that the teeth push on have no known reactions")]
    pub pressure_angle: Option<Formula>,
    /// Helix angle: of the first gear's teeth against its axis, or of a bevel gear's against the cone; positive for a
    /// right-handed gear.
    #[quantity(unit = "rad", default = 0, constant, requires = BELOW_RIGHT)]
    #[key(image = Turning)]
    pub helix_angle: Formula,
    /// Where the middle of the teeth is along the first joint's axis, from that joint's point; of parallel axes.
    #[quantity(unit = "m", default = 0, constant)]
    pub face: Formula,
}

impl ToothContact {
    /// Teeth of which nothing is known.
    pub fn unknown() -> Self {
        Self { pressure_angle: None, helix_angle: Formula::number(0.0), face: Formula::number(0.0) }
    }
}

impl Checked for ToothContact {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        for key in ["helix_angle", "face"] {
            if fields.get(key).is_some() && fields.get("pressure_angle").is_none() {
                let help = "e.g. `pressure_angle: 20 deg`".to_owned();
                reader.error(
                    Code::MisplacedKey,
                    fields.key_span(key),
                    format!("`{key}` goes with a `pressure_angle`"),
                    help,
                );
            }
        }
    }
}

/// Says in the schema which keys need a pressure angle.
pub(super) fn constrain(schema: &mut Schema) {
    let with = |key: &str| (key.to_owned(), serde_json::json!(["pressure_angle"]));
    let needed: serde_json::Map<_, _> = ["helix_angle", "face", "cone_distance"].map(with).into_iter().collect();
    schema.insert("dependentRequired".to_owned(), serde_json::Value::Object(needed));
}

/// The force between two bodies with teeth, for the multiplier of their constraint.
#[derive(Clone, Copy, Debug)]
pub struct ToothForce<'g> {
    /// The bodies with teeth.
    pub bodies: [usize; 2],
    /// Their pitch point, in the ground's frame, m.
    pub at: Vector<'g>,
    /// Force on the second body, in the ground's axes, N.
    pub force: Vector<'g>,
    /// Its magnitude, N.
    pub magnitude: Scalar<'g>,
    /// The constraint's torques or forces on the joints' coordinates, N m or N, which the force stands for.
    pub instead: [(OnJoint, Scalar<'g>); 2],
}

/// A gear, or rack, and its bearing in the frame of the body that both bearings have in common.
#[derive(Clone, Copy)]
pub(super) struct ToothedBody<'g> {
    /// Index of the body.
    pub body: usize,
    /// 1 if the joint's coordinate is that of the toothed body against the common one, −1 if it is the opposite.
    pub sign: f64,
    /// A point of the axis.
    pub center: Vector<'g>,
    /// The unit vector along it.
    pub axis: Vector<'g>,
}

impl<'g> ToothedBody<'g> {
    /// Vector from a point to the axis, normal to it.
    fn inward(self, from: Vector<'g>) -> Vector<'g> {
        let arm = self.center - from;
        arm - arm.dot(self.axis) * self.axis
    }
}

/// A pitch point with its directions, in the common body's frame.
struct Pitch<'g> {
    at: Vector<'g>,
    /// g, t and m.
    line: Vector<'g>,
    across: Vector<'g>,
    apart: Vector<'g>,
    /// h.
    hand: f64,
    /// F_t, N.
    transmitted: Scalar<'g>,
}

/// Two bearings on a common body.
pub(super) struct Mesh<'g, 'k> {
    k: &'k dyn Kinematics<'g>,
    own: usize,
    on: [OnJoint; 2],
    /// The body that holds both, by index.
    pub common: usize,
    pub toothed: [ToothedBody<'g>; 2],
}

impl<'g, 'k> Mesh<'g, 'k> {
    /// Mesh of the coupling `own` between two joints.
    pub fn of(k: &'k dyn Kinematics<'g>, own: usize, on: [OnJoint; 2]) -> Result<Self, BuildError> {
        let names = on.map(|on| k.joint_name(on.joint));
        let refuse = |why: String| BuildError::Teeth { joint: k.joint_name(own).to_owned(), why };
        let [first, second] = on.map(|on| k.bodies(on.joint).unwrap_or_default());
        let common = first.into_iter().find(|body| second.contains(body));
        let other = |[a, b]: [usize; 2], common: usize| if a == common { b } else { a };
        let common = common.filter(|&common| other(first, common) != other(second, common)).ok_or_else(|| {
            refuse(format!("`{}` and `{}` have to hold two bodies on one that they have in common", names[0], names[1]))
        })?;
        let toothed = |on: OnJoint, bodies: [usize; 2]| {
            let [center, axis] =
                k.line(on, common)?.ok_or_else(|| refuse(format!("`{}` has no axis", k.joint_name(on.joint))))?;
            let sign = if bodies[0] == common { 1.0 } else { -1.0 };
            Ok(ToothedBody { body: other(bodies, common), sign, center, axis })
        };
        Ok(Self { k, own, on, common, toothed: [toothed(on[0], first)?, toothed(on[1], second)?] })
    }

    /// Force between two gears whose second angle is `ratio` times the first, under the torque −λ on the second.
    pub fn of_gears(
        &self,
        ratio: Scalar<'g>,
        cone_distance: Option<Scalar<'g>>,
        flanks: &ToothContact,
        lambda: Scalar<'g>,
    ) -> Result<ToothForce<'g>, BuildError> {
        let [first, second] = self.toothed;
        let efforts = [ratio * lambda, -lambda];
        // ψ̇₂/ψ̇₁, each about its own axis.
        let ratio = first.sign * second.sign * ratio;
        let (at, line) = if self.nominal(first.axis.cross(second.axis).norm()) < TUNING.aligned {
            if cone_distance.is_some() {
                return Err(self.refused("`cone_distance` goes with axes that intersect, but they are parallel"));
            }
            let sense = self.nominal(first.axis.dot(second.axis)).signum();
            (self.between_parallel(sense * ratio, flanks)?, first.axis)
        } else {
            let Some(distance) = cone_distance else {
                let why = "the axes are not parallel: bevel gears need their mean `cone_distance`";
                return Err(self.refused(why));
            };
            self.on_cones(ratio, distance)?
        };
        let across = first.axis.cross(at - first.center).unit();
        let normal = line.cross(across);
        let radii = self.toothed.map(|gear| gear.axis.cross(at - gear.center).dot(across));
        // Across the pitch surfaces the smaller gear is pushed towards its axis.
        let [a, b] = radii.map(|radius| self.nominal(radius).abs());
        let smaller = usize::from(b < a);
        let inward = self.toothed[smaller].inward(at);
        let towards = self.nominal(normal.dot(inward)).signum();
        let apart = if smaller == 1 { towards } else { -towards } * normal;
        let hand = self.nominal(line.dot(first.axis)).signum();
        let transmitted = -(second.sign * lambda) / radii[1];
        self.force(&Pitch { at, line, across, apart, hand, transmitted }, flanks, efforts)
    }

    /// The pitch point of parallel axes; `ratio` counts both angles about the first.
    fn between_parallel(&self, ratio: Scalar<'g>, flanks: &ToothContact) -> Result<Vector<'g>, BuildError> {
        let [first, second] = self.toothed;
        let offset = second.center - first.center;
        let offset = offset - offset.dot(first.axis) * first.axis;
        if self.nominal(offset.norm()) <= 0.0 {
            return Err(self.refused("the axes coincide"));
        }
        if self.nominal(ratio - 1.0).abs() < TUNING.aligned {
            return Err(self.refused("gears that turn alike have no pitch point"));
        }
        let face = self.k.number(&flanks.face)?;
        Ok(first.center + face * first.axis + ratio / (ratio - 1.0) * offset)
    }

    /// The pitch point of axes that intersect, and the direction from the apex to it.
    fn on_cones(&self, ratio: Scalar<'g>, distance: Scalar<'g>) -> Result<(Vector<'g>, Vector<'g>), BuildError> {
        let [first, second] = self.toothed;
        let offset = second.center - first.center;
        let normal = first.axis.cross(second.axis);
        let size = self.nominal(offset.norm()).max(self.nominal(distance).abs());
        if self.nominal(offset.dot(normal)).abs() > TUNING.aligned * size {
            return Err(self.refused("the axes are neither parallel nor do they intersect"));
        }
        // c₁ + u a₁ = c₂ + v a₂
        let along = offset.cross(second.axis).dot(normal) / normal.dot(normal);
        let apex = first.center + along * first.axis;
        let line = (first.axis - ratio * second.axis).unit();
        let side = self.nominal(line.dot(first.center - apex) + line.dot(second.center - apex));
        if side.abs() <= TUNING.aligned * size {
            let why = "the bearings' points have to be on the side of the apex on which the teeth are";
            return Err(self.refused(why));
        }
        let line = side.signum() * line;
        Ok((apex + distance * line, line))
    }

    /// Force between a pinion and a rack that moves by `radius` a radian of the pinion, under the force −λ on the rack.
    pub fn of_rack(
        &self,
        radius: Scalar<'g>,
        flanks: &ToothContact,
        lambda: Scalar<'g>,
    ) -> Result<ToothForce<'g>, BuildError> {
        let [pinion, rack] = self.toothed;
        if self.nominal(pinion.axis.dot(rack.axis)).abs() > TUNING.aligned {
            return Err(self.refused("the rack does not slide across the pinion's axis"));
        }
        let moved = pinion.sign * rack.sign * radius;
        let outward = rack.axis.cross(pinion.axis);
        let face = self.k.number(&flanks.face)?;
        let side = self.nominal(moved).signum();
        let pitch = Pitch {
            at: pinion.center + face * pinion.axis + moved * outward,
            line: pinion.axis,
            across: rack.axis,
            apart: side * outward,
            hand: side,
            transmitted: -(rack.sign * lambda),
        };
        self.force(&pitch, flanks, [radius * lambda, -lambda])
    }

    fn force(
        &self,
        pitch: &Pitch<'g>,
        flanks: &ToothContact,
        efforts: [Scalar<'g>; 2],
    ) -> Result<ToothForce<'g>, BuildError> {
        let k = self.k;
        let pressure = match &flanks.pressure_angle {
            Some(angle) => k.number(angle)?,
            None => k.graph().number(0.0),
        };
        let helix = k.number(&flanks.helix_angle)?;
        let pressed = pitch.transmitted.abs();
        let opening = pressure.sin() / (pressure.cos() * helix.cos());
        let mut force = pitch.transmitted * pitch.across + opening * pressed * pitch.apart;
        let mut square = 1.0 + opening * opening;
        // A thrust along the axis acts in space only.
        if k.is_spatial() {
            let slope = helix.sin() / helix.cos();
            force = force - pitch.hand * slope * pitch.transmitted * pitch.line;
            square += slope * slope;
        }
        let [first, second] = self.toothed;
        Ok(ToothForce {
            bodies: [first.body, second.body],
            at: k.place(self.common, pitch.at),
            force: k.rotated(self.common, force),
            magnitude: square.sqrt() * pressed,
            instead: [(self.on[0], efforts[0]), (self.on[1], efforts[1])],
        })
    }

    /// Value at the nominal parameters.
    pub fn nominal(&self, value: Scalar<'g>) -> f64 {
        self.k.nominal([value; 3].into())[0]
    }

    /// Why teeth cannot touch there.
    pub fn refused(&self, why: &str) -> BuildError {
        BuildError::Teeth { joint: self.k.joint_name(self.own).to_owned(), why: why.to_owned() }
    }
}
