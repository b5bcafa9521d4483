//! Flexible bodies by their matrices: how they deform, their weight, and how they start.
//!
//! The weight follows from [`super::superelement_inertia`]: gravity is the acceleration −g,
//!
//! ```text
//! V = −g · (m r_1 + R S)          J
//! ```

use nalgebra::Matrix3;
use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::{Mechanism, Owner};
use super::superelement::Superelement;
use super::system::{ConditionOf, ConstraintInfo, ResidualUnit, StartCondition};
use crate::elements::effects::superelement::matrices::Matrices;
use crate::model::{Description, Effect, PointRef, ReducedInertia};
use crate::multibody::{Body, BuildError, Context, Matrix, Pair, RelativeDisplacement, Vector};

/// Values by row of M, such as u: the index of each row with its value.
pub type ByRow<'g> = Vec<(usize, Scalar<'g>)>;

/// u with its first and second derivatives.
pub struct Deformation<'g> {
    /// Nodes but the first one, as it sees them.
    pub ends: Vec<End<'g>>,
    /// u and its derivatives by the rows of M.
    pub values: [ByRow<'g>; 3],
}

/// A node as the first one sees it.
pub struct End<'g> {
    /// Both frames
    pub pair: Pair<'g>,
    /// d and ρ
    pub at: RelativeDisplacement<'g>,
    /// y and its derivative along the displacements
    pub turned: [Vector<'g>; 2],
}

/// The motion of the first node, in its own axes.
pub struct Carrier<'g> {
    /// R
    pub outward: Matrix<'g>,
    /// V, a
    pub along: [Vector<'g>; 2],
    /// Ω, Ω̇
    pub about: [Vector<'g>; 2],
}

impl<'g> Mechanism<'g, '_> {
    /// The coordinates of all modes.
    pub fn add_modes(&mut self, effects: &[Effect]) {
        let counts: Vec<_> = self.superelements.iter().map(|of| (of.effect, of.inertia.matrices.modes)).collect();
        for (effect, modes) in counts {
            for mode in 0..modes {
                let name = format!("{}.mode{}", effects[effect].name, mode + 1);
                let index = self.add_coordinate(Owner::Mode, &name);
                self.modes.insert((effect, mode), index);
            }
        }
    }

    /// The modal coordinates of an effect, or their derivatives.
    fn modes_of(&self, effect: usize, list: &[Scalar<'g>], count: usize) -> Vec<Scalar<'g>> {
        (0..count).map(|mode| list[self.modes[&(effect, mode)]]).collect()
    }

    /// The motion of a first node.
    pub fn carrier(&self, first: PointRef) -> Carrier<'g> {
        let outward = self.frame(first).orientation.matrix();
        let inward = outward.transposed();
        let (point, body) = (self.point(first), &self.bodies[first.body]);
        let along = [point.velocity, body.acceleration_of(point.arm)].map(|value| inward * value);
        let about = [body.angular_velocity(), body.angular_acceleration()].map(|value| inward * value);
        Carrier { outward, along, about }
    }

    /// A node relative to the first one, without derivatives.
    fn end(&self, inertia: &ReducedInertia, node: usize) -> (Pair<'g>, RelativeDisplacement<'g>) {
        let pair = self.pair([inertia.nodes[0], inertia.nodes[node]]);
        (pair, RelativeDisplacement::of(&pair, inertia.matrices.offset_in(self.g, node)))
    }

    /// u with its derivatives, from the motion of the first node.
    pub fn deformation(&self, element: &Superelement, carrier: &Carrier<'g>) -> Deformation<'g> {
        let Superelement { effect, inertia, .. } = element;
        let [omega, alpha] = carrier.about;
        let mut ends = Vec::new();
        let mut values: [ByRow<'g>; 3] = Default::default();
        for node in 1..inertia.nodes.len() {
            let (pair, at) = self.end(inertia, node);
            let bodies = [pair.first, pair.second].map(|frame| &self.bodies[frame.point.body]);
            let [first, second] = [pair.first, pair.second].map(|frame| {
                let body = &self.bodies[frame.point.body];
                [body.acceleration_of(frame.point.arm), body.angular_acceleration()]
            });
            let rates = at.rates(&pair, bodies.map(Body::angular_velocity));
            let changes = at.second_rates(&pair, bodies.map(Body::angular_velocity), [first, second]);
            for (list, parts) in values.iter_mut().zip([[at.displacement, at.rotation], rates, changes]) {
                let parts = parts.into_iter().flat_map(Vector::components).enumerate();
                list.extend(parts.map(|(coordinate, value)| (Matrices::of_node(node, coordinate), value)));
            }
            let turned = [omega.cross(at.displacement), alpha.cross(at.displacement) + omega.cross(rates[0])];
            ends.push(End { pair, at, turned });
        }
        for (list, of) in values.iter_mut().zip([&self.q, &self.v, &self.w]) {
            let modes = self.modes_of(*effect, of, inertia.matrices.modes).into_iter().enumerate();
            list.extend(modes.map(|(mode, value)| (inertia.matrices.of_mode(mode), value)));
        }
        Deformation { ends, values }
    }

    /// Σ of vectors by rows.
    pub fn vector_sum(&self, by: &[[f64; 3]], values: &ByRow<'g>) -> Vector<'g> {
        std::array::from_fn(|axis| self.g.sum(values.iter().map(|&(row, value)| by[row][axis] * value))).into()
    }

    /// Σ of matrices by rows.
    pub fn matrix_sum(&self, by: &[Matrix3<f64>], values: &ByRow<'g>) -> Matrix<'g> {
        Matrix::from_fn(|i, j| self.g.sum(values.iter().map(|&(row, value)| by[row][(i, j)] * value)))
    }

    /// The change of S with u, or that of its derivatives.
    pub fn moment(&self, element: &Superelement, values: &ByRow<'g>) -> Vector<'g> {
        self.vector_sum(&element.carried.translation, values)
    }

    /// A vector of numbers.
    pub fn numbers(&self, values: [f64; 3]) -> Vector<'g> {
        values.map(|value| self.g.number(value)).into()
    }

    /// Adds the forces on u, f_k by row: on nodes, with the opposite ones on the first node's body, and on modes.
    pub fn push_deformation(
        &self,
        applied: &mut AppliedForces<'g>,
        element: &Superelement,
        ends: &[(Pair<'g>, RelativeDisplacement<'g>)],
        by: impl Fn(usize) -> Scalar<'g>,
    ) {
        let Superelement { effect, inertia, .. } = element;
        let first = inertia.nodes[0].body;
        for ((pair, at), node) in ends.iter().zip(1..) {
            let three = |from: usize| -> Vector<'g> {
                std::array::from_fn(|axis| by(Matrices::of_node(node, from + axis))).into()
            };
            let second = &pair.second.point;
            let there = self.point_now_at(first, second.position);
            applied.add_force_pair(&there, second, at.outward * three(0));
            applied.add_torque_pair(first, second.body, at.torque(three(3)));
        }
        for mode in 0..inertia.matrices.modes {
            applied.add_to_coordinate(self.modes[&(*effect, mode)], by(inertia.matrices.of_mode(mode)));
        }
    }

    /// Adds the weights of all superelements in a uniform field, with their potential energy.
    pub fn weigh_superelements(&self, applied: &mut AppliedForces<'g>, field: Vector<'g>) -> Result<(), BuildError> {
        for element in &self.superelements {
            let Superelement { effect, inertia, carried } = element;
            let factor = self.formula(inertia.factor, Context::Parameters)?;
            let first = inertia.nodes[0];
            let outward = self.frame(first).orientation.matrix();
            // g in the axes of the first node, and its work by a row of u.
            let pull = factor * (outward.transposed() * field);
            let by = |row: usize| {
                let [x, y, z] = carried.translation[row];
                x * pull[0] + y * pull[1] + z * pull[2]
            };
            let ends: Vec<_> = (1..inertia.nodes.len()).map(|node| self.end(inertia, node)).collect();
            self.push_deformation(applied, element, &ends, by);
            let mut values: ByRow<'g> = Vec::new();
            for ((_, at), node) in ends.iter().zip(1..) {
                let parts = [at.displacement, at.rotation].into_iter().flat_map(Vector::components).enumerate();
                values.extend(parts.map(|(coordinate, value)| (Matrices::of_node(node, coordinate), value)));
            }
            let modes = self.modes_of(*effect, &self.q, inertia.matrices.modes).into_iter().enumerate();
            values.extend(modes.map(|(mode, value)| (inertia.matrices.of_mode(mode), value)));
            let total = carried.mass * factor;
            let lever = factor * (outward * (self.numbers(carried.moment) + self.moment(element, &values)));
            applied.add_force(&self.point(first), total * field);
            applied.add_torque_pair(0, first.body, lever.cross(field));
            let origin = total * self.point(first).position;
            applied.add_potential(self, &field.components(), -field.dot(origin + lever));
        }
        Ok(())
    }

    /// A superelement starts undeformed, and moves as a rigid body.
    pub fn start_of_superelements(&self, description: &Description) -> Vec<StartCondition> {
        let mut conditions = Vec::new();
        for Superelement { effect, inertia, .. } in &self.superelements {
            let owner = &description.effects[*effect].name;
            let mut zero = |name: String, unit: ResidualUnit, value: Scalar<'g>| {
                conditions.push(StartCondition {
                    info: ConstraintInfo { name, joint: owner.clone(), unit },
                    of: ConditionOf::Superelement,
                    value: value.expr(),
                    rate: None,
                    position: true,
                    velocity: true,
                });
            };
            for node in 1..inertia.nodes.len() {
                let (_, at) = self.end(inertia, node);
                let body = &description.bodies[inertia.nodes[node].body].name;
                let axes = ["x", "y", "z"].into_iter().enumerate();
                for (axis, letter) in axes.filter(|(axis, _)| self.is_spatial || *axis < 2) {
                    zero(format!("{body}.{letter}"), ResidualUnit::Length, at.displacement[axis]);
                }
                for axis in if self.is_spatial { 0..3 } else { 2..3 } {
                    let letter = ["x", "y", "z"][axis];
                    zero(format!("{body}.rotation about {letter}"), ResidualUnit::Angle, at.rotation[axis]);
                }
            }
            for (mode, value) in self.modes_of(*effect, &self.q, inertia.matrices.modes).into_iter().enumerate() {
                zero(format!("mode {}", mode + 1), ResidualUnit::Length, value);
            }
        }
        conditions
    }
}
