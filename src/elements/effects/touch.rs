//! What touches in a contact: the first body's surface, and the forces on a circle, sphere or point of the second.
//!
//! The equations are in `contact`.

use std::rc::Rc;

use symdiff::Scalar;

use super::Forces;
use super::dry_friction::Resistance;
use super::felt::Felt;
use super::ground::Ground;
use super::hull::Hull;
use super::impact::Push;
use super::outline::Outline;
use super::rod::Rod;
use super::solid::{Gap, Solid};
use crate::multibody::{Pair, Vector};

/// ε over R − r.
const CENTRED: f64 = 1e-4;

/// What the first body's surface is made of.
pub(super) enum Surface<'g> {
    Whole(Shape<'g>),
    Edges(Outline<'g>),
}

impl<'g> Surface<'g> {
    /// Positive where a line of the second body may touch a solid; `None` of other surfaces, which are found at once.
    pub fn is_near(&self, line: &Rod<'g>, pair: &Pair<'g>) -> Option<Scalar<'g>> {
        match self {
            Self::Whole(Shape::Solid(solid, reach)) => Some(line.is_near(pair, solid.radius(reach.builder()), *reach)),
            Self::Whole(Shape::Hull(hull, reach)) => {
                Some(line.is_near(pair, reach.builder().number(hull.radius()), *reach))
            }
            _ => None,
        }
    }

    /// Centres on a line of the second body that are nearest.
    pub fn centres_on(&self, line: &Rod<'g>, pair: &Pair<'g>) -> Vec<Vector<'g>> {
        match *self {
            Self::Whole(Shape::Hull(ref hull, _)) => vec![line.nearest_to_hull(pair, hull)],
            Self::Whole(Shape::Solid(Solid::Capsule { start, tangent, length }, _)) => {
                vec![line.nearest_to_line(pair, (start, tangent, length))]
            }
            Self::Whole(Shape::Solid(Solid::Block { half }, reach)) => vec![line.nearest_to_block(pair, half, reach)],
            Self::Whole(Shape::Round(_)) => vec![line.nearest_to_point(pair, pair.first.point.position)],
            _ => line.ends(pair).to_vec(),
        }
    }
}

/// The first body's surface, where it is one.
#[derive(Clone, Debug)]
pub(super) enum Shape<'g> {
    /// A unit normal, in the first frame.
    Plane(Vector<'g>),
    /// R, m
    Round(Scalar<'g>),
    /// R − r, m
    Hollow(Scalar<'g>),
    /// A height over its x.
    Ground(Ground<'g>),
    /// With ρ + r, m
    Solid(Solid<'g>, Scalar<'g>),
    /// With ρ + r, m
    Hull(Rc<Hull>, Scalar<'g>),
}

/// Two surfaces and what they do to one another.
#[derive(Clone, Debug)]
pub(super) struct Touch<'g> {
    pub shape: Shape<'g>,
    /// r, m
    pub radius: Scalar<'g>,
    /// A unit vector in the first frame across which centres are apart.
    pub axis: Option<Vector<'g>>,
    pub impact: Push<'g>,
    pub friction: Option<Resistance<'g>>,
    /// A unit vector in the first frame and the coefficient of friction along it.
    pub along: Option<(Vector<'g>, Scalar<'g>)>,
    /// Not positive where both are so far apart that nothing else is needed.
    pub near: Option<Scalar<'g>>,
}

impl<'g> Touch<'g> {
    /// Adds the forces on a circle or point about `centre`, which belongs to the second body.
    pub fn act(&self, forces: &mut dyn Forces<'g>, (pair, centre): (&Pair<'g>, Vector<'g>)) -> Felt<'g> {
        let Gap { gap, normal, overlap } = self.gap(pair, centre);
        let overlap = self.near.map_or(overlap, |near| near.select(overlap, near));
        let place = centre - self.radius * normal;
        let [first, second] = [pair.first, pair.second].map(|frame| forces.point_at(frame.point.body, place));
        let mut velocity = second.velocity - first.velocity;
        if let Shape::Ground(ground) = &self.shape {
            velocity = velocity - ground.velocity(pair, centre - pair.first.point.position);
        }
        let parting = normal.dot(velocity);
        let (depth, approach) = (-gap, -parting);
        forces.only_where(overlap);
        let push = self.impact.force(depth, approach).only_where(depth);
        let mut force = push * normal;
        let mut felt_friction = None;
        if let Some(friction) = &self.friction {
            let sliding = velocity - parting * normal;
            let resistance = friction.by_speed(sliding.dot(sliding));
            let mut drag = friction.coefficient * push * resistance * sliding;
            if let Some((direction, coefficient)) = self.along {
                let direction = pair.outward(direction);
                let direction = direction - direction.dot(normal) * normal;
                let excess = (coefficient - friction.coefficient) * push * resistance;
                drag += excess * direction.dot(sliding) * direction;
            }
            force = force - drag;
            let felt = if forces.is_spatial() {
                drag.norm()
            } else {
                // Along n turned clockwise: x on a floor.
                normal.perpendicular().dot(drag)
            };
            felt_friction = Some(felt.only_where(overlap));
        }
        forces.between(&first, &second, force);
        let push = push.only_where(overlap);
        let potential = self.impact.potential(depth).only_where(depth);
        forces.potential(&[self.impact.stiffness], potential);
        Felt { gap, rate: parting, force: push, friction: felt_friction }
    }

    fn gap(&self, pair: &Pair<'g>, centre: Vector<'g>) -> Gap<'g> {
        let offset = centre - pair.first.point.position;
        match self.shape {
            Shape::Hull(ref hull, reach) => hull.gap(pair, offset, reach),
            Shape::Plane(normal) => {
                let normal = pair.outward(normal);
                let height = normal.dot(offset);
                Gap { gap: height - self.radius, normal, overlap: self.radius - height }
            }
            Shape::Round(outer) => {
                let (across, square) = self.across(pair, offset);
                let distance = square.sqrt();
                let normal = across / distance;
                let together = outer + self.radius;
                let square_of_sum = together * together;
                Gap { gap: distance - together, normal, overlap: square_of_sum - square }
            }
            Shape::Hollow(clearance) => {
                let (across, square) = self.across(pair, offset);
                let centred = CENTRED * clearance;
                let smooth = square + centred * centred;
                let distance = smooth.sqrt();
                let outward = across / distance;
                let square_of_clearance = clearance * clearance;
                Gap { gap: clearance - distance, overlap: smooth - square_of_clearance, normal: -outward }
            }
            Shape::Ground(ground) => ground.gap(pair, offset),
            Shape::Solid(solid, reach) => solid.gap(pair, offset, reach),
        }
    }

    /// d, and its square.
    fn across(&self, pair: &Pair<'g>, offset: Vector<'g>) -> (Vector<'g>, Scalar<'g>) {
        let across = match self.axis {
            Some(axis) => {
                let axis = pair.outward(axis);
                offset - axis.dot(offset) * axis
            }
            None => offset,
        };
        (across, across.dot(across))
    }
}
