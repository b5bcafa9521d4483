//! Effects on a mechanism: the motion they read and the forces they add.

use symdiff::{Builder, Formula, Scalar};

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use crate::elements::effects::Forces;
use crate::elements::meshing::Meshing;
use crate::grammar::{OfPlace, OnJoint, PointRef, Rotating, Sensor, TimeOrder};
use crate::multibody::{ANGLE, BuildError, Context, MaterialPoint, OwnFunction, Pair, Vector};

/// A mechanism while an effect acts on it.
pub struct Acting<'m, 'g, 'd> {
    /// The mechanism, in motion.
    pub m: &'m Mechanism<'g, 'd>,
    /// Index of the effect among all.
    pub effect: usize,
    /// Forces applied to the mechanism so far.
    pub applied: &'m mut AppliedForces<'g>,
}

impl<'g> Forces<'g> for Acting<'_, 'g, '_> {
    fn graph(&self) -> &'g Builder {
        self.m.g
    }

    fn is_spatial(&self) -> bool {
        self.m.is_spatial
    }

    fn time(&self) -> Scalar<'g> {
        self.m.time
    }

    fn value(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.m.formula(formula, Context::Motion)
    }

    fn value_with(&self, formula: &Formula, own: &[(Sensor, Scalar<'g>)]) -> Result<Scalar<'g>, BuildError> {
        self.m.own_formula(formula, own)
    }

    fn prescribed(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.m.formula(formula, Context::Time)
    }

    fn vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
        self.m.vector(formulas, Context::Motion)
    }

    fn prescribed_vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
        self.m.vector(formulas, Context::Time)
    }

    fn of_place(&self, formula: &OfPlace) -> Result<OwnFunction<'g>, BuildError> {
        self.m.function_of(&formula.0, OfPlace::VARIABLE)
    }

    fn point(&self, point: PointRef) -> MaterialPoint<'g> {
        self.m.point(point)
    }

    fn point_at(&self, body: usize, position: Vector<'g>) -> MaterialPoint<'g> {
        self.m.point_now_at(body, position)
    }

    fn pair(&self, between: [PointRef; 2]) -> Pair<'g> {
        self.m.pair(between)
    }

    fn rotated(&self, body: usize, vector: Vector<'g>) -> Vector<'g> {
        self.m.bodies[body].rotate(vector)
    }

    fn angular_velocity(&self, body: usize) -> Vector<'g> {
        self.m.bodies[body].angular_velocity()
    }

    fn angle(&self, of: Rotating, order: TimeOrder) -> Scalar<'g> {
        match (of, order) {
            (Rotating::Body { body, ground }, TimeOrder::Position) => {
                self.m.bodies[body].position[ANGLE] - self.m.bodies[ground].position[ANGLE]
            }
            (Rotating::Body { body, .. }, _) => self.m.bodies[body].velocity[ANGLE],
            (Rotating::Joint(joint), _) => self.coordinate(OnJoint::angle(joint), order),
        }
    }

    fn coordinate(&self, on: OnJoint, order: TimeOrder) -> Scalar<'g> {
        self.m.joint_coordinate(on, order)
    }

    fn rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError> {
        self.m.joint_rate(on)
    }

    fn axis(&self, on: OnJoint) -> Result<Vector<'g>, BuildError> {
        self.m.axis_in_ground(on)
    }

    fn reaction(&self, joint: usize) -> [Vector<'g>; 2] {
        let reaction = &self.m.reactions[joint];
        [reaction.force, reaction.torque]
    }

    fn multiplier(&self, joint: usize) -> Option<Scalar<'g>> {
        self.m.multipliers[joint]
    }

    fn meshing(&self, joint: usize) -> Result<Option<Meshing<'g>>, BuildError> {
        self.m.meshing(joint)
    }

    fn only_where(&mut self, condition: Scalar<'g>) {
        self.applied.only_where(condition);
    }

    fn only_within(&mut self, within: Scalar<'g>, condition: Scalar<'g>) {
        self.applied.only_within(within, condition);
    }

    fn at(&mut self, point: &MaterialPoint<'g>, force: Vector<'g>) {
        self.applied.add_force(point, force);
        self.applied.note_thrust(None, point, force);
    }

    fn between(&mut self, from: &MaterialPoint<'g>, to: &MaterialPoint<'g>, force: Vector<'g>) {
        self.applied.add_force_pair(from, to, force);
        self.applied.note_thrust(Some(from), to, force);
    }

    fn torque(&mut self, from: usize, on: usize, torque: Vector<'g>) {
        self.applied.add_torque_pair(from, on, torque);
    }

    fn effort(&mut self, on: OnJoint, effort: Scalar<'g>) -> Result<(), BuildError> {
        self.applied.add_joint_effort(self.m, on, effort)
    }

    fn weight(&mut self, field: Vector<'g>) -> Result<(), BuildError> {
        let m = self.m;
        for (index, body) in m.bodies.iter().enumerate() {
            let weight = body.mass * field;
            let center = m.point_at(index, body.center);
            self.applied.add_weight(m, &center, weight);
            let potential = -weight.dot(center.position);
            self.applied.add_potential(m, &weight.components(), potential);
        }
        m.weigh_beams(self.applied, field)?;
        m.weigh_superelements(self.applied, field)?;
        self.applied.add_field(field);
        Ok(())
    }

    fn potential(&mut self, coefficients: &[Scalar<'g>], energy: Scalar<'g>) {
        self.applied.add_potential(self.m, coefficients, energy);
    }

    fn state(&self, index: usize) -> Scalar<'g> {
        self.m.v[self.m.states[&(self.effect, index)]]
    }

    fn state_rate(&mut self, index: usize, rate: Scalar<'g>) {
        self.applied.add_to_coordinate(self.m.states[&(self.effect, index)], rate);
    }

    fn hold(&mut self, index: usize, value: Scalar<'g>) {
        self.applied.sampled.push(((self.effect, index), value));
    }

    fn mode(&self, place: usize) -> [Scalar<'g>; 2] {
        let index = self.m.modes[&(self.effect, place)];
        [self.m.q[index], self.m.v[index]]
    }

    fn modal_force(&mut self, index: usize, force: Scalar<'g>) {
        self.applied.add_to_coordinate(self.m.modes[&(self.effect, index)], force);
    }

    fn begins_within(&mut self, room: Scalar<'g>) {
        self.applied.room = Some(room);
    }

    fn overlaps_to(&mut self, gap: Scalar<'g>, deepest: Scalar<'g>) {
        self.applied.overlap = Some((gap, deepest));
    }

    fn sensor(&mut self, measure: Sensor, value: Scalar<'g>) {
        self.applied.sensor(measure, value);
    }
}
