//! Rack and pinion: a displacement in a fixed ratio to an angle.
//!
//! ```text
//! Φ = s − radius φ − offset = 0          1 row, m
//! ```
//!
//! φ is the angle of the pinion's joint, s the displacement of the rack's. −Φ_qᵀ λ is the force −λ along the rack's
//! axis on the second body of its joint and the torque +radius λ about the pinion's axis on the second body of its; the
//! opposites act on the first bodies. The reaction is the force on the rack: with a `pressure_angle` that of the teeth
//! at the pitch point (`teeth`), which the bearings and the guide feel.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::elements::meshing::{Member, Meshing};
use crate::grammar::{Checked, JointCoordinate, MeshKind, OnJoint, RotatingJoint, SlidingJoint};
use crate::multibody::{BuildError, Vector};

use super::teeth::{self, Mesh, ToothContact, ToothForce};
use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows, Toothed};

/// A displacement in a fixed ratio to an angle: displacement of the rack = radius * angle of the pinion + offset.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "rack",
    what = "a rack",
    equation = "s − radius φ − offset = 0",
    equation = "with a pressure angle: F = F_t s + |F_t| tan α/cos β m − F_t tan β a at the pitch point",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4",
    example = "{ pinion: axle, rack: guide, radius: 20 mm }",
    checked
)]
pub struct Rack {
    /// The joint about which the pinion turns.
    pinion: RotatingJoint,
    /// The joint along which the rack slides.
    rack: SlidingJoint,
    /// Displacement a radian; negative where the rack goes against the angle.
    #[quantity(unit = "m", nonzero, constant)]
    #[key(image = Turning)]
    radius: Formula,
    /// Displacement where the angle is zero.
    #[quantity(unit = "m", default = 0, constant)]
    offset: Formula,
    /// How teeth touch.
    #[group]
    flanks: ToothContact,
}

impl Checked for Rack {
    fn constrain(schema: &mut schemars::Schema) {
        teeth::constrain(schema);
    }
}

impl JointElement for Rack {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "m",
        multiplier: "N: −λ is the force along the rack, +radius λ the torque about the pinion's axis",
    }];
}

impl Joint for Rack {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        self.pinion_and_rack().to_vec()
    }

    fn toothed(&self) -> Toothed {
        if self.flanks.pressure_angle.is_some() {
            return Toothed::default();
        }
        Toothed { joints: self.pinion_and_rack().map(|on| on.joint).to_vec(), bodies: Vec::new() }
    }

    fn tooth_force<'g>(
        &self,
        own: usize,
        k: &dyn Kinematics<'g>,
        lambda: Scalar<'g>,
    ) -> Result<Option<ToothForce<'g>>, BuildError> {
        if self.flanks.pressure_angle.is_none() {
            return Ok(None);
        }
        let mesh = Mesh::of(k, own, self.pinion_and_rack())?;
        mesh.of_rack(k.number(&self.radius)?, &self.flanks, lambda).map(Some)
    }

    fn mesh_kind(&self) -> Option<MeshKind> {
        Some(MeshKind::Rolling)
    }

    fn meshing<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Result<Option<Meshing<'g>>, BuildError> {
        let [pinion, rack] = self.pinion_and_rack().map(Member::Joint);
        let (radius, one) = (k.number(&self.radius)?, k.graph().number(1.0));
        Ok(Some(Meshing::Rolling(vec![vec![(pinion, radius)], vec![(rack, one)]])))
    }

    fn glyph(&self) -> Glyph {
        Glyph::Gear
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (radius, offset) = (k.number(&self.radius)?, k.number(&self.offset)?);
        let [pinion, rack] = self.pinion_and_rack();
        let (angle, moved) = (k.coordinate(pinion), k.coordinate(rack));
        let value = moved - radius * angle - offset;
        let axis = k.axis(rack)?;
        Ok(vec![Row { name: "", value, force: -axis, torque: Vector::zero(k.graph()) }])
    }
}

impl Rack {
    fn pinion_and_rack(&self) -> [OnJoint; 2] {
        [
            OnJoint { joint: self.pinion.0, coordinate: JointCoordinate::Angle },
            OnJoint { joint: self.rack.0, coordinate: JointCoordinate::Displacement },
        ]
    }
}
