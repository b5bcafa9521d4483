//! The sum of the forces on a mechanism.
//!
//! Generalised forces follow from virtual power: Σ Qᵢ vᵢ = F · ṙ + τ · ω for every motion. Values may depend on
//! parameters, t, positions, velocities and reactions.

use std::collections::{BTreeMap, BTreeSet};

use symdiff::{Builder, Scalar};

use super::mechanism::Mechanism;
use super::thrust::Thrust;
use crate::grammar::{JointCoordinate, OnJoint, Sensor};
use crate::multibody::{
    AxisMotion, BuildError, DEGREES_OF_FREEDOM, EULER, MaterialPoint, RotationCoordinates, Vector, Wrench,
};

/// Target of a force: a component of a body's wrench (0 to 5), or a coordinate of its own: of a joint, a mode, a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Body(usize, usize),
    Coordinate(usize),
}

/// Something acts only where both are positive; `within` is cheap to compute.
#[derive(Clone, Copy)]
struct Guard<'g> {
    within: Option<Scalar<'g>>,
    condition: Scalar<'g>,
}

/// A part of a force that acts only where a condition is positive.
#[derive(Clone, Copy)]
struct Guarded<'g> {
    guard: Guard<'g>,
    target: Target,
    part: Scalar<'g>,
}

/// The forces on all bodies.
#[derive(Clone)]
pub struct AppliedForces<'g> {
    g: &'g Builder,
    /// Wrench on each body, about its frame's origin, in the ground's axes.
    bodies: Vec<Wrench<'g>>,
    /// Generalised forces on coordinates of joints, modes and states, by their index in q.
    coordinates: BTreeMap<usize, Scalar<'g>>,
    /// The acceleration that gives children their weight, in the ground's axes, m/s².
    pub field: Vector<'g>,
    /// Potential energies, J.
    pub potentials: Vec<Scalar<'g>>,
    /// States that change at instants only: the effect, the index among its states, and the new value.
    pub sampled: Vec<((usize, usize), Scalar<'g>)>,
    /// Targets added to since the last [`AppliedForces::begin`].
    touched: BTreeSet<Target>,
    /// Sensor values recorded since then.
    measured: Vec<(Sensor, Scalar<'g>)>,
    /// Forces at points since then.
    thrusts: Vec<Thrust<'g>>,
    /// Room of the effect at the start.
    pub room: Option<Scalar<'g>>,
    /// The gap of its surfaces, and how deep they may overlap.
    pub overlap: Option<(Scalar<'g>, Scalar<'g>)>,
    /// The condition of the terms that are added now, if they have one.
    guard: Option<Guard<'g>>,
    /// Parts of forces that act under conditions.
    guarded: Vec<Guarded<'g>>,
}

impl<'g> AppliedForces<'g> {
    /// No forces.
    pub fn new(g: &'g Builder, bodies: usize) -> Self {
        Self {
            g,
            bodies: vec![Wrench::zero(g); bodies],
            coordinates: BTreeMap::new(),
            field: Vector::zero(g),
            potentials: Vec::new(),
            sampled: Vec::new(),
            touched: BTreeSet::new(),
            measured: Vec::new(),
            thrusts: Vec::new(),
            room: None,
            overlap: None,
            guard: None,
            guarded: Vec::new(),
        }
    }

    /// The next effect begins.
    pub fn begin(&mut self) {
        self.touched.clear();
        self.measured.clear();
        self.thrusts.clear();
        self.room = None;
        self.overlap = None;
        self.guard = None;
    }

    /// Makes everything that the effect adds from now on act only where `condition` is positive, whatever its
    /// expressions are elsewhere; it is not computed where no sample of a tile needs it. It vanishes continuously as
    /// the condition does.
    pub fn only_where(&mut self, condition: Scalar<'g>) {
        self.guard = Some(Guard { within: None, condition });
    }

    /// The same, and where `within` is not positive the condition itself is not computed.
    pub fn only_within(&mut self, within: Scalar<'g>, condition: Scalar<'g>) {
        self.guard = Some(Guard { within: Some(within), condition });
    }

    /// The conditions under which something acts.
    pub fn conditions(&self) -> Vec<Scalar<'g>> {
        let mut conditions: Vec<_> =
            self.guarded.iter().map(|Guarded { guard, .. }| guard.within.unwrap_or(guard.condition)).collect();
        conditions.dedup();
        conditions
    }

    /// All forces, each under its condition.
    pub fn with_guarded(&self) -> Self {
        let mut all = Self { guarded: Vec::new(), guard: None, ..self.clone() };
        for &Guarded { guard: Guard { within, condition }, target, part } in &self.guarded {
            let total = all.total(target);
            let more = condition.select(*total + part, *total);
            *total = within.map_or(more, |within| within.select(more, *total));
        }
        all
    }

    /// Only the forces that act under conditions.
    pub fn guarded(&self) -> Self {
        let guarded = self.guarded.clone();
        Self { guarded, ..Self::new(self.g, self.bodies.len()) }.with_guarded()
    }

    /// Adds a quantity that the effect measures, for outputs.
    pub fn sensor(&mut self, measure: Sensor, value: Scalar<'g>) {
        self.measured.push((measure, value));
    }

    /// Quantities that the effect measures, with their values.
    pub fn measured(&self) -> &[(Sensor, Scalar<'g>)] {
        &self.measured
    }

    /// Notes a force at a point, whose opposite is at `from` if it is inside of the mechanism.
    pub fn note_thrust(&mut self, from: Option<&MaterialPoint<'g>>, to: &MaterialPoint<'g>, force: Vector<'g>) {
        let condition = self.guard.map(|guard| guard.condition);
        let thrust = match from {
            Some(from) if to.body == 0 => {
                Thrust { bodies: [to.body, from.body], at: from.position, force: -force, condition }
            }
            _ => Thrust { bodies: [from.map_or(0, |from| from.body), to.body], at: to.position, force, condition },
        };
        self.thrusts.push(thrust);
    }

    /// The forces at points.
    pub fn thrusts(&self) -> &[Thrust<'g>] {
        &self.thrusts
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
                    while let Some(motion) = &m.bodies[index].relative_motion {
                        moved.extend(motion.dofs.iter().map(|dof| dof.index));
                        index = motion.parent;
                    }
                    let body = &m.bodies[index];
                    let dofs = match (component, body.rotation_coordinates) {
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

    /// The wrench on each body, about its frame's origin, without forces that act under conditions.
    pub fn wrenches(&self) -> &[Wrench<'g>] {
        &self.bodies
    }

    /// Generalised forces on coordinates of joints, modes and states, by their index in q.
    pub fn efforts(&self) -> impl Iterator<Item = (usize, Scalar<'g>)> {
        self.coordinates.iter().map(|(&index, &effort)| (index, effort))
    }

    /// The wrench on each body, including those on its children, and on theirs.
    pub fn with_children(&self, m: &Mechanism<'g, '_>) -> Vec<Wrench<'g>> {
        let mut totals = self.bodies.clone();
        for &index in m.tree.order.iter().rev() {
            let Some(motion) = &m.bodies[index].relative_motion else { continue };
            let Wrench { force, torque } = totals[index];
            let arm = m.bodies[index].origin() - m.bodies[motion.parent].origin();
            let moment = arm.cross(force);
            totals[motion.parent] += Wrench { force, torque: torque + moment };
        }
        totals
    }

    /// Generalised forces on all coordinates.
    pub fn generalised(&self, m: &Mechanism<'g, '_>) -> Vec<Scalar<'g>> {
        let mut force = vec![self.g.number(0.0); m.q.len()];
        for (body, wrench) in m.bodies.iter().zip(self.with_children(m)) {
            if let Some(motion) = &body.relative_motion {
                let (about, along) = match (motion.rotations.as_slice(), motion.translations.as_slice()) {
                    ([rotation], [translation]) => {
                        let [about, along] = [rotation, translation].map(|axis| body.rotate(axis.in_child));
                        let at_joint = wrench.torque_about(body.rotate(motion.outboard_in_child));
                        (vec![about.dot(at_joint)], vec![along.dot(wrench.force)])
                    }
                    // The forces are turned where axes are many.
                    (rotations, translations) => {
                        let inward = body.matrix().transposed();
                        let torque = inward * wrench.torque_about(body.rotate(motion.outboard_in_child));
                        let force = inward * wrench.force;
                        let parts = |axes: &[AxisMotion<'g>], of: Vector<'g>| {
                            axes.iter().map(|axis| axis.in_child.dot(of)).collect()
                        };
                        (parts(rotations, torque), parts(translations, force))
                    }
                };
                for (row, part) in motion.generalised(about, along) {
                    force[row] = part;
                }
                continue;
            }
            for (index, part) in body.index.iter().zip(body.generalised(wrench)) {
                if let Some(row) = *index {
                    force[row] = part;
                }
            }
        }
        for (&row, &part) in &self.coordinates {
            force[row] += part;
        }
        force
    }

    /// A force at a point: F, and R s × F about the origin.
    pub fn add_force(&mut self, at: &MaterialPoint<'g>, force: Vector<'g>) {
        let moment = at.arm.cross(force);
        for (component, part) in force.components().into_iter().chain(moment.components()).enumerate() {
            self.add(Target::Body(at.body, component), part);
        }
    }

    /// A body's weight at its centre of mass. A child's is left to the field.
    pub fn add_weight(&mut self, m: &Mechanism, center: &MaterialPoint<'g>, weight: Vector<'g>) {
        if !m.bodies[center.body].is_child() {
            self.add_force(center, weight);
            return;
        }
        let felt = (0..3).filter(|&axis| !weight[axis].is_zero());
        self.touched.extend(felt.map(|axis| Target::Body(center.body, axis)));
    }

    /// A uniform field of acceleration, m/s² in the ground's axes, on all children.
    pub fn add_field(&mut self, acceleration: Vector<'g>) {
        self.field += acceleration;
    }

    /// A force at `to` and its opposite at `from`.
    pub fn add_force_pair(&mut self, from: &MaterialPoint<'g>, to: &MaterialPoint<'g>, force: Vector<'g>) {
        self.add_force(to, force);
        self.add_force(from, -force);
    }

    /// A torque on `on` and its opposite on `from`.
    pub fn add_torque_pair(&mut self, from: usize, on: usize, torque: Vector<'g>) {
        for (body, torque) in [(on, torque), (from, -torque)] {
            for (axis, part) in torque.components().into_iter().enumerate() {
                self.add(Target::Body(body, 3 + axis), part);
            }
        }
    }

    /// Adds a torque about a joint's axis on its second body and the opposite on its first, or a force along it at the
    /// second point and the opposite on the first body at the same position; on the joint's coordinate, if the
    /// mechanism has that coordinate.
    pub fn add_joint_effort(
        &mut self,
        m: &Mechanism<'g, '_>,
        on: OnJoint,
        effort: Scalar<'g>,
    ) -> Result<(), BuildError> {
        if let Some(&index) = m.joint_coordinates.get(&(on.joint, on.coordinate)) {
            self.add(Target::Coordinate(index), effort);
            return Ok(());
        }
        let effort = effort * m.axis_in_ground(on)?;
        let Some([first, second]) = m.joints[on.joint].kind.between() else { return Ok(()) };
        match on.coordinate {
            JointCoordinate::Angle => self.add_torque_pair(first.body, second.body, effort),
            JointCoordinate::Displacement => {
                let at = m.point(second);
                let there = m.point_now_at(first.body, at.position);
                self.add_force_pair(&there, &at, effort);
            }
        }
        Ok(())
    }

    /// Generalised force on coordinate `index` of q, or the rate of a state.
    pub fn add_to_coordinate(&mut self, index: usize, part: Scalar<'g>) {
        self.add(Target::Coordinate(index), part);
    }

    /// A potential energy, if it is one: `coefficients` that depend on the motion leave none whose gradient is the
    /// force.
    pub fn add_potential(&mut self, m: &Mechanism<'g, '_>, coefficients: &[Scalar<'g>], potential: Scalar<'g>) {
        if m.is_given(coefficients) {
            self.potentials.push(potential);
        }
    }

    fn total(&mut self, target: Target) -> &mut Scalar<'g> {
        match target {
            Target::Body(body, component) => self.bodies[body].component_mut(component),
            Target::Coordinate(index) => self.coordinates.entry(index).or_insert_with(|| self.g.number(0.0)),
        }
    }

    fn add(&mut self, target: Target, part: Scalar<'g>) {
        if part.is_zero() {
            return;
        }
        self.touched.insert(target);
        match self.guard {
            Some(guard) => self.guarded.push(Guarded { guard, target, part }),
            None => *self.total(target) += part,
        }
    }
}
