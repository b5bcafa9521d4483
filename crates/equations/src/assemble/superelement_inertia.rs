//! Flexible bodies by their matrices: inertia.
//!
//! R is the orientation of the first node, Ω its angular velocity and a = Rᵀ r̈_1 its acceleration in its own axes. u
//! are the displacements of [`crate::elements::effects::superelement`], y = (Ω × d_i, 0, 0) the contribution of the
//! frame's rotation to the nodes' rates, and m, S_0, J_0, a_k, b_k, c_k those of [`crate::elements::effects::Carried`]:
//!
//! ```text
//! S = S_0 + Σ a_k u_k,   J = J_0 + 2 Σ c_k u_k,   z = u̇ + y,   π = M z
//! T = ½ m V·V + V·(Ω × S) + ½ Ω·J Ω + Σ (V·a_k + Ω·b_k) u̇_k + ½ zᵀ M z,   V = Rᵀ ṙ_1          J
//! ```
//!
//! is the kinetic energy of ρ |V + Ω × (x + N u) + N u̇|²/2, but for the square of Ω × N u between the nodes. From
//! Lagrange's equations, d/dt ∂T/∂v − ∂T/∂q (Shabana, *Dynamics of Multibody Systems* (2013), ch. 5), follow
//!
//! ```text
//! f_k = a_k·a + b_k·Ω̇ − Ω·c_k Ω + π̇_k, on displacements + Ω × π_i          on each coordinate of u
//! F = m a + Ω̇ × S + Ω × (Ω × S) + 2 Ω × Ṡ + S̈          on the whole body
//! τ = S × a + J Ω̇ + J̇ Ω + Ω × J Ω + Σ (b_k ü_k + Ω × b_k u̇_k)
//!   + Σ (ḋ_i × π_i + d_i × π̇_i + Ω × (d_i × π_i))          about the first node
//! ```
//!
//! in which no velocity stands but against the first node: the body is the same from a frame that moves steadily.

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::superelement::Superelement;
use super::superelement_motion::{ByRow, Deformation};
use crate::elements::effects::superelement::matrices::{Matrices, OF_NODE};
use crate::model::ReducedInertia;
use crate::multibody::{BuildError, Context, DEGREES_OF_FREEDOM, EULER, Matrix, RotationCoordinates, Vector};

impl<'g> Mechanism<'g, '_> {
    /// M (u̇ + y), and its derivative, by the rows of u.
    fn momenta(&self, element: &Superelement, deformation: &Deformation<'g>) -> [ByRow<'g>; 2] {
        let Deformation { ends, values } = deformation;
        [0, 1].map(|order| {
            let mut moving = values[1 + order].clone();
            for (end, node) in ends.iter().zip(0..) {
                for axis in 0..3 {
                    moving[OF_NODE * node + axis].1 += end.turned[order][axis];
                }
            }
            let mass = &element.inertia.matrices.mass;
            let times = |row| self.g.sum(moving.iter().map(|&(column, value)| mass[(row, column)] * value));
            moving.iter().map(|&(row, _)| (row, times(row))).collect()
        })
    }

    /// Generalised inertial forces of all superelements, n: their part of M w, with velocity-dependent terms.
    pub fn inertia_of_superelements(&self) -> Result<Vec<Scalar<'g>>, BuildError> {
        let mut applied = AppliedForces::new(self.g, self.bodies.len());
        for element in &self.superelements {
            self.add_inertia(element, &mut applied)?;
        }
        let mut inertia = applied.generalised(self);
        for element in &self.superelements {
            self.stretch_nodes(&element.inertia, &mut inertia)?;
        }
        Ok(inertia)
    }

    fn add_inertia(&self, element: &Superelement, applied: &mut AppliedForces<'g>) -> Result<(), BuildError> {
        let Superelement { inertia, carried, .. } = element;
        let factor = self.formula(inertia.factor, Context::Parameters)?;
        let carrier = self.carrier(inertia.nodes[0]);
        let ([_, a], [omega, alpha]) = (carrier.along, carrier.about);
        let deformation = self.deformation(element, &carrier);
        let Deformation { ends, values: [values, rates, changes] } = &deformation;
        let [momenta, growths] = self.momenta(element, &deformation);

        let squares = Matrix::from_fn(|i, j| omega[i] * omega[j]);
        let force = |index: usize| {
            let (row, growth) = growths[index];
            let (a_k, b_k, c_k) = (carried.translation[row], carried.rotation[row], carried.stretch[row]);
            let linear = (0..3).flat_map(|axis| [a_k[axis] * a[axis], b_k[axis] * alpha[axis]]);
            let pulled = (0..3).flat_map(|i| (0..3).map(move |j| -c_k[(i, j)] * squares[i][j]));
            let turned = match index / OF_NODE {
                node if node < ends.len() && index % OF_NODE < 3 => {
                    let own = std::array::from_fn(|axis| momenta[OF_NODE * node + axis].1);
                    omega.cross(own.into())[index % OF_NODE]
                }
                _ => self.g.number(0.0),
            };
            factor * (self.g.sum(linear.chain(pulled)) + growth + turned)
        };
        let forces: Vec<Scalar<'g>> = (0..growths.len()).map(force).collect();
        let pairs: Vec<_> = ends.iter().map(|end| (end.pair, end.at)).collect();
        self.push_deformation(applied, element, &pairs, |row| forces[row - OF_NODE]);

        let moment = self.numbers(carried.moment) + self.moment(element, values);
        let [flow, gain] = [rates, changes].map(|values| self.moment(element, values));
        let whole = self.g.number(carried.mass) * a + alpha.cross(moment) + omega.cross(omega.cross(moment));
        let whole = whole + 2.0 * omega.cross(flow) + gain;
        let at_rest = Matrix::from_fn(|i, j| self.g.number(carried.inertia[(i, j)]));
        let [change, growth] = [values, rates].map(|values| {
            let half = self.matrix_sum(&carried.stretch, values);
            half + half
        });
        let now = at_rest + change;
        let [spin, spun] = [rates, changes].map(|values| self.vector_sum(&carried.rotation, values));
        let mut torque = moment.cross(a) + now * alpha + growth * omega + omega.cross(now * omega);
        torque += spun + omega.cross(spin);
        for (end, node) in ends.iter().zip(0..) {
            let of_node =
                |list: &ByRow<'g>| -> Vector<'g> { std::array::from_fn(|axis| list[OF_NODE * node + axis].1).into() };
            let (d, rate) = (end.at.displacement, of_node(rates));
            let (own, own_growth) = (of_node(&momenta), of_node(&growths));
            torque += rate.cross(own) + d.cross(own_growth) + omega.cross(d.cross(own));
        }
        let first = inertia.nodes[0];
        applied.add_force(&self.point(first), carrier.outward * (factor * whole));
        applied.add_torque_pair(0, first.body, carrier.outward * (factor * torque));
        Ok(())
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
        let energies: Result<Vec<_>, _> =
            self.superelements.iter().map(|element| self.kinetic_energy_of(element)).collect();
        Ok(self.g.sum(energies?))
    }

    fn kinetic_energy_of(&self, element: &Superelement) -> Result<Scalar<'g>, BuildError> {
        let Superelement { inertia, carried, .. } = element;
        let factor = self.formula(inertia.factor, Context::Parameters)?;
        let carrier = self.carrier(inertia.nodes[0]);
        let ([velocity, _], [omega, _]) = (carrier.along, carrier.about);
        let deformation = self.deformation(element, &carrier);
        let Deformation { ends, values: [values, rates, _] } = &deformation;
        let [momenta, _] = self.momenta(element, &deformation);
        let moment = self.numbers(carried.moment) + self.moment(element, values);
        let half = Matrix::from_fn(|i, j| self.g.number(0.5 * carried.inertia[(i, j)]));
        let half = half + self.matrix_sum(&carried.stretch, values);
        let mut parts = vec![
            0.5 * carried.mass * velocity.dot(velocity),
            velocity.dot(omega.cross(moment) + self.moment(element, rates)),
            omega.dot(half * omega + self.vector_sum(&carried.rotation, rates)),
        ];
        for (index, (&(_, rate), &(_, momentum))) in rates.iter().zip(&momenta).enumerate() {
            let turned = match index / OF_NODE {
                node if node < ends.len() && index % OF_NODE < 3 => ends[node].turned[0][index % OF_NODE],
                _ => self.g.number(0.0),
            };
            parts.push(0.5 * (momentum * (rate + turned)));
        }
        Ok(factor * self.g.sum(parts))
    }
}
