//! The balance of power as outputs of a system.

use symdiff::{Expr, Unary};

use super::equations::{equations_of_motion, time_derivative};
use crate::assemble::System;

/// Number of outputs before those of the effects.
pub const OF_WHOLE: usize = 2;
/// Number of outputs of each effect.
pub const OF_EFFECT: usize = 2;

/// The system with its balance of power as outputs, W: the defect of
/// Σ vᵢ (M w + Φ_qᵀ λ − Q)ᵢ = dT/dt + Σ λₖ (Φ_q v)ₖ − Σ Pₑ, the sum of its terms' sizes, and for each effect Pₑ and
/// the rate of its stored energy. `None` where powers were not asked for.
pub fn observing_powers(system: &System) -> Option<System> {
    let powers = system.powers.as_ref()?;
    let mut system = system.clone();
    let mut graph = std::mem::take(&mut system.graph);
    let (rows, jacobian) = equations_of_motion(&system, &mut graph);
    let moves = |index: usize| !system.coordinates[index].is_state;
    let mut gained = Vec::new();
    let mut sizes = Vec::new();
    for (index, &row) in rows.iter().enumerate().filter(|(index, _)| moves(*index)) {
        gained.push(graph.mul(system.v[index], row));
        sizes.push(graph.mul(system.v[index], system.inertia[index]));
    }
    let mut given = Vec::new();
    for (constraint, coordinate, derivative) in jacobian.entries() {
        let rate = graph.mul(derivative, system.v[coordinate]);
        given.push(graph.mul(system.lambda[constraint], rate));
    }
    let stored: Vec<Expr> = powers.effects.iter().map(|effect| effect.stored).collect();
    let rates = time_derivative(&system, &mut graph, &[&[powers.kinetic][..], &stored].concat());
    given.push(rates[0]);
    sizes.extend(&given);
    for effect in &powers.effects {
        sizes.push(effect.power);
        gained.push(effect.power);
    }
    let (gained, given) = (graph.sum(gained), graph.sum(given));
    let defect = graph.sub(gained, given);
    let sizes: Vec<Expr> = sizes.into_iter().map(|term| graph.unary(Unary::Abs, term)).collect();
    let size = graph.sum(sizes);
    let of_effects = powers.effects.iter().zip(&rates[1..]).flat_map(|(effect, &rate)| [effect.power, rate]);
    let outputs: Vec<Expr> = [defect, size].into_iter().chain(of_effects).collect();
    system.graph = graph;
    Some(system.observing(outputs))
}
