//! Values of symbols at a state, for expressions that no program computes.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use crate::assemble::System;
use crate::compile::Layout;

/// Values of the parameters, positions and velocities in `state` (the layout's registers), and of the time in s.
pub fn motion_values(system: &System, layout: &Layout, state: &[f64], time: f64) -> FxHashMap<Expr, f64> {
    let parameters = system.parameters.iter().map(|parameter| parameter.symbol).zip(layout.parameters.clone());
    let inputs = system.input_symbols().zip(layout.inputs.clone());
    let positions = system.q.iter().copied().zip(layout.q.clone());
    let velocities = system.v.iter().copied().zip(layout.v.clone());
    let registers = parameters.chain(inputs).chain(positions).chain(velocities);
    registers.map(|(symbol, register)| (symbol, state[register])).chain([(system.time, time)]).collect()
}
