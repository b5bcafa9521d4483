//! Gear: two angles in a fixed ratio.
//!
//! ```text
//! Φ = φ₂ − ratio φ₁ − offset = 0          1 row, rad
//! ```
//!
//! φ is the angle of a body about z, or of a joint about its axis. An external pair has a negative ratio. −Φ_qᵀ λ is
//! the torque −λ on the second and +ratio λ on the first; the difference is carried by whatever holds the axles, so
//! this is no pair of action and reaction. A torque on a joint's angle acts on its second body, and the opposite on its
//! first. Where teeth touch does not change the motion, but the reactions of the bearings. With a `pressure_angle` they
//! are those of the force at the pitch point (`teeth`), which is the gear's own reaction; without, they are refused
//! where something asks for them.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::elements::meshing::{Member, Meshing};
use crate::grammar::{Checked, Fields, JointCoordinate, MeshKind, OnJoint, Reader, Rotating, SymbolTable};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

use super::teeth::{self, Mesh, ToothContact, ToothForce};
use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows, Toothed};

/// Angles in a fixed ratio: angle of the second = ratio * angle of the first + offset.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "gear",
    what = "a gear",
    equation = "φ₂ − ratio φ₁ − offset = 0",
    equation = "with a pressure angle: F = F_t t + |F_t| tan α/cos β m − F_t tan β g at the pitch point, F_t = τ₂/r₂",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4",
    example = "{ between: [pinion, wheel], ratio: -0.5 }",
    checked
)]
pub struct Gear {
    /// Two bodies (their angles about z) or two joints.
    between: [Rotating; 2],
    /// Angle of the second per angle of the first; negative for external gears.
    #[quantity(unit = "1", nonzero, constant)]
    ratio: Formula,
    /// Angle of the second where that of the first is zero.
    #[quantity(unit = "rad", default = 0, constant)]
    #[key(image = Turning)]
    offset: Formula,
    /// How teeth touch.
    #[group]
    flanks: ToothContact,
    /// Distance from the point where the axes intersect to the middle of the teeth of bevel gears.
    #[quantity(unit = "m", positive, constant)]
    cone_distance: Option<Formula>,
}

impl Gear {
    /// A gear whose teeth are unknown.
    pub fn of(between: [Rotating; 2], ratio: f64, offset: f64) -> Self {
        let (ratio, offset) = (Formula::number(ratio), Formula::number(offset));
        Self { between, ratio, offset, flanks: ToothContact::unknown(), cone_distance: None }
    }
}

impl Checked for Gear {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.get("cone_distance").is_some() && fields.get("pressure_angle").is_none() {
            let help = "e.g. `pressure_angle: 20 deg`".to_owned();
            reader.error(
                Code::MisplacedKey,
                fields.key_span("cone_distance"),
                "`cone_distance` goes with a `pressure_angle`",
                help,
            );
        }
    }

    fn constrain(schema: &mut schemars::Schema) {
        teeth::constrain(schema);
    }

    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if self.flanks.pressure_angle.is_some() && self.between.iter().any(|of| matches!(of, Rotating::Body { .. })) {
            let help = "name the revolute joints that hold the gears instead of the bodies".to_owned();
            reader.error(
                Code::MisplacedKey,
                fields.key_span("pressure_angle"),
                "the force of teeth acts between two bearings",
                help,
            );
        }
    }
}

impl JointElement for Gear {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "rad",
        multiplier: "N m: −λ is the torque on the second, +ratio λ that on the first",
    }];
}

/// The coordinate of an angle that is a joint's.
fn of_joint(angle: Rotating) -> Option<OnJoint> {
    match angle {
        Rotating::Joint(joint) => Some(OnJoint { joint, coordinate: JointCoordinate::Angle }),
        Rotating::Body { .. } => None,
    }
}

impl Joint for Gear {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        self.between.into_iter().filter_map(of_joint).collect()
    }

    fn toothed(&self) -> Toothed {
        let mut toothed = Toothed::default();
        if self.flanks.pressure_angle.is_some() {
            return toothed;
        }
        for angle in self.between {
            match angle {
                Rotating::Joint(joint) => toothed.joints.push(joint),
                Rotating::Body { body, .. } => toothed.bodies.push(body),
            }
        }
        toothed
    }

    fn tooth_force<'g>(
        &self,
        own: usize,
        k: &dyn Kinematics<'g>,
        lambda: Scalar<'g>,
    ) -> Result<Option<ToothForce<'g>>, BuildError> {
        let [Some(first), Some(second)] = self.between.map(of_joint) else { return Ok(None) };
        if self.flanks.pressure_angle.is_none() {
            return Ok(None);
        }
        let distance = self.cone_distance.as_ref().map(|distance| k.number(distance)).transpose()?;
        let mesh = Mesh::of(k, own, [first, second])?;
        mesh.of_gears(k.number(&self.ratio)?, distance, &self.flanks, lambda).map(Some)
    }

    fn mesh_kind(&self) -> Option<MeshKind> {
        Some(MeshKind::Rolling)
    }

    fn meshing<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Result<Option<Meshing<'g>>, BuildError> {
        let [first, second] = self.between.map(|angle| match angle {
            Rotating::Body { body, .. } => Member::Body(body),
            Rotating::Joint(joint) => Member::Joint(OnJoint::angle(joint)),
        });
        let (ratio, one) = (k.number(&self.ratio)?, k.graph().number(1.0));
        Ok(Some(Meshing::Rolling(vec![vec![(first, ratio)], vec![(second, one)]])))
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (ratio, offset) = (k.number(&self.ratio)?, k.number(&self.offset)?);
        let [first, second] = self.between.map(|angle| match angle {
            Rotating::Body { body, ground } => k.angle(body) - k.angle(ground),
            Rotating::Joint(joint) => k.coordinate(OnJoint { joint, coordinate: JointCoordinate::Angle }),
        });
        let value = second - ratio * first - offset;
        let axis = match of_joint(self.between[1]) {
            Some(on) => k.axis(on)?,
            None => Vector::along(k.graph(), 2),
        };
        Ok(vec![Row { name: "", value, force: Vector::zero(k.graph()), torque: -axis }])
    }
}
