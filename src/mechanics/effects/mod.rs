//! Applied forces, one file each.
//!
//! An effect adds forces and torques on bodies, and potential energy where it has one. Their generalised forces follow
//! from virtual power: Σ Qᵢ vᵢ = F · ṙ + τ · ω for every motion, which [`Loads`] sees to. Values may depend on
//! parameters, t, positions, velocities and reactions.
//!
//! To add an effect: its file here, its variant in [`EffectKind`], its line in [`apply`].

mod bushing;
mod force;
mod gravity;
mod spring_damper;
mod torque;
mod torsional_spring_damper;

use std::collections::{BTreeMap, BTreeSet};

use symdiff::{Expr, Graph};

use crate::model::{EffectKind, JointCoordinate};

use super::body::{EULER, FREEDOMS, MaterialPoint, Turn};
use super::error::BuildError;
use super::joints;
use super::mechanism::Mechanism;
use super::space::{self, Vector};

/// Applies an effect.
pub fn apply(g: &mut Graph, m: &Mechanism, loads: &mut Loads, kind: &EffectKind) -> Result<(), BuildError> {
    match kind {
        EffectKind::Gravity { acceleration } => gravity::apply(g, m, loads, acceleration),
        EffectKind::Force { on, value, in_body } => force::apply(g, m, loads, *on, value, *in_body),
        EffectKind::Torque { on, from, value, in_body } => torque::apply(g, m, loads, *on, *from, value, *in_body),
        EffectKind::JointTorque { joint, value } => torque::apply_at_joint(g, m, loads, *joint, value),
        EffectKind::SpringDamper { between, along, stiffness, damping, free_length } => {
            let spring = spring_damper::Spring { stiffness, damping, free_length };
            spring_damper::apply(g, m, loads, *between, along.as_ref(), spring)
        }
        EffectKind::TorsionalSpringDamper { on, stiffness, damping, free_angle } => {
            torsional_spring_damper::apply(g, m, loads, *on, stiffness, damping, free_angle)
        }
        EffectKind::Bushing { between, stiffness, damping, torsional_stiffness, torsional_damping } => {
            let straight = [stiffness, damping];
            bushing::apply(g, m, loads, *between, straight, [torsional_stiffness, torsional_damping])
        }
    }
}

/// What is added to: a component of a body's force or torque (0 to 5), or a joint's own coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Body(usize, usize),
    Coordinate(usize),
}

/// The forces on all bodies.
pub struct Loads {
    /// Force on each body, and torque about its frame's origin, in the ground's axes: N, N m.
    bodies: Vec<[Expr; 6]>,
    /// Generalised forces on joints' own coordinates, by their place in q.
    coordinates: BTreeMap<usize, Expr>,
    /// Potential energies, J.
    pub potentials: Vec<Expr>,
    /// What was added to since the last [`Loads::begin`].
    touched: BTreeSet<Target>,
}

impl Loads {
    /// No forces.
    pub fn new(g: &mut Graph, bodies: usize) -> Self {
        let zero = g.constant(0.0);
        let (coordinates, potentials, touched) = (BTreeMap::new(), Vec::new(), BTreeSet::new());
        Self { bodies: vec![[zero; 6]; bodies], coordinates, potentials, touched }
    }

    /// The next effect begins.
    pub fn begin(&mut self) {
        self.touched.clear();
    }

    /// Number of coordinates that the effect acts on.
    pub fn coordinates_touched(&self, m: &Mechanism) -> usize {
        let mut moved = BTreeSet::new();
        for &target in &self.touched {
            match target {
                Target::Coordinate(index) => {
                    moved.insert(index);
                }
                Target::Body(body, component) => {
                    let body = &m.bodies[body];
                    let freedoms = match (component, body.turn) {
                        (0..3, _) => component..component + 1,
                        (5, Turn::Angle) => EULER..EULER + 1,
                        (_, Turn::Angle) => 0..0,
                        (_, Turn::Euler) => EULER..FREEDOMS,
                    };
                    moved.extend(body.index[freedoms].iter().flatten());
                }
            }
        }
        moved.len()
    }

    /// Generalised forces on all coordinates.
    pub fn generalised(&self, g: &mut Graph, m: &Mechanism) -> Vec<Expr> {
        let mut force = vec![g.constant(0.0); m.q.len()];
        for (body, &[fx, fy, fz, tx, ty, tz]) in m.bodies.iter().zip(&self.bodies) {
            let parts = body.generalised(g, [fx, fy, fz], [tx, ty, tz]);
            for (index, part) in body.index.iter().zip(parts) {
                if let Some(row) = *index {
                    force[row] = part;
                }
            }
        }
        for (&row, &part) in &self.coordinates {
            force[row] = part;
        }
        force
    }

    /// A force at a point: F, and R s × F about the origin.
    pub fn add_force(&mut self, g: &mut Graph, at: &MaterialPoint, force: Vector) {
        let moment = space::cross(g, at.arm, force);
        for (component, part) in force.into_iter().chain(moment).enumerate() {
            self.add(g, at.body, component, part);
        }
    }

    /// A force at `to` and its opposite at `from`.
    pub fn add_force_pair(&mut self, g: &mut Graph, from: &MaterialPoint, to: &MaterialPoint, force: Vector) {
        self.add_force(g, to, force);
        let opposite = space::neg(g, force);
        self.add_force(g, from, opposite);
    }

    /// A torque on `on` and its opposite on `from`.
    pub fn add_torque_pair(&mut self, g: &mut Graph, from: usize, on: usize, torque: Vector) {
        let opposite = space::neg(g, torque);
        for (body, torque) in [(on, torque), (from, opposite)] {
            for (axis, part) in torque.into_iter().enumerate() {
                self.add(g, body, 3 + axis, part);
            }
        }
    }

    /// A torque about a joint's axis on its second body and the opposite on its first: on the joint's angle, where that is
    /// a coordinate of its own.
    pub fn add_joint_torque(
        &mut self,
        g: &mut Graph,
        m: &Mechanism,
        joint: usize,
        torque: Expr,
    ) -> Result<(), BuildError> {
        if let Some(&index) = m.joint_coordinates.get(&(joint, JointCoordinate::Angle)) {
            if !g.is_zero(torque) {
                let zero = g.constant(0.0);
                let total = self.coordinates.entry(index).or_insert(zero);
                *total = g.add(*total, torque);
                self.touched.insert(Target::Coordinate(index));
            }
            return Ok(());
        }
        let axis = joints::axis_in_ground(g, m, joint, JointCoordinate::Angle)?;
        let torque = space::scale(g, torque, axis);
        if let Some([first, second]) = m.description.joints[joint].kind.between() {
            self.add_torque_pair(g, first.body, second.body, torque);
        }
        Ok(())
    }

    fn add(&mut self, g: &mut Graph, body: usize, component: usize, part: Expr) {
        if !g.is_zero(part) {
            let total = &mut self.bodies[body][component];
            *total = g.add(*total, part);
            self.touched.insert(Target::Body(body, component));
        }
    }

    /// A potential energy, if it is one: `coefficients` that depend on the motion leave none whose gradient is the
    /// force.
    pub fn add_potential(&mut self, g: &Graph, m: &Mechanism, coefficients: &[Expr], potential: Expr) {
        if m.is_given(g, coefficients) {
            self.potentials.push(potential);
        }
    }
}
