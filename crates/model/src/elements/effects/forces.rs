//! The mechanism in motion, as effects see it, and the forces that they add to it.

use symdiff::{Builder, Formula, Scalar};

use crate::elements::meshing::{Member, Meshing};
use crate::grammar::{OfPlace, OnJoint, PointRef, Rotating, Sensor, TimeOrder};
use crate::multibody::{BuildError, MaterialPoint, OwnFunction, Pair, Vector};

/// The motion of a mechanism as formulas of an effect may depend on it, and the sum of the forces on it.
///
/// # Errors
/// Methods that evaluate formulas fail where a name cannot stand in one; the reader of model files lets none through.
pub trait Forces<'g> {
    /// The graph that expressions are added to.
    fn graph(&self) -> &'g Builder;
    /// Whether the mechanism leaves the plane.
    fn is_spatial(&self) -> bool;
    /// t, s.
    fn time(&self) -> Scalar<'g>;
    /// A formula of parameters, t, positions, velocities and reactions.
    fn value(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError>;
    /// Same as [`value`](Self::value) for a formula that may refer to the effect's own sensors.
    fn value_with(&self, formula: &Formula, own: &[(Sensor, Scalar<'g>)]) -> Result<Scalar<'g>, BuildError>;
    /// A formula of parameters and t.
    fn prescribed(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError>;
    /// Three formulas of parameters, t, positions, velocities and reactions.
    fn vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError>;
    /// Three formulas of parameters and t.
    fn prescribed_vector(&self, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError>;

    /// A height, formula of parameters, t and the position along the ground, as a function of that position.
    fn of_place(&self, formula: &OfPlace) -> Result<OwnFunction<'g>, BuildError>;

    /// A named point.
    fn point(&self, point: PointRef) -> MaterialPoint<'g>;
    /// The point of a body that is now at a position in the ground's frame.
    fn point_at(&self, body: usize, position: Vector<'g>) -> MaterialPoint<'g>;
    /// The frames at two points.
    fn pair(&self, between: [PointRef; 2]) -> Pair<'g>;
    /// A vector of a body's frame, in the ground's axes.
    fn rotated(&self, body: usize, vector: Vector<'g>) -> Vector<'g>;
    /// ω of a body in the ground's axes, rad/s.
    fn angular_velocity(&self, body: usize) -> Vector<'g>;
    /// The angle of a body about z or of a joint, rad, or its rate, rad/s.
    fn angle(&self, of: Rotating, order: TimeOrder) -> Scalar<'g>;
    /// A coordinate of a joint, rad or m, or its rate.
    fn coordinate(&self, on: OnJoint, order: TimeOrder) -> Scalar<'g>;
    /// The rate of a joint's coordinate, rad/s or m/s, by the velocities of its bodies.
    fn rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError>;
    /// The unit vector about or along which a joint's coordinate is counted, in the ground's axes.
    fn axis(&self, on: OnJoint) -> Result<Vector<'g>, BuildError>;
    /// A joint's reaction on its second body, in the ground's axes: force, N, and torque about the second point, N m.
    fn reaction(&self, joint: usize) -> [Vector<'g>; 2];

    /// The multiplier of a joint's one constraint; `None` if it has none, or if nothing that it constrains can move.
    fn multiplier(&self, joint: usize) -> Option<Scalar<'g>>;
    /// How the teeth of a joint rub.
    fn meshing(&self, joint: usize) -> Result<Option<Meshing<'g>>, BuildError>;

    /// From now on the effect acts only where the condition is positive, whatever its expressions are elsewhere. They
    /// are not computed where no sample of a tile needs them, so they have to vanish continuously as the condition
    /// does.
    fn only_where(&mut self, condition: Scalar<'g>);
    /// The same, for a condition that is costly: it is not computed either where `within` is not positive.
    fn only_within(&mut self, within: Scalar<'g>, condition: Scalar<'g>);
    /// A force at a point, N.
    fn at(&mut self, point: &MaterialPoint<'g>, force: Vector<'g>);
    /// A force at one point and its opposite at another, N.
    fn between(&mut self, from: &MaterialPoint<'g>, to: &MaterialPoint<'g>, force: Vector<'g>);
    /// A torque on a body and its opposite on another, N m.
    fn torque(&mut self, from: usize, on: usize, torque: Vector<'g>);
    /// A force or torque that pushes a joint's coordinate up, N or N m.
    fn effort(&mut self, on: OnJoint, effort: Scalar<'g>) -> Result<(), BuildError>;
    /// The weight of every body in a uniform field of acceleration, m/s², with its potential energy.
    fn weight(&mut self, field: Vector<'g>) -> Result<(), BuildError>;
    /// A potential energy, J, if it is one: where a coefficient depends on the motion, its gradient is not the force.
    fn potential(&mut self, coefficients: &[Scalar<'g>], energy: Scalar<'g>);
    /// State of the effect, by its index among them.
    fn state(&self, index: usize) -> Scalar<'g>;
    /// How fast a state of the effect changes, by its index among them.
    fn state_rate(&mut self, index: usize, rate: Scalar<'g>);
    /// Sets the value that sampled state `index` takes at its next sampling instant, from values just before it.
    fn hold(&mut self, index: usize, value: Scalar<'g>);
    /// A modal coordinate of the effect and its rate, by its index among them.
    fn mode(&self, index: usize) -> [Scalar<'g>; 2];
    /// A force on a modal coordinate of the effect, by its index among them.
    fn modal_force(&mut self, index: usize, force: Scalar<'g>);
    /// How much room there is where the effect begins: a start without any is refused, m.
    fn begins_within(&mut self, room: Scalar<'g>);
    /// The gap of two surfaces, m, and how deep they may overlap: where the gap is less than −`deepest`, they have no
    /// nearest side.
    fn overlaps_to(&mut self, gap: Scalar<'g>, deepest: Scalar<'g>);
    /// Something that the effect measures, for outputs.
    fn sensor(&mut self, measure: Sensor, value: Scalar<'g>);
}

impl<'g> dyn Forces<'g> + '_ {
    /// A coordinate of a joint and its rate.
    pub fn coordinate_and_rate(&self, on: OnJoint) -> [Scalar<'g>; 2] {
        [TimeOrder::Position, TimeOrder::Velocity].map(|order| self.coordinate(on, order))
    }

    /// A torque about z: on a body from the ground, or on a joint's second body from its first, N m.
    pub fn torque_about(&mut self, on: Rotating, torque: Scalar<'g>) -> Result<(), BuildError> {
        match on {
            Rotating::Body { body, .. } => {
                let zero = self.graph().number(0.0);
                self.torque(0, body, [zero, zero, torque].into());
                Ok(())
            }
            Rotating::Joint(joint) => self.effort(OnJoint::angle(joint), torque),
        }
    }

    /// The rate of a toothed member, rad/s or m/s.
    pub fn member_rate(&self, member: Member) -> Result<Scalar<'g>, BuildError> {
        match member {
            Member::Body(body) => Ok(self.angle(Rotating::of_body(body), TimeOrder::Velocity)),
            Member::Joint(on) => self.rate(on),
        }
    }

    /// A torque or force on a toothed member, N m or N.
    pub fn member_effort(&mut self, member: Member, effort: Scalar<'g>) -> Result<(), BuildError> {
        match member {
            Member::Body(body) => self.torque_about(Rotating::of_body(body), effort),
            Member::Joint(on) => self.effort(on, effort),
        }
    }

    /// Several things that the effect measures.
    pub fn sensors<const N: usize>(&mut self, measured: [(Sensor, Scalar<'g>); N]) {
        for (measure, value) in measured {
            self.sensor(measure, value);
        }
    }
}
