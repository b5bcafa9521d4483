//! Planetary set: a sun and a ring, meshed by planets on a carrier.
//!
//! ```text
//! Φ = φ_s − φ_c + ρ (φ_r − φ_c) − offset = 0,   ρ = z_r/z_s          1 row, rad
//! ```
//!
//! Angles are those of joints about parallel axes, against the one body that carries them all; a member without a name
//! stands still. Against the carrier the sun turns the ring backwards (Willis). −Φ_qᵀ λ is the torque −λ on the sun,
//! −ρ λ on the ring and (1 + ρ) λ on the carrier: together they are zero, and planets at even distances push no
//! bearing aside. The planets have no inertia of their own here: that of their masses about the common axis belongs to
//! the carrier's, and their spin, where it matters, is that of a body with an `angle` alone and an `equation`, φ_p =
//! φ_c − (φ_s − φ_c) z_s/z_p.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::elements::meshing::{Member, Meshing, Rim};
use crate::grammar::{Checked, Fields, JointCoordinate, MeshKind, OnJoint, Reader, RotatingJoint, SymbolTable};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows};
use crate::elements::tuning::TUNING;

/// A sun and a ring, meshed by planets on a carrier; two of the three at least are named, and the third stands still.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "planetary",
    what = "a planetary set",
    equation = "φ_s − φ_c + ρ (φ_r − φ_c) − offset = 0, ρ = z_r/z_s",
    source = "Willis, Principles of Mechanism (1841); Müller, Die Umlaufgetriebe (1998)",
    example = "{ sun: axle, carrier: pivot, ratio: 60/20 }",
    checked
)]
pub struct Planetary {
    /// Revolute joint of the sun on the housing.
    #[key(otherwise = "it stands still")]
    sun: Option<RotatingJoint>,
    /// Revolute joint of the ring on the housing.
    #[key(otherwise = "it stands still")]
    ring: Option<RotatingJoint>,
    /// Revolute joint of the carrier on the housing.
    #[key(otherwise = "it stands still")]
    carrier: Option<RotatingJoint>,
    /// Teeth of the ring per tooth of the sun.
    #[quantity(unit = "1", positive, constant)]
    ratio: Formula,
    /// Angle of the sun where those of ring and carrier are zero.
    #[quantity(unit = "rad", default = 0, constant)]
    #[key(image = Turning)]
    offset: Formula,
}

impl Planetary {
    /// Sun, ring and carrier, as far as they turn.
    fn members(&self) -> [Option<OnJoint>; 3] {
        let on = |joint: Option<RotatingJoint>| OnJoint { joint: joint?.0, coordinate: JointCoordinate::Angle }.into();
        [self.sun, self.ring, self.carrier].map(on)
    }

    /// Sense of each member: 1, or −1 if its joint counts the other way round than that of the first one named.
    fn senses(&self, own: usize, k: &dyn Kinematics<'_>) -> Result<[f64; 3], BuildError> {
        let refuse = |why: String| BuildError::Teeth { joint: k.joint_name(own).to_owned(), why };
        let given: Vec<OnJoint> = self.members().into_iter().flatten().collect();
        let held: Vec<[usize; 2]> = given.iter().map(|on| k.bodies(on.joint).unwrap_or_default()).collect();
        // The ground, body 0, does not turn: where it would, the angles are against the carrier, or another member.
        let holds_all = |body: &usize| {
            held.iter().all(|bodies| bodies.contains(body) && bodies.iter().all(|held| held == body || *held != 0))
        };
        let housing = held.first().and_then(|bodies| bodies.iter().copied().find(holds_all));
        let housing = housing.ok_or_else(|| {
            refuse("sun, ring and carrier have to turn on one body that they have in common, the housing".to_owned())
        })?;
        let mut first = None;
        let mut senses = [1.0; 3];
        for (sense, on) in senses.iter_mut().zip(self.members()) {
            let Some(on) = on else { continue };
            let name = k.joint_name(on.joint);
            let [_, axis] = k.line(on, housing)?.ok_or_else(|| refuse(format!("`{name}` has no axis")))?;
            let first = *first.get_or_insert(axis);
            if k.nominal(first.cross(axis)).iter().any(|across| across.abs() > TUNING.aligned) {
                return Err(refuse(format!("the axis of `{name}` is not parallel to the others")));
            }
            let [along, ..] = k.nominal([first.dot(axis); 3].into());
            let is_second = k.bodies(on.joint).is_some_and(|bodies| bodies[0] == housing);
            *sense = if is_second { along.signum() } else { -along.signum() };
        }
        Ok(senses)
    }
}

impl Checked for Planetary {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        const KEYS: [&str; 3] = ["sun", "ring", "carrier"];
        let given: Vec<&str> = KEYS.into_iter().filter(|key| fields.get(key).is_some()).collect();
        if given.len() < 2 {
            let help = "name the joints of two of `sun`, `ring` and `carrier` at least; a member that is not named stands still".to_owned();
            reader.error(
                Code::IncompleteElement,
                fields.key_span("ratio"),
                "one wheel alone is no planetary set",
                help,
            );
            return;
        }
        let members = self.members();
        for (second, key) in KEYS.into_iter().enumerate() {
            let earlier = members[..second].iter().position(|first| first.is_some() && *first == members[second]);
            if let Some(first) = earlier {
                let message = format!("`{}` and `{key}` are the same joint", KEYS[first]);
                reader.error(Code::SameBody, fields.key_span(key), message, None);
            }
        }
    }
}

impl JointElement for Planetary {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "rad",
        multiplier: "N m: −λ is the torque on the sun, −ratio λ that on the ring, (1 + ratio) λ that on the carrier",
    }];
}

impl Joint for Planetary {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        self.members().into_iter().flatten().collect()
    }

    fn mesh_kind(&self) -> Option<MeshKind> {
        Some(MeshKind::Rolling)
    }

    fn meshing<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Result<Option<Meshing<'g>>, BuildError> {
        let ratio = k.number(&self.ratio)?;
        let senses = self.senses(own, k)?;
        let members = self.members();
        let carrier = members[2].map(|on| (Member::Joint(on), senses[2]));
        // The rim of the sun or the ring, relative to the carrier.
        let rim = |index: usize, radius: Scalar<'g>| -> Rim<'g> {
            let wheel = members[index].map(|on| (Member::Joint(on), senses[index] * radius));
            let carrier = carrier.map(|(member, sense)| (member, -(sense * radius)));
            wheel.into_iter().chain(carrier).collect()
        };
        Ok(Some(Meshing::Rolling(vec![rim(0, k.graph().number(1.0)), rim(1, ratio)])))
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (ratio, offset) = (k.number(&self.ratio)?, k.number(&self.offset)?);
        let senses = self.senses(own, k)?;
        let angle = |index: usize, on: Option<OnJoint>| match on {
            Some(on) => senses[index] * k.coordinate(on),
            None => k.graph().number(0.0),
        };
        let [sun, ring, carrier] = self.members();
        let (sun_angle, carrier_angle) = (angle(0, sun), angle(2, carrier));
        let value = sun_angle - carrier_angle + ratio * (angle(1, ring) - carrier_angle) - offset;
        // The reaction is the torque on the sun, or on the ring if the sun stands still.
        let torque = match (sun, ring) {
            (Some(sun), _) => -senses[0] * k.axis(sun)?,
            (None, Some(ring)) => -senses[1] * ratio * k.axis(ring)?,
            (None, None) => Vector::zero(k.graph()),
        };
        Ok(vec![Row { name: "", value, force: Vector::zero(k.graph()), torque }])
    }
}
