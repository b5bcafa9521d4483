//! Bodies that begin outside of their enclosure: a journal outside of its bearing.

use symdiff::Expr;

use crate::assemble::System;
use crate::compile::Layout;
use crate::simulate::motion_values::motion_values;

/// The first effect that has no room at the start (the layout's registers), and how much it lacks, m.
pub fn outside(system: &System, layout: &Layout, state: &[f64]) -> Option<(String, f64)> {
    let (effects, rooms): (Vec<_>, Vec<Expr>) =
        system.effects.iter().filter_map(|effect| Some((effect, effect.room?))).unzip();
    if rooms.is_empty() {
        return None;
    }
    let values = motion_values(system, layout, state, 0.0);
    let rooms = system.graph.evaluate(&rooms, |symbol| values.get(&symbol).copied().unwrap_or(0.0));
    let (effect, room) = effects.into_iter().zip(rooms).find(|(_, room)| *room < 0.0)?;
    Some((effect.name.clone(), -room))
}
