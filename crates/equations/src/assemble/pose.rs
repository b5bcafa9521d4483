//! A first guess of where the bodies are in space, in numbers, at the nominal parameters.
//!
//! Bodies are placed one after the other, each onto a joint with a body that is already placed, so that a chain of
//! joints is closed from the start and only loops are left to assembly:
//!
//! - at a joint that leaves the frames an axis or less, with the joint's angle and displacement where they are known,
//!   else at zero; these joints are walked first;
//! - at a spherical joint, and after those, with its next spherical joint towards its position if that is on a placed
//!   body, else along the ground's axes;
//! - at joints that constrain less, last: a distance away along x.
//!
//! Known coordinates of a body are unchanged. Axes are those of the ground of the body's instance, in its mirror.
//! Bodies that nothing joins to the ground stay where that is, else at 0.

use std::collections::VecDeque;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use symdiff::{Formula, Scalar};

use super::mechanism::{Mechanism, Owner, RelativeCoordinate, dof};
use crate::elements::joints::{Orientation, Separation};
use crate::grammar::{JointCoordinate, PointRef};
use crate::model::{LineMass, ReducedInertia, Standing};
use crate::multibody::{ANGLE, Body, BuildError, Context, EULER, Quaternion, RotationCoordinates, Vector};

/// A frame against another, in numbers.
#[derive(Clone, Copy, Default)]
struct Pose {
    position: Vector3<f64>,
    orientation: UnitQuaternion<f64>,
}

impl Pose {
    const fn at(position: Vector3<f64>, orientation: UnitQuaternion<f64>) -> Self {
        Self { position, orientation }
    }

    /// First this, then, in its frame, the other.
    fn then(&self, other: &Self) -> Self {
        Self::at(self.position + self.orientation * other.position, self.orientation * other.orientation)
    }

    fn inverse(&self) -> Self {
        let back = self.orientation.inverse();
        Self::at(-(back * self.position), back)
    }
}

/// Known parts of a body's pose.
#[derive(Clone, Copy, Default)]
struct Known {
    position: [Option<f64>; 3],
    orientation: Option<UnitQuaternion<f64>>,
}

/// A joint as seen from one of its bodies: the frames on this body and on the other, and how they are to each other.
#[derive(Clone, Copy)]
struct Link {
    here: Pose,
    there: Pose,
    other: usize,
    kind: LinkKind,
}

#[derive(Clone, Copy)]
enum LinkKind {
    /// The other frame against this one.
    Axis(Pose),
    /// Points coincide.
    Ball,
    /// The other point is so far away along x.
    Loose(f64),
}

/// Poses of all bodies.
pub struct Poses<'m, 'g, 'd> {
    mechanism: &'m Mechanism<'g, 'd>,
    known: Vec<Known>,
    /// Known values of joints' own coordinates, by their index in q.
    values: Vec<Option<f64>>,
    links: Vec<Vec<Link>>,
    poses: Vec<Option<Pose>>,
    /// Grounds of the bodies' instances, in whose axes the bodies are placed.
    frames: Vec<Pose>,
    /// Whether the instances are mirrored along x.
    is_flipped: Vec<bool>,
}

impl<'m, 'g, 'd> Poses<'m, 'g, 'd> {
    /// Places all bodies; `known` are the coordinates with a value at the start, `standing` says in which frames.
    pub fn of(
        m: &'m Mechanism<'g, 'd>,
        known: &[Option<Scalar<'g>>],
        standing: &[Option<Standing>],
    ) -> Result<Self, BuildError> {
        let values: Vec<Option<f64>> = known.iter().map(|known| known.map(|value| m.nominal([value])[0])).collect();
        let known: Vec<Known> = m.bodies.iter().map(|body| known_of(m, body, &values)).collect();
        let complete = |known: &Known| {
            let [x, y, z] = known.position;
            Some(Pose::at(Vector3::new(x?, y?, z?), known.orientation?))
        };
        let poses: Vec<Option<Pose>> = known.iter().map(complete).collect();
        let frame = |standing: &Option<Standing>| standing.and_then(|found| poses[found.ground]).unwrap_or_default();
        let frames = standing.iter().map(frame).collect();
        let flips = |standing: &Option<Standing>| standing.is_some_and(|found| found.mirrors.flips(0));
        let is_flipped = standing.iter().map(flips).collect();
        let links = vec![Vec::new(); m.bodies.len()];
        let mut placed = Self { mechanism: m, known, values, links, poses, frames, is_flipped };
        placed.find_links()?;
        placed.walk();
        Ok(placed)
    }

    /// Values of all coordinates.
    pub fn coordinates(&self) -> Result<Vec<f64>, BuildError> {
        let m = self.mechanism;
        let mut values = Vec::with_capacity(m.coordinates.len());
        for &owner in &m.coordinates {
            values.push(match owner {
                Owner::Body(body, coordinate) => {
                    let pose = self.pose(body);
                    let index = dof(coordinate);
                    match (index, m.bodies[body].rotation_coordinates) {
                        (0..3, _) => pose.position[index],
                        (_, RotationCoordinates::Angle) => angle_about(&pose.orientation, &Vector3::z()),
                        // nalgebra keeps the scalar part last.
                        (_, RotationCoordinates::Euler) => pose.orientation.coords[(index - EULER + 3) % 4],
                    }
                }
                Owner::Joint(joint, coordinate) => self.joint(joint, coordinate)?,
                Owner::Relative(joint, coordinate) => self.relative(joint, coordinate)?,
                Owner::Mode | Owner::State => 0.0,
            });
        }
        Ok(values)
    }

    fn joint(&self, joint: usize, coordinate: JointCoordinate) -> Result<f64, BuildError> {
        let kind = &self.mechanism.joints[joint].kind;
        let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(coordinate)) else { return Ok(0.0) };
        let axis = self.direction(axis)?;
        let [first, second] = between.map(|point| self.pose(point.body).then(&local(self.mechanism, point)));
        let relative = first.inverse().then(&second);
        Ok(match coordinate {
            JointCoordinate::Angle => angle_about(&relative.orientation, &axis),
            JointCoordinate::Displacement => relative.position.dot(&axis),
        })
    }

    fn relative(&self, joint: usize, coordinate: RelativeCoordinate) -> Result<f64, BuildError> {
        let m = self.mechanism;
        let kind = &m.joints[joint].kind;
        let (Some(between), Some(mobilizer)) = (kind.between(), kind.mobilizer()) else { return Ok(0.0) };
        let [first, second] = between.map(|point| self.pose(point.body).then(&local(m, point)));
        let Pose { position, orientation } = first.inverse().then(&second);
        let [x, y, z, w] = orientation.coords.into();
        let rotation = Quaternion::from([w, x, y, z].map(|component| m.g.number(component)));
        let offset = Vector::from(<[f64; 3]>::from(position).map(|component| m.g.number(component)));
        let value = m.relative_coordinate(&mobilizer, coordinate, rotation, offset)?;
        Ok(m.nominal([value])[0])
    }

    fn direction(&self, axis: &[Formula; 3]) -> Result<Vector3<f64>, BuildError> {
        let axis = self.mechanism.vector(axis, Context::Time)?;
        Ok(Vector3::from(self.mechanism.nominal(axis.components())).normalize())
    }

    fn pose(&self, body: usize) -> Pose {
        let frame = self.frames[body];
        self.poses[body].unwrap_or_else(|| self.known[body].or(frame.position, frame.orientation))
    }

    fn find_links(&mut self) -> Result<(), BuildError> {
        let m = self.mechanism;
        for (index, joint) in m.joints.iter().enumerate() {
            let (Some(between), Some(placement)) = (joint.kind.between(), joint.kind.placement()) else { continue };
            let kind = match (placement.orientation, placement.separation) {
                (Orientation::Free, Separation::Coincident) => LinkKind::Ball,
                (Orientation::Free, Separation::Unknown) => LinkKind::Loose(0.0),
                (Orientation::Free, Separation::Distance(length)) => LinkKind::Loose(self.nominal(length)?),
                (Orientation::AboutAxis, _) => LinkKind::Axis(self.across(index, UnitQuaternion::identity())?),
                (Orientation::Fixed(angle), _) => {
                    let angle = self.nominal(angle)?;
                    let twist = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
                    LinkKind::Axis(self.across(index, twist)?)
                }
            };
            self.link(between, kind);
        }
        for LineMass { between, length, .. } in &m.line_masses {
            let length = self.nominal(length)?;
            let across = Pose::at(length * Vector3::x(), UnitQuaternion::identity());
            self.link(*between, LinkKind::Axis(across));
        }
        for ReducedInertia { nodes, matrices, .. } in m.superelements.iter().map(|of| &of.inertia) {
            for node in 1..nodes.len() {
                let across = Vector3::from(matrices.offset(node));
                let across = Pose::at(across, UnitQuaternion::identity());
                self.link([nodes[0], nodes[node]], LinkKind::Axis(across));
            }
        }
        Ok(())
    }

    /// Records the relation between two points at both of their bodies.
    fn link(&mut self, between: [PointRef; 2], kind: LinkKind) {
        let [here, there] = between.map(|point| local(self.mechanism, point));
        let back = match kind {
            LinkKind::Axis(pose) => LinkKind::Axis(pose.inverse()),
            kind => kind,
        };
        let [first, second] = between.map(|point| point.body);
        self.links[first].push(Link { here, there, other: second, kind });
        self.links[second].push(Link { here: there, there: here, other: first, kind: back });
    }

    fn nominal(&self, formula: &Formula) -> Result<f64, BuildError> {
        let value = self.mechanism.formula(formula, Context::Time)?;
        Ok(self.mechanism.nominal([value])[0])
    }

    /// A joint's second frame against the first: turned by `twist`, the joint's coordinates zero where they are not
    /// known.
    fn across(&self, joint: usize, twist: UnitQuaternion<f64>) -> Result<Pose, BuildError> {
        let kind = &self.mechanism.joints[joint].kind;
        let mut pose = Pose::at(Vector3::zeros(), twist);
        for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
            let place = self.mechanism.joint_coordinates.get(&(joint, coordinate));
            let value = place.and_then(|&place| self.values[place]);
            if let (Some(axis), Some(value)) = (kind.axis_of(coordinate), value) {
                let axis = self.direction(axis)?;
                match coordinate {
                    JointCoordinate::Angle => {
                        pose.orientation = UnitQuaternion::from_axis_angle(&Unit::new_unchecked(axis), value);
                    }
                    JointCoordinate::Displacement => pose.position = value * axis,
                }
            }
        }
        Ok(pose)
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
                self.poses[link.other] = Some(self.placed(body, link));
                self.enqueue(&mut queues, link.other);
            }
        }
    }

    fn enqueue(&self, queues: &mut [VecDeque<(usize, Link)>; 3], body: usize) {
        for &link in &self.links[body] {
            let urgency = match link.kind {
                LinkKind::Axis(_) => 0,
                LinkKind::Ball => 1,
                LinkKind::Loose(_) => 2,
            };
            queues[urgency].push_back((body, link));
        }
    }

    /// The pose of `link.other` on its joint with `body`, which is placed.
    fn placed(&self, body: usize, link: Link) -> Pose {
        let here = self.pose(body).then(&link.here);
        let frame = self.frames[link.other].orientation;
        let wanted = match link.kind {
            LinkKind::Axis(across) => here.then(&across).then(&link.there.inverse()).orientation,
            LinkKind::Ball => self.aimed(link, here.position).unwrap_or(frame),
            LinkKind::Loose(_) => frame,
        };
        let anchor = match link.kind {
            LinkKind::Axis(across) => here.then(&across).position,
            LinkKind::Ball => here.position,
            LinkKind::Loose(distance) => {
                let distance = if self.is_flipped[link.other] { -distance } else { distance };
                here.position + frame * (distance * Vector3::x())
            }
        };
        let known = self.known[link.other];
        let orientation = known.orientation.unwrap_or(wanted);
        known.or(anchor - orientation * link.there.position, orientation)
    }

    /// The orientation of `link.other` that has its next ball, on a placed body, in the right direction.
    fn aimed(&self, link: Link, anchor: Vector3<f64>) -> Option<UnitQuaternion<f64>> {
        self.links[link.other].iter().find_map(|next| {
            let goal = self.poses[next.other]?.then(&next.there).position;
            let (own, wanted) = (next.here.position - link.there.position, goal - anchor);
            let other_end = matches!(next.kind, LinkKind::Ball) && own.norm() > 0.0;
            let frame = self.frames[link.other].orientation;
            let turned = || UnitQuaternion::rotation_between(&own, &(frame.inverse() * wanted));
            other_end.then(turned).flatten().map(|turned| frame * turned)
        })
    }
}

impl Known {
    /// This pose, with known parts replaced.
    fn or(&self, position: Vector3<f64>, orientation: UnitQuaternion<f64>) -> Pose {
        let position = Vector3::from_fn(|axis, _| self.position[axis].unwrap_or(position[axis]));
        Pose::at(position, self.orientation.unwrap_or(orientation))
    }
}

fn known_of<'g>(m: &Mechanism<'g, '_>, body: &Body<'g>, values: &[Option<f64>]) -> Known {
    let value = |index: usize| match body.index[index] {
        Some(index) => values[index],
        None if body.is_child() => None,
        None => Some(m.nominal([body.position[index]])[0]),
    };
    let orientation = match body.rotation_coordinates {
        RotationCoordinates::Angle => {
            value(ANGLE).map(|angle| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle))
        }
        RotationCoordinates::Euler => {
            let p: Option<Vec<f64>> = (EULER..EULER + 4).map(value).collect();
            p.map(|p| UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(p[0], p[1], p[2], p[3])))
        }
    };
    Known { position: [0, 1, 2].map(value), orientation }
}

/// Angle of the part of a rotation about an axis, between −π and π.
fn angle_about(rotation: &UnitQuaternion<f64>, axis: &Vector3<f64>) -> f64 {
    let (sin, cos) = (rotation.imag().dot(axis), rotation.w);
    if cos < 0.0 { 2.0 * symdiff::math::atan2(-sin, -cos) } else { 2.0 * symdiff::math::atan2(sin, cos) }
}

/// The frame at a point against its body's.
fn local(m: &Mechanism, point: PointRef) -> Pose {
    let position = m.local(point);
    let frame = m.local_frame(point);
    let (position, [p0, p1, p2, p3]) = (m.nominal(position.components()), m.nominal(frame.components()));
    Pose::at(Vector3::from(position), UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(p0, p1, p2, p3)))
}
