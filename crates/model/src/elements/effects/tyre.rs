//! Forces of a tyre on the ground: across its heading by the slip angle, and along it by the slip of its wheel.
//!
//! ```text
//! α = atan(v_y/√(v_x² + v₀²)),     κ = (r ω − v_x)/√(v_x² + v₀²)                              rad, 1
//! s_x = C_x κ/(μ_x N),   s_y = C α/(μ N),   s = √(s_x² + s_y²)
//! F = f(s)/s (μ_x N s_x e_x − μ N s_y e_y)                                                    N
//! linear:            f = sat(s),   limited to 1
//! magic formula:     f = sin(c atan(b s − e (b s − atan b s))),    b = 1/c
//! ```
//!
//! e_x is the wheel's heading: the x axis of the point's frame, in the ground's plane, turned by `steer` about the
//! ground's normal; e_y is to its left. C and C_x are the slopes at no slip, μ N and μ_x N the largest forces, c and e
//! the shape and curvature of the magic formula (Bakker, Nyborg & Pacejka, SAE 870421 (1987); Pacejka, *Tire and
//! Vehicle Dynamics*, 3rd ed. (2012), sec. 4.3.1), in which C, μ and e may be formulas of the load. Forces of both
//! directions share the slip s, so that they lie within the ellipse of μ_x N and μ N (similarity method, ibid., sec.
//! 4.2). sat is that of a servo. Below v₀ slips fade, so that a tyre at rest is a damper. r ω − v_x is how fast the
//! wheel's lowest point slides back, and the force acts there: on the wheel, the radius below the point. Without a
//! wheel κ = 0.

use mbint_derive::Element;
use symdiff::{Binary, Formula, Scalar};

use super::laws::saturation::saturated;
use super::{ForceElement, Forces, Scope, TypedSensor};
use crate::elements::tuning::TUNING;
use crate::elements::{Form, Glyph, Shape, SurfaceAt, Surroundings};
use crate::grammar::quantity::Dimension;
use crate::grammar::{BodyRef, Checked, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::{BuildError, MaterialPoint, Vector};
use crate::syntax::codes::Code;

/// α.
const SLIP_ANGLE: Sensor = Sensor::of_motion("slip_angle");

/// κ.
const SLIP: Sensor = Sensor::of_motion("slip");
/// The force along the heading.
const FORCE_ALONG: Sensor = Sensor::of_force("force_along");
/// Further sensors of a wheel.
const OF_WHEEL: [TypedSensor; 2] = [(SLIP, Dimension::NUMBER), (FORCE_ALONG, Dimension::FORCE)];

/// A tyre that is led across its heading, or whose wheel is driven or braked.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "tyre",
    what = "a tyre",
    equation = "F = f(s)/s (μ_x N s_x e_x − μ N s_y e_y),  s_x = C_x κ/(μ_x N),  s_y = C α/(μ N)",
    equation = "f = sat(s) up to 1,  or f = sin(c atan(b s − e (b s − atan b s))),  b = 1/c",
    source = "Bakker, Nyborg & Pacejka, SAE 870421 (1987); Pacejka, Tire and Vehicle Dynamics, 3rd ed. (2012), sec. 4.2 and 4.3.1",
    example = "{ on: cart.hook, steer: 3 deg, load: 4 kN, friction: 0.9, cornering_stiffness: 6e4, shape: 1.3, curvature: -0.7 }",
    checked
)]
pub struct Tyre {
    /// Where it touches the ground, or with `wheel` the wheel's centre: `body.point` or `body`; x is its heading.
    pub on: PointRef,
    /// Angle of the wheel against the point's x axis, about the ground's normal.
    #[quantity(unit = "rad", default = 0)]
    #[key(image = Axial)]
    pub steer: Formula,
    /// Force across the ground; may depend on t, positions, velocities and states.
    #[quantity(unit = "N", positive)]
    pub load: Formula,
    /// Largest force over the load.
    #[quantity(unit = "1", positive)]
    pub friction: Formula,
    /// Side force by slip angle, where that is small.
    #[quantity(unit = "N/rad", positive, otherwise = "none: no side force")]
    pub cornering_stiffness: Option<Formula>,
    /// The body that rolls, for forces along the heading. In the plane the ground is then below, along x, and there is
    /// no side force.
    pub wheel: Option<BodyRef>,
    /// Radius of the wheel.
    #[quantity(unit = "m", constant, positive)]
    pub radius: Option<Formula>,
    /// Force along the heading by slip κ, where that is small.
    #[quantity(unit = "N", positive)]
    pub slip_stiffness: Option<Formula>,
    /// Largest force along the heading over the load.
    #[quantity(unit = "1", positive, otherwise = "`friction`")]
    pub friction_along: Option<Formula>,
    /// c of the magic formula.
    #[quantity(unit = "1", positive, otherwise = "none: linear up to the largest force")]
    pub shape: Option<Formula>,
    /// e of the magic formula, at most 1.
    #[quantity(unit = "1", default = 0)]
    pub curvature: Formula,
    /// Speed along the heading below which slips fade.
    #[quantity(unit = "m/s", constant, positive, default = 0.1)]
    pub rest_speed: Formula,
}

/// A wheel on the ground.
struct Rolling<'g> {
    /// Its lowest point.
    patch: MaterialPoint<'g>,
    /// κ
    slip: Scalar<'g>,
    /// C_x κ, N
    straight: Scalar<'g>,
    /// μ_x N, N
    most: Scalar<'g>,
}

impl ForceElement for Tyre {
    const GLYPH: Glyph = Glyph::Force;
    const RESISTS: bool = true;
    const SCOPE: Scope = Scope::LevelGround;
    const SENSORS: &'static [TypedSensor] = &[(SLIP_ANGLE, Dimension::ANGLE), (Sensor::FORCE, Dimension::FORCE)];

    fn surfaces(&self, surroundings: Surroundings) -> Vec<SurfaceAt> {
        let Some(radius) = self.radius.clone() else { return Vec::new() };
        let form = if surroundings.spatial {
            let length = radius.combined(Binary::Mul, &Formula::number(0.5));
            Form::Cylinder { axis: [0.0, 1.0, 0.0].map(Formula::number), length, radius }
        } else {
            Form::Sphere { radius }
        };
        vec![(self.on, Shape::in_place(form))]
    }

    fn sensors(&self) -> Vec<TypedSensor> {
        let side = self.cornering_stiffness.iter().flat_map(|_| Self::SENSORS.iter().copied());
        side.chain(self.wheel.into_iter().flat_map(|_| OF_WHEEL)).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let point = forces.point(self.on);
        let [heading, left] = self.axes(forces)?;
        let rest = forces.value(&self.rest_speed)?;
        let [along, across] = [heading, left].map(|axis| axis.dot(point.velocity));
        let speed = (along * along + rest * rest).sqrt();
        let load = forces.value(&self.load)?;
        let most = forces.value(&self.friction)? * load;
        let slip_angle = across.atan2(speed);
        let side = match &self.cornering_stiffness {
            None => forces.graph().number(0.0),
            Some(stiffness) => forces.value(stiffness)? * slip_angle,
        };
        let Some(rolling) = self.rolling(forces, &point, heading, speed)? else {
            let force = most * self.characteristic(forces, side / most)?;
            forces.at(&point, -(force * left));
            forces.sensors([(SLIP_ANGLE, slip_angle), (Sensor::FORCE, -force)]);
            return Ok(());
        };
        let [s_x, s_y] = [rolling.straight / rolling.most, side / most];
        let slip = (s_x * s_x + s_y * s_y + TUNING.no_slip).sqrt();
        let share = self.characteristic(forces, slip)? / slip;
        let [ahead, aside] = [share * rolling.straight, share * side];
        forces.at(&rolling.patch, ahead * heading - aside * left);
        if self.cornering_stiffness.is_some() {
            forces.sensors([(SLIP_ANGLE, slip_angle), (Sensor::FORCE, -aside)]);
        }
        forces.sensors([(SLIP, rolling.slip), (FORCE_ALONG, ahead)]);
        Ok(())
    }
}

impl Tyre {
    /// The ground's normal.
    fn up<'g>(&self, forces: &dyn Forces<'g>) -> Vector<'g> {
        let is_side_view = self.wheel.is_some() && !forces.is_spatial();
        Vector::along(forces.graph(), if is_side_view { 1 } else { 2 })
    }

    /// e_x and e_y.
    fn axes<'g>(&self, forces: &dyn Forces<'g>) -> Result<[Vector<'g>; 2], BuildError> {
        let g = forces.graph();
        if self.wheel.is_some() && !forces.is_spatial() {
            return Ok([Vector::along(g, 0), Vector::zero(g)]);
        }
        let [x, y, _] = forces.pair([self.on, self.on]).outward(Vector::along(g, 0)).components();
        let mut ahead: Vector = [x, y, g.number(0.0)].into();
        if forces.is_spatial() {
            ahead = ahead.unit();
        }
        let steer = forces.value(&self.steer)?;
        let heading = steer.cos() * ahead + steer.sin() * ahead.perpendicular();
        Ok([heading, heading.perpendicular()])
    }

    /// How the wheel rolls, if there is one.
    fn rolling<'g>(
        &self,
        forces: &dyn Forces<'g>,
        center: &MaterialPoint<'g>,
        heading: Vector<'g>,
        speed: Scalar<'g>,
    ) -> Result<Option<Rolling<'g>>, BuildError> {
        let (Some(wheel), Some(radius), Some(stiffness)) = (self.wheel, &self.radius, &self.slip_stiffness) else {
            return Ok(None);
        };
        let below = forces.value(radius)? * self.up(forces);
        let patch = forces.point_at(wheel.0, center.position - below);
        let slip = -(heading.dot(patch.velocity) / speed);
        let friction = forces.value(self.friction_along.as_ref().unwrap_or(&self.friction))?;
        let most = friction * forces.value(&self.load)?;
        Ok(Some(Rolling { patch, slip, straight: forces.value(stiffness)? * slip, most }))
    }

    /// f
    fn characteristic<'g>(&self, forces: &dyn Forces<'g>, slip: Scalar<'g>) -> Result<Scalar<'g>, BuildError> {
        let Some(shape) = &self.shape else { return Ok(saturated(slip, forces.graph().number(1.0))) };
        let shape = forces.value(shape)?;
        let turned = slip / shape;
        let curved = turned - forces.value(&self.curvature)? * (turned - arctangent(turned));
        Ok((shape * arctangent(curved)).sin())
    }
}

fn arctangent(x: Scalar<'_>) -> Scalar<'_> {
    x.atan2(x.builder().number(1.0))
}

impl Checked for Tyre {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let has = |key: &str| fields.get(key).is_some();
        if has("curvature") && !has("shape") {
            let message = "`curvature` goes with `shape`, both of the magic formula";
            reader.error(Code::MisplacedKey, fields.key_span("curvature"), message, None);
        }
        for key in ["radius", "slip_stiffness", "friction_along"].into_iter().filter(|key| has(key)) {
            if fields.lacks("wheel") {
                reader.error(
                    Code::MisplacedKey,
                    fields.key_span(key),
                    format!("`{key}` goes with `wheel`, the body that rolls"),
                    None,
                );
                return;
            }
        }
        if has("wheel") {
            for key in ["radius", "slip_stiffness"] {
                reader.required(fields, key);
            }
            if !reader.model.is_spatial() {
                for key in ["cornering_stiffness", "steer"].into_iter().filter(|key| has(key)) {
                    let help =
                        "seen from the side a tyre has forces along the ground alone; in space it has both".to_owned();
                    reader.error(
                        Code::MisplacedKey,
                        fields.key_span(key),
                        format!("with a `wheel` in the plane there is no `{key}`"),
                        help,
                    );
                }
            }
        } else {
            reader.required(fields, "cornering_stiffness");
        }
    }
}
