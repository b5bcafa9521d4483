//! Functions of the positions in a mechanism's forces that may be bounded as a whole.

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Binary, Expr, Graph, Node, Unary};

use super::tuning::TUNING;
use crate::assemble::System;

/// Dependences of an expression, and an upper bound of its number of operations.
#[derive(Clone, Copy, Default)]
struct Known {
    on_positions: bool,
    on_rates: bool,
    operations: usize,
}

/// A function of the positions that may be bounded, and the conditions under which alone the forces use it.
pub(super) struct Candidate {
    pub of: Expr,
    pub conditions: Vec<Expr>,
}

/// Functions of the positions that may be bounded: waves, bells, steps, tables and quotients.
pub(super) fn candidates(system: &System, graph: &mut Graph) -> Vec<Candidate> {
    let positions: FxHashSet<Expr> = system.q.iter().copied().collect();
    let rates: FxHashSet<Expr> = system.v.iter().chain(&system.w).chain(&system.lambda).copied().collect();
    let reachable = graph.reachable(&system.force);
    let mut known: FxHashMap<Expr, Known> = FxHashMap::default();
    let mut found: Vec<(Expr, Expr)> = Vec::new();
    for &expr in &reachable {
        let node = graph.node(expr);
        let mut of = Known { on_positions: positions.contains(&expr), on_rates: rates.contains(&expr), operations: 1 };
        for child in node.children() {
            of.on_positions |= known[&child].on_positions;
            of.on_rates |= known[&child].on_rates;
            of.operations = of.operations.saturating_add(known[&child].operations);
        }
        known.insert(expr, of);
        if !of.on_positions || of.on_rates || of.operations > TUNING.most_operations {
            continue;
        }
        match node {
            // Turning bodies make waves that are as long as a turn.
            Node::Unary(Unary::Sin | Unary::Cos, a) if is_sum(graph, a) => {}
            Node::Unary(Unary::Sin | Unary::Cos | Unary::Exp | Unary::Tanh | Unary::Atan | Unary::Spline(..), _)
            | Node::Binary(Binary::Pow, ..) => found.push((expr, expr)),
            Node::Binary(Binary::Div, _, divisor) if known[&divisor].on_positions => {
                let one = graph.constant(1.0);
                found.push((graph.div(one, divisor), expr));
            }
            _ => {}
        }
    }
    found.sort_unstable();
    let is_known = |condition: &Expr| {
        let of = known[condition];
        of.on_positions && !of.on_rates && of.operations <= TUNING.most_operations
    };
    let conditions = conditions(graph, &system.force, &reachable, is_known);
    let with_conditions = |uses: &[(Expr, Expr)]| Candidate {
        of: uses[0].0,
        conditions: uses.iter().map(|(_, index)| conditions[index].clone()).reduce(common).unwrap_or_default(),
    };
    found.chunk_by(|a, b| a.0 == b.0).map(with_conditions).collect()
}

/// The conditions without which no root uses it, for every expression of `reachable` (children first).
fn conditions(
    graph: &Graph,
    roots: &[Expr],
    reachable: &[Expr],
    is_known: impl Fn(&Expr) -> bool,
) -> FxHashMap<Expr, Vec<Expr>> {
    let mut conditions: FxHashMap<Expr, Vec<Expr>> = roots.iter().map(|&root| (root, Vec::new())).collect();
    for &expr in reachable.iter().rev() {
        let own = conditions[&expr].clone();
        let node = graph.node(expr);
        for child in node.children() {
            let mut of_use = own.clone();
            if let Node::Binary(Binary::Select, condition, value) = node
                && child == value
                && is_known(&condition)
                && !of_use.contains(&condition)
            {
                of_use.push(condition);
            }
            let all = match conditions.remove(&child) {
                Some(before) => common(before, of_use),
                None => of_use,
            };
            conditions.insert(child, all);
        }
    }
    conditions
}

/// Conditions of both.
fn common(mut a: Vec<Expr>, b: Vec<Expr>) -> Vec<Expr> {
    a.retain(|condition| b.contains(condition));
    a
}

/// Whether an expression is a sum of symbols and numbers.
fn is_sum(graph: &Graph, expr: Expr) -> bool {
    match graph.node(expr) {
        Node::Constant(_) | Node::Symbol(_) => true,
        Node::Unary(Unary::Neg, a) => is_sum(graph, a),
        Node::Binary(Binary::Add | Binary::Sub, a, b) => is_sum(graph, a) && is_sum(graph, b),
        _ => false,
    }
}
