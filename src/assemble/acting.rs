//! Effects on a mechanism: what they see of its motion, and what they add to its forces.

use symdiff::{Builder, Formula, Scalar};

use super::applied_forces::AppliedForces;
use super::body::ANGLE;
use super::error::BuildError;
use super::joints::axis_in_ground;
use super::mechanism::{Context, Mechanism};
use super::space;
use crate::elements::effects::{Forces, MovingPoint};
use crate::grammar::{JointCoordinate, OnJoint, PointRef, Rotating, Sensor, TimeOrder};
use crate::multibody::{Pair, Vector};

/// A mechanism while an effect acts on it.
pub struct Acting<'g, 'm, 'd> {
    /// The graph that expressions are added to.
    pub g: &'g Builder,
    /// The mechanism, in motion.
    pub m: &'m Mechanism<'d>,
    /// What acts on it so far.
    pub applied: &'m mut AppliedForces,
}

impl<'g> Acting<'g, '_, '_> {
    fn evaluated(&self, formula: &Formula, context: Context) -> Result<Scalar<'g>, BuildError> {
        self.m.formula(self.g, formula, context).map(|expr| self.g.scalar(expr))
    }

    fn evaluated_vector(&self, formulas: &[Formula; 3], context: Context) -> Result<Vector<'g>, BuildError> {
        self.m.vector(self.g, formulas, context).map(|components| Vector::of(self.g, components))
    }
}

impl<'g> Forces<'g> for Acting<'g, '_, '_> {
    fn graph(&self) -> &'g Builder {
        self.g
    }

    fn is_spatial(&self) -> bool {
        self.m.is_spatial()
    }

    fn time(&self) -> Scalar<'g> {
        self.g.scalar(self.m.time)
    }

    fn value(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.evaluated(formula, Context::Motion)
    }

    fn value_with(&self, formula: &Formula, own: &[(Sensor, Scalar<'g>)]) -> Result<Scalar<'g>, BuildError> {
        let own: Vec<_> = own.iter().map(|&(measure, value)| (measure, value.expr())).collect();
        self.m.own_formula(self.g, formula, &own).map(|expr| self.g.scalar(expr))
    }

    fn prescribed(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.evaluated(formula, Context::Time)
    }

    fn vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
        self.evaluated_vector(formulas, Context::Motion)
    }

    fn prescribed_vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
        self.evaluated_vector(formulas, Context::Time)
    }

    fn point(&self, point: PointRef) -> MovingPoint<'g> {
        MovingPoint::of(self.g, self.m.point(self.g, point))
    }

    fn point_at(&self, body: usize, position: Vector<'g>) -> MovingPoint<'g> {
        MovingPoint::of(self.g, self.m.carried_along(self.g, body, position.exprs()))
    }

    fn pair(&self, between: [PointRef; 2]) -> Pair {
        self.m.pair(self.g, between)
    }

    fn rotated(&self, body: usize, vector: Vector<'g>) -> Vector<'g> {
        Vector::of(self.g, self.m.bodies[body].rotate(self.g, vector.exprs()))
    }

    fn angular_velocity(&self, body: usize) -> Vector<'g> {
        Vector::of(self.g, self.m.bodies[body].angular_velocity(self.g))
    }

    fn angle(&self, of: Rotating, order: TimeOrder) -> Scalar<'g> {
        match (of, order) {
            (Rotating::Body(body), TimeOrder::Position) => self.g.scalar(self.m.bodies[body].position[ANGLE]),
            (Rotating::Body(body), _) => self.g.scalar(self.m.bodies[body].velocity[ANGLE]),
            (Rotating::Joint(joint), _) => self.coordinate(OnJoint::angle(joint), order),
        }
    }

    fn coordinate(&self, on: OnJoint, order: TimeOrder) -> Scalar<'g> {
        self.g.scalar(self.m.joint_coordinate(self.g, on.joint, on.coordinate, order))
    }

    fn rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError> {
        self.m.joint_rate(self.g, on.joint, on.coordinate).map(|rate| self.g.scalar(rate))
    }

    fn axis(&self, on: OnJoint) -> Result<Vector<'g>, BuildError> {
        axis_in_ground(self.g, self.m, on.joint, on.coordinate).map(|axis| Vector::of(self.g, axis))
    }

    fn reaction(&self, joint: usize) -> [Vector<'g>; 2] {
        let reaction = &self.m.reactions[joint];
        [reaction.force, reaction.torque].map(|components| Vector::of(self.g, components))
    }

    fn only_where(&mut self, condition: Scalar<'g>) {
        self.applied.only_where(condition.expr());
    }

    fn at(&mut self, point: &MovingPoint<'g>, force: Vector<'g>) {
        self.applied.add_force(self.g, &point.material(), force.exprs());
    }

    fn between(&mut self, from: &MovingPoint<'g>, to: &MovingPoint<'g>, force: Vector<'g>) {
        self.applied.add_force_pair(self.g, &from.material(), &to.material(), force.exprs());
    }

    fn torque(&mut self, from: usize, on: usize, torque: Vector<'g>) {
        self.applied.add_torque_pair(self.g, from, on, torque.exprs());
    }

    fn effort(&mut self, on: OnJoint, effort: Scalar<'g>) -> Result<(), BuildError> {
        match on.coordinate {
            JointCoordinate::Angle => self.applied.add_joint_torque(self.g, self.m, on.joint, effort.expr()),
            JointCoordinate::Displacement => self.applied.add_joint_force(self.g, self.m, on.joint, effort.expr()),
        }
    }

    fn weight(&mut self, field: Vector<'g>) -> Result<(), BuildError> {
        let (g, m, field) = (self.g, self.m, field.exprs());
        for (index, body) in m.bodies.iter().enumerate() {
            let weight = space::scale(g, body.mass, field);
            let center = m.point_at(g, index, body.center);
            self.applied.add_weight(g, m, &center, weight);
            let height = space::dot(g, weight, center.position);
            let potential = g.neg(height);
            self.applied.add_potential(g, m, &weight, potential);
        }
        m.weigh_beams(g, self.applied, field)?;
        self.applied.add_field(g, field);
        Ok(())
    }

    fn potential(&mut self, coefficients: &[Scalar<'g>], energy: Scalar<'g>) {
        let coefficients: Vec<_> = coefficients.iter().map(|coefficient| coefficient.expr()).collect();
        self.applied.add_potential(self.g, self.m, &coefficients, energy.expr());
    }

    fn sensor(&mut self, measure: Sensor, value: Scalar<'g>) {
        self.applied.sensor(measure, value.expr());
    }
}
