//! Contact of a surface on the first body with a circle, sphere, cylinder or mere point (radius r) on the second.
//!
//! ```text
//! plane through A, normal n:    gap = n · (r_B − r_A) − r
//! round, radius R:              gap = |d| − R − r,     n = d/|d|,      d = r_B − r_A
//! hollow, radius R > r:         gap = R − r − |d|,     n = −d/|d|
//! F_B = f(−gap) n − R_μ v_t,    F_A = −F_B          N, both at r_B − r n
//! ```
//!
//! f is that of `impact`, R_μ that of `dry_friction` under the load f, v_t the tangential part of the velocity of the second
//! surface against the first. In space round surfaces are spheres, or cylinders with parallel axes where an axis is
//! given: d is then taken across it. Centres that coincide have no direction between them: inside a hollow |d| is
//! √(d² + ε²), ε = 10⁻⁴ (R − r), which moves the wall by half of 10⁻⁸ of the clearance. One round body in another, or two whose
//! centres meet, is no contact that this can tell. Apart the force and its slopes are exactly zero, and of a tile of samples that
//! all are apart only the sign of the gap is computed: without a root, from squares.

use symdiff::{Builder, Expr, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space::{self, Vector};
use crate::model::{Contact, Measure, PointRef};
use crate::multibody::{Pair, Vector as Handle};

use super::Loads;
use super::dry_friction::DryFriction;
use super::impact::Impact;

/// ε over R − r.
const CENTRED: f64 = 1e-4;

/// The first body's surface.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A unit normal, in the first frame.
    Plane(Vector),
    /// R, m
    Round(Expr),
    /// R − r, m
    Hollow(Expr),
}

/// Two surfaces and what they do to one another.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'g> {
    pub between: [PointRef; 2],
    pub shape: Shape,
    /// r, m
    pub radius: Expr,
    /// A unit vector in the first frame across which centres are apart.
    pub axis: Option<Vector>,
    pub impact: Impact<'g>,
    pub friction: Option<DryFriction<'g>>,
}

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, contact: &Contact) -> Result<(), BuildError> {
    let radius = m.formula(g, &contact.radius, Context::Time)?;
    let direction = |g: &Builder, formulas: &[Formula; 3]| -> Result<Vector, BuildError> {
        let vector = m.vector(g, formulas, Context::Time)?;
        Ok(space::unit(g, vector))
    };
    let axis = contact.axis.as_ref().filter(|_| m.is_spatial()).map(|axis| direction(g, axis)).transpose()?;
    let shape = match (&contact.plane, &contact.circle, &contact.hollow) {
        (Some(normal), ..) => Shape::Plane(direction(g, normal)?),
        (_, Some(outer), _) => Shape::Round(m.formula(g, outer, Context::Time)?),
        (.., Some(bore)) => {
            let bore = m.formula(g, bore, Context::Time)?;
            Shape::Hollow(g.sub(bore, radius))
        }
        (None, None, None) => return Ok(()),
    };
    let impact = Impact::of(g, m, &contact.impact)?;
    let friction = contact
        .friction
        .as_ref()
        .map(|friction| DryFriction::of(g, m, &friction.coefficient, &friction.speed))
        .transpose()?;
    Touch { between: contact.between, shape, radius, axis, impact, friction }.apply(g, m, loads);
    Ok(())
}

/// Where two surfaces are to one another.
#[derive(Clone, Copy, Debug)]
struct Gap {
    /// How far they are apart, m.
    gap: Expr,
    /// The direction in which the second is pushed.
    normal: Vector,
    /// Positive where they overlap; as few operations as tell.
    overlap: Expr,
}

impl<'g> Touch<'g> {
    /// Adds the forces.
    pub fn apply(&self, g: &'g Builder, m: &Mechanism, loads: &mut Loads) {
        let pair = m.pair(g, self.between);
        let Gap { gap, normal, overlap } = self.gap(g, &pair);
        let (gap, overlap, normal) = (g.scalar(gap), g.scalar(overlap), Handle::of(g, normal));
        let place = Handle::of(g, pair.second.point.position) - g.scalar(self.radius) * normal;
        let [first, second] = self.between.map(|point| m.carried_along(g, point.body, place.exprs()));
        let velocity = Handle::of(g, second.velocity) - Handle::of(g, first.velocity);
        let parting = normal.dot(velocity);
        let (depth, approach) = (-gap, -parting);
        loads.only_where(overlap.expr());
        let push = self.impact.force(depth, approach).only_where(depth);
        let mut force = push * normal;
        if let Some(friction) = &self.friction {
            let sliding = velocity - parting * normal;
            let resistance = friction.resistance(sliding.dot(sliding));
            let drag = friction.coefficient * push * resistance * sliding;
            force = force - drag;
            let felt = if m.is_spatial() {
                drag.norm()
            } else {
                // Along n turned clockwise: x on a floor.
                normal.perpendicular().dot(drag)
            };
            loads.measure(Measure::FRICTION, felt.only_where(overlap).expr());
        }
        loads.add_force_pair(g, &first, &second, force.exprs());
        let push = push.only_where(overlap);
        let potential = self.impact.potential(depth).only_where(depth);
        loads.add_potential(g, m, &[self.impact.stiffness.expr()], potential.expr());
        for (measure, value) in [(Measure::GAP, gap), (Measure::RATE, parting), (Measure::FORCE, push)] {
            loads.measure(measure, value.expr());
        }
    }

    fn gap(&self, g: &Builder, pair: &Pair) -> Gap {
        let offset = pair.offset(g);
        match self.shape {
            Shape::Plane(normal) => {
                let normal = pair.outward(g, normal);
                let height = space::dot(g, normal, offset);
                let gap = g.sub(height, self.radius);
                Gap { gap, normal, overlap: g.sub(self.radius, height) }
            }
            Shape::Round(outer) => {
                let (across, square) = self.across(g, pair, offset);
                let distance = g.sqrt(square);
                let normal = across.map(|component| g.div(component, distance));
                let together = g.add(outer, self.radius);
                let touching = g.mul(together, together);
                Gap { gap: g.sub(distance, together), normal, overlap: g.sub(touching, square) }
            }
            Shape::Hollow(clearance) => {
                let (across, square) = self.across(g, pair, offset);
                let centred = g.scale(CENTRED, clearance);
                let centred = g.mul(centred, centred);
                let smooth = g.add(square, centred);
                let distance = g.sqrt(smooth);
                let outward = across.map(|component| g.div(component, distance));
                let touching = g.mul(clearance, clearance);
                let (gap, overlap) = (g.sub(clearance, distance), g.sub(smooth, touching));
                Gap { gap, normal: space::neg(g, outward), overlap }
            }
        }
    }

    /// d, and its square.
    fn across(&self, g: &Builder, pair: &Pair, offset: Vector) -> (Vector, Expr) {
        let across = match self.axis {
            Some(axis) => {
                let axis = pair.outward(g, axis);
                let along = space::dot(g, axis, offset);
                let along = space::scale(g, along, axis);
                space::sub(g, offset, along)
            }
            None => offset,
        };
        (across, space::dot(g, across, across))
    }
}
