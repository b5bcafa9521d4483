//! Start values of quantities that are not coordinates of the equations: of points, of parts of angular velocities, and
//! in joint coordinates of bodies whose position follows from their joint's.
//!
//! They are conditions that hold at the start alone, in addition to the constraints.

use symdiff::Scalar;

use super::mechanism::{Mechanism, dof};
use super::start::Named;
use super::system::{ConditionOf, ConstraintInfo, ResidualUnit, StartCondition};
use crate::grammar::Symbol;
use crate::grammar::motions::{ATTITUDE, AXES, motion_name};
use crate::model::{Coordinate, Description, StartValue, TimeOrder};
use crate::multibody::{BuildError, Context, rotation};

impl<'g> Mechanism<'g, '_> {
    /// Conditions for the values in `initial` that are not coordinates of the equations.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn start_conditions(&self, description: &Description) -> Result<Vec<StartCondition>, BuildError> {
        let mut conditions = Vec::new();
        for value in &description.initial {
            match value {
                StartValue::Coordinate { body, coordinate, order, value }
                    if self.lacks(description, *body, *coordinate, *order) =>
                {
                    let symbol = Symbol::Coordinate { body: *body, coordinate: *coordinate, order: *order };
                    let name = format!("{}.{}", description.bodies[*body].name, motion_name(*coordinate, *order));
                    let residual = self.observe(symbol) - self.formula(value, Context::Parameters)?;
                    conditions.push(self.condition(name, unit(*coordinate), *order, residual));
                }
                StartValue::Point { place, coordinate, order, value } => {
                    let Some(point) = place.point else { continue };
                    let symbol = Symbol::Point { body: place.body, point, coordinate: *coordinate, order: *order };
                    let body = &description.bodies[place.body];
                    let motion = motion_name(*coordinate, *order);
                    let name = format!("{}.{}.{motion}", body.name, body.points[point].name);
                    let residual = self.observe(symbol) - self.formula(value, Context::Parameters)?;
                    conditions.push(self.condition(name, unit(*coordinate), *order, residual));
                }
                StartValue::AngularRate { body, axis, in_body, value } => {
                    let value = self.formula(value, Context::Parameters)?;
                    conditions.push(self.rate_condition(description, *body, *axis, *in_body, value));
                }
                StartValue::RollPitchYaw { body, angle, value } => {
                    let name = format!("{}.{}", description.bodies[*body].name, ATTITUDE[*angle]);
                    let left = self.turn_left(*body, *angle, self.formula(value, Context::Parameters)?);
                    conditions.push(self.condition(name, ResidualUnit::Angle, TimeOrder::Position, left));
                }
                StartValue::AngularVelocity { body, value, in_body } if self.is_child(*body) => {
                    let value = self.vector(value, Context::Parameters)?;
                    conditions.extend(
                        (0..3).map(|axis| self.rate_condition(description, *body, axis, *in_body, value[axis])),
                    );
                }
                StartValue::Orientation { body, rotation } if self.is_child(*body) => {
                    // Twice the vector part of the remaining rotation: its angle about each axis, for a small one.
                    let left = (self.rotation(rotation)?.conjugate() * self.bodies[*body].orientation()).vector_part();
                    conditions.extend((0..3).map(|axis| {
                        let name = format!("{}.orientation.{}", description.bodies[*body].name, AXES[axis]);
                        self.condition(name, ResidualUnit::Angle, TimeOrder::Position, 2.0 * left[axis])
                    }));
                }
                _ => {}
            }
        }
        Ok(conditions)
    }

    /// Difference of a body's roll, pitch or yaw from a value, between −π and π.
    fn turn_left(&self, body: usize, angle: usize, value: Scalar<'g>) -> Scalar<'g> {
        let (sin, cos) = rotation::directions(&self.bodies[body].orientation().matrix())[angle];
        let (across, along) = (value.sin(), value.cos());
        (sin * along - cos * across).atan2(cos * along + sin * across)
    }

    /// Whether a coordinate of a body that `initial` names is no coordinate of the equations, nor stands for one.
    fn lacks(&self, description: &Description, body: usize, coordinate: Coordinate, order: TimeOrder) -> bool {
        self.is_child(body)
            && self.bodies[body].index[dof(coordinate)].is_none()
            && self.angle_of_inboard_joint(description, Named::Kept, body, coordinate, order).is_none()
    }

    /// Whether a body's position follows from that of another.
    pub(super) fn is_child(&self, body: usize) -> bool {
        self.bodies[body].relative_motion.is_some()
    }

    /// A condition on a part of a body's angular velocity.
    fn rate_condition(
        &self,
        description: &Description,
        body: usize,
        axis: usize,
        in_body: bool,
        value: Scalar<'g>,
    ) -> StartCondition {
        let rate = self.observe(Symbol::AngularMotion { body, axis, order: TimeOrder::Velocity, in_body });
        let of = if in_body { "omega_body" } else { "omega" };
        let name = format!("{}.{of}.{}", description.bodies[body].name, AXES[axis]);
        self.condition(name, ResidualUnit::Angle, TimeOrder::Velocity, rate - value)
    }

    /// A condition from a residual of positions, or of velocities.
    fn condition(&self, name: String, unit: ResidualUnit, order: TimeOrder, residual: Scalar<'g>) -> StartCondition {
        let position = order == TimeOrder::Position;
        StartCondition {
            info: ConstraintInfo { joint: name.clone(), name, unit },
            of: ConditionOf::Initial,
            value: if position { residual.expr() } else { self.g.number(0.0).expr() },
            rate: (!position).then(|| residual.expr()),
            position,
            velocity: !position,
        }
    }
}

fn unit(coordinate: Coordinate) -> ResidualUnit {
    if coordinate.is_length() { ResidualUnit::Length } else { ResidualUnit::Angle }
}
