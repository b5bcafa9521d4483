//! The term of the equations that is no finite number at a state.

use symdiff::{Binary, Expr, Graph, Node, Unary};

use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::Layout;
use crate::grammar::TimeOrder;
use crate::grammar::motions::derivative_name;
use crate::simulate::motion_values::motion_values;

/// A term that is no finite number, and the equation that it is part of: `` `1/t` in the motion of rod.angle ``. `None`
/// where all equations have finite values. `state` holds the values of the layout's registers.
pub fn not_finite(system: &System, layout: &Layout, state: &[f64], time: f64) -> Option<String> {
    let values = motion_values(system, layout, state, time);
    // Reactions and accelerations that follow from a term are not finite either; they say nothing of where it comes
    // from.
    let value_of = |symbol: Expr| values.get(&symbol).copied().unwrap_or(0.0);
    let motion = system.force.iter().chain(&system.inertia).zip(system.coordinates.iter().cycle());
    let named = motion.map(|(&expr, coordinate)| (expr, format!("the motion of `{}`", coordinate.name)));
    let named = named.chain(system.named_constraints().map(|(expr, info)| (expr, format!("`{}`", info.name))));
    let graph = &system.graph;
    let value = |expr: Expr| graph.evaluate(&[expr], value_of)[0];
    let (mut term, place) = named.into_iter().find(|&(expr, _)| !value(expr).is_finite())?;
    // Points that coincide leave a line without direction: a force along it must be zero there.
    let is_zero = |length: &Expr| value(*length).abs() <= f64::EPSILON * system.length;
    if let Some(line) = system.effects.iter().find(|effect| effect.length.as_ref().is_some_and(is_zero)) {
        return Some(format!(
            "the direction of `{}`, whose points coincide and which is not without force there,",
            line.name
        ));
    }
    while let Some(part) = graph.node(term).children().find(|&part| !value(part).is_finite()) {
        term = part;
    }
    Some(format!("`{}` in {place}", written(graph, term)))
}

/// A formula, and the motion or the joint that the term `of` is part of.
pub fn place_of(system: &System, of: Expr, formula: &str) -> String {
    let motion = system.force.iter().chain(&system.inertia).zip(system.coordinates.iter().cycle());
    let named = motion.map(|(&root, coordinate)| (root, format!("the motion of `{}`", coordinate.name)));
    let mut named = named.chain(system.named_constraints().map(|(root, info)| (root, format!("`{}`", info.name))));
    match named.find(|&(root, _)| system.graph.reachable(&[root]).contains(&of)) {
        Some((_, place)) => format!("`{formula}` in {place}"),
        None => format!("`{formula}`"),
    }
}

/// A term as a formula.
pub fn written(graph: &Graph, expr: Expr) -> String {
    written_to(graph, expr, TUNING.deepest_term)
}

fn written_to(graph: &Graph, expr: Expr, depth: usize) -> String {
    let part = |expr: Expr| match graph.node(expr) {
        Node::Constant(_) | Node::Symbol(_) => written_to(graph, expr, depth),
        _ if depth == 0 => "…".to_owned(),
        node => {
            let text = written_to(graph, expr, depth - 1);
            if matches!(node, Node::Binary(..)) && !text.ends_with(')') { format!("({text})") } else { text }
        }
    };
    match graph.node(expr) {
        Node::Constant(bits) => f64::from_bits(bits).to_string(),
        Node::Symbol(_) => {
            let name = graph.symbol_name(expr).unwrap_or_default();
            // `q:rod.angle`, `v:rod.angle`, `p:length`.
            match name.split_once(':') {
                Some(("v", coordinate)) => derivative_name(coordinate, TimeOrder::Velocity),
                Some(("w", coordinate)) => derivative_name(coordinate, TimeOrder::Acceleration),
                Some((_, name)) => name.to_owned(),
                None => name.to_owned(),
            }
        }
        Node::Unary(Unary::Neg, a) => format!("-{}", part(a)),
        Node::Unary(Unary::Spline(..), a) => format!("table({})", written_to(graph, a, depth.saturating_sub(1))),
        Node::Unary(function, a) => {
            let name = format!("{function:?}").to_lowercase();
            format!("{name}({})", if depth == 0 { "…".to_owned() } else { written_to(graph, a, depth - 1) })
        }
        Node::Binary(function, a, b) => {
            let (a, b) = (part(a), part(b));
            match function {
                Binary::Add => format!("{a} + {b}"),
                Binary::Sub => format!("{a} - {b}"),
                Binary::Mul => format!("{a}*{b}"),
                Binary::Div => format!("{a}/{b}"),
                Binary::Pow => format!("{a}^{b}"),
                Binary::Select | Binary::SelectElse => b,
                other => format!("{}({a}, {b})", format!("{other:?}").to_lowercase()),
            }
        }
    }
}
