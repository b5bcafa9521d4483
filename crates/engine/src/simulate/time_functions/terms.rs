//! Functions of the time: the largest expressions that depend on the time and on parameters only, taken apart where
//! they are sums, since each summand has a size of its own.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Binary, Expr, Graph, Node, Unary};

use crate::assemble::System;
use crate::compile::Layout;

/// Functions of the time, over the symbols of `graph`.
pub(super) struct Functions {
    pub graph: Graph,
    /// Functions, and whether other symbols have been replaced by their values at the start.
    pub terms: Vec<(Expr, bool)>,
    /// Arguments of jumps: a jump is where such an expression changes its sign.
    pub conditions: Vec<Condition>,
}

/// Dependences of an expression.
#[derive(Clone, Copy, Default)]
struct Dependence {
    time: bool,
    state: bool,
    /// Whether there is a nonlinear function of both in it.
    mixed_function: bool,
}

/// The functions of the time in the equations of motion; `None` where there are none.
pub(super) fn functions(system: &System, layout: &Layout, nominal_start: &[f64]) -> Option<Functions> {
    if !system.depends_on_time() {
        return None;
    }
    let roots = system.of_motion();
    let mut graph = system.graph.clone();
    let (mut whole, frozen) = maximal(&graph, system, &roots);
    let (prescribed, more_frozen) = maximal(&graph, system, &system.constraint);
    // Accelerations follow the second derivatives of prescribed positions.
    for &position in &prescribed {
        let velocity = graph.derivative(position, system.time);
        whole.push(graph.derivative(velocity, system.time));
    }
    whole.extend(prescribed);
    let start = at_start(&mut graph, system, layout, nominal_start);
    let frozen: Vec<Expr> = frozen.into_iter().chain(more_frozen).collect();
    let frozen = graph.substitute(&frozen, &start);
    let terms = summands(&graph, system.time, &whole);
    let of_frozen: Vec<Expr> = summands(&graph, system.time, &frozen).difference(&terms).copied().collect();
    let all: Vec<(Expr, bool)> =
        terms.into_iter().map(|term| (term, false)).chain(of_frozen.into_iter().map(|term| (term, true))).collect();
    let within: Vec<Expr> = all.iter().map(|&(term, _)| term).collect();
    let conditions = conditions(&mut graph, system.time, &within);
    Some(Functions { graph, terms: all, conditions })
}

/// The largest subexpressions of time and parameters alone; and the smallest nonlinear functions of both time and
/// state.
fn maximal(graph: &Graph, system: &System, roots: &[Expr]) -> (Vec<Expr>, Vec<Expr>) {
    let parameters: FxHashSet<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    let mut known: FxHashMap<Expr, Dependence> = FxHashMap::default();
    let (mut whole, mut frozen) = (Vec::new(), Vec::new());
    let is_whole = |on: Dependence| on.time && !on.state;
    for expr in graph.reachable(roots) {
        let node = graph.node(expr);
        let mut on = Dependence::default();
        if let Node::Symbol(_) = node {
            on.time = expr == system.time;
            on.state = !on.time && !parameters.contains(&expr);
        }
        for child in node.children() {
            let of = known[&child];
            on.time |= of.time;
            on.state |= of.state;
            on.mixed_function |= of.mixed_function;
        }
        if on.time && on.state {
            whole.extend(node.children().filter(|child| is_whole(known[child])));
            if !on.mixed_function && is_nonlinear(node, &known) {
                on.mixed_function = true;
                frozen.push(expr);
            }
        }
        known.insert(expr, on);
    }
    whole.extend(roots.iter().filter(|root| is_whole(known[root])));
    (whole, frozen)
}

fn is_nonlinear(node: Node, known: &FxHashMap<Expr, Dependence>) -> bool {
    match node {
        Node::Constant(_) | Node::Symbol(_) | Node::Unary(Unary::Neg, _) => false,
        Node::Binary(Binary::Add | Binary::Sub | Binary::Mul, ..) => false,
        Node::Binary(Binary::Div, _, divisor) => known[&divisor].time,
        Node::Binary(Binary::Select | Binary::SelectElse, condition, _) => known[&condition].time,
        Node::Unary(..) | Node::Binary(..) => true,
    }
}

/// The state's symbols with their values at the nominal start.
fn at_start(graph: &mut Graph, system: &System, layout: &Layout, nominal_start: &[f64]) -> FxHashMap<Expr, Expr> {
    let blocks =
        [(&system.q, &layout.q), (&system.v, &layout.v), (&system.w, &layout.w), (&system.lambda, &layout.lambda)];
    let mut values = FxHashMap::default();
    for (symbols, registers) in blocks {
        for (&symbol, register) in symbols.iter().zip(registers.clone()) {
            values.insert(symbol, graph.constant(nominal_start[register]));
        }
    }
    values
}

/// The summands of expressions, without factors that do not depend on the time, nor the time itself.
fn summands(graph: &Graph, time: Expr, whole: &[Expr]) -> BTreeSet<Expr> {
    let mut dependent = FxHashSet::from_iter([time]);
    for expr in graph.reachable(whole) {
        if graph.node(expr).children().any(|child| dependent.contains(&child)) {
            dependent.insert(expr);
        }
    }
    let mut found = BTreeSet::new();
    let mut stack = whole.to_vec();
    while let Some(expr) = stack.pop() {
        if expr == time || !dependent.contains(&expr) {
            continue;
        }
        match graph.node(expr) {
            Node::Unary(Unary::Neg, a) => stack.push(a),
            Node::Binary(Binary::Add | Binary::Sub, a, b) => stack.extend([a, b]),
            Node::Binary(Binary::Mul, a, b) if !dependent.contains(&a) || !dependent.contains(&b) => {
                stack.extend([a, b]);
            }
            Node::Binary(Binary::Div, a, b) if !dependent.contains(&b) => stack.push(a),
            _ => {
                found.insert(expr);
            }
        }
    }
    found
}

/// An expression of the time at whose changes of sign functions jump.
#[derive(Clone, Debug)]
pub(super) struct Condition {
    pub of: Expr,
    /// Indices of conditions of whole numbers at which this one itself jumps.
    pub jumps_with: Vec<usize>,
}

fn conditions(graph: &mut Graph, time: Expr, terms: &[Expr]) -> Vec<Condition> {
    let mut found = BTreeSet::new();
    let mut of_floor: FxHashMap<Expr, Expr> = FxHashMap::default();
    for expr in graph.reachable(terms) {
        match graph.node(expr) {
            Node::Unary(Unary::Floor, a) => {
                let turns = graph.scale(PI, a);
                let sine = graph.sin(turns);
                of_floor.insert(expr, sine);
                found.insert(sine);
            }
            Node::Unary(Unary::Sign, a) | Node::Binary(Binary::Select | Binary::SelectElse, a, _) => {
                found.insert(a);
            }
            _ => {}
        }
    }
    let steady: Vec<Expr> = found.into_iter().filter(|&of| graph.changes_steadily(of, &[time])).collect();
    let index = |of: Expr| of_floor.get(&of).and_then(|sine| steady.binary_search(sine).ok());
    let jumps_with = |of: Expr| graph.reachable(&[of]).into_iter().filter_map(index).collect();
    steady.iter().map(|&of| Condition { of, jumps_with: jumps_with(of) }).collect()
}
