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
//! by φ about an axis K_t sin φ: a bushing is no spring for full turns. Where a stiffness depends on the motion there is no
//! potential and none is counted.

use symdiff::{Formula, Graph};

use crate::mechanics::error::BuildError;
use crate::mechanics::joints::Pair;
use crate::mechanics::mechanism::{Context, Mechanism};
use crate::mechanics::rotation;
use crate::mechanics::space::{self, Vector};
use crate::model::PointRef;

use super::Loads;

pub fn apply(
    g: &mut Graph,
    m: &Mechanism,
    loads: &mut Loads,
    between: [PointRef; 2],
    [stiffness, damping]: [&[Formula; 3]; 2],
    [torsional_stiffness, torsional_damping]: [&[Formula; 3]; 2],
) -> Result<(), BuildError> {
    let stiffness = m.vector(g, stiffness, Context::Motion)?;
    let damping = m.vector(g, damping, Context::Motion)?;
    let torsional_stiffness = m.vector(g, torsional_stiffness, Context::Motion)?;
    let torsional_damping = m.vector(g, torsional_damping, Context::Motion)?;
    let pair = Pair::of(g, m, between);
    let axes: [Vector; 3] = std::array::from_fn(|axis| {
        let unit = space::along(g, axis);
        pair.outward(g, unit)
    });
    let (first, second) = (pair.first.point, pair.second.point);
    let omega = [first, second].map(|point| m.bodies[point.body].angular_velocity(g));
    let turning = space::sub(g, omega[1], omega[0]);

    let offset = pair.offset(g);
    let carried = space::cross(g, omega[0], offset);
    let rate = space::sub(g, second.velocity, first.velocity);
    let rate = space::sub(g, rate, carried);
    let displacement = axes.map(|axis| space::dot(g, axis, offset));
    let elastic = weighted(g, stiffness, displacement);
    let doubled = space::dot(g, displacement, elastic);
    let rate = axes.map(|axis| space::dot(g, axis, rate));
    let viscous = weighted(g, damping, rate);
    let pull = space::add(g, elastic, viscous);
    let pull = in_ground(g, axes, pull);
    let there = m.carried_along(g, first.body, second.position);
    loads.add_force_pair(g, &second, &there, pull);

    let q = pair.relative(g);
    let e = rotation::vector_part(q);
    let twisted = weighted(g, torsional_stiffness, e);
    let (straight, across) = (space::scale(g, q[0], twisted), space::cross(g, e, twisted));
    let half = space::add(g, straight, across);
    let elastic = half.map(|component| g.scale(2.0, component));
    let rate = axes.map(|axis| space::dot(g, axis, turning));
    let viscous = weighted(g, torsional_damping, rate);
    let torque = space::add(g, elastic, viscous);
    let torque = in_ground(g, axes, torque);
    loads.add_torque_pair(g, second.body, first.body, torque);

    let halved = space::dot(g, e, twisted);
    let (straight, twisting) = (g.scale(0.5, doubled), g.scale(2.0, halved));
    let potential = g.add(straight, twisting);
    loads.add_potential(g, m, &[stiffness, torsional_stiffness].concat(), potential);
    Ok(())
}

/// Component by component.
fn weighted(g: &mut Graph, weights: Vector, a: Vector) -> Vector {
    std::array::from_fn(|i| g.mul(weights[i], a[i]))
}

/// A vector along given axes.
fn in_ground(g: &mut Graph, axes: [Vector; 3], a: Vector) -> Vector {
    let mut sum = space::zero(g);
    for (axis, component) in axes.into_iter().zip(a) {
        let part = space::scale(g, component, axis);
        sum = space::add(g, sum, part);
    }
    sum
}
