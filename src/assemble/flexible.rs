//! Beams with mass: the inertia and weight of an element between two frames, and how it starts.
//!
//! What lies between the ends follows them by Hermite's cubics, L t being the derivative at an end whose axis is t:
//!
//! ```text
//! r(s) = N₁ r_A + N₂ L t_A + N₃ r_B + N₄ L t_B           t = (cos θ, sin θ),  n = t⊥
//! T = ½ Σ m_kl ė_k · ė_l,   e = (r_A, L t_A, r_B, L t_B)          J
//!
//!             ⎡ 156   22   54  −13 ⎤
//! m = μL/420  ⎢  22    4   13   −3 ⎥   μ the mass per length, kg/m
//!             ⎢  54   13  156  −22 ⎥
//!             ⎣ −13   −3  −22    4 ⎦
//! ```
//!
//! So d'Alembert's forces on the ends are −Σ m_kl ë_l, with L ẗ = L (θ̈ n − θ̇² t), and their moments L n · (…); M is their slope
//! by the accelerations. For small bending it is the consistent mass matrix of Euler and Bernoulli's beam (Przemieniecki, *Theory of
//! Matrix Structural Analysis* (1968), ch. 11); sections have no inertia of rotation. Gravity acts on r(s):
//!
//! ```text
//! ∫ r ds = L/2 (r_A + r_B) + L²/12 (t_A − t_B)
//! ```

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::system::{ConditionOf, ConstraintInfo, ResidualUnit, StartCondition};
use crate::model::{Coordinate, Description, LineMass, StartValue, TimeOrder};
use crate::multibody::{ANGLE, BuildError, Context, MaterialPoint, Vector};

/// m over μL/420.
const MASS: [[f64; 4]; 4] =
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]];

/// An element of a beam with mass, over the symbols.
struct Element<'g> {
    ends: [MaterialPoint<'g>; 2],
    /// t of both ends.
    axes: [Vector<'g>; 2],
    /// L
    length: Scalar<'g>,
    /// μ
    mass: Scalar<'g>,
}

impl<'g> Mechanism<'g, '_> {
    /// The name of a beam with mass, if there is one.
    pub fn flexible(&self) -> Option<&str> {
        self.line_masses.first().map(|beam| beam.body)
    }

    /// Lengths of all elements with mass together.
    pub fn length_of_beams(&self) -> Result<Scalar<'g>, BuildError> {
        let lengths: Result<Vec<_>, BuildError> =
            self.line_masses.iter().map(|beam| self.formula(beam.length, Context::Parameters)).collect();
        Ok(self.g.sum(lengths?))
    }

    fn elements(&self) -> Result<Vec<Element<'g>>, BuildError> {
        self.line_masses.iter().map(|beam| self.element(beam)).collect()
    }

    fn element(&self, beam: &LineMass) -> Result<Element<'g>, BuildError> {
        let ends = beam.between.map(|point| self.point(point));
        let axis = self.unit_vector(beam.axis, Context::Parameters)?;
        let axes = beam.between.map(|point| self.bodies[point.body].rotate(axis));
        let length = self.formula(beam.length, Context::Parameters)?;
        let mass = self.formula(beam.mass_per_length, Context::Parameters)?;
        Ok(Element { ends, axes, length, mass })
    }

    /// Generalised inertial forces of all beams, n: their part of M w, with what depends on velocities.
    pub fn inertia_of_beams(&self) -> Result<Vec<Scalar<'g>>, BuildError> {
        let mut applied = AppliedForces::new(self.g, self.bodies.len());
        for element in self.elements()? {
            let accelerations = element.end_values(|end| {
                let (point, axis) = (&element.ends[end], element.axes[end]);
                let body = &self.bodies[point.body];
                let position = body.acceleration_of(point.arm);
                let (rate, gain) = (body.angular_velocity()[2], body.angular_acceleration()[2]);
                let (across, square) = (axis.perpendicular(), rate * rate);
                let (along, beside) = (square * axis, gain * across);
                [position, beside - along]
            });
            let [first, turning_first, second, turning_second] = element.momenta(&accelerations);
            for (end, force, turning) in [(0, first, turning_first), (1, second, turning_second)] {
                element.push_by(&mut applied, end, force, element.length * turning);
            }
        }
        Ok(applied.generalised(self))
    }

    /// T of all beams, J.
    pub fn total_kinetic_energy_of_beams(&self) -> Result<Scalar<'g>, BuildError> {
        let mut parts = Vec::new();
        for element in self.elements()? {
            let velocities = element.end_values(|end| {
                let point = &element.ends[end];
                let rate = self.bodies[point.body].angular_velocity()[2];
                [point.velocity, rate * element.axes[end].perpendicular()]
            });
            let momenta = element.momenta(&velocities);
            parts.extend(velocities.into_iter().zip(momenta).map(|(velocity, momentum)| 0.5 * velocity.dot(momentum)));
        }
        Ok(self.g.sum(parts))
    }

    /// Adds the weights of all beams in a uniform field, with their potential energy.
    pub fn weigh_beams(&self, applied: &mut AppliedForces<'g>, field: Vector<'g>) -> Result<(), BuildError> {
        for element in self.elements()? {
            let square = element.length * element.length;
            let (whole, bent) = (element.mass * element.length, element.mass * square);
            let (half, twelfth) = (0.5 * whole, 1.0 / 12.0 * bent);
            let weight = half * field;
            let mut potential = self.g.number(0.0);
            for (end, side) in [(0, 1.0), (1, -1.0)] {
                let turning = side * twelfth * field;
                let lever = turning.dot(element.axes[end]);
                element.push_by(applied, end, weight, turning);
                potential -= weight.dot(element.ends[end].position) + lever;
            }
            applied.add_potential(self, &field.components(), potential);
        }
        Ok(())
    }

    /// A beam starts straight and moves as a rigid body, but between nodes whose coordinates (velocities) are all given.
    pub fn start_of_beams(&self, description: &Description) -> Result<Vec<StartCondition>, BuildError> {
        let mut conditions = Vec::new();
        for beam in &self.line_masses {
            let [first, second] = beam.between.map(|point| point.body);
            let is_free = |order| [first, second].iter().any(|&body| !is_given_at_start(description, body, order));
            let (position, velocity) = (is_free(TimeOrder::Position), is_free(TimeOrder::Velocity));
            let element = self.element(beam)?;
            let line = element.ends[1].position - element.ends[0].position;
            let across = element.axes[0].perpendicular();
            let along = line.dot(element.axes[0]);
            let angles = [first, second].map(|body| self.bodies[body].position[ANGLE]);
            let rows = [
                ("x", ResidualUnit::Length, along - element.length),
                ("y", ResidualUnit::Length, line.dot(across)),
                ("angle", ResidualUnit::Angle, angles[1] - angles[0]),
            ];
            let joint = beam.body.to_owned();
            let node = &description.bodies[second].name;
            conditions.extend(rows.map(|(name, unit, value)| StartCondition {
                info: ConstraintInfo { name: format!("{node}.{name}"), joint: joint.clone(), unit },
                of: ConditionOf::Beam,
                value: value.expr(),
                rate: None,
                position,
                velocity,
            }));
        }
        Ok(conditions)
    }
}

/// Whether `initial` names all coordinates of a body, or all their velocities.
fn is_given_at_start(description: &Description, body: usize, wanted: TimeOrder) -> bool {
    let named = |coordinate: &Coordinate| {
        description.initial.iter().any(|value| {
            matches!(value, StartValue::Coordinate { body: of, coordinate: c, order, .. }
                if (*of, c, *order) == (body, coordinate, wanted))
        })
    };
    description.bodies[body].coordinates.iter().all(named)
}

impl<'g> Element<'g> {
    /// Something of e: (r_A, L t_A, r_B, L t_B), from what it is of r and t at each end.
    fn end_values(&self, of: impl Fn(usize) -> [Vector<'g>; 2]) -> [Vector<'g>; 4] {
        let ([first, turning_first], [second, turning_second]) = (of(0), of(1));
        [first, self.length * turning_first, second, self.length * turning_second]
    }

    /// Σ m_kl x_l
    fn momenta(&self, values: &[Vector<'g>; 4]) -> [Vector<'g>; 4] {
        let unit = 1.0 / 420.0 * (self.mass * self.length);
        MASS.map(|row| {
            let component = |axis: usize| {
                unit * self.length.builder().sum(row.iter().zip(values).map(|(&m, value)| m * value[axis]))
            };
            std::array::from_fn(component).into()
        })
    }

    /// What does F · δr + G · δt for every motion of an end.
    fn push_by(&self, applied: &mut AppliedForces<'g>, end: usize, force: Vector<'g>, turning: Vector<'g>) {
        let across = self.axes[end].perpendicular();
        let (zero, moment) = (self.length.builder().number(0.0), across.dot(turning));
        applied.add_force(&self.ends[end], force);
        applied.add_torque_pair(0, self.ends[end].body, [zero, zero, moment].into());
    }
}
