//! A journal that is loose in its bearing: a revolute joint with a tolerance.
//!
//! ```text
//! gap = c − |d|,   d = r_J − r_B across the axis,   c = R − r          m, forces as in `contact`
//! ```
//!
//! c is the radial clearance, which may be uncertain, r the journal's radius, at which friction acts. In space only
//! displacements across the axis are felt; another joint prevents motion along it and tilts. K of two cylinders' ends
//! as spheres (Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369): 4/(3 (h₁ + h₂)) √(R r/(R − r)), h = (1 − ν²)/E.

use mbint_derive::Element;
use symdiff::{Binary, Formula};

use super::contact::felt::SENSORS;
use super::contact::touch::{self, ContactLaw};
use super::laws::impact::Push;
use super::{ForceElement, Forces, Friction, Impact, TypedSensor};
use crate::elements::{Form, Glyph, Shape, SurfaceAt, Surroundings};
use crate::grammar::{Axis, PointRef};
use crate::multibody::BuildError;

/// A journal that is loose in its bearing.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "clearance_joint",
    what = "a clearance joint",
    equation = "gap = c − |d|, d across the axis; forces as of a contact",
    source = "Flores, Ambrósio, Claro & Lankarani, Kinematics and Dynamics of Multibody Systems with Imperfect Joints (2008)",
    example = "{ between: [arm.socket, ball], clearance: 0.1 mm, radius: 10 mm, impact: { stiffness: 1e9, dissipation: 0.5 } }"
)]
pub struct ClearanceJoint {
    /// The bearing's centre, then the journal's; each `body.point` or `body`.
    between: [PointRef; 2],
    /// Radius of the bearing less that of the journal.
    #[quantity(unit = "m", constant, positive)]
    clearance: Formula,
    /// Radius of the journal.
    #[quantity(unit = "m", constant, positive, default = 0)]
    radius: Formula,
    /// Direction in the bearing's frame.
    #[key(default = Axis::z())]
    axis: Axis,
    /// How the surfaces push each other apart.
    impact: Impact,
    /// How they resist sliding.
    #[key(otherwise = "not at all")]
    friction: Option<Friction>,
}

impl ForceElement for ClearanceJoint {
    const GLYPH: Glyph = Glyph::Pin;
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = SENSORS;

    fn surfaces(&self, _: Surroundings) -> Vec<SurfaceAt> {
        let [bearing, journal] = self.between;
        let bore = self.clearance.combined(Binary::Add, &self.radius);
        let length = self.radius.combined(Binary::Mul, &Formula::number(2.0));
        let journal_form = Form::Cylinder { axis: self.axis.0.clone(), length, radius: self.radius.clone() };
        vec![
            (bearing, Shape::in_place(Form::Bore { axis: self.axis.0.clone(), radius: bore })),
            (journal, Shape::in_place(journal_form)),
        ]
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let clearance = forces.prescribed(&self.clearance)?;
        let radius = forces.prescribed(&self.radius)?;
        let axis = forces.prescribed_vector(&self.axis)?;
        let axis = forces.is_spatial().then(|| axis.unit());
        let impact = Push::of(forces, &self.impact)?;
        let friction = self.friction.as_ref().map(|friction| friction.resistance(forces)).transpose()?;
        let shape = touch::WholeSurface::Hollow(clearance);
        let pair = forces.pair(self.between);
        let centre = pair.second.point.position;
        let law = ContactLaw { impact, friction, along: None };
        let felt = law.act(forces, &pair, shape.touch(&pair, centre, radius, axis));
        felt.measured(forces);
        // Beyond, the middle of the journal is outside of the bearing.
        forces.begins_within(felt.gap + radius.max(clearance));
        Ok(())
    }
}
