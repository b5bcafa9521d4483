//! The reference to which a start is nearest if the model leaves it open: zero coordinates of the inboard joints, or
//! those that `guess` gives for them or for their bodies.
//!
//! These are the inboard joints of joint coordinates, so that the start does not depend on the formulation, nor on the
//! outputs. A root stays near its guess, and so does a body behind a joint whose coordinates have no names.

use symdiff::Scalar;

use super::at_guess::AtGuess;
use super::mechanism::{Mechanism, Owner};
use super::system::{Distance, Start};
use super::tree::Tree;
use crate::grammar::{Coordinate, JointCoordinate, OnJoint, TimeOrder};
use crate::model::{Description, StartValue};
use crate::multibody::{BuildError, Context};

impl<'g> Mechanism<'g, '_> {
    /// The distances that are smallest at the start, of coordinates that `start` does not give, in a model of size
    /// `length`.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn distances(
        &self,
        description: &Description,
        length: f64,
        start: &Start,
    ) -> Result<Vec<Distance>, BuildError> {
        let tree =
            Tree::spanning(self.questions, |mobilizer| mobilizer.has_one_axis() && self.is_time_independent(mobilizer));
        let mut distances = Vec::new();
        let mut add = |owner: Owner, name: String, value: Scalar<'g>, place: Option<usize>| {
            let is_open = |kept: &[Option<_>]| place.is_none_or(|place| kept[place].is_none());
            let distance = Distance {
                name,
                value: value.expr(),
                scale: if owner.is_length() { length } else { 1.0 },
                position: is_open(&start.position),
                velocity: is_open(&start.velocity),
            };
            distances.extend((distance.position || distance.velocity).then_some(distance));
        };
        for (place, &owner) in self.coordinates.iter().enumerate() {
            if matches!(owner, Owner::Body(body, _) if tree.inboard[body].is_none()) {
                let value = self.q[place] - self.g.scalar(start.guess[place]);
                add(owner, self.coordinate_names[place].clone(), value, Some(place));
            }
        }
        for (&body, guess) in self.body_guesses.iter().filter(|(body, _)| tree.inboard[**body].is_none()) {
            let name = &description.bodies[body].name;
            let placed = &self.bodies[body];
            for (axis, coordinate) in [Coordinate::X, Coordinate::Y, Coordinate::Z].into_iter().enumerate() {
                let owner = Owner::Body(body, coordinate);
                add(owner, format!("{name}.{}", owner.suffix()), placed.position[axis] - guess[axis], None);
            }
            // p and −p are one rotation.
            let [.., p0, p1, p2, p3] = guess.map(|value| self.g.number(value));
            let p = placed.euler();
            let sign = p.dot([p0, p1, p2, p3].into()).select(self.g.number(1.0), self.g.number(-1.0));
            for (component, guess) in [p0, p1, p2, p3].into_iter().enumerate() {
                let owner = Owner::Body(body, Coordinate::Euler(component));
                add(owner, format!("{name}.{}", owner.suffix()), sign * p[component] - guess, None);
            }
        }
        let carried = tree.order.iter().filter(|&&body| !tree.merges(body));
        for (body, joint) in carried.filter_map(|&body| Some((body, tree.inboard[body]?.joint))) {
            let Some(mobilizer) = self.joints[joint].kind.mobilizer() else { continue };
            for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
                // A screw's displacement follows from its angle.
                let follows = mobilizer.pitch().is_some() && coordinate == JointCoordinate::Displacement;
                if mobilizer.axis_of(coordinate).is_none() || follows {
                    continue;
                }
                let place = self.joint_coordinates.get(&(joint, coordinate)).copied();
                let on = OnJoint { joint, coordinate };
                let mut value = self.measured_coordinate(on)?;
                if let Some(guess) = self.guessed(description, start, body, on, value)? {
                    value -= guess;
                }
                let owner = Owner::Joint(joint, coordinate);
                add(owner, format!("{}.{}", self.joints[joint].name, owner.suffix()), value, place);
            }
        }
        Ok(distances)
    }

    /// Guess of the coordinate of a body's inboard joint: its value in `guess`, or its value at the guess of the start
    /// if `guess` names the body.
    fn guessed(
        &self,
        description: &Description,
        start: &Start,
        body: usize,
        on: OnJoint,
        value: Scalar<'g>,
    ) -> Result<Option<Scalar<'g>>, BuildError> {
        let of_joint = description.guess.iter().find_map(|guess| match guess {
            StartValue::Joint { joint, coordinate, order: TimeOrder::Position, value } => {
                (OnJoint { joint: *joint, coordinate: *coordinate } == on).then_some(value)
            }
            _ => None,
        });
        if let Some(formula) = of_joint {
            return self.formula(formula, Context::Parameters).map(Some);
        }
        let names_body = description.guess.iter().any(|guess| match guess {
            StartValue::Coordinate { body: of, order: TimeOrder::Position, .. }
            | StartValue::Orientation { body: of, .. } => *of == body,
            _ => false,
        });
        if !names_body {
            return Ok(None);
        }
        let there = {
            let graph = self.g.graph();
            AtGuess::of(self, &graph, &start.guess).values(&graph, &[value.expr()])[0]
        };
        Ok(Some(self.g.number(there)))
    }

    /// Whether all distances are coordinates of the mechanism: those of the inboard joints alone.
    pub fn has_distances(&self) -> bool {
        !self.coordinates.iter().any(|owner| matches!(owner, Owner::Body(..) | Owner::Relative(..)))
    }

    /// A joint's coordinate, whether it is a coordinate of the mechanism or not: then an angle of space is between −π
    /// and π.
    pub(super) fn measured_coordinate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError> {
        let kind = &self.joints[on.joint].kind;
        let planar_angle = on.coordinate == JointCoordinate::Angle && !self.is_spatial;
        let is_own = planar_angle || self.joint_coordinates.contains_key(&(on.joint, on.coordinate));
        let (Some(between), Some(axis), false) = (kind.between(), kind.axis_of(on.coordinate), is_own) else {
            return Ok(self.joint_coordinate(on, TimeOrder::Position));
        };
        let axis = self.unit_vector(axis, Context::Time)?;
        let pair = self.pair(between);
        Ok(match on.coordinate {
            JointCoordinate::Displacement => pair.displacement(axis),
            JointCoordinate::Angle => {
                let relative = pair.relative();
                let (cos, sin) = (relative[0], relative.vector_part().dot(axis));
                // Sine and cosine of twice the half angle: q and −q are one rotation.
                (2.0 * cos * sin).atan2(cos * cos - sin * sin)
            }
        })
    }
}
