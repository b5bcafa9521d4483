//! The first body's surface in a contact, and its forces on a circle, sphere or point of the second.
//!
//! The equations are in `contact`.

use std::rc::Rc;

use symdiff::Scalar;

use super::felt::Felt;
use super::ground::Ground;
use super::hull::Hull;
use super::outline::ContactEdges;
use super::rod::Rod;
use super::solid::{Gap, Solid};
use crate::elements::effects::Forces;
use crate::elements::effects::laws::dry_friction::Resistance;
use crate::elements::effects::laws::impact::Push;
use crate::elements::tuning::TUNING;
use crate::multibody::{Pair, Vector};

/// Surface of the first body.
pub enum ContactSurface<'g> {
    Whole(WholeSurface<'g>),
    Edges(ContactEdges<'g>),
}

impl<'g> ContactSurface<'g> {
    /// Positive where the points within a radius about a line of the second body may touch a solid; `None` for other
    /// surfaces, whose contacts are found at once.
    pub fn is_near(&self, line: &Rod<'g>, radius: Scalar<'g>, pair: &Pair<'g>) -> Option<Scalar<'g>> {
        let (solid, reach) = match self {
            Self::Whole(WholeSurface::Solid(solid, reach)) => (solid.radius(reach.builder()), *reach),
            Self::Whole(WholeSurface::Hull(hull, reach)) => (reach.builder().number(hull.radius()), *reach),
            _ => return None,
        };
        Some(line.is_near(pair, solid, reach + radius))
    }

    /// Centres on a line of the second body that are nearest.
    pub fn centres_on(&self, line: &Rod<'g>, pair: &Pair<'g>) -> Vec<Vector<'g>> {
        match *self {
            Self::Whole(WholeSurface::Hull(ref hull, _)) => vec![line.nearest_to_hull(pair, hull)],
            Self::Whole(WholeSurface::Solid(Solid::Capsule { start, tangent, length }, _)) => {
                vec![line.nearest_to_line(pair, (start, tangent, length))]
            }
            Self::Whole(WholeSurface::Solid(Solid::Block { half }, reach)) => {
                vec![line.nearest_to_block(pair, half, reach)]
            }
            Self::Whole(WholeSurface::Round(_)) => vec![line.nearest_to_point(pair, pair.first.point.position)],
            _ => line.ends(pair).to_vec(),
        }
    }
}

/// A surface of the first body that is not made of edges.
#[derive(Clone, Debug)]
pub enum WholeSurface<'g> {
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

/// Forces between two surfaces.
#[derive(Clone, Copy, Debug)]
pub struct ContactLaw<'g> {
    pub impact: Push<'g>,
    pub friction: Option<Resistance<'g>>,
    /// A unit vector in the first frame and the coefficient of friction along it.
    pub along: Option<(Vector<'g>, Scalar<'g>)>,
}

impl<'g> ContactLaw<'g> {
    /// Adds the forces at a point; `moving` is the first surface's velocity beyond its body's.
    pub fn act(
        &self,
        forces: &mut dyn Forces<'g>,
        pair: &Pair<'g>,
        Touch { gap: Gap { gap, normal, overlap, near }, place, moving }: Touch<'g>,
    ) -> Felt<'g> {
        let [first, second] = [pair.first, pair.second].map(|frame| forces.point_at(frame.point.body, place));
        let mut velocity = second.velocity - first.velocity;
        if let Some(moving) = moving {
            velocity = velocity - moving;
        }
        let parting = normal.dot(velocity);
        let (depth, approach) = (-gap, -parting);
        match near {
            Some(near) => forces.only_within(near, overlap),
            None => forces.only_where(overlap),
        }
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
}

/// Where two surfaces touch.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'g> {
    pub gap: Gap<'g>,
    pub place: Vector<'g>,
    /// The first surface's velocity beyond its body's.
    pub moving: Option<Vector<'g>>,
}

impl<'g> Touch<'g> {
    /// Touch of surfaces at rest on their bodies.
    pub fn at(place: Vector<'g>, gap: Gap<'g>) -> Self {
        Self { gap, place, moving: None }
    }

    /// Touch of the same surfaces, with the first and the second exchanged.
    pub fn reversed(mut self) -> Self {
        self.gap.normal = -self.gap.normal;
        self
    }

    /// None where `near` is not positive: both are so far apart then that nothing else is needed.
    pub fn only_within(mut self, near: Option<Scalar<'g>>) -> Self {
        self.gap.near = near.or(self.gap.near);
        self
    }
}

impl<'g> WholeSurface<'g> {
    /// Where it touches a circle, sphere or point of a radius about `centre`, which belongs to the second body. Across
    /// the axis, a unit vector in the first frame, centres are apart.
    pub fn touch(
        &self,
        pair: &Pair<'g>,
        centre: Vector<'g>,
        radius: Scalar<'g>,
        axis: Option<Vector<'g>>,
    ) -> Touch<'g> {
        let gap = self.gap(pair, centre, radius, axis);
        let moving = match self {
            Self::Ground(ground) => Some(ground.velocity(pair, centre - pair.first.point.position)),
            _ => None,
        };
        Touch { moving, ..Touch::at(centre - radius * gap.normal, gap) }
    }

    fn gap(&self, pair: &Pair<'g>, centre: Vector<'g>, radius: Scalar<'g>, axis: Option<Vector<'g>>) -> Gap<'g> {
        let offset = centre - pair.first.point.position;
        match *self {
            Self::Hull(ref hull, reach) => hull.gap(pair, offset, reach),
            Self::Plane(normal) => {
                let normal = pair.outward(normal);
                let height = normal.dot(offset);
                Gap { gap: height - radius, normal, overlap: radius - height, near: None }
            }
            Self::Round(outer) => {
                let (across, square) = across(pair, offset, axis);
                let distance = square.sqrt();
                let normal = across / distance;
                let together = outer + radius;
                let square_of_sum = together * together;
                Gap { gap: distance - together, normal, overlap: square_of_sum - square, near: None }
            }
            Self::Hollow(clearance) => {
                let (across, square) = across(pair, offset, axis);
                let centred = TUNING.centred_touch * clearance;
                let smooth = square + centred * centred;
                let distance = smooth.sqrt();
                let outward = across / distance;
                let square_of_clearance = clearance * clearance;
                Gap { gap: clearance - distance, overlap: smooth - square_of_clearance, normal: -outward, near: None }
            }
            Self::Ground(ground) => ground.gap(pair, offset),
            Self::Solid(solid, reach) => solid.gap(pair, offset, reach),
        }
    }
}

/// d, and its square.
fn across<'g>(pair: &Pair<'g>, offset: Vector<'g>, axis: Option<Vector<'g>>) -> (Vector<'g>, Scalar<'g>) {
    let across = match axis {
        Some(axis) => {
            let axis = pair.outward(axis);
            offset - axis.dot(offset) * axis
        }
        None => offset,
    };
    (across, across.dot(across))
}
