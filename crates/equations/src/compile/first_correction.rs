//! The first correction after a factorisation: both are at one iterate, so that the correction uses the values that the
//! factorisation has computed, sines and cosines and the entries of the constraint Jacobian above all.

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Binary, Expr, Graph, Guard, Input, Node, Stages};

use super::newton_matrix::ITERATION;

/// A value to compute, and the register that it must have, if any.
type Target = (Expr, Option<u32>);

/// `correct` over values that `frozen`, the factorisation, has in registers after it. Missing values are added to it,
/// in registers from `next` on. Values that matter under a guard only, or in a region that may be skipped, are
/// computed again.
pub(super) fn first_correction(
    graph: &mut Graph,
    inputs: &mut Vec<Input>,
    next: &mut u32,
    frozen: &mut Vec<Target>,
    guards: &FxHashMap<Expr, Guard>,
    correct: &[Target],
) -> Vec<Target> {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let known = always_computed(graph, &stages, frozen, guards);
    let symbol_at: FxHashMap<u32, Expr> = inputs.iter().map(|input| (input.register, input.symbol)).collect();
    let mut symbol_of: FxHashMap<Expr, Expr> = FxHashMap::default();
    for (value, register) in frozen.iter() {
        let symbol = register.and_then(|register| symbol_at.get(&register));
        symbol_of.extend(symbol.filter(|_| !guards.contains_key(value)).map(|&symbol| (*value, symbol)));
    }
    let values: Vec<Expr> = correct.iter().map(|&(value, _)| value).collect();
    for value in frontier(graph, &stages, &known, &symbol_of, &values) {
        let symbol = graph.symbol(&format!("kept:{next}"));
        inputs.push(Input { symbol, stage: ITERATION, register: *next });
        frozen.push((value, Some(*next)));
        symbol_of.insert(value, symbol);
        *next += 1;
    }
    let values = graph.substitute(&values, &symbol_of);
    values.into_iter().zip(correct).map(|(value, &(_, register))| (value, register)).collect()
}

/// Values of the iteration that the factorisation computes in every lane.
fn always_computed(
    graph: &Graph,
    stages: &Stages,
    frozen: &[Target],
    guards: &FxHashMap<Expr, Guard>,
) -> FxHashSet<Expr> {
    let reached = |is_root: &dyn Fn(Option<&Guard>) -> bool| {
        let roots = frozen.iter().map(|&(value, _)| value).filter(|value| is_root(guards.get(value)));
        let mut stack: Vec<Expr> = roots.collect();
        let mut found = FxHashSet::default();
        while let Some(expr) = stack.pop() {
            if stages.of(expr) != Some(ITERATION) || !found.insert(expr) {
                continue;
            }
            match graph.node(expr) {
                // The value's region may be skipped.
                Node::Binary(Binary::Select | Binary::SelectElse, condition, _) => stack.push(condition),
                node => stack.extend(node.children()),
            }
        }
        found
    };
    let mut always = reached(&|guard| guard.is_none());
    if !guards.is_empty() {
        let [wanted, elsewhere] =
            [false, true].map(|elsewhere| reached(&|guard| guard.is_some_and(|guard| guard.elsewhere == elsewhere)));
        always.extend(wanted.intersection(&elsewhere));
    }
    always
}

/// Values in `known` that `values` need directly, but for those that have a symbol already.
fn frontier(
    graph: &Graph,
    stages: &Stages,
    known: &FxHashSet<Expr>,
    symbol_of: &FxHashMap<Expr, Expr>,
    values: &[Expr],
) -> Vec<Expr> {
    let needed: Vec<Expr> =
        graph.reachable(values).into_iter().filter(|&expr| stages.of(expr) == Some(ITERATION)).collect();
    let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
    let mut terms = FxHashSet::default();
    for &expr in &needed {
        let node = graph.node(expr);
        node.children().for_each(|child| *uses.entry(child).or_default() += 1);
        if matches!(node, Node::Binary(Binary::Add | Binary::Sub, ..)) {
            terms.extend(node.children());
        }
    }
    // A product that one sum needs is a part of that sum's instruction: nothing is saved by keeping it.
    let is_free = |expr: Expr| match graph.node(expr) {
        Node::Binary(Binary::Mul, ..) => uses.get(&expr) == Some(&1) && terms.contains(&expr),
        Node::Symbol(_) | Node::Binary(Binary::Select | Binary::SelectElse, ..) => true,
        _ => false,
    };
    let mut found = Vec::new();
    let mut seen = FxHashSet::default();
    let mut stack = values.to_vec();
    while let Some(expr) = stack.pop() {
        if stages.of(expr) != Some(ITERATION) || symbol_of.contains_key(&expr) || !seen.insert(expr) {
            continue;
        }
        if known.contains(&expr) && !is_free(expr) {
            found.push(expr);
        } else {
            stack.extend(graph.node(expr).children());
        }
    }
    found.sort_unstable();
    found
}
