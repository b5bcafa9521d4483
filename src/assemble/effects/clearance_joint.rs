//! A journal that is loose in its bearing: what a revolute joint is with a tolerance.
//!
//! ```text
//! gap = c − |d|,   d = r_J − r_B across the axis,   c = R − r          m, forces as in `contact`
//! ```
//!
//! c is the radial clearance, which may be uncertain, r the journal's radius, at which friction acts. In space only
//! displacements across the axis are felt; another joint holds what moves along it or tilts. K of two cylinders' ends as
//! spheres (Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369): 4/(3 (h₁ + h₂)) √(R r/(R − r)), h = (1 − ν²)/E.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::ClearanceJoint;

use super::Loads;
use super::contact::{Shape, Touch};
use super::dry_friction::DryFriction;
use super::impact::Impact;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, joint: &ClearanceJoint) -> Result<(), BuildError> {
    let clearance = m.formula(g, &joint.clearance, Context::Time)?;
    let radius = m.formula(g, &joint.radius, Context::Time)?;
    let axis = m.vector(g, &joint.axis, Context::Time)?;
    let axis = m.is_spatial().then(|| space::unit(g, axis));
    let impact = Impact::of(g, m, &joint.impact)?;
    let friction = joint
        .friction
        .as_ref()
        .map(|friction| DryFriction::of(g, m, &friction.coefficient, &friction.speed))
        .transpose()?;
    let shape = Shape::Hollow(clearance);
    Touch { between: joint.between, shape, radius, axis, impact, friction }.apply(g, m, loads);
    Ok(())
}
