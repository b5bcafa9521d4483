//! Bushing: springs and dampers between two frames, along and about the axes of the first.
//!
//! With d = R_F₁ᵀ (r_B − r_A), q = (q₀, e) the rotation of the second frame against the first (`joints::pair`), and K, C, K_t,
//! C_t diagonal, in the first frame's axes,
//!
//! ```text
//! F_B = −(K d + C ḋ)                                       V = ½ dᵀ K d + 2 eᵀ K_t e          N, J
//! τ₂  = −(2 q₀ K_t e + 2 e × K_t e + C_t (ω₂ − ω₁))                                           N m
//! ```
//!
//! on the second body at B; the opposites act on the first body at the same place. ḋ is what an observer in the first frame
//! sees. 2 e is the rotation vector to second order, so K_t is the stiffness for small rotations, the torque of a rotation
//! by φ about an axis K_t sin φ: a bushing is no spring for full turns.
//!
//! Full matrices 𝐊, 𝐂 (6 × 6, displacements before rotations) add 𝐊 x + 𝐂 ẋ, x = (d, 2 e), ẋ = (ḋ, ω₂ − ω₁), with the torque
//! q₀ y + e × y of the rotational part y of 𝐊 x, so that V gains ½ xᵀ 𝐊 x. Where 𝐊 is not symmetric, or a stiffness depends on
//! the motion, there is no potential and none is counted.

use symdiff::{Builder, Expr, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::rotation;
use crate::assemble::space::{self, Vector};
use crate::model::Bushing;

use super::Loads;

/// Stiffness or damping: by axis and, where there is one, the full matrix.
struct Law {
    straight: Vector,
    torsional: Vector,
    full: Option<[[Expr; 6]; 6]>,
}

impl Law {
    fn new(
        g: &Builder,
        m: &Mechanism,
        [straight, torsional]: [&[Formula; 3]; 2],
        full: Option<&[[Formula; 6]; 6]>,
    ) -> Result<Self, BuildError> {
        let straight = m.vector(g, straight, Context::Motion)?;
        let torsional = m.vector(g, torsional, Context::Motion)?;
        let mut matrix = full.map(|_| [[g.constant(0.0); 6]; 6]);
        if let (Some(matrix), Some(full)) = (&mut matrix, full) {
            for (entry, formula) in matrix.iter_mut().flatten().zip(full.iter().flatten()) {
                *entry = m.formula(g, formula, Context::Motion)?;
            }
        }
        Ok(Self { straight, torsional, full: matrix })
    }

    /// The full matrix times (displacement, rotation): a force and a torque.
    fn full_times(&self, g: &Builder, displacement: Vector, rotation: Vector) -> Option<[Vector; 2]> {
        let along = [displacement, rotation].concat();
        let matrix = self.full?;
        let product = matrix.map(|row| g.dot(&row, &along));
        Some([[product[0], product[1], product[2]], [product[3], product[4], product[5]]])
    }

    /// All its numbers.
    fn coefficients(&self) -> Vec<Expr> {
        let full = self.full.iter().flatten().flatten().copied();
        self.straight.into_iter().chain(self.torsional).chain(full).collect()
    }

    fn is_symmetric(&self) -> bool {
        let symmetric = |m: &[[Expr; 6]; 6]| (0..6).all(|i| (0..i).all(|j| m[i][j] == m[j][i]));
        self.full.as_ref().is_none_or(symmetric)
    }
}

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, effect: &Bushing) -> Result<(), BuildError> {
    let full = [&effect.stiffness_matrix, &effect.damping_matrix].map(|full| full.as_ref().map(|full| &*full.0));
    let stiffness = Law::new(g, m, [&effect.stiffness, &effect.torsional_stiffness], full[0])?;
    let damping = Law::new(g, m, [&effect.damping, &effect.torsional_damping], full[1])?;
    let pair = m.pair(g, effect.between);
    let axes: [Vector; 3] = std::array::from_fn(|axis| {
        let unit = space::along(g, axis);
        pair.outward(g, unit)
    });
    let (first, second) = (pair.first.point, pair.second.point);
    let omega = [first, second].map(|point| m.bodies[point.body].angular_velocity(g));
    let turning = space::sub(g, omega[1], omega[0]);
    let q = pair.relative(g);
    let e = rotation::vector_part(q);

    let offset = pair.offset(g);
    let carried = space::cross(g, omega[0], offset);
    let rate = space::sub(g, second.velocity, first.velocity);
    let rate = space::sub(g, rate, carried);
    let displacement = axes.map(|axis| space::dot(g, axis, offset));
    let elastic = weighted(g, stiffness.straight, displacement);
    let doubled = space::dot(g, displacement, elastic);
    let rate = axes.map(|axis| space::dot(g, axis, rate));
    let viscous = weighted(g, damping.straight, rate);
    let mut pull = space::add(g, elastic, viscous);

    let twisted = weighted(g, stiffness.torsional, e);
    let half = conjugate(g, q[0], e, twisted);
    let elastic = half.map(|component| g.scale(2.0, component));
    let spin = axes.map(|axis| space::dot(g, axis, turning));
    let viscous = weighted(g, damping.torsional, spin);
    let mut torque = space::add(g, elastic, viscous);

    let halved = space::dot(g, e, twisted);
    let (straight, twisting) = (g.scale(0.5, doubled), g.scale(2.0, halved));
    let mut potential = g.add(straight, twisting);
    let rotation = e.map(|component| g.scale(2.0, component));
    if let Some([force, moment]) = stiffness.full_times(g, displacement, rotation) {
        pull = space::add(g, pull, force);
        let moment_here = conjugate(g, q[0], e, moment);
        torque = space::add(g, torque, moment_here);
        let (straight, twisting) = (space::dot(g, displacement, force), space::dot(g, rotation, moment));
        let doubled = g.add(straight, twisting);
        let stored = g.scale(0.5, doubled);
        potential = g.add(potential, stored);
    }
    if let Some([force, moment]) = damping.full_times(g, rate, spin) {
        pull = space::add(g, pull, force);
        torque = space::add(g, torque, moment);
    }
    let pull = in_ground(g, axes, pull);
    let there = m.carried_along(g, first.body, second.position);
    loads.add_force_pair(g, &second, &there, pull);
    let torque = in_ground(g, axes, torque);
    loads.add_torque_pair(g, second.body, first.body, torque);
    if stiffness.is_symmetric() {
        loads.add_potential(g, m, &stiffness.coefficients(), potential);
    }
    Ok(())
}

/// The torque q₀ y + e × y that does the work y · d(2 e).
fn conjugate(g: &Builder, q0: Expr, e: Vector, y: Vector) -> Vector {
    let (straight, across) = (space::scale(g, q0, y), space::cross(g, e, y));
    space::add(g, straight, across)
}

/// Component by component.
fn weighted(g: &Builder, weights: Vector, a: Vector) -> Vector {
    std::array::from_fn(|i| g.mul(weights[i], a[i]))
}

/// A vector along given axes.
fn in_ground(g: &Builder, axes: [Vector; 3], a: Vector) -> Vector {
    let mut sum = space::zero(g);
    for (axis, component) in axes.into_iter().zip(a) {
        let part = space::scale(g, component, axis);
        sum = space::add(g, sum, part);
    }
    sum
}
