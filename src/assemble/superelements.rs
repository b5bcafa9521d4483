//! Flexible bodies by their matrices: inertia, weight, and how they start.
//!
//! R is the orientation of the first node, Ω its angular velocity in its own axes. The nodes' velocities V_i = Rᵀ ṙ_i
//! and W_i = Rᵀ ω_i against the ground and the rates q̇ of the modes are v; with p_i, h_i and π the parts of M v, and
//! M constant,
//!
//! ```text
//! T = ½ vᵀ M v          J
//! F_i = R (ṗ_i + Ω × p_i)          τ_i = R (ḣ_i + Ω × h_i − W_i × h_i)          F_q = π̇          N, N m
//! on the first node also τ = R Σ (V_i × p_i + W_i × h_i)
//! ```
//!
//! are what d/dt ∂T/∂v − ∂T/∂q comes to: T depends on where the first node points, too (Géradin & Cardona, *Flexible
//! Multibody Dynamics* (2001), ch. 10). Gravity acts on S, the mass times the centre of mass from the first node,
//! which is linear in the displacements u of [`crate::elements::effects::superelement`]:
//!
//! ```text
//! V = −g · (m r_1 + R S),   S = S_0 + A u          J
//! ```

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::{Mechanism, Owner};
use super::system::{ConditionOf, ConstraintInfo, ResidualUnit, StartCondition};
use crate::elements::effects::matrices::{Matrices, OF_NODE};
use crate::model::{Description, Effect, ReducedInertia};
use crate::multibody::{
    BuildError, Context, DEGREES_OF_FREEDOM, EULER, MaterialPoint, Matrix, RelativeDisplacement, RotationCoordinates,
    Vector,
};

/// Those of a description: the effect's place among all, and its inertia.
pub fn superelements(description: &Description) -> Vec<(usize, ReducedInertia<'_>)> {
    let effects = description.effects.iter().enumerate();
    effects.filter_map(|(place, effect)| Some((place, effect.kind.reduced_inertia()?))).collect()
}

/// A row of M with what stands there of v, or of something else that is linear in it.
struct Momenta<'g> {
    /// p_i and h_i
    nodes: Vec<[Vector<'g>; 2]>,
    /// π
    modes: Vec<Scalar<'g>>,
}

/// A flexible body in motion.
struct Moving<'g> {
    /// R
    outward: Matrix<'g>,
    points: Vec<MaterialPoint<'g>>,
    /// V_i and W_i
    velocities: Vec<[Vector<'g>; 2]>,
}

impl<'g> Mechanism<'g, '_> {
    /// The coordinates of all modes.
    pub fn add_modes(&mut self, effects: &[Effect]) {
        for (effect, inertia) in self.superelements.clone() {
            for mode in 0..inertia.matrices.modes {
                let name = format!("{}.mode{}", effects[effect].name, mode + 1);
                let index = self.add_coordinate(Owner::Mode, &name);
                self.modes.insert((effect, mode), index);
            }
        }
    }

    fn moving(&self, inertia: &ReducedInertia) -> Moving<'g> {
        let outward = self.frame(inertia.nodes[0]).orientation.matrix();
        let inward = outward.transposed();
        let points: Vec<_> = inertia.nodes.iter().map(|&node| self.point(node)).collect();
        let velocity =
            |point: &MaterialPoint<'g>| [inward * point.velocity, inward * self.bodies[point.body].angular_velocity()];
        let velocities = points.iter().map(velocity).collect();
        Moving { outward, points, velocities }
    }

    /// The modal coordinates of an effect, or their derivatives.
    fn modes_of(&self, effect: usize, list: &[Scalar<'g>], count: usize) -> Vec<Scalar<'g>> {
        (0..count).map(|mode| list[self.modes[&(effect, mode)]]).collect()
    }

    /// m M times nodes' and modes' values.
    fn momenta(
        &self,
        inertia: &ReducedInertia,
        nodes: &[[Vector<'g>; 2]],
        modes: &[Scalar<'g>],
    ) -> Result<Momenta<'g>, BuildError> {
        let factor = self.formula(inertia.factor, Context::Parameters)?;
        let matrices = inertia.matrices;
        let values: Vec<Scalar<'g>> =
            nodes.iter().flatten().flat_map(|value| value.components()).chain(modes.iter().copied()).collect();
        let times = |row: usize| {
            let terms = values.iter().enumerate().map(|(column, &value)| matrices.mass[(row, column)] * value);
            factor * self.g.sum(terms)
        };
        let three =
            |node: usize, from: usize| std::array::from_fn(|axis| times(Matrices::of_node(node, from + axis))).into();
        let nodes = (0..nodes.len()).map(|node| [three(node, 0), three(node, 3)]).collect();
        Ok(Momenta { nodes, modes: (0..modes.len()).map(|mode| times(matrices.of_mode(mode))).collect() })
    }

    /// Generalised inertial forces of all superelements, n: their part of M w, with what depends on velocities.
    pub fn inertia_of_superelements(&self) -> Result<Vec<Scalar<'g>>, BuildError> {
        let mut applied = AppliedForces::new(self.g, self.bodies.len());
        for (effect, inertia) in &self.superelements {
            let moving = self.moving(inertia);
            let count = inertia.matrices.modes;
            let [rates, second_rates] = [&self.v, &self.w].map(|list| self.modes_of(*effect, list, count));
            let momenta = self.momenta(inertia, &moving.velocities, &rates)?;
            let omega = moving.velocities[0][1];
            let inward = moving.outward.transposed();
            let accelerations: Vec<[Vector<'g>; 2]> = moving
                .points
                .iter()
                .zip(&moving.velocities)
                .map(|(point, &[velocity, turning])| {
                    let body = &self.bodies[point.body];
                    let of_point = inward * body.acceleration_of(point.arm) - omega.cross(velocity);
                    [of_point, inward * body.angular_acceleration() - omega.cross(turning)]
                })
                .collect();
            let changes = self.momenta(inertia, &accelerations, &second_rates)?;
            let mut of_frame = Vector::zero(self.g);
            for (node, point) in moving.points.iter().enumerate() {
                let ([velocity, turning], [p, h]) = (moving.velocities[node], momenta.nodes[node]);
                let [p_change, h_change] = changes.nodes[node];
                of_frame += velocity.cross(p) + turning.cross(h);
                let force = p_change + omega.cross(p);
                let torque = h_change + omega.cross(h) - turning.cross(h);
                applied.add_force(point, moving.outward * force);
                applied.add_torque_pair(0, point.body, moving.outward * torque);
            }
            applied.add_torque_pair(0, moving.points[0].body, moving.outward * of_frame);
            for (mode, &change) in changes.modes.iter().enumerate() {
                applied.add_to_coordinate(self.modes[&(*effect, mode)], change);
            }
        }
        let mut inertia = applied.generalised(self);
        for (_, element) in &self.superelements {
            self.stretch_nodes(element, &mut inertia)?;
        }
        Ok(inertia)
    }

    /// M regular along p, where nothing moves: as of a body with a third of the trace of each node's inertia.
    fn stretch_nodes(&self, element: &ReducedInertia, inertia: &mut [Scalar<'g>]) -> Result<(), BuildError> {
        let factor = self.formula(element.factor, Context::Parameters)?;
        for (node, point) in element.nodes.iter().enumerate() {
            let body = &self.bodies[point.body];
            if body.rotation_coordinates != RotationCoordinates::Euler {
                continue;
            }
            let rows = (3..OF_NODE).map(|coordinate| Matrices::of_node(node, coordinate));
            let trace: f64 = rows.map(|row| element.matrices.mass[(row, row)]).sum();
            let coordinates = EULER..DEGREES_OF_FREEDOM;
            let (p, change) = (&body.position[coordinates.clone()], &body.acceleration[coordinates.clone()]);
            let along = 4.0 / 3.0 * (trace * factor) * self.g.dot(p, change);
            for (index, &p) in body.index[coordinates].iter().zip(p) {
                if let Some(row) = *index {
                    inertia[row] += along * p;
                }
            }
        }
        Ok(())
    }

    /// T of all superelements, J.
    pub fn energy_of_superelements(&self) -> Result<Scalar<'g>, BuildError> {
        let mut parts = Vec::new();
        for (effect, inertia) in &self.superelements {
            let moving = self.moving(inertia);
            let rates = self.modes_of(*effect, &self.v, inertia.matrices.modes);
            let momenta = self.momenta(inertia, &moving.velocities, &rates)?;
            let nodes = moving.velocities.iter().zip(&momenta.nodes);
            parts.extend(nodes.flat_map(|(v, p)| v.iter().zip(p).map(|(v, p)| 0.5 * v.dot(*p))));
            parts.extend(rates.iter().zip(&momenta.modes).map(|(&rate, &momentum)| 0.5 * (rate * momentum)));
        }
        Ok(self.g.sum(parts))
    }

    /// Adds the weights of all superelements in a uniform field, with their potential energy.
    pub fn weigh_superelements(&self, applied: &mut AppliedForces<'g>, field: Vector<'g>) -> Result<(), BuildError> {
        for (effect, inertia) in &self.superelements {
            let factor = self.formula(inertia.factor, Context::Parameters)?;
            let matrices = inertia.matrices;
            let total = matrices.total_mass() * factor;
            let first = inertia.nodes[0];
            let outward = self.frame(first).orientation.matrix();
            // g in the axes of the first node, and its work by a row of u.
            let pull = factor * (outward.transposed() * field);
            let by = |row: usize| {
                let [x, y, z] = matrices.first_moment(row);
                x * pull[0] + y * pull[1] + z * pull[2]
            };
            let three = |node: usize, from: usize| -> Vector<'g> {
                std::array::from_fn(|axis| by(Matrices::of_node(node, from + axis))).into()
            };
            let mut moment = Vector::from(matrices.undeformed_moment().map(|part| self.g.number(part)));
            let mut gather = |row: usize, value: Scalar<'g>| {
                let parts = matrices.first_moment(row).map(|part| part * value);
                moment += Vector::from(parts);
            };
            for node in 1..inertia.nodes.len() {
                let pair = self.pair([first, inertia.nodes[node]]);
                let at = RelativeDisplacement::of(&pair, matrices.offset_in(self.g, node));
                for axis in 0..3 {
                    gather(Matrices::of_node(node, axis), at.displacement[axis]);
                    gather(Matrices::of_node(node, 3 + axis), at.rotation[axis]);
                }
                let there = self.point_now_at(first.body, pair.second.point.position);
                applied.add_force_pair(&there, &pair.second.point, outward * three(node, 0));
                applied.add_torque_pair(first.body, pair.second.point.body, at.torque(three(node, 3)));
            }
            for (mode, value) in self.modes_of(*effect, &self.q, matrices.modes).into_iter().enumerate() {
                gather(matrices.of_mode(mode), value);
                applied.add_to_coordinate(self.modes[&(*effect, mode)], by(matrices.of_mode(mode)));
            }
            let lever = factor * (outward * moment);
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
        for (effect, inertia) in &self.superelements {
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
                let pair = self.pair([inertia.nodes[0], inertia.nodes[node]]);
                let at = RelativeDisplacement::of(&pair, inertia.matrices.offset_in(self.g, node));
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
