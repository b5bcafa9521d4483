//! Outlines in contact with a circle, sphere or point: straight edges and arcs, and all points within a radius of them.
//!
//! ```text
//! edge from a along u, length L; w = p − a:    t = u · w,    h = u × w,    s = min(t, 0) + max(t − L, 0)
//! d = √(h² + s²),    depth = ρ + r − d,    normal = (h n + s u)/d
//! arc of radius R about c; w = p − c:          d = |R − |w|| within its ends, else the distance from the nearer one
//! ```
//!
//! p is the centre of the circle of radius r in the first frame, n the edge's left normal, ρ the outline's rounding.
//! Where two edges join, the surface is round about their corner, so that normals do not jump. On the outer side of a
//! corner the nearer edge pushes, and of two that both end there the first one; on the inner side both push. All edges'
//! forces are summed at p, with their torque about it.

use symdiff::Scalar;

use super::arc::Arc;
use super::course::Corner;
use super::felt::Felt;
use crate::elements::effects::Forces;
use crate::elements::effects::laws::dry_friction::Resistance;
use crate::elements::effects::laws::impact::Push;
use crate::elements::tuning::TUNING;
use crate::multibody::{Pair, Vector};

/// Edges in the x and y of a frame.
#[derive(Clone, Debug)]
pub struct ContactEdges<'g> {
    edges: Vec<Edge<'g>>,
    /// Whether the last edge ends where the first begins.
    closed: bool,
    /// ρ + r, m
    reach: Scalar<'g>,
    /// r, m
    radius: Scalar<'g>,
}

#[derive(Clone, Copy, Debug)]
struct Edge<'g> {
    start: Vector<'g>,
    /// u
    tangent: Vector<'g>,
    /// L, m
    length: Scalar<'g>,
    /// Arc between its ends; `None` for a straight edge.
    arc: Option<Arc<'g>>,
}

/// Where the circle's centre is to an edge.
#[derive(Clone, Copy, Debug)]
struct Place<'g> {
    /// h, m
    beside: Scalar<'g>,
    /// t, m
    along: Scalar<'g>,
    /// t − L, m
    past: Scalar<'g>,
    /// d², m²
    square: Scalar<'g>,
    /// p
    centre: Vector<'g>,
}

/// Sum of the forces of all edges.
struct Sum<'g> {
    force: Vector<'g>,
    torque: Vector<'g>,
    push: Scalar<'g>,
    friction: Vector<'g>,
    /// Friction along the surface, positive clockwise about it.
    along: Scalar<'g>,
    energy: Scalar<'g>,
}

impl<'g> ContactEdges<'g> {
    /// Outline through points, and back to the first if it is closed.
    pub fn through(corners: &[Corner<'g>], closed: bool, rounding: Scalar<'g>, radius: Scalar<'g>) -> Self {
        let last = closed.then(|| (corners.last(), corners.first()));
        let pairs = corners.windows(2).map(|pair| (pair.first(), pair.last())).chain(last);
        let edges = pairs.filter_map(|(start, end)| {
            let (start, end) = (start?, end?);
            let way = end.place - start.place;
            let length = way.norm();
            let arc = end.radius.map(|radius| Arc::between([start.place, end.place], radius));
            Some(Edge { start: start.place, tangent: way / length, length, arc })
        });
        Self { edges: edges.collect(), closed, reach: rounding + radius, radius }
    }

    /// Adds the forces on a circle about `centre`, which belongs to the second body.
    pub fn apply(
        &self,
        forces: &mut dyn Forces<'g>,
        pair: &Pair<'g>,
        centre: Vector<'g>,
        impact: &Push<'g>,
        friction: Option<&Resistance<'g>>,
    ) -> Felt<'g> {
        let g = forces.graph();
        let axes = [0, 1, 2].map(|axis| pair.outward(Vector::along(g, axis)));
        let inward = |vector: Vector<'g>| Vector::from(axes.map(|axis| axis.dot(vector)));
        let outward = |vector: Vector<'g>| {
            axes.into_iter().zip(vector.components()).fold(Vector::zero(g), |sum, (axis, part)| sum + part * axis)
        };
        let local = inward(centre - pair.first.point.position);
        let places: Vec<Place> = self.edges.iter().map(|edge| edge.place(local)).collect();
        let square_of_reach = self.reach * self.reach;
        let bodies = [pair.first.point.body, pair.second.point.body];
        let [first, second] = bodies.map(|body| forces.point_at(body, centre));
        let velocity = inward(second.velocity - first.velocity);
        let spin = inward(forces.angular_velocity(bodies[1]) - forces.angular_velocity(bodies[0]));
        let nearest = places.iter().map(|place| place.square).reduce(Scalar::min).unwrap_or(square_of_reach);
        let overlap = square_of_reach - nearest;
        forces.only_where(overlap);
        let sum = self.pushes(&places, velocity, spin, impact, friction);
        forces.between(&first, &second, outward(sum.force));
        if friction.is_some() {
            forces.torque(bodies[0], bodies[1], outward(sum.torque));
        }
        forces.potential(&[impact.stiffness], sum.energy);
        Felt {
            gap: nearest.sqrt() - self.reach,
            rate: self.rate(&places, velocity),
            force: sum.push.only_where(overlap),
            friction: friction.map(|_| {
                let felt = if forces.is_spatial() { sum.friction.norm() } else { sum.along };
                felt.only_where(overlap)
            }),
        }
    }

    fn pushes(
        &self,
        places: &[Place<'g>],
        velocity: Vector<'g>,
        spin: Vector<'g>,
        impact: &Push<'g>,
        friction: Option<&Resistance<'g>>,
    ) -> Sum<'g> {
        let g = self.reach.builder();
        let (none, zero) = (Vector::zero(g), g.number(0.0));
        let mut sum = Sum { force: none, torque: none, push: zero, friction: none, along: zero, energy: zero };
        let square_of_reach = self.reach * self.reach;
        for (index, (edge, place)) in self.edges.iter().zip(places).enumerate() {
            // In radii, so that it stays where the effect's own condition is known to hold: what follows switches in a
            // contact only.
            let touches = 1.0 - place.square / square_of_reach;
            let (before, past) = (place.along.only_where(touches), place.past.only_where(touches));
            let across = edge.across(place, [before, past]);
            let distance = across.dot(across).sqrt();
            let normal = across / distance;
            let depth = self.reach - distance;
            let parting = normal.dot(velocity);
            let acts = |value: Scalar<'g>| self.kept(places, index, touches, [before, past], value).only_where(touches);
            let push = acts(impact.force(depth, -parting));
            let mut force = push * normal;
            if let Some(friction) = friction {
                let arm = -(self.radius * normal);
                let sliding = velocity + spin.cross(arm) - parting * normal;
                let resistance = friction.by_speed(sliding.dot(sliding));
                let drag = (friction.coefficient * push * resistance * sliding).map(|part| part.only_where(touches));
                force = force - drag;
                sum.torque += arm.cross(-drag);
                sum.friction += drag;
                sum.along += normal.perpendicular().dot(drag).only_where(touches);
            }
            sum.force += force.map(|part| part.only_where(touches));
            sum.push += push;
            sum.energy += acts(impact.potential(depth));
        }
        sum
    }

    /// `value`, the contribution of an edge; zero where a neighbour acts in its place.
    fn kept(
        &self,
        places: &[Place<'g>],
        index: usize,
        touches: Scalar<'g>,
        [before, past]: [Scalar<'g>; 2],
        value: Scalar<'g>,
    ) -> Scalar<'g> {
        let count = self.edges.len();
        let none = value.builder().number(0.0);
        let mut kept = value;
        if index > 0 || self.closed {
            let inside = self.inside(places, (index + count - 1) % count).only_where(touches);
            kept = before.select(kept, inside.select(kept, none));
        }
        if index + 1 < count || self.closed {
            let next = (index + 1) % count;
            let inside = self.inside(places, index).only_where(touches);
            let begins = places[next].along.only_where(touches);
            kept = past.select(begins.select(inside.select(kept, none), kept), kept);
        }
        kept
    }

    /// Positive on the inner side of the corner at an edge's end.
    fn inside(&self, places: &[Place<'g>], edge: usize) -> Scalar<'g> {
        let next = (edge + 1) % self.edges.len();
        let (before, after) = (&self.edges[edge], &self.edges[next]);
        let turn = before.last_tangent().cross(after.first_tangent())[2];
        let inside = turn * (places[edge].beside + places[next].beside);
        if before.arc.is_none() && after.arc.is_none() {
            return inside;
        }
        // Where an arc continues in the direction of the edge before it, there is no corner: rounding makes none.
        inside - TUNING.smooth_corner * self.reach
    }

    /// How fast the circle and the nearest edge part, m/s.
    fn rate(&self, places: &[Place<'g>], velocity: Vector<'g>) -> Scalar<'g> {
        let zero = velocity[0].builder().number(0.0);
        let rates = self.edges.iter().zip(places).map(|(edge, place)| {
            let across = edge.across(place, [place.along, place.past]);
            (place.square, across.dot(velocity) / place.square.sqrt())
        });
        let nearer = |(square, rate): (Scalar<'g>, Scalar<'g>), (other, its): (Scalar<'g>, Scalar<'g>)| {
            (square.min(other), (square - other).select(its, rate))
        };
        rates.reduce(nearer).map_or(zero, |(_, rate)| rate)
    }
}

impl<'g> Edge<'g> {
    fn first_tangent(&self) -> Vector<'g> {
        self.arc.map_or(self.tangent, |arc| arc.tangents[0])
    }

    fn last_tangent(&self) -> Vector<'g> {
        self.arc.map_or(self.tangent, |arc| arc.tangents[1])
    }

    /// Vector from the nearest point to the centre, which is before the start and past the end where these say so.
    fn across(&self, place: &Place<'g>, [before, past]: [Scalar<'g>; 2]) -> Vector<'g> {
        if let Some(arc) = &self.arc {
            return arc.across(place.centre, [before, past]);
        }
        let zero = before.builder().number(0.0);
        let beyond = before.min(zero) + past.max(zero);
        place.beside * self.tangent.perpendicular() + beyond * self.tangent
    }

    fn place(&self, centre: Vector<'g>) -> Place<'g> {
        if let Some(arc) = &self.arc {
            let [along, past] = arc.ends(centre);
            return Place {
                beside: arc.beside(centre),
                along,
                past,
                square: arc.square(centre, [along, past]),
                centre,
            };
        }
        let offset = centre - self.start;
        let (along, beside) = (self.tangent.dot(offset), self.tangent.perpendicular().dot(offset));
        let past = along - self.length;
        let beyond = (-along).max(past).max(along.builder().number(0.0));
        Place { beside, along, past, square: beside * beside + beyond * beyond, centre }
    }
}
