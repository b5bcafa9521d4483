//! Numbers through which alone parameters act: a product of a mass and a length, a sum of lengths, a formula of the
//! model.
//!
//! An expression is such a number where every way from any of its parameters to an equation, a start value or an output
//! leads through it. In the graph these are the nodes that dominate their parameters, seen from the roots
//! (Lengauer & Tarjan, TOPLAS 1 (1979) 121; a graph without cycles needs one pass).

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Node};

use super::switches::jumps;
use crate::assemble::System;

/// Continuous functions of one or more parameters through which alone they act.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Combination {
    /// The uncertain parameters, by number, ascending.
    pub parameters: Vec<usize>,
    /// The first such function that is computed,
    pub first: Expr,
    /// and the last, a function of the first.
    pub last: Expr,
}

/// The combinations of a system, each of as many parameters as there are. No parameter is in two of them.
pub fn combinations(system: &System) -> Vec<Combination> {
    // Nearest starts have equations in a graph of their own; results of an analysis follow from parameters directly.
    if system.start.nearest.is_some() || system.outputs.iter().any(|output| output.is_derived()) {
        return Vec::new();
    }
    let (graph, roots) = (&system.graph, system.roots());
    let of_parameters = functions_of(system, graph, &roots);
    let gates = Gates::new(graph, &roots);
    let mut found: Vec<Combination> = Vec::new();
    for parameter in &system.parameters {
        let mut best: Option<Combination> = None;
        for gate in gates.after(parameter.symbol) {
            let Some(parameters) = of_parameters.get(&gate).filter(|_| !jumps(graph, gate)) else { break };
            let is_gate_of_all =
                parameters.iter().all(|&other| gates.after(system.parameters[other].symbol).any(|of| of == gate));
            match &mut best {
                _ if !is_gate_of_all => {}
                Some(best) if best.parameters == *parameters => best.last = gate,
                best => *best = Some(Combination { parameters: parameters.clone(), first: gate, last: gate }),
            }
        }
        if let Some(best) = best
            && !found.contains(&best)
        {
            found.push(best);
        }
    }
    found
}

/// Numbers of the uncertain parameters of expressions that are functions of these alone.
fn functions_of(system: &System, graph: &Graph, roots: &[Expr]) -> FxHashMap<Expr, Vec<usize>> {
    let mut found: FxHashMap<Expr, Vec<usize>> = FxHashMap::default();
    for expr in graph.reachable(roots) {
        let parameters = match graph.node(expr) {
            Node::Constant(_) => Some(Vec::new()),
            Node::Symbol(_) => {
                system.parameters.iter().position(|parameter| parameter.symbol == expr).map(|number| vec![number])
            }
            node => node.children().map(|child| found.get(&child)).try_fold(Vec::new(), |mut all, own| {
                all.extend(own?);
                Some(all)
            }),
        };
        if let Some(mut parameters) = parameters {
            parameters.sort_unstable();
            parameters.dedup();
            found.insert(expr, parameters);
        }
    }
    found
}

/// The first expression that all paths from an expression to the roots lead through, for each expression.
struct Gates {
    /// That expression, and the number of those that follow; none if the paths have none in common.
    next: FxHashMap<Expr, (Option<Expr>, usize)>,
}

impl Gates {
    fn new(graph: &Graph, roots: &[Expr]) -> Self {
        let mut gates = Self { next: FxHashMap::default() };
        // Next common expression of the paths from an expression, as far as its users are known.
        let mut ways: FxHashMap<Expr, Option<Expr>> = roots.iter().map(|&root| (root, None)).collect();
        for expr in graph.reachable(roots).into_iter().rev() {
            // Every reachable expression is a root, or has a user that came before.
            let next = ways.get(&expr).copied().flatten();
            gates.next.insert(expr, (next, next.map_or(0, |next| gates.depth(next) + 1)));
            for child in graph.node(expr).children() {
                let joint = match ways.get(&child) {
                    Some(&known) => gates.joint(known, Some(expr)),
                    None => Some(expr),
                };
                ways.insert(child, joint);
            }
        }
        gates
    }

    fn depth(&self, expr: Expr) -> usize {
        self.next[&expr].1
    }

    /// The first gate of both.
    fn joint(&self, mut a: Option<Expr>, mut b: Option<Expr>) -> Option<Expr> {
        while a != b {
            let (of_a, of_b) = (a?, b?);
            if self.depth(of_a) >= self.depth(of_b) {
                a = self.next[&of_a].0;
            }
            if self.depth(of_b) >= self.depth(of_a) {
                b = self.next[&of_b].0;
            }
        }
        a
    }

    /// All gates of an expression, the first one first; none of an expression that is not reached.
    fn after(&self, expr: Expr) -> impl Iterator<Item = Expr> {
        let next = |expr: &Expr| self.next.get(expr).and_then(|(next, _)| *next);
        std::iter::successors(next(&expr), move |expr| next(expr))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::tests::model::Model;
    use crate::model::TimeOrder;

    /// Two parameters in a mass, three in a start.
    fn found(output: &str) -> Vec<Vec<usize>> {
        let mut m = Model::new();
        for name in ["p", "q", "r", "s", "u"] {
            m.interval(name, [1.0, 1.5, 2.0]);
        }
        m.body("b", "p*q", "1", "x", &[]);
        m.initial("b", 'x', TimeOrder::Position, "r + s*u");
        m.initial("b", 'x', TimeOrder::Velocity, "0");
        m.output(output);
        let system = m.build();
        combinations(&system).into_iter().map(|combination| combination.parameters).collect()
    }

    #[test]
    fn combinations_group_parameters_that_act_through_them() {
        assert_eq!(found("b.x"), [vec![0, 1], vec![2, 3, 4]]);
        // Functions of it do no harm, and other combinations of the same parameters do.
        assert_eq!(found("p*q*b.x"), [vec![0, 1], vec![2, 3, 4]]);
        assert_eq!(found("(p + q)*b.x"), [vec![2, 3, 4]]);
        // A parameter that acts by itself, too: s u is not in the output, but u is.
        assert_eq!(found("u*b.x"), [vec![0, 1]]);
        assert_eq!(found("b.x + r"), [vec![0, 1], vec![3, 4]]);
    }

    #[test]
    fn combinations_exclude_functions_that_jump() {
        let mut m = Model::new();
        m.interval("p", [1.0, 1.5, 2.0]);
        m.interval("q", [1.0, 1.5, 2.0]);
        m.body("b", "1 + floor((p*q)^2)", "1", "x", &[]);
        m.initial("b", 'x', TimeOrder::Position, "0");
        m.initial("b", 'x', TimeOrder::Velocity, "0");
        m.output("b.x");
        let system = m.build();
        let found = combinations(&system);
        // Everything below the jump is continuous.
        let at = |expr| system.graph.evaluate(&[expr], |_| 1.5)[0];
        assert_eq!(found.iter().map(|found| [at(found.first), at(found.last)]).collect::<Vec<_>>(), [[2.25, 5.0625]]);
    }
}
