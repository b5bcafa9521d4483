//! Formulas as expressions over t, q, v, w, λ and the parameters: the meaning of each symbol.

use symdiff::{Formula, Scalar};

use super::inputs::{RandomInput, RandomSymbols};
use super::mechanism::{Mechanism, dof};
use super::system::OutputInfo;
use crate::grammar::{EnergyKind, OnJoint, PointRef, ReactionComponent, Sensor, Symbol, TimeOrder};
use crate::model::{Output, Rotation};
use crate::multibody::{BuildError, Context, OwnFunction, Quaternion, Vector, rotation};

impl<'g> Mechanism<'g, '_> {
    /// A formula as an expression: the one place where names become expressions.
    pub fn formula(&self, formula: &Formula, context: Context) -> Result<Scalar<'g>, BuildError> {
        formula.build(self.g, |name| self.names.known(name, context).map(|symbol| self.observe(symbol)))
    }

    /// A formula of an effect, which may use the quantities that the effect measures itself.
    pub fn own_formula(&self, formula: &Formula, own: &[(Sensor, Scalar<'g>)]) -> Result<Scalar<'g>, BuildError> {
        formula.build(self.g, |name| match self.names.symbol(name) {
            Some(Symbol::Sensor { effect, measure }) if !self.sensors.contains_key(&(effect, measure)) => {
                let found = own.iter().find(|(known, _)| *known == measure).map(|&(_, value)| value);
                found.ok_or_else(|| BuildError::Name { name: name.to_owned(), allowed: Context::Motion })
            }
            _ => self.names.known(name, Context::Motion).map(|symbol| self.observe(symbol)),
        })
    }

    /// A formula of parameters, t and a variable of its own, as a function of that.
    pub fn function_of(&self, formula: &Formula, variable: &str) -> Result<OwnFunction<'g>, BuildError> {
        // A name that no file can give to anything else.
        let own = self.g.variable(&format!("own:{variable}"));
        let value = formula.build(self.g, |name| match name {
            name if name == variable => Ok(own),
            _ => self.names.known(name, Context::Time).map(|symbol| self.observe(symbol)),
        })?;
        Ok(OwnFunction::new(own, value))
    }

    /// Three formulas as a vector.
    pub fn vector(&self, formulas: &[Formula; 3], context: Context) -> Result<Vector<'g>, BuildError> {
        let [x, y, z] = formulas;
        Ok([self.formula(x, context)?, self.formula(y, context)?, self.formula(z, context)?].into())
    }

    /// Three formulas as a vector of length 1.
    pub fn unit_vector(&self, formulas: &[Formula; 3], context: Context) -> Result<Vector<'g>, BuildError> {
        self.vector(formulas, context).map(Vector::unit)
    }

    /// A rotation of parameters as Euler parameters of length 1.
    pub fn rotation(&self, rotation: &Rotation) -> Result<Quaternion<'g>, BuildError> {
        match rotation {
            Rotation::RollPitchYaw(angles) => self.vector(angles, Context::Parameters).map(Quaternion::roll_pitch_yaw),
            Rotation::AxisAngle(axis, angle) => {
                let axis = self.unit_vector(axis, Context::Parameters)?;
                Ok(Quaternion::about(axis, self.formula(angle, Context::Parameters)?))
            }
            Rotation::Quaternion(formulas) => {
                let [p0, p1, p2, p3] = formulas.each_ref().map(|p| self.formula(p, Context::Parameters));
                Ok(Quaternion::from([p0?, p1?, p2?, p3?]).normalised())
            }
        }
    }

    /// The expression that a name stands for. Joints whose reactions are asked for must have been built.
    pub fn observe(&self, symbol: Symbol) -> Scalar<'g> {
        let g = self.g;
        match symbol {
            Symbol::Parameter(index) => self.parameters[index],
            Symbol::Time => self.time,
            // Outputs of answers are no part of the equations.
            Symbol::BlackBox { .. } => g.number(f64::NAN),
            Symbol::Trajectory { trajectory, order } => self.trajectory(trajectory, order),
            Symbol::Coordinate { body, coordinate, order } => self.bodies[body].motion(order)[dof(coordinate)],
            Symbol::AngularMotion { body, axis, order, in_body } => {
                let body = &self.bodies[body];
                let rate = match (order, in_body) {
                    (TimeOrder::Acceleration, true) => body.angular_acceleration_in_body(),
                    (TimeOrder::Acceleration, false) => body.angular_acceleration(),
                    (_, true) => body.angular_velocity_in_body(),
                    (_, false) => body.angular_velocity(),
                };
                rate[axis]
            }
            Symbol::RollPitchYaw { body, angle } => rotation::angles(&self.bodies[body].orientation().matrix())[angle],
            Symbol::JointCoordinate { joint, coordinate, order } => {
                self.joint_coordinate(OnJoint { joint, coordinate }, order)
            }
            Symbol::Point { body, point, coordinate, order } => {
                let body = &self.bodies[body];
                let arm = body.rotate(body.points[point]);
                let vector = match order {
                    TimeOrder::Position => body.position_of(arm),
                    TimeOrder::Velocity => body.velocity_of(arm),
                    TimeOrder::Acceleration => body.acceleration_of(arm),
                };
                vector[dof(coordinate)]
            }
            Symbol::Reaction { joint, component } => self.reaction(joint, component),
            Symbol::Sensor { effect, measure } => {
                let measured = self.sensors.get(&(effect, measure)).copied();
                measured.or_else(|| self.thrust(effect, measure)).unwrap_or_else(|| g.number(0.0))
            }
            Symbol::Energy(EnergyKind::Kinetic) => self.kinetic_energy(),
            Symbol::Energy(EnergyKind::Potential) => g.sum(self.potentials.iter().copied()),
            Symbol::Energy(EnergyKind::Total) => self.kinetic_energy() + g.sum(self.potentials.iter().copied()),
        }
    }

    /// A trajectory or its derivative, exactly: kinks are those of its timing. Its formulas are of parameters, of an
    /// excitation of t too, as the reader saw to.
    fn trajectory(&self, trajectory: usize, order: TimeOrder) -> Scalar<'g> {
        let number = |formula: &Formula| self.formula(formula, Context::Time);
        if let Some(random) = self.random.iter().find(|random| random.trajectory == trajectory) {
            return random.values[order as usize];
        }
        let own = self.names.trajectory(trajectory);
        self.is_excited.set(self.is_excited.get() || own.excitation().is_some());
        let input = self.inputs.iter().find(|input| input.trajectory == trajectory);
        let value = match (own.excitation(), input) {
            (Some(excitation), Some(input)) => excitation.of_function(input.value, number),
            _ => own.value(self.time, number),
        };
        let value = value.unwrap_or_else(|_| self.g.number(f64::NAN));
        (0..order as usize).fold(value, |value, _| value.derivative(self.time))
    }

    /// Random excitations about which the mechanism is linearised.
    pub fn random_inputs(&self) -> Result<Vec<RandomInput>, BuildError> {
        let number = |formula: &Formula| Ok(self.formula(formula, Context::Parameters)?.expr());
        let mut inputs = Vec::with_capacity(self.random.len());
        for RandomSymbols { trajectory, values } in &self.random {
            let Some(random) = self.names.trajectory(*trajectory).random() else { continue };
            inputs.push(RandomInput {
                symbols: values.map(Scalar::expr),
                seed: random.seed.names().map(|(name, _)| name).collect(),
                level: number(&random.level)?,
                speed: number(&random.speed)?,
                delay: number(&random.delay)?,
                spectrum: random.spectrum.clone(),
                band: random.band,
            });
        }
        Ok(inputs)
    }

    fn reaction(&self, joint: usize, component: ReactionComponent) -> Scalar<'g> {
        let reaction = &self.reactions[joint];
        match component {
            ReactionComponent::Force => reaction.magnitude,
            ReactionComponent::ForceAlong(axis) => reaction.force[axis],
            ReactionComponent::Torque if self.is_spatial => {
                reaction.about_axis.unwrap_or_else(|| reaction.torque.norm())
            }
            ReactionComponent::Torque => reaction.torque[2],
            ReactionComponent::TorqueAbout(axis) => reaction.torque[axis],
            ReactionComponent::Axial => reaction.along_line.unwrap_or_else(|| reaction.force.dot(self.axis_of(joint))),
            ReactionComponent::Radial => {
                let axis = self.axis_of(joint);
                if !self.is_spatial && axis[2].is_zero() {
                    return reaction.force.dot(axis.perpendicular());
                }
                (reaction.force - reaction.force.dot(axis) * axis).norm()
            }
            ReactionComponent::AxialTorque => reaction.torque.dot(self.axis_of(joint)),
            ReactionComponent::ForceInBody(axis) => self.in_second_frame(joint, reaction.force)[axis],
            ReactionComponent::TorqueInBody(axis) => self.in_second_frame(joint, reaction.torque)[axis],
            ReactionComponent::TorqueAt(place, axis) => {
                let about = self.point(place).position;
                let arm = self.second_point(joint).map_or(about, |point| self.point(point).position) - about;
                (reaction.torque + arm.cross(reaction.force))[axis]
            }
        }
    }

    /// The point at which a joint's reaction acts on its second body.
    fn second_point(&self, joint: usize) -> Option<PointRef> {
        self.joints[joint].kind.between().map(|[_, second]| second)
    }

    /// A vector of the ground's axes in those of the frame at a joint's second point.
    fn in_second_frame(&self, joint: usize, vector: Vector<'g>) -> Vector<'g> {
        let Some(second) = self.second_point(joint) else { return vector };
        let in_body = self.bodies[second.body].matrix().transposed() * vector;
        self.local_frame(second).matrix().transposed() * in_body
    }

    /// The unit vector of a joint's own axis in the ground's axes, of a coupling, the axis of the driven body; zero
    /// without an axis.
    fn axis_of(&self, joint: usize) -> Vector<'g> {
        let kind = &self.joints[joint].kind;
        // An axis is a formula of parameters and t, as its joint's rows needed it.
        let axis = match (kind.between(), kind.reaction_axis()) {
            (Some(between), Some(axis)) => {
                self.unit_vector(axis, Context::Time).map(|axis| self.pair(between).outward(axis)).ok()
            }
            (Some(_), None) => None,
            (None, _) => {
                let driven = kind.coordinates(joint);
                let has_axis = |on: &&OnJoint| self.joints[on.joint].kind.axis_of(on.coordinate).is_some();
                driven.iter().rfind(has_axis).and_then(|&on| self.axis_in_ground(on).ok())
            }
        };
        axis.unwrap_or_else(|| Vector::zero(self.g))
    }

    /// All outputs that are asked for.
    pub fn outputs(&self) -> Result<Vec<OutputInfo>, BuildError> {
        let outputs = self.questions.outputs.iter();
        outputs
            .map(|output| {
                let Output { name, formula, unit, dimension, of_results } = output.clone();
                let of_results = of_results || self.questions.description.black_box.is_some();
                let expr = match of_results {
                    true => self.g.number(0.0),
                    false => self.formula(&formula, Context::Everything)?,
                };
                Ok(OutputInfo { name, unit, dimension, expr: expr.expr(), of_results: of_results.then_some(formula) })
            })
            .collect()
    }

    /// T of all bodies, J.
    pub fn kinetic_energy(&self) -> Scalar<'g> {
        let bodies = self.bodies.iter().map(|body| body.kinetic_energy());
        self.g.sum(bodies.chain([self.kinetic_energy_of_flexible]))
    }
}
