//! Side force of a tyre, at a point of a body that runs on the ground z = const.
//!
//! ```text
//! α = atan(v_y/√(v_x² + v₀²)),     F = −f e_y                              N
//! linear:            f = sat(C α),   limited to μ N
//! magic formula:     f = μ N sin(c atan(B α − e (B α − atan B α))),    B = C/(c μ N)
//! ```
//!
//! e_x is the wheel's heading: the x axis of the point's frame, in the ground's plane, turned by `steer` about the ground's z; e_y is to
//! its left. C is the cornering stiffness, the slope at α = 0 of either, μ N the largest force, c and e the shape and curvature
//! of the magic formula (Bakker, Nyborg & Pacejka, SAE 870421 (1987); Pacejka, *Tire and Vehicle Dynamics*, 3rd ed. (2012), sec. 4.3.1), in
//! which C, μ and e may be formulas of the load. sat is that of a servo. Below v₀ the slip angle fades, so that a tyre at rest is a damper.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use super::saturation::saturated;
use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::{BuildError, Vector};

/// α.
const SLIP_ANGLE: Sensor = Sensor::of_motion("slip_angle");

/// A tyre that is led across its heading.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "tyre",
    what = "a tyre",
    equation = "α = atan(v_y/√(v_x² + v₀²)),  f = sat(C α) up to μ N,  or f = μ N sin(c atan(B α − e (B α − atan B α))),  B = C/(c μ N)",
    source = "Bakker, Nyborg & Pacejka, SAE 870421 (1987); Pacejka, Tire and Vehicle Dynamics, 3rd ed. (2012), sec. 4.3.1",
    example = "{ on: cart.hook, steer: 3 deg, load: 4 kN, friction: 0.9, cornering_stiffness: 6e4, shape: 1.3, curvature: -0.7 }",
    checked
)]
pub struct Tyre {
    /// Where it touches the ground: `body.point` or `body`; x is its heading.
    pub on: PointRef,
    /// Angle of the wheel against the point's x axis, about z.
    #[quantity(unit = "rad", default = 0)]
    pub steer: Formula,
    /// Force across the ground; may depend on t, positions, velocities and states.
    #[quantity(unit = "N", positive)]
    pub load: Formula,
    /// Largest side force over the load.
    #[quantity(unit = "1", positive)]
    pub friction: Formula,
    /// Side force by slip angle, where that is small.
    #[quantity(unit = "N/rad", positive)]
    pub cornering_stiffness: Formula,
    /// c of the magic formula.
    #[quantity(unit = "1", positive, otherwise = "none: linear up to the largest force")]
    pub shape: Option<Formula>,
    /// e of the magic formula, at most 1.
    #[quantity(unit = "1", default = 0)]
    pub curvature: Formula,
    /// Speed along the heading below which the slip angle fades.
    #[quantity(unit = "m/s", constant, positive, default = 0.1)]
    pub rest_speed: Formula,
}

impl ForceElement for Tyre {
    const GLYPH: Glyph = Glyph::Force;
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = &[(SLIP_ANGLE, Dimension::ANGLE), (Sensor::FORCE, Dimension::FORCE)];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let g = forces.graph();
        let point = forces.point(self.on);
        let [x, y, _] = forces.pair([self.on, self.on]).outward(Vector::along(g, 0)).components();
        let mut ahead: Vector = [x, y, g.number(0.0)].into();
        if forces.is_spatial() {
            ahead = ahead.unit();
        }
        let steer = forces.value(&self.steer)?;
        let heading = steer.cos() * ahead + steer.sin() * ahead.perpendicular();
        let left = heading.perpendicular();
        let rest = forces.value(&self.rest_speed)?;
        let [along, across] = [heading, left].map(|axis| axis.dot(point.velocity));
        let slip = across.atan2((along * along + rest * rest).sqrt());
        let most = forces.value(&self.friction)? * forces.value(&self.load)?;
        let stiffness = forces.value(&self.cornering_stiffness)?;
        let force = match &self.shape {
            None => saturated(stiffness * slip, most),
            Some(shape) => {
                let shape = forces.value(shape)?;
                let turned = stiffness / (shape * most) * slip;
                let curved = turned - forces.value(&self.curvature)? * (turned - arctangent(turned));
                most * (shape * arctangent(curved)).sin()
            }
        };
        forces.at(&point, -(force * left));
        forces.sensors([(SLIP_ANGLE, slip), (Sensor::FORCE, -force)]);
        Ok(())
    }
}

fn arctangent(x: Scalar<'_>) -> Scalar<'_> {
    x.atan2(x.builder().number(1.0))
}

impl Checked for Tyre {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.get("curvature").is_some() && fields.get("shape").is_none() {
            let message = "`curvature` goes with `shape`, both of the magic formula";
            reader.error(fields.key_span("curvature"), message, None);
        }
    }
}
