//! Beams with mass: the inertia and weight of an element between two frames, and how it starts.
//!
//! The points between the ends follow them by Hermite's cubics; L t is the derivative at an end whose axis is t:
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
//! So d'Alembert's forces on the ends are −Σ m_kl ë_l, with L ẗ = L (θ̈ n − θ̇² t), and their moments L n · (…); M is
//! their slope by the accelerations. For small bending it is the consistent mass matrix of Euler and Bernoulli's beam
//! (Przemieniecki, *Theory of Matrix Structural Analysis* (1968), ch. 11); in the plane, sections have no inertia of
//! rotation. Gravity acts on r(s):
//!
//! ```text
//! ∫ r ds = L/2 (r_A + r_B) + L²/12 (t_A − t_B)
//! ```
//!
//! In space ẗ = ω̇ × t + ω × (ω × t), the moments are t × L (…), and half of the element's sections turn with each
//! end: with I in its axes, i_y = μ EI_y/EA, i_z = μ EI_z/EA, i_x = i_y + i_z (a section of one material), T gains ¼ L
//! ω · I ω.

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::system::{ConditionOf, ConstraintInfo, ResidualUnit, StartCondition};
use crate::elements::effects::Section;
use crate::grammar::PointRef;
use crate::model::{Coordinate, Description, LineMass, StartValue, TimeOrder};
use crate::multibody::{ANGLE, BuildError, Context, DEGREES_OF_FREEDOM, EULER, MaterialPoint, Vector};

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
    /// ½ L I of each end, kg m², in space.
    section: Option<Vector<'g>>,
}

impl<'g> Mechanism<'g, '_> {
    /// Flexible body with mass, if any.
    pub fn flexible(&self) -> Option<String> {
        let beam = self.line_masses.first().map(|beam| format!("beam `{}` bends", beam.body));
        beam.or_else(|| self.superelements.first().map(|_| "a superelement deforms".to_owned()))
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
        let section = beam.section.map(|section| self.half_of_sections(section, length * mass)).transpose()?;
        Ok(Element { ends, axes, length, mass, section })
    }

    /// ½ L I from the mass of an element.
    fn half_of_sections(&self, section: Section, mass: Scalar<'g>) -> Result<Vector<'g>, BuildError> {
        let axial = self.formula(section.axial_stiffness, Context::Parameters)?;
        let [about_y, about_z] = section
            .bending_stiffness
            .map(|bending| Ok::<_, BuildError>(0.5 * mass * self.formula(bending, Context::Parameters)? / axial));
        let (about_y, about_z) = (about_y?, about_z?);
        Ok([about_y + about_z, about_y, about_z].into())
    }

    /// Generalised inertial forces of all beams, n: their part of M w, with velocity-dependent terms.
    pub fn inertia_of_beams(&self) -> Result<Vec<Scalar<'g>>, BuildError> {
        let mut applied = AppliedForces::new(self.g, self.bodies.len());
        for element in self.elements()? {
            let accelerations = element.end_values(|end| {
                let (point, axis) = (&element.ends[end], element.axes[end]);
                let body = &self.bodies[point.body];
                let position = body.acceleration_of(point.arm);
                if element.section.is_some() {
                    let (omega, alpha) = (body.angular_velocity(), body.angular_acceleration());
                    return [position, alpha.cross(axis) + omega.cross(omega.cross(axis))];
                }
                let (rate, gain) = (body.angular_velocity()[2], body.angular_acceleration()[2]);
                let (across, square) = (axis.perpendicular(), rate * rate);
                let (along, beside) = (square * axis, gain * across);
                [position, beside - along]
            });
            let [first, turning_first, second, turning_second] = element.momenta(&accelerations);
            for (end, force, turning) in [(0, first, turning_first), (1, second, turning_second)] {
                element.push_by(&mut applied, end, force, element.length * turning);
                let Some(section) = element.section else { continue };
                let at = element.ends[end].body;
                let body = &self.bodies[at];
                let (omega, alpha) = (body.angular_velocity_in_body(), body.angular_acceleration_in_body());
                let torque = section.weighting(alpha) + omega.cross(section.weighting(omega));
                applied.add_torque_pair(0, at, body.rotate(torque));
            }
        }
        let mut inertia = applied.generalised(self);
        for element in self.elements()? {
            self.add_stretch(&element, &mut inertia);
        }
        Ok(inertia)
    }

    /// M regular along p, where nothing moves: as of a body with a third of the trace of J.
    fn add_stretch(&self, element: &Element<'g>, inertia: &mut [Scalar<'g>]) {
        let Some(section) = element.section else { return };
        let square = element.length * element.length;
        let across = MASS[1][1] / 420.0 * (element.mass * element.length * square);
        let trace = self.g.sum(section.components()) + 2.0 * across;
        for end in &element.ends {
            let body = &self.bodies[end.body];
            let coordinates = EULER..DEGREES_OF_FREEDOM;
            let (p, change) = (&body.position[coordinates.clone()], &body.acceleration[coordinates.clone()]);
            let along = 4.0 / 3.0 * trace * self.g.dot(p, change);
            for (index, &p) in body.index[coordinates].iter().zip(p) {
                if let Some(row) = *index {
                    inertia[row] += along * p;
                }
            }
        }
    }

    /// T of all beams, J.
    pub fn energy_of_beams(&self) -> Result<Scalar<'g>, BuildError> {
        let mut parts = Vec::new();
        for element in self.elements()? {
            let velocities = element.end_values(|end| {
                let point = &element.ends[end];
                let omega = self.bodies[point.body].angular_velocity();
                let axis = element.axes[end];
                let turning =
                    if element.section.is_some() { omega.cross(axis) } else { omega[2] * axis.perpendicular() };
                [point.velocity, turning]
            });
            let momenta = element.momenta(&velocities);
            parts.extend(velocities.into_iter().zip(momenta).map(|(velocity, momentum)| 0.5 * velocity.dot(momentum)));
            for end in element.section.iter().flat_map(|_| &element.ends) {
                let omega = self.bodies[end.body].angular_velocity_in_body();
                parts.extend(element.section.map(|section| 0.5 * omega.dot(section.weighting(omega))));
            }
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

    /// A beam starts straight and moves as a rigid body, but between nodes whose coordinates (velocities) are all
    /// given.
    pub fn start_of_beams(&self, description: &Description) -> Result<Vec<StartCondition>, BuildError> {
        let mut conditions = Vec::new();
        for beam in &self.line_masses {
            let [first, second] = beam.between.map(|point| point.body);
            let is_free = |order| [first, second].iter().any(|&body| !is_given_at_start(description, body, order));
            let (position, velocity) = (is_free(TimeOrder::Position), is_free(TimeOrder::Velocity));
            let element = self.element(beam)?;
            let rows = match element.section {
                Some(_) => self.straight_in_space(beam.between, element.length),
                None => self.straight_in_plane(&element, [first, second]),
            };
            let joint = beam.body.to_owned();
            let node = &description.bodies[second].name;
            conditions.extend(rows.into_iter().map(|(name, unit, value)| StartCondition {
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

/// Something that is zero where an element is straight, by its name.
type Straight<'g> = (&'static str, ResidualUnit, Scalar<'g>);

impl<'g> Mechanism<'g, '_> {
    fn straight_in_plane(&self, element: &Element<'g>, bodies: [usize; 2]) -> Vec<Straight<'g>> {
        let line = element.ends[1].position - element.ends[0].position;
        let across = element.axes[0].perpendicular();
        let along = line.dot(element.axes[0]);
        let angles = bodies.map(|body| self.bodies[body].position[ANGLE]);
        vec![
            ("x", ResidualUnit::Length, along - element.length),
            ("y", ResidualUnit::Length, line.dot(across)),
            ("angle", ResidualUnit::Angle, angles[1] - angles[0]),
        ]
    }

    /// The second frame is as far along x of the first as the beam is long, and turned by nothing.
    fn straight_in_space(&self, between: [PointRef; 2], length: Scalar<'g>) -> Vec<Straight<'g>> {
        let pair = self.pair(between);
        let place = pair.first.orientation.matrix().transposed() * pair.offset();
        let turn = 2.0 * pair.relative().vector_part();
        let lengths = [("x", place[0] - length), ("y", place[1]), ("z", place[2])];
        let angles = ["rotation about x", "rotation about y", "rotation about z"].into_iter().zip(turn.components());
        let lengths = lengths.map(|(name, value)| (name, ResidualUnit::Length, value));
        lengths.into_iter().chain(angles.map(|(name, value)| (name, ResidualUnit::Angle, value))).collect()
    }
}

/// Whether `initial` names all coordinates of a body, or all their velocities.
fn is_given_at_start(description: &Description, body: usize, wanted: TimeOrder) -> bool {
    let named = |coordinate: &Coordinate| {
        description.initial.iter().any(|value| match value {
            StartValue::Coordinate { body: of, coordinate: c, order, .. } => {
                (*of, c, *order) == (body, coordinate, wanted)
            }
            StartValue::Orientation { body: of, .. } => {
                *of == body && wanted == TimeOrder::Position && !coordinate.is_length()
            }
            StartValue::AngularVelocity { body: of, .. } => {
                *of == body && wanted == TimeOrder::Velocity && !coordinate.is_length()
            }
            _ => false,
        })
    };
    description.bodies[body].coordinates.iter().all(named)
}

impl<'g> Element<'g> {
    /// Vector over e: (r_A, L t_A, r_B, L t_B), from its parts in r and t at each end.
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

    /// Generalised force with the virtual work F · δr + G · δt for every motion of an end.
    fn push_by(&self, applied: &mut AppliedForces<'g>, end: usize, force: Vector<'g>, turning: Vector<'g>) {
        applied.add_force(&self.ends[end], force);
        let axis = self.axes[end];
        let moment = match self.section {
            Some(_) => axis.cross(turning),
            None => {
                let zero = self.length.builder().number(0.0);
                [zero, zero, axis.perpendicular().dot(turning)].into()
            }
        };
        applied.add_torque_pair(0, self.ends[end].body, moment);
    }
}
