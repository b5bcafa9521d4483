//! A system with the loads of a manufactured motion, which starts on it.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph};

use super::motion::Manufactured;
use crate::assemble::{Start, System};
use crate::numerics::ChebyshevSeries;

/// The system with loads in addition to its forces and slips in its velocity constraints; its outputs are its
/// coordinates, velocities, accelerations and multipliers (3n + m). `independent` coordinates are given at the start,
/// the others follow.
pub fn loaded(system: &System, motion: &Manufactured, independent: &[usize]) -> System {
    let mut system = later(system, motion.begin);
    let n = system.q.len();
    let scaled = scaled_time(&mut system.graph, system.time, motion.length());
    for (force, load) in system.force.iter_mut().zip(&motion.loads) {
        let load = expression(&mut system.graph, scaled, load);
        *force = system.graph.add(*force, load);
    }
    for (constraint, slip) in system.velocity_constraint.iter_mut().zip(&motion.slips) {
        let slip = expression(&mut system.graph, scaled, slip);
        *constraint = system.graph.sub(*constraint, slip);
    }
    let at_start = |series: &[ChebyshevSeries], graph: &mut Graph| -> Vec<Expr> {
        series.iter().map(|own| graph.constant(own.at(motion.begin))).collect()
    };
    let positions = at_start(&motion.positions, &mut system.graph);
    let velocities = at_start(&motion.velocities, &mut system.graph);
    let given = |values: &[Expr]| -> Vec<Option<Expr>> {
        let is_given = |index: usize| independent.contains(&index) || system.coordinates[index].is_state;
        (0..n).map(|index| is_given(index).then_some(values[index])).collect()
    };
    system.start = Start {
        position: given(&positions),
        velocity: given(&velocities),
        guess: positions,
        fulfils_velocity_constraints: true,
        conditions: Vec::new(),
        at_equilibrium: false,
        nearest: None,
    };
    // The loads hold bodies where a model's start could not be.
    system.effects.iter_mut().for_each(|effect| (effect.room, effect.overlap) = (None, None));
    observed(&system)
}

/// The system, in whose equations the time counts from `begin` on. Outputs and powers keep theirs.
fn later(system: &System, begin: f64) -> System {
    let mut system = system.clone();
    if begin == 0.0 {
        return system;
    }
    let by = system.graph.constant(begin);
    let moved = system.graph.add(system.time, by);
    let of_links = system.links.iter_mut().flat_map(|link| link.values.iter_mut().chain(&mut link.inertial_forces));
    let all: Vec<&mut Expr> = system
        .mass
        .iter_mut()
        .map(|(_, _, value)| value)
        .chain(&mut system.inertia)
        .chain(&mut system.force)
        .chain(&mut system.active_condition)
        .chain(&mut system.conditional)
        .chain(&mut system.constraint)
        .chain(&mut system.velocity_constraint)
        .chain(of_links)
        .collect();
    let before: Vec<Expr> = all.iter().map(|own| **own).collect();
    let after = system.graph.substitute(&before, &FxHashMap::from_iter([(system.time, moved)]));
    all.into_iter().zip(after).for_each(|(own, after)| *own = after);
    system
}

/// The system with its coordinates, velocities, accelerations and multipliers as outputs.
pub fn observed(system: &System) -> System {
    system.observing([&system.q, &system.v, &system.w, &system.lambda].into_iter().flatten().copied())
}

/// τ = 2 t/T − 1
fn scaled_time(graph: &mut Graph, time: Expr, end: f64) -> Expr {
    let twice = graph.scale(2.0 / end, time);
    let one = graph.constant(1.0);
    graph.sub(twice, one)
}

/// Σ cₖ Tₖ(τ), by Clenshaw's recurrence.
fn expression(graph: &mut Graph, tau: Expr, series: &ChebyshevSeries) -> Expr {
    let twice = graph.scale(2.0, tau);
    let zero = graph.constant(0.0);
    let (mut next, mut last) = (zero, zero);
    for &coefficient in series.coefficients().iter().skip(1).rev() {
        let product = graph.mul(twice, next);
        let difference = graph.sub(product, last);
        let coefficient = graph.constant(coefficient);
        (next, last) = (graph.add(coefficient, difference), next);
    }
    let product = graph.mul(tau, next);
    let difference = graph.sub(product, last);
    let constant = graph.constant(series.coefficients()[0]);
    graph.add(constant, difference)
}
