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

use symdiff::{Builder, Expr};

use crate::model::{Coordinate, LineMass, StartValue, TimeOrder};

use super::applied_forces::AppliedForces;
use super::body::MaterialPoint;
use super::error::BuildError;
use super::mechanism::{Context, Mechanism};
use super::space::{self, Vector};
use super::system::{ConstraintInfo, ResidualUnit, StartCondition};

/// m over μL/420.
const MASS: [[f64; 4]; 4] =
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]];

/// An element of a beam with mass, over the symbols.
struct Element {
    ends: [MaterialPoint; 2],
    /// t of both ends.
    axes: [Vector; 2],
    /// L
    length: Expr,
    /// μ
    mass: Expr,
}

/// The elements that have mass.
fn beams<'d>(m: &Mechanism<'d>) -> impl Iterator<Item = LineMass<'d>> {
    m.description.effects.iter().filter_map(|effect| effect.kind.inertia())
}

impl Mechanism<'_> {
    /// The name of a beam with mass, if there is one.
    pub fn flexible(&self) -> Option<String> {
        beams(self).next().map(|beam| beam.body.to_owned())
    }

    /// Lengths of all elements with mass together.
    pub fn length_of_beams(&self, g: &Builder) -> Result<Expr, BuildError> {
        let lengths: Result<Vec<Expr>, BuildError> =
            beams(self).map(|beam| self.formula(g, beam.length, Context::Parameters)).collect();
        Ok(g.sum(lengths?))
    }

    fn elements(&self, g: &Builder) -> Result<Vec<Element>, BuildError> {
        beams(self).map(|beam| self.element(g, &beam)).collect()
    }

    fn element(&self, g: &Builder, beam: &LineMass) -> Result<Element, BuildError> {
        let ends = beam.between.map(|point| self.point(g, point));
        let axis = self.vector(g, beam.axis, Context::Parameters)?;
        let axis = space::unit(g, axis);
        let axes = beam.between.map(|point| self.bodies[point.body].rotate(g, axis));
        let length = self.formula(g, beam.length, Context::Parameters)?;
        let mass = self.formula(g, beam.mass_per_length, Context::Parameters)?;
        Ok(Element { ends, axes, length, mass })
    }

    /// Generalised inertial forces of all beams, n: their part of M w, with what depends on velocities.
    pub fn inertia_of_beams(&self, g: &Builder) -> Result<Vec<Expr>, BuildError> {
        let mut applied = AppliedForces::new(g, self.bodies.len());
        for element in self.elements(g)? {
            let accelerations = element.end_values(g, |g, element, end| {
                let (point, axis) = (&element.ends[end], element.axes[end]);
                let body = &self.bodies[point.body];
                let position = body.acceleration_of(g, point.arm);
                let (spin, gain) = (body.angular_velocity(g)[2], body.angular_acceleration(g)[2]);
                let (across, square) = (space::perpendicular(g, axis), g.mul(spin, spin));
                let (along, beside) = (space::scale(g, square, axis), space::scale(g, gain, across));
                [position, space::sub(g, beside, along)]
            });
            let momenta = element.momenta(g, &accelerations);
            for end in 0..2 {
                element.push(g, &mut applied, end, momenta[2 * end], momenta[2 * end + 1]);
            }
        }
        Ok(applied.generalised(g, self))
    }

    /// T of all beams, J.
    pub fn kinetic_energy_of_beams(&self, g: &Builder) -> Result<Expr, BuildError> {
        let mut parts = Vec::new();
        for element in self.elements(g)? {
            let velocities = element.end_values(g, |g, element, end| {
                let (point, axis) = (&element.ends[end], element.axes[end]);
                let spin = self.bodies[point.body].angular_velocity(g)[2];
                let across = space::perpendicular(g, axis);
                [point.velocity, space::scale(g, spin, across)]
            });
            let momenta = element.momenta(g, &velocities);
            for (velocity, momentum) in velocities.into_iter().zip(momenta) {
                let part = space::dot(g, velocity, momentum);
                parts.push(g.scale(0.5, part));
            }
        }
        Ok(g.sum(parts))
    }

    /// Adds the weights of all beams in a uniform field, with their potential energy.
    pub fn weigh_beams(&self, g: &Builder, applied: &mut AppliedForces, field: Vector) -> Result<(), BuildError> {
        for element in self.elements(g)? {
            let square = g.mul(element.length, element.length);
            let (whole, bent) = (g.mul(element.mass, element.length), g.mul(element.mass, square));
            let (half, twelfth) = (g.scale(0.5, whole), g.scale(1.0 / 12.0, bent));
            let weight = space::scale(g, half, field);
            let mut potential = g.constant(0.0);
            for (end, side) in [(0, 1.0), (1, -1.0)] {
                let lever = g.scale(side, twelfth);
                let turning = space::scale(g, lever, field);
                let lever = space::dot(g, turning, element.axes[end]);
                element.push_by(g, applied, end, weight, turning);
                let height = space::dot(g, weight, element.ends[end].position);
                let sum = g.add(height, lever);
                potential = g.sub(potential, sum);
            }
            applied.add_potential(g, self, &field, potential);
        }
        Ok(())
    }

    /// A beam starts straight and moves as a rigid body, but between nodes whose coordinates (velocities) are all given.
    pub fn start_of_beams(&self, g: &Builder) -> Result<Vec<StartCondition>, BuildError> {
        let mut conditions = Vec::new();
        for beam in beams(self) {
            let [first, second] = beam.between.map(|point| point.body);
            let free = |order| !(self.is_given_at_start(first, order) && self.is_given_at_start(second, order));
            let (position, velocity) = (free(TimeOrder::Position), free(TimeOrder::Velocity));
            let element = self.element(g, &beam)?;
            let line = space::sub(g, element.ends[1].position, element.ends[0].position);
            let across = space::perpendicular(g, element.axes[0]);
            let along = space::dot(g, line, element.axes[0]);
            let angles = [first, second].map(|body| self.bodies[body].position[super::body::ANGLE]);
            let rows = [
                ("x", ResidualUnit::Length, g.sub(along, element.length)),
                ("y", ResidualUnit::Length, space::dot(g, line, across)),
                ("angle", ResidualUnit::Angle, g.sub(angles[1], angles[0])),
            ];
            let joint = beam.body.to_owned();
            let node = &self.description.bodies[second].name;
            conditions.extend(rows.map(|(name, unit, value)| StartCondition {
                info: ConstraintInfo { name: format!("{node}.{name}"), joint: joint.clone(), unit },
                value,
                position,
                velocity,
            }));
        }
        Ok(conditions)
    }

    /// Whether `initial` names all coordinates of a body, or all their velocities.
    fn is_given_at_start(&self, body: usize, wanted: TimeOrder) -> bool {
        let named = |coordinate: &Coordinate| {
            self.description.initial.iter().any(|value| {
                matches!(value, StartValue::Coordinate { body: of, coordinate: c, order, .. }
                    if (*of, c, *order) == (body, coordinate, wanted))
            })
        };
        self.description.bodies[body].coordinates.iter().all(named)
    }
}

impl Element {
    /// Something of e: (r_A, L t_A, r_B, L t_B), from what it is of r and t.
    fn end_values(&self, g: &Builder, of: impl Fn(&Builder, &Self, usize) -> [Vector; 2]) -> [Vector; 4] {
        let ([first, turning], [second, turned]) = (of(g, self, 0), of(g, self, 1));
        [first, space::scale(g, self.length, turning), second, space::scale(g, self.length, turned)]
    }

    /// Σ m_kl x_l
    fn momenta(&self, g: &Builder, values: &[Vector; 4]) -> [Vector; 4] {
        let whole = g.mul(self.mass, self.length);
        let unit = g.scale(1.0 / 420.0, whole);
        MASS.map(|row| {
            std::array::from_fn(|axis| {
                let parts: Vec<Expr> = row.iter().zip(values).map(|(&m, value)| g.scale(m, value[axis])).collect();
                let sum = g.sum(parts);
                g.mul(unit, sum)
            })
        })
    }

    /// What does F · δr + G · L δt for every motion of an end.
    fn push(&self, g: &Builder, applied: &mut AppliedForces, end: usize, force: Vector, turning: Vector) {
        let turning = space::scale(g, self.length, turning);
        self.push_by(g, applied, end, force, turning);
    }

    /// What does F · δr + G · δt.
    fn push_by(&self, g: &Builder, applied: &mut AppliedForces, end: usize, force: Vector, turning: Vector) {
        let across = space::perpendicular(g, self.axes[end]);
        let (zero, moment) = (g.constant(0.0), space::dot(g, across, turning));
        applied.add_force(g, &self.ends[end], force);
        applied.add_torque_pair(g, 0, self.ends[end].body, [zero, zero, moment]);
    }
}
