//! M(q₊) (a₊ − a): the part of the equations of motion due to the change of the algorithmic accelerations.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph};

use crate::assemble::System;

/// The change by M; `new` and `old` are a₊ and a.
pub(super) fn by_mass(
    system: &System,
    graph: &mut Graph,
    [new, old]: [&[Expr]; 2],
    at_end: &FxHashMap<Expr, Expr>,
) -> Vec<Expr> {
    let entries = system.mass_entries(graph);
    let masses: Vec<Expr> = entries.iter().map(|&(_, _, mass)| mass).collect();
    let masses = graph.substitute(&masses, at_end);
    let mut changes = vec![graph.constant(0.0); system.q.len()];
    for (&(row, column, _), mass) in entries.iter().zip(masses) {
        let change = graph.sub(new[column], old[column]);
        let change = graph.mul(mass, change);
        changes[row] = graph.add(changes[row], change);
    }
    changes
}

/// The same from the inertial forces, which are linear in w, without M.
pub(super) fn by_forces(
    system: &System,
    graph: &mut Graph,
    [new, old]: [&[Expr]; 2],
    at_end: &FxHashMap<Expr, Expr>,
) -> Vec<Expr> {
    let zero = graph.constant(0.0);
    let (mut changed, mut unchanged) = (at_end.clone(), at_end.clone());
    for (index, &w) in system.w.iter().enumerate() {
        changed.insert(w, graph.sub(new[index], old[index]));
        unchanged.insert(w, zero);
    }
    let [changed, unchanged] = [changed, unchanged].map(|values| graph.substitute(&system.inertia, &values));
    changed.into_iter().zip(unchanged).map(|(changed, unchanged)| graph.sub(changed, unchanged)).collect()
}
