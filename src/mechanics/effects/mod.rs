//! Applied forces, one file each.
//!
//! An effect adds forces and torques on bodies, and potential energy where it has one. Their generalised forces follow
//! from virtual power: Σ Qᵢ vᵢ = F · ṙ + τ θ̇ for every motion, which [`Loads`] sees to. Values may depend on
//! parameters, t, positions, velocities and reactions.
//!
//! To add an effect: its file here, its variant in [`EffectKind`], its line in [`apply`].

mod force;
mod gravity;
mod spring_damper;
mod torque;
mod torsional_spring_damper;

use std::collections::BTreeSet;

use symdiff::{Expr, Graph};

use crate::model::EffectKind;

use super::body::{ANGLE, FREEDOMS, MaterialPoint};
use super::error::BuildError;
use super::mechanism::Mechanism;
use super::plane::{self, Vector};

/// Applies an effect.
pub fn apply(g: &mut Graph, m: &Mechanism, loads: &mut Loads, kind: &EffectKind) -> Result<(), BuildError> {
    match kind {
        EffectKind::Gravity { acceleration } => gravity::apply(g, m, loads, acceleration),
        EffectKind::Force { on, value, in_body } => force::apply(g, m, loads, *on, value, *in_body),
        EffectKind::Torque { on, from, value } => torque::apply(g, m, loads, *on, *from, value),
        EffectKind::SpringDamper { between, along, stiffness, damping, free_length } => {
            let spring = spring_damper::Spring { stiffness, damping, free_length };
            spring_damper::apply(g, m, loads, *between, along.as_ref(), spring)
        }
        EffectKind::TorsionalSpringDamper { between, stiffness, damping, free_angle } => {
            torsional_spring_damper::apply(g, m, loads, *between, stiffness, damping, free_angle)
        }
    }
}

/// The forces on all bodies.
pub struct Loads {
    /// Generalised forces on x, y and θ of each body, held ones included: N, N, N m.
    pub bodies: Vec<[Expr; FREEDOMS]>,
    /// Potential energies, J.
    pub potentials: Vec<Expr>,
    /// (body, freedom) of the generalised forces added to since this was last cleared.
    pub touched: BTreeSet<(usize, usize)>,
}

impl Loads {
    /// No forces.
    pub fn new(g: &mut Graph, bodies: usize) -> Self {
        Self { bodies: vec![[g.constant(0.0); FREEDOMS]; bodies], potentials: Vec::new(), touched: BTreeSet::new() }
    }

    /// A force at a point: (Fₓ, F_y, R s × F).
    pub fn add_force(&mut self, g: &mut Graph, at: &MaterialPoint, force: Vector) {
        let moment = plane::cross(g, at.arm, force);
        for (freedom, part) in [force[0], force[1], moment].into_iter().enumerate() {
            self.add(g, at.body, freedom, part);
        }
    }

    /// A force at `to` and its opposite at `from`.
    pub fn add_force_pair(&mut self, g: &mut Graph, from: &MaterialPoint, to: &MaterialPoint, force: Vector) {
        self.add_force(g, to, force);
        let opposite = plane::neg(g, force);
        self.add_force(g, from, opposite);
    }

    /// A torque on `on` and its opposite on `from`.
    pub fn add_torque_pair(&mut self, g: &mut Graph, from: usize, on: usize, torque: Expr) {
        self.add(g, on, ANGLE, torque);
        let opposite = g.neg(torque);
        self.add(g, from, ANGLE, opposite);
    }

    fn add(&mut self, g: &mut Graph, body: usize, freedom: usize, part: Expr) {
        if !g.is_zero(part) {
            let total = &mut self.bodies[body][freedom];
            *total = g.add(*total, part);
            self.touched.insert((body, freedom));
        }
    }

    /// A potential energy, if it is one: `coefficients` that depend on the motion leave none whose gradient is the
    /// force.
    pub fn add_potential(&mut self, g: &Graph, m: &Mechanism, coefficients: &[Expr], potential: Expr) {
        let fixed =
            |symbol: &Expr| *symbol == m.time || m.uncertain.iter().any(|parameter| parameter.symbol == *symbol);
        if g.symbols_of(coefficients).iter().all(fixed) {
            self.potentials.push(potential);
        }
    }
}
