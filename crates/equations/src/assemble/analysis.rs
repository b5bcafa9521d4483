//! The equations in the form that an analysis needs.

use std::borrow::Cow;

use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::System;
use super::system::{OutputInfo, Start};

impl System {
    /// Masses and forces of the equations of motion.
    pub fn of_motion(&self) -> Vec<Expr> {
        let mass = self.mass.iter().map(|&(_, _, value)| value);
        mass.chain(self.inertia.iter().chain(&self.force).copied()).collect()
    }

    /// Number of expressions that masses, forces and constraints consist of.
    pub fn length(&self) -> usize {
        let mut roots = self.of_motion();
        roots.extend(&self.constraint);
        self.graph.reachable(&roots).len()
    }

    /// Whether the time itself is in the equations of motion or in constraints.
    pub fn depends_on_time(&self) -> bool {
        let is_in = |roots: &[Expr]| self.graph.symbols_of(roots).contains(&self.time);
        is_in(&self.of_motion()) || is_in(&self.constraint)
    }

    /// The equations for a configuration at rest, in which states rest, too: each is represented by the position of its
    /// coordinate instead of its velocity, and its rate is the force on it; a state that changes at instants has its
    /// new value.
    pub fn at_rest(&self) -> Cow<'_, Self> {
        let states: Vec<usize> = (0..self.q.len()).filter(|&index| self.coordinates[index].is_state).collect();
        if states.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut system = self.clone();
        let graph = &mut system.graph;
        for sampled in &system.sampled {
            let change = graph.sub(sampled.value, system.v[sampled.coordinate]);
            system.force[sampled.coordinate] = graph.add(system.force[sampled.coordinate], change);
        }
        let positions: FxHashMap<Expr, Expr> = states.iter().map(|&index| (system.v[index], system.q[index])).collect();
        let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
        let condition: Vec<Expr> = system.active_condition.into_iter().collect();
        let lists = [&system.inertia, &system.force, &system.conditional, &outputs, &condition];
        let lists = lists.map(|list| graph.substitute(list, &positions));
        let [inertia, force, conditional, outputs, condition] = lists;
        (system.inertia, system.force, system.conditional) = (inertia, force, conditional);
        system.outputs.iter_mut().zip(outputs).for_each(|(output, expr)| output.expr = expr);
        system.active_condition = condition.first().copied();
        Cow::Owned(system)
    }

    /// The equations with these values as outputs, without names or units, instead of the model's.
    #[must_use]
    pub fn observing(&self, values: impl IntoIterator<Item = Expr>) -> Self {
        let output = |(index, expr): (usize, Expr)| OutputInfo {
            name: format!("value {index}"),
            unit: String::new(),
            dimension: None,
            expr,
            of_results: None,
        };
        Self { outputs: values.into_iter().enumerate().map(output).collect(), ..self.clone() }
    }

    /// Whether it has states.
    pub fn has_states(&self) -> bool {
        self.coordinates.iter().any(|coordinate| coordinate.is_state)
    }

    /// A start at an equilibrium is known: nothing is given of positions, and nothing decides where they are left
    /// open. States are those that their coordinates' positions were there.
    pub fn start_at_equilibrium(&mut self) {
        self.start.leave_positions();
        for index in (0..self.q.len()).filter(|&index| self.coordinates[index].is_state) {
            self.start.velocity[index] = Some(self.q[index]);
        }
    }

    /// Removes forces and masses: w minimises Σ (w/scale)² and follows from the constraints alone. If they leave no
    /// freedom, they determine everything else, too.
    pub(super) fn forget_forces(&mut self) {
        let graph = &mut self.graph;
        let mut mass = Vec::with_capacity(self.q.len());
        let mut inertia = Vec::with_capacity(self.q.len());
        for (index, (coordinate, &w)) in self.coordinates.iter().zip(&self.w).enumerate() {
            let weight = graph.constant(coordinate.scale.powi(-2));
            mass.push((index, index, weight));
            inertia.push(graph.mul(weight, w));
        }
        let nothing = vec![graph.constant(0.0); self.q.len()];
        (self.mass, self.inertia) = (mass, inertia);
        self.massive.fill(true);
        (self.force, self.conditional, self.active_condition) = (nothing.clone(), nothing, None);
    }
}

impl Start {
    /// Positions are known: nothing is given of them, and nothing decides where they are left open.
    fn leave_positions(&mut self) {
        self.position.fill(None);
        self.conditions.iter_mut().for_each(|condition| condition.position = false);
        self.conditions.retain(|condition| condition.velocity);
        if let Some(nearest) = &mut self.nearest {
            let nearest = std::sync::Arc::make_mut(nearest);
            nearest.distances.iter_mut().for_each(|distance| distance.position = false);
        }
    }
}
