//! Outlines in contact with a circle, sphere or point: straight edges, with what lies within a radius of them.
//!
//! ```text
//! edge from a along u, length L; w = p − a:    t = u · w,    h = u × w,    s = min(t, 0) + max(t − L, 0)
//! d = √(h² + s²),    depth = ρ + r − d,    normal = (h n + s u)/d
//! ```
//!
//! p is the centre of the circle of radius r in the first frame, n the edge's left normal, ρ the outline's rounding. Where two edges join,
//! the surface is round about their corner, so that normals do not jump. On the outer side of a corner the nearer edge pushes, and of two
//! that both end there the first one; on the inner side both push. All edges' forces are summed at p, with their torque about it.

use std::ops::Deref;

use schemars::{Schema, SchemaGenerator};
use symdiff::{Formula, Scalar};

use super::Forces;
use super::dry_friction::Resistance;
use super::felt::Felt;
use super::impact::Push;
use crate::grammar::{Node, Quantity, Reader, Span, SymbolTable, Value, values};
use crate::multibody::{BuildError, Pair, Vector};
use crate::syntax::yaml;

/// Points in a frame.
#[derive(Clone, Debug)]
pub struct Points(Vec<[Formula; 3]>);

impl Deref for Points {
    type Target = [[Formula; 3]];

    fn deref(&self) -> &[[Formula; 3]] {
        &self.0
    }
}

impl Points {
    /// Reports too few points, and neighbours that are one point somewhere in the box of parameters.
    pub fn check_edges<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, at: Span, (key, least): (&str, usize)) {
        let count = self.0.len();
        if count < least {
            reader.error(at, format!("a `{key}` has {least} points or more, not {count}"), None);
            return;
        }
        let edges = if least > 2 { count } else { count - 1 };
        for corner in 0..reader.corners.len() {
            let place = |point: &[Formula; 3]| {
                let [x, y] = [0, 1].map(|axis| reader.evaluate(&point[axis], corner));
                x.zip(y)
            };
            let is_none = |edge: &usize| {
                let ends = place(&self.0[*edge]).zip(place(&self.0[(*edge + 1) % count]));
                ends.is_some_and(|(start, end)| start == end)
            };
            if let Some(edge) = (0..edges).find(is_none) {
                let (start, end) = (edge + 1, (edge + 1) % count + 1);
                let label = &reader.corners[corner].label;
                let help = (end == 1).then(|| "a polygon closes by itself: leave its last point out".to_owned());
                reader.error(at, format!("points {start} and {end} of the `{key}` are one point{label}"), help);
                return;
            }
        }
    }
}

impl Value for Points {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, quantity: &Quantity) -> Option<Self> {
        let items = match &node.value {
            yaml::Value::Sequence(items) if !items.is_empty() => items,
            _ => {
                let help = "e.g. `[[0, 0], [0.2, 0], [0.2, 0.1]]`".to_owned();
                reader.error(
                    node.span.clone(),
                    "a list of points belongs here, each a list of two or three numbers",
                    help,
                );
                return None;
            }
        };
        let points: Vec<_> =
            items.iter().map(|item| reader.components(item, quantity.context, quantity.dimension())).collect();
        points.into_iter().collect::<Option<_>>().map(Self)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<Vec<values::Components>>()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(self.0.iter().flatten());
    }

    fn leaves_plane(node: &Node) -> bool {
        matches!(&node.value, yaml::Value::Sequence(items) if items.iter().any(crate::grammar::plane::points_out))
    }
}

/// Edges in the x and y of a frame.
#[derive(Clone, Debug)]
pub(super) struct Outline<'g> {
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
}

/// What the edges do together.
struct Sum<'g> {
    force: Vector<'g>,
    torque: Vector<'g>,
    push: Scalar<'g>,
    friction: Vector<'g>,
    /// Of the friction along the surface, clockwise about it.
    along: Scalar<'g>,
    energy: Scalar<'g>,
}

impl<'g> Outline<'g> {
    /// Through points, and back to the first where it is closed.
    pub fn through(points: &[Vector<'g>], closed: bool, rounding: Scalar<'g>, radius: Scalar<'g>) -> Self {
        let last = closed.then(|| (points.last(), points.first()));
        let pairs = points.windows(2).map(|pair| (pair.first(), pair.last())).chain(last);
        let edges = pairs.filter_map(|(start, end)| {
            let (start, end) = (*start?, *end?);
            let way = end - start;
            let length = way.norm();
            Some(Edge { start, tangent: way / length, length })
        });
        Self { edges: edges.collect(), closed, reach: rounding + radius, radius }
    }

    /// Adds the forces on a circle about `centre`, which belongs to the second body.
    pub fn apply(
        &self,
        forces: &mut dyn Forces<'g>,
        (pair, centre): (&Pair<'g>, Vector<'g>),
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
        let sum = self.pushes(&places, (velocity, spin), impact, friction);
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
        (velocity, spin): (Vector<'g>, Vector<'g>),
        impact: &Push<'g>,
        friction: Option<&Resistance<'g>>,
    ) -> Sum<'g> {
        let g = self.reach.builder();
        let (none, zero) = (Vector::zero(g), g.number(0.0));
        let mut sum = Sum { force: none, torque: none, push: zero, friction: none, along: zero, energy: zero };
        let square_of_reach = self.reach * self.reach;
        for (index, (edge, place)) in self.edges.iter().zip(places).enumerate() {
            // In radii, so that it stays where the effect's own condition is known to hold: what follows switches in a contact only.
            let touches = 1.0 - place.square / square_of_reach;
            let (before, past) = (place.along.only_where(touches), place.past.only_where(touches));
            let beyond = before.min(zero) + past.max(zero);
            let across = place.beside * edge.tangent.perpendicular() + beyond * edge.tangent;
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

    /// What an edge does, where no neighbour does it in its place.
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
        let turn = self.edges[edge].tangent.cross(self.edges[next].tangent)[2];
        turn * (places[edge].beside + places[next].beside)
    }

    /// How fast the circle and the nearest edge part, m/s.
    fn rate(&self, places: &[Place<'g>], velocity: Vector<'g>) -> Scalar<'g> {
        let zero = velocity[0].builder().number(0.0);
        let rates = self.edges.iter().zip(places).map(|(edge, place)| {
            let beyond = place.along.min(zero) + place.past.max(zero);
            let across = place.beside * edge.tangent.perpendicular() + beyond * edge.tangent;
            (place.square, across.dot(velocity) / place.square.sqrt())
        });
        let nearer = |(square, rate): (Scalar<'g>, Scalar<'g>), (other, its): (Scalar<'g>, Scalar<'g>)| {
            (square.min(other), (square - other).select(its, rate))
        };
        rates.reduce(nearer).map_or(zero, |(_, rate)| rate)
    }
}

impl<'g> Edge<'g> {
    fn place(&self, centre: Vector<'g>) -> Place<'g> {
        let offset = centre - self.start;
        let (along, beside) = (self.tangent.dot(offset), self.tangent.perpendicular().dot(offset));
        let past = along - self.length;
        let beyond = (-along).max(past).max(along.builder().number(0.0));
        Place { beside, along, past, square: beside * beside + beyond * beyond }
    }
}

/// Formulas of points as vectors.
pub(super) fn placed<'g>(forces: &dyn Forces<'g>, points: &Points) -> Result<Vec<Vector<'g>>, BuildError> {
    points.iter().map(|point| forces.prescribed_vector(point)).collect()
}
