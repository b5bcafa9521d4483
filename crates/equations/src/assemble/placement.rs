//! A first guess of where the bodies are in the plane, in numbers, at the nominal parameters.
//!
//! Assembly is a Newton iteration and wants to begin near a solution, and never at a singular one: a four-bar linkage
//! with all its links at angle 0 is stretched, and no small rotation closes its gap. So the bodies are placed one after
//! the other, each onto a joint with a body that is already placed:
//!
//! - pins and welds before slides, since a slide does not say where along its line a body is;
//! - bodies whose angle is given (kept, guessed or prescribed, or by that of a pin) before others;
//! - the angle, where it is not given: that of a weld, slide or given pin to a placed body; or towards the other pin,
//!   where the body's second pin is on a placed body; or, where a second unplaced body leads on to a placed pin, that
//!   of the triangle with both bodies' lengths as sides, its corner on top; or 0.
//!
//! Angles, sides and the top are those of the ground of the body's instance, in its mirror. Bodies that nothing joins
//! to the ground stay where that is, else at 0.

use std::collections::VecDeque;

use symdiff::{Scalar, math};

use super::mechanism::Mechanism;
use crate::elements::joints::{Orientation, Separation};
use crate::model::{Coordinate, JointCoordinate, LineMass, PointRef, ReducedInertia, Standing};
use crate::multibody::{self, BuildError, Context};

/// x, y, θ.
const DEGREES_OF_FREEDOM: usize = 3;
/// Index of θ.
const ANGLE: usize = 2;

/// A joint as seen from one of its bodies.
#[derive(Clone, Copy)]
struct Link {
    /// Its position on this body, and on the other, in each body's frame.
    here: [f64; 2],
    there: [f64; 2],
    other: usize,
    kind: LinkKind,
}

#[derive(Clone, Copy)]
enum LinkKind {
    /// Points coincide.
    Pin,
    /// Points coincide, and the other's angle is this one's plus that.
    Weld(f64),
    /// The other's angle is this one's plus that.
    Slide(f64),
    /// Points on a line, or at a distance (zero for a slot).
    Loose(f64),
}

impl Link {
    /// Seen from the other body.
    fn reversed(self, body: usize) -> Self {
        let kind = match self.kind {
            LinkKind::Weld(angle) => LinkKind::Weld(-angle),
            LinkKind::Slide(angle) => LinkKind::Slide(-angle),
            kind => kind,
        };
        Self { here: self.there, there: self.here, other: body, kind }
    }
}

/// Poses of all bodies.
pub struct PlanarPoses {
    links: Vec<Vec<Link>>,
    given: Vec<[Option<f64>; DEGREES_OF_FREEDOM]>,
    poses: Vec<Option<[f64; DEGREES_OF_FREEDOM]>>,
    /// Grounds of the bodies' instances, in whose axes the bodies are placed.
    frames: Vec<Frame>,
}

/// The ground of an instance, in numbers.
#[derive(Clone, Copy, Default)]
struct Frame {
    pose: [f64; DEGREES_OF_FREEDOM],
    /// Whether the instance is mirrored along x and along y.
    is_flipped: [bool; 2],
}

impl Frame {
    /// A vector along the instance's x.
    fn along(self, length: f64) -> [f64; 2] {
        let length = if self.is_flipped[0] { -length } else { length };
        at([0.0, 0.0, self.pose[ANGLE]], [length, 0.0])
    }

    /// Height of a direction.
    fn height(self, direction: f64) -> f64 {
        let height = math::sin(direction - self.pose[ANGLE]);
        if self.is_flipped[1] { -height } else { height }
    }
}

impl PlanarPoses {
    /// Places all bodies; `known` are the coordinates with a value at the start, `standing` says in which frames.
    pub fn of<'g>(
        m: &Mechanism<'g, '_>,
        known: &[Option<Scalar<'g>>],
        standing: &[Option<Standing>],
    ) -> Result<Self, BuildError> {
        let mut given = vec![[None; DEGREES_OF_FREEDOM]; m.bodies.len()];
        for (body, given) in m.bodies.iter().zip(&mut given) {
            for (dof, given) in [0, 1, multibody::ANGLE].into_iter().zip(given) {
                let value = match body.index[dof] {
                    Some(index) => known[index],
                    None => (!body.is_child()).then_some(body.position[dof]),
                };
                *given = value.map(|value| m.nominal([value])[0]);
            }
        }
        let poses: Vec<_> = given.iter().map(|given| Some([given[0]?, given[1]?, given[ANGLE]?])).collect();
        let frame = |standing: &Option<Standing>| {
            let frame = |found: &Standing| {
                let is_flipped = [0, 1].map(|axis| found.mirrors.flips(axis));
                Some(Frame { pose: poses[found.ground]?, is_flipped })
            };
            standing.as_ref().and_then(frame).unwrap_or_default()
        };
        let frames = standing.iter().map(frame).collect();
        let mut placement = Self { links: links(m, known)?, given, poses, frames };
        placement.walk();
        Ok(placement)
    }

    /// A body's coordinate.
    pub fn value(&self, body: usize, coordinate: Coordinate) -> f64 {
        match coordinate {
            Coordinate::X => self.pose(body)[0],
            Coordinate::Y => self.pose(body)[1],
            Coordinate::Angle => self.pose(body)[ANGLE],
            Coordinate::Z | Coordinate::Euler(_) => 0.0,
        }
    }

    /// A joint's coordinate.
    pub fn joint(&self, m: &Mechanism, joint: usize, coordinate: JointCoordinate) -> f64 {
        let kind = &m.joints[joint].kind;
        let Some(between) = kind.between() else { return 0.0 };
        let [first, second] = between.map(|point| self.pose(point.body));
        match coordinate {
            JointCoordinate::Angle => second[ANGLE] - first[ANGLE],
            JointCoordinate::Displacement => {
                let [a, b] = between.map(|point| at(self.pose(point.body), local(m, point)));
                let axis = kind.axis_of(coordinate).and_then(|axis| m.vector(axis, Context::Time).ok());
                let [x, y, _] = axis.map_or([1.0, 0.0, 0.0], |axis| m.nominal(axis.components()));
                let along = at([0.0, 0.0, first[ANGLE] + math::atan2(y, x)], [1.0, 0.0]);
                along[0] * (b[0] - a[0]) + along[1] * (b[1] - a[1])
            }
        }
    }

    /// x, y, θ of a body.
    pub fn pose(&self, body: usize) -> [f64; DEGREES_OF_FREEDOM] {
        let frame = self.frames[body].pose;
        self.poses[body].unwrap_or_else(|| [0, 1, ANGLE].map(|dof| self.given[body][dof].unwrap_or(frame[dof])))
    }

    fn walk(&mut self) {
        let mut queues = [VecDeque::new(), VecDeque::new(), VecDeque::new()];
        for body in 0..self.poses.len() {
            if self.poses[body].is_some() {
                self.enqueue(&mut queues, body);
            }
        }
        while let Some((body, link)) = queues.iter_mut().find_map(VecDeque::pop_front) {
            if self.poses[link.other].is_none() {
                self.place(body, link);
                self.enqueue(&mut queues, link.other);
            }
        }
    }

    fn enqueue(&self, queues: &mut [VecDeque<(usize, Link)>; 3], body: usize) {
        for &link in &self.links[body] {
            let urgency = match link.kind {
                LinkKind::Weld(_) => 0,
                LinkKind::Pin if self.given[link.other][ANGLE].is_some() => 0,
                LinkKind::Pin => 1,
                LinkKind::Slide(_) | LinkKind::Loose(_) => 2,
            };
            queues[urgency].push_back((body, link));
        }
    }

    /// Places `link.other` onto its joint with `body`, which is placed.
    fn place(&mut self, body: usize, link: Link) {
        let mut anchor = at(self.pose(body), link.here);
        let frame = self.frames[link.other];
        if let LinkKind::Loose(distance) = link.kind {
            let [x, y] = frame.along(distance);
            anchor = [anchor[0] + x, anchor[1] + y];
        }
        let given = self.given[link.other];
        let angle = given[ANGLE].or_else(|| self.angle(body, link, anchor)).unwrap_or(frame.pose[ANGLE]);
        let arm = at([0.0, 0.0, angle], link.there);
        let origin = |axis: usize| given[axis].unwrap_or(anchor[axis] - arm[axis]);
        self.poses[link.other] = Some([origin(0), origin(1), angle]);
    }

    /// The angle of `link.other`, one of whose points is to be at `anchor`.
    fn angle(&self, body: usize, link: Link, anchor: [f64; 2]) -> Option<f64> {
        if let LinkKind::Weld(angle) | LinkKind::Slide(angle) = link.kind {
            return Some(self.pose(body)[ANGLE] + angle);
        }
        let onward = &self.links[link.other];
        let slid = onward.iter().find_map(|next| match (next.kind, self.poses[next.other]) {
            (LinkKind::Weld(angle) | LinkKind::Slide(angle), Some(pose)) => Some(pose[ANGLE] - angle),
            _ => None,
        });
        if slid.is_some() || !matches!(link.kind, LinkKind::Pin) {
            return slid;
        }
        let pins = || onward.iter().filter(|next| matches!(next.kind, LinkKind::Pin) && next.here != link.there);
        let aimed = pins().find_map(|next| {
            let goal = at(self.poses[next.other]?, next.there);
            Some(direction(anchor, goal)? - direction(link.there, next.here)?)
        });
        aimed.or_else(|| pins().find_map(|next| self.corner(link, anchor, next)))
    }

    /// The angle that makes a triangle of `anchor`, the pin `next` on the other side of `link.other`, and a placed pin
    /// on the far side of the body behind it.
    fn corner(&self, link: Link, anchor: [f64; 2], next: &Link) -> Option<f64> {
        if self.given[next.other][ANGLE].is_some() {
            return None;
        }
        let far = self.links[next.other].iter().find(|far| {
            matches!(far.kind, LinkKind::Pin) && far.here != next.there && self.poses[far.other].is_some()
        })?;
        let goal = at(self.poses[far.other]?, far.there);
        let (near_side, far_side) = (distance(link.there, next.here), distance(next.there, far.here));
        let base = distance(anchor, goal);
        let cosine = (near_side * near_side + base * base - far_side * far_side) / (2.0 * near_side * base);
        let opening = math::acos(cosine.clamp(-1.0, 1.0));
        let towards = direction(anchor, goal)?;
        let frame = self.frames[link.other];
        let is_higher = frame.height(towards + opening) >= frame.height(towards - opening);
        let higher = if is_higher { opening } else { -opening };
        Some(towards + higher - direction(link.there, next.here)?)
    }
}

/// A point of a body in the ground's frame.
fn at([x, y, angle]: [f64; DEGREES_OF_FREEDOM], [a, b]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = math::sin_cos(angle);
    [x + cos * a - sin * b, y + sin * a + cos * b]
}

fn distance(from: [f64; 2], to: [f64; 2]) -> f64 {
    math::hypot(to[0] - from[0], to[1] - from[1])
}

/// Angle of the line between two points; `None` where they coincide.
fn direction(from: [f64; 2], to: [f64; 2]) -> Option<f64> {
    (distance(from, to) > 0.0).then(|| math::atan2(to[1] - from[1], to[0] - from[0]))
}

/// The joints of each body, and the elements of beams, straight. A pin whose angle is known holds its bodies as a weld
/// does.
fn links<'g>(m: &Mechanism<'g, '_>, known: &[Option<Scalar<'g>>]) -> Result<Vec<Vec<Link>>, BuildError> {
    let mut links = vec![Vec::new(); m.bodies.len()];
    for (index, joint) in m.joints.iter().enumerate() {
        let turned = m.joint_coordinates.get(&(index, JointCoordinate::Angle)).and_then(|&place| known[place]);
        let value = |formula| Ok(m.nominal([m.formula(formula, Context::Time)?])[0]);
        let (Some(between), Some(placement)) = (joint.kind.between(), joint.kind.placement()) else { continue };
        let kind = match (placement.separation, placement.orientation) {
            (Separation::Coincident, Orientation::Fixed(angle)) => LinkKind::Weld(value(angle)?),
            (_, Orientation::Fixed(angle)) => LinkKind::Slide(value(angle)?),
            (Separation::Coincident, _) => match turned {
                Some(angle) => LinkKind::Weld(m.nominal([angle])[0]),
                None => LinkKind::Pin,
            },
            (Separation::Unknown, _) => LinkKind::Loose(0.0),
            (Separation::Distance(length), _) => LinkKind::Loose(value(length)?),
        };
        let [here, there] = between.map(|point| local(m, point));
        let link = Link { here, there, other: between[1].body, kind };
        links[between[0].body].push(link);
        links[between[1].body].push(link.reversed(between[0].body));
    }
    for LineMass { between, length, .. } in &m.line_masses {
        let here = [m.nominal([m.formula(length, Context::Parameters)?])[0], 0.0];
        let link = Link { here, there: [0.0, 0.0], other: between[1].body, kind: LinkKind::Weld(0.0) };
        links[between[0].body].push(link);
        links[between[1].body].push(link.reversed(between[0].body));
    }
    for ReducedInertia { nodes, matrices, .. } in m.superelements.iter().map(|of| &of.inertia) {
        for node in 1..nodes.len() {
            let [x, y, _] = matrices.offset(node);
            let [here, there] = [nodes[0], nodes[node]].map(|point| local(m, point));
            let turned = [nodes[0], nodes[node]].map(|point| turned_in_plane(m, point));
            let [along, across] = at([0.0, 0.0, turned[0]], [x, y]);
            let here = [here[0] + along, here[1] + across];
            let link = Link { here, there, other: nodes[node].body, kind: LinkKind::Weld(turned[0] - turned[1]) };
            links[nodes[0].body].push(link);
            links[nodes[node].body].push(link.reversed(nodes[0].body));
        }
    }
    Ok(links)
}

/// The angle of the frame at a point against its body's, in the plane.
fn turned_in_plane(m: &Mechanism, point: PointRef) -> f64 {
    let frame = m.local_frame(point);
    let [whole, about] = m.nominal([frame[0], frame.components()[3]]);
    2.0 * math::atan2(about, whole)
}

fn local(m: &Mechanism, point: PointRef) -> [f64; 2] {
    let [x, y, _] = m.nominal(m.local(point).components());
    [x, y]
}
