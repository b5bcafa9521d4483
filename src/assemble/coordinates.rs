//! Coordinates of joints: the angle about an axis, the displacement along it.
//!
//! One that a formula, the start or a coupling names becomes a coordinate of the mechanism, without inertia, with a
//! constraint that defines it. With q = (q₀, e) the rotation of the second frame against the first and a the axis,
//!
//! ```text
//! angle φ:           Φ = 2 [cos(φ/2) e·a − sin(φ/2) q₀] = 0          (for a rotation by ψ about a: 2 sin((ψ − φ)/2))
//! displacement s:    Φ = R₁ a · (r_B − r_A) − s = 0
//! ```
//!
//! so that angles are continuous over any number of turns, and can be driven, coupled and kept at the start like any other
//! coordinate. Forces on them reach the bodies through the constraint's multiplier, which is no part of the joint's reaction.
//! In the plane an angle is the difference θ₂ − θ₁, and is a coordinate of its own only where the start names it.

use std::collections::BTreeSet;

use symdiff::{Builder, Expr, Formula};

use crate::grammar::JointCoordinate;
use crate::model::{Description, StartValue, Symbol, TimeOrder};

use super::body::ANGLE;
use super::error::BuildError;
use super::joints;
use super::mechanism::{Context, Mechanism};
use super::space;

/// The coordinates of joints that are coordinates of their own.
pub fn called_for(description: &Description) -> BTreeSet<(usize, JointCoordinate)> {
    let mut found = BTreeSet::new();
    for value in description.initial.iter().chain(&description.guess) {
        if let StartValue::Joint { joint, coordinate, .. } = value {
            found.insert((*joint, *coordinate));
        }
    }
    let mut add = |joint: usize, coordinate: JointCoordinate| {
        if description.space.spatial || coordinate != JointCoordinate::Angle {
            found.insert((joint, coordinate));
        }
    };
    for (index, joint) in description.joints.iter().enumerate() {
        joint.kind.coordinates(index).into_iter().for_each(|on| add(on.joint, on.coordinate));
    }
    for effect in &description.effects {
        effect.kind.coordinates().into_iter().for_each(|on| add(on.joint, on.coordinate));
    }
    for formula in formulas(description) {
        for (name, _) in formula.names() {
            if let Some(Symbol::JointCoordinate { joint, coordinate, .. }) = description.symbol(name) {
                add(joint, coordinate);
            }
        }
    }
    found
}

/// Formulas that may speak of the motion.
fn formulas(description: &Description) -> Vec<&Formula> {
    let outputs = description.outputs.iter().map(|output| &output.formula);
    formulas_of_motion(description).into_iter().chain(outputs).collect()
}

/// Formulas of constraints and effects.
pub fn formulas_of_motion(description: &Description) -> Vec<&Formula> {
    let equations = description.joints.iter().filter_map(|joint| joint.kind.equation());
    let mut found: Vec<&Formula> = equations.flatten().collect();
    found.extend(description.effects.iter().flat_map(|effect| effect.kind.formulas()));
    found
}

impl Mechanism<'_> {
    /// A joint's coordinate or its derivative. One that is not a coordinate of its own is an angle of the plane.
    pub fn joint_coordinate(&self, g: &Builder, joint: usize, coordinate: JointCoordinate, order: TimeOrder) -> Expr {
        if let Some(&index) = self.joint_coordinates.get(&(joint, coordinate)) {
            let list = match order {
                TimeOrder::Position => &self.q,
                TimeOrder::Velocity => &self.v,
                TimeOrder::Acceleration => &self.w,
            };
            return list[index];
        }
        let Some(between) = self.description.joints[joint].kind.between() else { return g.constant(0.0) };
        let [first, second] = between.map(|point| {
            let body = &self.bodies[point.body];
            match order {
                TimeOrder::Position => body.position[ANGLE],
                TimeOrder::Velocity => body.velocity[ANGLE],
                TimeOrder::Acceleration => body.acceleration[ANGLE],
            }
        });
        g.sub(second, first)
    }

    /// The rate of a joint's coordinate; one that is not a coordinate of its own follows from the bodies' velocities.
    pub fn joint_rate(&self, g: &Builder, joint: usize, coordinate: JointCoordinate) -> Result<Expr, BuildError> {
        let planar_angle = coordinate == JointCoordinate::Angle && !self.is_spatial();
        let between = self.description.joints[joint].kind.between();
        let (Some(between), false) =
            (between, planar_angle || self.joint_coordinates.contains_key(&(joint, coordinate)))
        else {
            return Ok(self.joint_coordinate(g, joint, coordinate, TimeOrder::Velocity));
        };
        let axis = joints::axis_in_ground(g, self, joint, coordinate)?;
        let [first, second] = between.map(|point| point.body);
        let relative = match coordinate {
            JointCoordinate::Angle => {
                let [first, second] = [first, second].map(|body| self.bodies[body].angular_velocity(g));
                space::sub(g, second, first)
            }
            JointCoordinate::Displacement => {
                let at = self.point(g, between[1]);
                let there = self.carried_along(g, first, at.position);
                space::sub(g, at.velocity, there.velocity)
            }
        };
        Ok(space::dot(g, axis, relative))
    }

    /// The constraints that define a joint's own coordinates: name and Φ.
    pub fn definitions(&self, g: &Builder, joint: usize) -> Result<Vec<(&'static str, Expr)>, BuildError> {
        let kind = &self.description.joints[joint].kind;
        let mut rows = Vec::new();
        if self.tree.uses(joint) {
            return Ok(rows);
        }
        for (coordinate, name) in [(JointCoordinate::Angle, "angle"), (JointCoordinate::Displacement, "displacement")] {
            let Some(&index) = self.joint_coordinates.get(&(joint, coordinate)) else { continue };
            let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(coordinate)) else { continue };
            let value = self.q[index];
            let planar_angle = coordinate == JointCoordinate::Angle && !self.is_spatial();
            let row = if planar_angle {
                let [first, second] = between.map(|point| self.bodies[point.body].position[ANGLE]);
                let turned = g.sub(second, first);
                g.sub(turned, value)
            } else {
                let pair = self.pair(g, between);
                let axis = self.vector(g, axis, Context::Time)?;
                let axis = space::unit(g, axis);
                match coordinate {
                    JointCoordinate::Angle => pair.turned_by(g, axis, value),
                    JointCoordinate::Displacement => {
                        let moved = pair.displacement(g, axis);
                        g.sub(moved, value)
                    }
                }
            };
            rows.push((name, row));
        }
        Ok(rows)
    }
}
