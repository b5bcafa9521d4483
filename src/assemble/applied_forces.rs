//! The sum of the forces on a mechanism.
//!
//! Generalised forces follow from virtual power: Σ Qᵢ vᵢ = F · ṙ + τ · ω for every motion. Values may depend on
//! parameters, t, positions, velocities and reactions.

use std::collections::{BTreeMap, BTreeSet};

use symdiff::{Builder, Expr};

use super::body::{DEGREES_OF_FREEDOM, EULER, MaterialPoint, RotationCoordinates};
use super::error::BuildError;
use super::joints;
use super::mechanism::Mechanism;
use super::space::{self, Vector};
use crate::grammar::{JointCoordinate, OnJoint, Sensor};

/// What is added to: a component of a body's force or torque (0 to 5), or a joint's own coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Body(usize, usize),
    Coordinate(usize),
}

/// The forces on all bodies.
#[derive(Clone)]
pub struct AppliedForces {
    /// Force on each body, and torque about its frame's origin, in the ground's axes: N, N m.
    bodies: Vec<[Expr; 6]>,
    /// Generalised forces on joints' own coordinates, by their place in q.
    coordinates: BTreeMap<usize, Expr>,
    /// The acceleration that gives carried bodies their weight, in the ground's axes, m/s².
    pub field: Vector,
    /// Potential energies, J.
    pub potentials: Vec<Expr>,
    /// What was added to since the last [`AppliedForces::begin`].
    touched: BTreeSet<Target>,
    /// What was measured since then.
    measured: Vec<(Sensor, Expr)>,
    /// The condition of what is added now, if it has one.
    guard: Option<Expr>,
    /// What acts only where a condition is positive.
    guarded: Vec<(Expr, Target, Expr)>,
}

impl AppliedForces {
    /// No forces.
    pub fn new(g: &Builder, bodies: usize) -> Self {
        let zero = g.constant(0.0);
        let (coordinates, potentials, touched) = (BTreeMap::new(), Vec::new(), BTreeSet::new());
        Self {
            bodies: vec![[zero; 6]; bodies],
            coordinates,
            field: [zero; 3],
            potentials,
            touched,
            measured: Vec::new(),
            guard: None,
            guarded: Vec::new(),
        }
    }

    /// The next effect begins.
    pub fn begin(&mut self) {
        self.touched.clear();
        self.measured.clear();
        self.guard = None;
    }

    /// What the effect adds from now on acts only where `condition` is positive, whatever its expressions are elsewhere, and is
    /// not computed where no sample of a tile needs it. It vanishes steadily as the condition does.
    pub fn only_where(&mut self, condition: Expr) {
        self.guard = Some(condition);
    }

    /// The conditions under which something acts.
    pub fn conditions(&self) -> Vec<Expr> {
        let mut conditions: Vec<Expr> = self.guarded.iter().map(|&(condition, ..)| condition).collect();
        conditions.dedup();
        conditions
    }

    /// All that acts, each under its condition.
    pub fn with_guarded(&self, g: &Builder) -> Self {
        let mut all = Self { guarded: Vec::new(), guard: None, ..self.clone() };
        for &(condition, target, part) in &self.guarded {
            let total = all.total(g, target);
            let more = g.add(*total, part);
            *total = g.select(condition, more, *total);
        }
        all
    }

    /// What acts under conditions alone.
    pub fn guarded(&self, g: &Builder) -> Self {
        let guarded = self.guarded.clone();
        Self { guarded, ..Self::new(g, self.bodies.len()) }.with_guarded(g)
    }

    /// Something that the effect measures, for outputs.
    pub fn sensor(&mut self, measure: Sensor, value: Expr) {
        self.measured.push((measure, value));
    }

    /// What the effect measures.
    pub fn measured(&self) -> &[(Sensor, Expr)] {
        &self.measured
    }

    /// Number of coordinates that the effect acts on.
    pub fn coordinates_touched(&self, m: &Mechanism) -> usize {
        let mut moved = BTreeSet::new();
        for &target in &self.touched {
            match target {
                Target::Coordinate(index) => {
                    moved.insert(index);
                }
                Target::Body(mut index, component) => {
                    while let Some(carried) = &m.bodies[index].carried {
                        moved.extend(carried.dofs.iter().map(|dof| dof.index));
                        index = carried.parent;
                    }
                    let body = &m.bodies[index];
                    let dofs = match (component, body.turn) {
                        (0..3, _) => component..component + 1,
                        (5, RotationCoordinates::Angle) => EULER..EULER + 1,
                        (_, RotationCoordinates::Angle) => 0..0,
                        (_, RotationCoordinates::Euler) => EULER..DEGREES_OF_FREEDOM,
                    };
                    moved.extend(body.index[dofs].iter().flatten());
                }
            }
        }
        moved.len()
    }

    /// Forces and torques on all bodies, and on each what acts on the bodies that it carries too.
    pub fn carried_on(&self, g: &Builder, m: &Mechanism) -> Vec<[Expr; 6]> {
        let mut totals = self.bodies.clone();
        for &index in m.tree.order.iter().rev() {
            let Some(carried) = &m.bodies[index].carried else { continue };
            let [fx, fy, fz, tx, ty, tz] = totals[index];
            let arm = space::sub(g, m.bodies[index].origin(), m.bodies[carried.parent].origin());
            let moment = space::cross(g, arm, [fx, fy, fz]);
            let torque = space::add(g, [tx, ty, tz], moment);
            for (total, part) in totals[carried.parent].iter_mut().zip([fx, fy, fz].into_iter().chain(torque)) {
                *total = g.add(*total, part);
            }
        }
        totals
    }

    /// Generalised forces on all coordinates.
    pub fn generalised(&self, g: &Builder, m: &Mechanism) -> Vec<Expr> {
        let mut force = vec![g.constant(0.0); m.q.len()];
        for (body, &[fx, fy, fz, tx, ty, tz]) in m.bodies.iter().zip(&self.carried_on(g, m)) {
            if let Some(carried) = &body.carried {
                let axis = body.rotate(g, carried.axis[0]);
                let foot = body.rotate(g, carried.foot);
                let moment = space::cross(g, foot, [fx, fy, fz]);
                let at_joint = space::sub(g, [tx, ty, tz], moment);
                let (about, along) = (space::dot(g, axis, at_joint), space::dot(g, axis, [fx, fy, fz]));
                for dof in &carried.dofs {
                    let (turn, slide) = (g.mul(dof.turn, about), g.mul(dof.slide, along));
                    force[dof.index] = g.add(turn, slide);
                }
                continue;
            }
            let parts = body.generalised(g, [fx, fy, fz], [tx, ty, tz]);
            for (index, part) in body.index.iter().zip(parts) {
                if let Some(row) = *index {
                    force[row] = part;
                }
            }
        }
        for (&row, &part) in &self.coordinates {
            force[row] = g.add(force[row], part);
        }
        force
    }

    /// A force at a point: F, and R s × F about the origin.
    pub fn add_force(&mut self, g: &Builder, at: &MaterialPoint, force: Vector) {
        let moment = space::cross(g, at.arm, force);
        for (component, part) in force.into_iter().chain(moment).enumerate() {
            self.add(g, at.body, component, part);
        }
    }

    /// A body's weight at its centre of mass. A carried body's is left to the field.
    pub fn add_weight(&mut self, g: &Builder, m: &Mechanism, center: &MaterialPoint, weight: Vector) {
        if m.bodies[center.body].carried.is_none() {
            self.add_force(g, center, weight);
            return;
        }
        let felt = (0..3).filter(|&axis| !g.is_zero(weight[axis]));
        self.touched.extend(felt.map(|axis| Target::Body(center.body, axis)));
    }

    /// A uniform field of acceleration, m/s² in the ground's axes, on all carried bodies.
    pub fn add_field(&mut self, g: &Builder, acceleration: Vector) {
        self.field = space::add(g, self.field, acceleration);
    }

    /// A force at `to` and its opposite at `from`.
    pub fn add_force_pair(&mut self, g: &Builder, from: &MaterialPoint, to: &MaterialPoint, force: Vector) {
        self.add_force(g, to, force);
        let opposite = space::neg(g, force);
        self.add_force(g, from, opposite);
    }

    /// A torque on `on` and its opposite on `from`.
    pub fn add_torque_pair(&mut self, g: &Builder, from: usize, on: usize, torque: Vector) {
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
        g: &Builder,
        m: &Mechanism,
        joint: usize,
        torque: Expr,
    ) -> Result<(), BuildError> {
        if self.add_to_coordinate(g, m, OnJoint { joint, coordinate: JointCoordinate::Angle }, torque) {
            return Ok(());
        }
        let axis = joints::axis_in_ground(g, m, joint, JointCoordinate::Angle)?;
        let torque = space::scale(g, torque, axis);
        if let Some([first, second]) = m.description.joints[joint].kind.between() {
            self.add_torque_pair(g, first.body, second.body, torque);
        }
        Ok(())
    }

    /// A force along a joint's axis on its second body at the second point, and the opposite on its first at the same
    /// place: on the joint's displacement, where that is a coordinate of its own.
    pub fn add_joint_force(&mut self, g: &Builder, m: &Mechanism, joint: usize, force: Expr) -> Result<(), BuildError> {
        if self.add_to_coordinate(g, m, OnJoint { joint, coordinate: JointCoordinate::Displacement }, force) {
            return Ok(());
        }
        let axis = joints::axis_in_ground(g, m, joint, JointCoordinate::Displacement)?;
        let force = space::scale(g, force, axis);
        if let Some([first, second]) = m.description.joints[joint].kind.between() {
            let at = m.point(g, second);
            let there = m.carried_along(g, first.body, at.position);
            self.add_force_pair(g, &there, &at, force);
        }
        Ok(())
    }

    /// Whether the joint's coordinate is one of its own, which the force then acts on.
    fn add_to_coordinate(&mut self, g: &Builder, m: &Mechanism, on: OnJoint, force: Expr) -> bool {
        let Some(&index) = m.joint_coordinates.get(&(on.joint, on.coordinate)) else { return false };
        self.add_to(g, Target::Coordinate(index), force);
        true
    }

    fn total(&mut self, g: &Builder, target: Target) -> &mut Expr {
        match target {
            Target::Body(body, component) => &mut self.bodies[body][component],
            Target::Coordinate(index) => self.coordinates.entry(index).or_insert_with(|| g.constant(0.0)),
        }
    }

    fn add_to(&mut self, g: &Builder, target: Target, part: Expr) {
        if g.is_zero(part) {
            return;
        }
        self.touched.insert(target);
        match self.guard {
            Some(condition) => self.guarded.push((condition, target, part)),
            None => {
                let total = self.total(g, target);
                *total = g.add(*total, part);
            }
        }
    }

    fn add(&mut self, g: &Builder, body: usize, component: usize, part: Expr) {
        self.add_to(g, Target::Body(body, component), part);
    }

    /// A potential energy, if it is one: `coefficients` that depend on the motion leave none whose gradient is the
    /// force.
    pub fn add_potential(&mut self, g: &Builder, m: &Mechanism, coefficients: &[Expr], potential: Expr) {
        if m.is_given(g, coefficients) {
            self.potentials.push(potential);
        }
    }
}
