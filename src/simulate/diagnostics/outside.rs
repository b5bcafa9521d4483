//! What begins outside of what it is in: a journal outside of its bearing.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use crate::assemble::System;
use crate::compile::Layout;

/// The first effect that has no room at a state (the layout's registers), and how much it lacks, m.
pub fn outside(system: &System, layout: &Layout, state: &[f64]) -> Option<(String, f64)> {
    let (effects, rooms): (Vec<_>, Vec<Expr>) =
        system.effects.iter().filter_map(|effect| Some((effect, effect.room?))).unzip();
    if rooms.is_empty() {
        return None;
    }
    let parameters = system.parameters.iter().map(|parameter| parameter.symbol).zip(layout.parameters.clone());
    let positions = system.q.iter().copied().zip(layout.q.clone());
    let values: FxHashMap<Expr, f64> =
        parameters.chain(positions).map(|(symbol, register)| (symbol, state[register])).collect();
    let rooms = system.graph.evaluate(&rooms, |symbol| values.get(&symbol).copied().unwrap_or(0.0));
    let (effect, room) = effects.into_iter().zip(rooms).find(|(_, room)| *room < 0.0)?;
    Some((effect.name.clone(), -room))
}
