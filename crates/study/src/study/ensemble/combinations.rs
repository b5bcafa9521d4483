//! Numbers through which alone parameters act, as functions.

use symdiff::Expr;

use crate::assemble::System;
use crate::compile;
use crate::methods::{Combination, OfParameters};

/// Combinations of a system.
pub(super) fn of(system: &System) -> Vec<Combination<'_>> {
    let known = |found: compile::Combination| {
        let of = |expr: Expr| -> OfParameters<'_> {
            let symbols = found.parameters.iter().map(|&number| system.parameters[number].symbol);
            let symbols: Vec<Expr> = symbols.collect();
            Box::new(move |values| {
                let at = |symbol: Expr| symbols.iter().position(|&own| own == symbol);
                system.graph.evaluate(&[expr], |symbol| at(symbol).map_or(f64::NAN, |at| values[at]))[0]
            })
        };
        Combination { first: of(found.first), last: of(found.last), parameters: found.parameters }
    };
    compile::combinations(system).into_iter().map(known).collect()
}
