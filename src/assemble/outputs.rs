//! What is observed: a symbol as an expression over t, q, v, w, λ and the parameters.

use symdiff::{Builder, Expr};

use crate::model::{EnergyKind, ReactionComponent, Symbol, TimeOrder};

use super::error::BuildError;
use super::joints::{across, along};
use super::mechanism::{Context, Mechanism, dof};
use super::rotation;
use super::space;
use super::system::OutputInfo;

impl Mechanism<'_> {
    /// The expression that a name stands for. Joints whose reactions are asked for must have been built.
    pub fn observe(&self, g: &Builder, symbol: Symbol) -> Expr {
        match symbol {
            Symbol::Parameter(index) => self.parameters[index],
            Symbol::Time => self.time,
            Symbol::Coordinate { body, coordinate, order } => {
                let body = &self.bodies[body];
                let list = match order {
                    TimeOrder::Position => &body.position,
                    TimeOrder::Velocity => &body.velocity,
                    TimeOrder::Acceleration => &body.acceleration,
                };
                list[dof(coordinate)]
            }
            Symbol::AngularMotion { body, axis, order, in_body } => {
                let body = &self.bodies[body];
                let turning = match (order, in_body) {
                    (TimeOrder::Acceleration, true) => body.angular_acceleration_in_body(g),
                    (TimeOrder::Acceleration, false) => body.angular_acceleration(g),
                    (_, true) => body.angular_velocity_in_body(g),
                    (_, false) => body.angular_velocity(g),
                };
                turning[axis]
            }
            Symbol::RollPitchYaw { body, angle } => {
                let orientation = self.bodies[body].orientation(g);
                let matrix = rotation::matrix(g, orientation);
                rotation::angles(g, &matrix)[angle]
            }
            Symbol::JointCoordinate { joint, coordinate, order } => self.joint_coordinate(g, joint, coordinate, order),
            Symbol::Point { body, point, coordinate, order } => {
                let body = &self.bodies[body];
                let arm = body.rotate(g, body.points[point]);
                let vector = match order {
                    TimeOrder::Position => body.position_of(g, arm),
                    TimeOrder::Velocity => body.velocity_of(g, arm),
                    TimeOrder::Acceleration => body.acceleration_of(g, arm),
                };
                vector[dof(coordinate)]
            }
            Symbol::Reaction { joint, component } => {
                let reaction = &self.reactions[joint];
                match component {
                    ReactionComponent::Force => reaction.magnitude,
                    ReactionComponent::ForceAlong(axis) => reaction.force[axis],
                    ReactionComponent::Torque if self.is_spatial() => {
                        reaction.about_axis.unwrap_or_else(|| space::norm(g, reaction.torque))
                    }
                    ReactionComponent::Torque => reaction.torque[2],
                    ReactionComponent::TorqueAbout(axis) => reaction.torque[axis],
                    ReactionComponent::Axial => along(g, reaction.force, self.axis_of_joint(g, joint)),
                    ReactionComponent::Radial => {
                        across(g, reaction.force, self.axis_of_joint(g, joint), self.is_spatial())
                    }
                    ReactionComponent::AxialTorque => along(g, reaction.torque, self.axis_of_joint(g, joint)),
                }
            }
            Symbol::Sensor { effect, measure } => match self.measures.get(&(effect, measure)) {
                Some(&measured) => measured,
                None => g.constant(0.0),
            },
            Symbol::Energy(EnergyKind::Kinetic) => self.kinetic_energy(g),
            Symbol::Energy(EnergyKind::Potential) => g.sum(self.potentials.iter().copied()),
            Symbol::Energy(EnergyKind::Total) => {
                let kinetic = self.kinetic_energy(g);
                let potential = g.sum(self.potentials.iter().copied());
                g.add(kinetic, potential)
            }
        }
    }

    fn kinetic_energy(&self, g: &Builder) -> Expr {
        let bodies: Vec<Expr> = self.bodies.iter().map(|body| body.kinetic_energy(g)).collect();
        g.sum(bodies.into_iter().chain([self.bending]))
    }

    /// All outputs of the description.
    pub fn outputs(&self, g: &Builder) -> Result<Vec<OutputInfo>, BuildError> {
        let outputs = self.description.outputs.iter();
        outputs
            .map(|output| {
                let expr = self.formula(g, &output.formula, Context::Everything)?;
                Ok(OutputInfo { name: output.name.clone(), unit: output.unit.clone(), expr })
            })
            .collect()
    }
}
