//! Joints in a mechanism: the quantities in their constraints, their axes, and the rates of their coordinates.

use symdiff::{Builder, Formula, Scalar};

use super::mechanism::Mechanism;
use crate::elements::joints::{Kinematics, Rows, ToothForce};
use crate::elements::meshing::Meshing;
use crate::grammar::{JointCoordinate, OfAngle, OnJoint, PointRef, TimeOrder};
use crate::multibody::{ANGLE, BuildError, Context, Pair, Vector};

impl<'g> Mechanism<'g, '_> {
    /// A joint's constraints.
    pub fn rows(&self, joint: usize) -> Rows<'g> {
        self.joints[joint].kind.rows(joint, &Motion(self))
    }

    /// A joint's velocity constraints.
    pub fn velocity_rows(&self, joint: usize) -> Rows<'g> {
        self.joints[joint].kind.velocity_rows(&Motion(self))
    }

    /// The force between the teeth of a joint under the multiplier λ.
    pub fn tooth_force(&self, joint: usize, lambda: Scalar<'g>) -> Result<Option<ToothForce<'g>>, BuildError> {
        self.joints[joint].kind.tooth_force(joint, &Motion(self), lambda)
    }

    /// Friction of a joint's teeth.
    pub fn meshing(&self, joint: usize) -> Result<Option<Meshing<'g>>, BuildError> {
        self.joints[joint].kind.meshing(joint, &Motion(self))
    }

    /// The unit vector about (along) which a joint's coordinate is counted, in the ground's axes; zero if it has none.
    pub fn axis_in_ground(&self, on: OnJoint) -> Result<Vector<'g>, BuildError> {
        let kind = &self.joints[on.joint].kind;
        let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(on.coordinate)) else {
            return Ok(Vector::zero(self.g));
        };
        let axis = self.unit_vector(axis, Context::Time)?;
        Ok(self.pair(between).outward(axis))
    }

    /// The rate of a joint's coordinate; one that is not a coordinate of its own follows from the bodies' velocities.
    pub fn joint_rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError> {
        let planar_angle = on.coordinate == JointCoordinate::Angle && !self.is_spatial;
        let is_own = planar_angle || self.joint_coordinates.contains_key(&(on.joint, on.coordinate));
        let (Some(between), false) = (self.joints[on.joint].kind.between(), is_own) else {
            return Ok(self.joint_coordinate(on, TimeOrder::Velocity));
        };
        let axis = self.axis_in_ground(on)?;
        let [first, second] = between.map(|point| point.body);
        let relative = match on.coordinate {
            JointCoordinate::Angle => {
                let [first, second] = [first, second].map(|body| self.bodies[body].angular_velocity());
                second - first
            }
            JointCoordinate::Displacement => {
                let at = self.point(between[1]);
                at.velocity - self.point_now_at(first, at.position).velocity
            }
        };
        Ok(axis.dot(relative))
    }
}

/// The positions and velocities of a mechanism.
struct Motion<'m, 'g, 'd>(&'m Mechanism<'g, 'd>);

impl<'g> Kinematics<'g> for Motion<'_, 'g, '_> {
    fn graph(&self) -> &'g Builder {
        self.0.g
    }

    fn is_spatial(&self) -> bool {
        self.0.is_spatial
    }

    fn time(&self) -> Scalar<'g> {
        self.0.time
    }

    fn number(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.0.formula(formula, Context::Time)
    }

    fn of_positions(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.0.formula(formula, Context::Positions)
    }

    fn is_prescribed(&self, formula: &Formula) -> bool {
        formula.names().all(|(name, _)| self.0.names.known(name, Context::Time).is_ok())
    }

    fn command(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.0.formula(formula, Context::Motion)
    }

    fn of_angle(&self, formula: &OfAngle, angle: Scalar<'g>) -> Result<[Scalar<'g>; 2], BuildError> {
        let function = self.0.function_of(&formula.0, OfAngle::VARIABLE)?;
        Ok([function.at(angle), function.derivative().at(angle)])
    }

    fn unit_vector(&self, direction: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
        self.0.unit_vector(direction, Context::Time)
    }

    fn points(&self, between: [PointRef; 2]) -> [Vector<'g>; 2] {
        between.map(|point| self.0.point(point).position)
    }

    fn velocity(&self, point: PointRef) -> Vector<'g> {
        self.0.point(point).velocity
    }

    fn angular_velocity(&self, body: usize) -> Vector<'g> {
        self.0.bodies[body].angular_velocity()
    }

    fn pair(&self, between: [PointRef; 2]) -> Pair<'g> {
        self.0.pair(between)
    }

    fn rotated(&self, body: usize, vector: Vector<'g>) -> Vector<'g> {
        self.0.bodies[body].rotate(vector)
    }

    fn angle(&self, body: usize) -> Scalar<'g> {
        self.0.bodies[body].position[ANGLE]
    }

    fn coordinate(&self, on: OnJoint) -> Scalar<'g> {
        self.0.joint_coordinate(on, TimeOrder::Position)
    }

    fn rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError> {
        self.0.joint_rate(on)
    }

    fn axis(&self, on: OnJoint) -> Result<Vector<'g>, BuildError> {
        self.0.axis_in_ground(on)
    }

    fn joint_name(&self, joint: usize) -> &str {
        &self.0.joints[joint].name
    }

    fn bodies(&self, joint: usize) -> Option<[usize; 2]> {
        self.0.joints[joint].kind.between().map(|between| between.map(|point| point.body))
    }

    fn line(&self, on: OnJoint, body: usize) -> Result<Option<[Vector<'g>; 2]>, BuildError> {
        let kind = &self.0.joints[on.joint].kind;
        let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(on.coordinate)) else { return Ok(None) };
        let Some(point) = between.into_iter().find(|point| point.body == body) else { return Ok(None) };
        let axis = self.0.unit_vector(axis, Context::Time)?;
        Ok(Some([self.0.local(point), self.0.local_frame(point).matrix() * axis]))
    }

    fn place(&self, body: usize, local: Vector<'g>) -> Vector<'g> {
        self.0.point_at(body, local).position
    }

    fn nominal(&self, vector: Vector<'g>) -> [f64; 3] {
        self.0.nominal(vector.components())
    }
}
