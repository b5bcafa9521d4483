//! The equations as a list of operations for a certificate: the facts of a mechanism that a checker needs.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph};

use super::start_equations::StartEquations;
use crate::assemble::System;
use crate::certificate::{self, Node};

/// Source of a coordinate's position, or of its velocity, at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AtStart {
    /// A given value.
    Given(Expr),
    /// A number.
    Number(f64),
    /// The closure, together with all other coordinates that have this source.
    Closure,
}

/// The list. `start` gives the source of each coordinate's position, and of its velocity.
pub fn list_equations(system: &System, start: &[Vec<AtStart>; 2]) -> certificate::Equations {
    let mut graph = system.graph.clone();
    let StartEquations { motion, closure, closure_rate, rate_of_rate, .. } = StartEquations::new(system, &mut graph);
    let mut of_start = |level: usize, symbols: &[Expr], closure: &[Expr]| -> Vec<Expr> {
        let mut rows = Vec::new();
        for (&symbol, at_start) in symbols.iter().zip(&start[level]) {
            let value = match *at_start {
                AtStart::Given(value) => value,
                AtStart::Number(number) => graph.constant(number),
                AtStart::Closure => continue,
            };
            rows.push(graph.sub(symbol, value));
        }
        if start[level].contains(&AtStart::Closure) {
            rows.extend_from_slice(closure);
        }
        rows
    };
    let of_start = [of_start(0, &system.q, &closure), of_start(1, &system.v, &closure_rate)];
    let motion = [motion, rate_of_rate].concat();
    let outputs: Vec<Expr> = system.outputs.iter().map(|output| output.expr).collect();
    let roots = [&motion[..], &of_start[0], &of_start[1], &outputs].concat();
    let reachable = graph.reachable(&roots);
    let place: FxHashMap<Expr, usize> = reachable.iter().enumerate().map(|(place, &expr)| (expr, place)).collect();
    let symbols = symbols(system);
    let places = |rows: &[Expr]| rows.iter().map(|row| place[row]).collect::<Vec<_>>();
    certificate::Equations {
        nodes: reachable.iter().map(|&expr| node(&graph, expr, &symbols, &place)).collect(),
        coordinates: system.q.len(),
        multipliers: system.lambda.len(),
        motion: places(&motion),
        start: of_start.each_ref().map(|rows| places(rows)),
        outputs: places(&outputs),
    }
}

fn symbols(system: &System) -> FxHashMap<Expr, Node> {
    let mut symbols = FxHashMap::from_iter([(system.time, Node::Time)]);
    let parameters = system.parameters.iter().enumerate();
    symbols.extend(parameters.map(|(index, parameter)| (parameter.symbol, Node::Parameter(index))));
    let mut add = |block: &[Expr], node: fn(usize) -> Node| {
        symbols.extend(block.iter().enumerate().map(|(index, &symbol)| (symbol, node(index))));
    };
    add(&system.q, Node::Position);
    add(&system.v, Node::Velocity);
    add(&system.w, Node::Acceleration);
    add(&system.lambda, Node::Multiplier);
    symbols
}

fn node(graph: &Graph, expr: Expr, symbols: &FxHashMap<Expr, Node>, place: &FxHashMap<Expr, usize>) -> Node {
    match graph.node(expr) {
        symdiff::Node::Constant(bits) if f64::from_bits(bits).is_finite() => Node::Number(f64::from_bits(bits)),
        symdiff::Node::Constant(_) => Node::Unknown,
        symdiff::Node::Symbol(_) => symbols.get(&expr).copied().unwrap_or(Node::Unknown),
        symdiff::Node::Unary(function, a) => Node::Unary(function, place[&a]),
        symdiff::Node::Binary(function, a, b) => Node::Binary(function, place[&a], place[&b]),
    }
}
