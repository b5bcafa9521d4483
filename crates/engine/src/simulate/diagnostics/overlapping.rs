//! Contacts whose surfaces overlap where a motion begins: they throw each other apart.

use symdiff::Expr;

use super::tuning::TUNING;
use crate::simulate::motion_values::motion_values;
use crate::simulate::simulator::Simulator;

/// The contacts whose surfaces overlap at the nominal start by more than other forces press them together, and by how
/// much, m. In an equilibrium none does.
pub fn overlapping(simulator: &Simulator) -> Vec<(String, f64)> {
    let (system, layout, state) = (&simulator.system, &simulator.start.layout, &simulator.nominal);
    if simulator.equilibrium.is_some() {
        return Vec::new();
    }
    let (names, touches): (Vec<&String>, Vec<[Expr; 3]>) =
        system.effects.iter().filter_map(|effect| Some((&effect.name, effect.touch?))).unzip();
    if names.is_empty() {
        return Vec::new();
    }
    let all: Vec<Expr> = touches.into_iter().flatten().collect();
    let values = |state: &[f64]| {
        let values = motion_values(system, layout, state, 0.0);
        system.graph.evaluate(&all, |symbol| values.get(&symbol).copied().unwrap_or(0.0))
    };
    let mut later = state.clone();
    for (value, rate) in layout.q.clone().chain(layout.v.clone()).zip(layout.v.clone().chain(layout.w.clone())) {
        later[value] += TUNING.moment_of_rate * state[rate];
    }
    let (now, later) = (values(state), values(&later));
    let of_contact = |(name, (now, later)): (&String, (&[f64], &[f64]))| {
        let [gap, rate, force] = now else { return None };
        let acceleration = (later[1] - rate) / TUNING.moment_of_rate;
        let is_thrown = acceleration > TUNING.overlapping_unbalanced * force.abs() / system.mass_of_bodies;
        (-gap > TUNING.rounded_gap * system.length && is_thrown).then(|| (name.clone(), -gap))
    };
    names.into_iter().zip(now.chunks_exact(3).zip(later.chunks_exact(3))).filter_map(of_contact).collect()
}
