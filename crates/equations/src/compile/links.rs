//! Derivatives of the equations of motion of trees, link by link.
//!
//! In joint coordinates each coordinate moves all bodies behind it, so that the derivatives of the equations of motion
//! r(x) fill a matrix. The equations go through few values z of each link, though: how it moves, and the sum of the
//! forces on it and on all behind it. With z = g(x, z) the derivatives are those of a larger and sparse system,
//!
//! ```text
//! [ r_x   r_z    ] [δx]   [ −r ]
//! [ g_x   g_z − 1] [δz] = [  0 ]
//! ```
//!
//! whose right side is zero for z, since residuals are computed through z. It is eliminated link by link from the
//! leaves: forces, then motions, each with the pivot −1, and then the coordinates of the link's joint, with the
//! multiplier that normalises them, whose pivots are those of articulated bodies (Featherstone, *Rigid Body Dynamics
//! Algorithms* (2008), ch. 7). The remainder on the previous link is as large for a long chain as for a short one.
//! (Vertices in the sense of Griewank & Walther, *Evaluating Derivatives*, 2nd ed., ch. 9.)

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Expr, Graph, Node, SparseMatrix};

use crate::assemble::System;
use crate::compile::tuning::TUNING;

/// Whether the equations are eliminated link by link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LinkElimination {
    /// The whole equations are eliminated.
    Whole,
    /// Link by link, if that is shorter.
    Shorter,
    /// Link by link.
    Links,
}

/// Chooses the eliminations that are tried.
pub(super) fn elimination(system: &System, has_redundant: bool) -> LinkElimination {
    let n = system.q.len();
    let is_sparse = !system.is_mass_left_out() && system.mass.len() < TUNING.coupled * n;
    if system.links.is_empty() || has_redundant || system.massive.contains(&false) || is_sparse {
        LinkElimination::Whole
    } else if system.is_mass_left_out() || system.mass.len() >= TUNING.closely_coupled * n {
        LinkElimination::Links
    } else {
        LinkElimination::Shorter
    }
}

/// A value of a link.
#[derive(Clone, Copy, Debug)]
struct Value {
    /// Its expression in the equations.
    value: Expr,
    /// Its symbol in their derivatives.
    symbol: Expr,
    /// Its expression over other values' symbols.
    definition: Expr,
    /// Index of its link.
    link: usize,
}

/// Unknowns of a derivative: symbols, the first one's column, and the factor of the derivatives.
pub(super) type Unknowns<'s> = (&'s [Expr], usize, Option<Expr>);

/// Equations, by the values of links.
#[derive(Clone, Debug)]
pub(super) struct Linked {
    rows: Vec<Expr>,
    /// Each after those on which it depends.
    values: Vec<Value>,
}

impl Linked {
    /// Writes `rows`, which depend on the unknowns `by`, by the values of links.
    pub fn new(system: &System, graph: &mut Graph, rows: &[Expr], by: &[&[Expr]]) -> Self {
        let mut unknown: FxHashSet<Expr> = by.iter().copied().flatten().copied().collect();
        let mut depends = FxHashSet::default();
        for expr in graph.reachable(rows) {
            if graph.node(expr).children().any(|child| unknown.contains(&child)) {
                unknown.insert(expr);
                depends.insert(expr);
            }
        }
        let mut found: Vec<(Expr, usize)> = Vec::new();
        // A value that several links share belongs to the first of them. But inertial forces that are the same for a
        // link and its parent belong to the child: one may be the whole residual of the child's coordinate, which has
        // no pivot before it is eliminated.
        for (link, child) in system.links.iter().enumerate().rev() {
            let of_parent = child.parent.map_or(&[][..], |parent| &system.links[parent].inertial_forces);
            let shared =
                child.inertial_forces.iter().filter(|force| of_parent.contains(force) && depends.remove(force));
            found.extend(shared.map(|&force| (force, link)));
        }
        for (link, of_link) in system.links.iter().enumerate() {
            let values = of_link.values.iter().chain(&of_link.inertial_forces).filter(|value| depends.remove(value));
            found.extend(values.map(|&value| (value, link)));
        }
        found.sort_unstable();
        let symbols: Vec<Expr> = (0..found.len()).map(|index| graph.symbol(&format!("link:{index}"))).collect();
        let symbol_of: FxHashMap<Expr, Expr> = found.iter().map(|found| found.0).zip(symbols.iter().copied()).collect();
        let operands = found.iter().flat_map(|found| graph.node(found.0).children());
        let roots: Vec<Expr> = rows.iter().copied().chain(operands).collect();
        let mut images = graph.substitute(&roots, &symbol_of).into_iter();
        let rows = images.by_ref().take(rows.len()).collect();
        // `substitute` returns an image of each root.
        let mut operand = || images.next().expect("an image of each operand");
        let mut values = Vec::with_capacity(found.len());
        for (&(value, link), symbol) in found.iter().zip(symbols) {
            let definition = match graph.node(value) {
                Node::Unary(function, _) => {
                    let a = operand();
                    graph.unary(function, a)
                }
                Node::Binary(function, ..) => {
                    let (a, b) = (operand(), operand());
                    graph.binary(function, a, b)
                }
                Node::Constant(_) | Node::Symbol(_) => value,
            };
            values.push(Value { value, symbol, definition, link });
        }
        Self { rows, values }
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Adds derivatives to a matrix of the equations' rows, whose rows and columns from `size` on are those of values;
    /// over values' symbols ([`Linked::symbols`]).
    pub fn differentiate(&self, graph: &mut Graph, matrix: &mut SparseMatrix, size: usize, by: &[Unknowns]) {
        let symbols: Vec<Expr> = self.values.iter().map(|value| value.symbol).collect();
        let definitions = self.values.iter().map(|value| value.definition);
        let rows: Vec<Expr> = self.rows.iter().copied().chain(definitions).collect();
        let index = |row: usize| row.checked_sub(self.rows.len()).map_or(row, |value| size + value);
        for &(symbols, first, gain) in by.iter().chain(&[(&symbols[..], size, None)]) {
            for (row, column, value) in graph.jacobian(&rows, symbols).entries() {
                let value = gain.map_or(value, |gain| graph.mul(gain, value));
                matrix.add(graph, index(row), first + column, value);
            }
        }
        let opposite = graph.constant(-1.0);
        for value in size..size + self.values.len() {
            matrix.add(graph, value, value, opposite);
        }
    }

    /// Values' symbols, and the values in the equations.
    pub fn symbols(&self) -> impl Iterator<Item = (Expr, Expr)> {
        self.values.iter().map(|value| (value.symbol, value.value))
    }

    /// Rows and columns of pivots, links from the leaves on.
    pub fn order(&self, system: &System, size: usize) -> Vec<(usize, usize)> {
        let mut of_link: Vec<Vec<usize>> = vec![Vec::new(); system.links.len()];
        for (index, value) in self.values.iter().enumerate().rev() {
            of_link[value.link].push(size + index);
        }
        let links = system.links.iter().zip(of_link).rev();
        let n = system.q.len();
        let pivots = links.flat_map(|(link, values)| {
            let multiplier = link.normalisation.map(|constraint| n + constraint);
            values.into_iter().chain(link.coordinates.iter().copied()).chain(multiplier)
        });
        pivots.map(|pivot| (pivot, pivot)).collect()
    }
}

/// M as derivatives of inertial forces by accelerations, link by link.
#[derive(Clone, Debug)]
pub(super) struct MassOfLinks {
    /// Rows and columns from n + m on are those of values of links.
    pub matrix: SparseMatrix,
    /// Pivots (row, column) before all others.
    pub first: Vec<(usize, usize)>,
}

impl MassOfLinks {
    /// Differentiates the inertial forces of a system.
    pub fn new(system: &System, graph: &mut Graph) -> Self {
        let size = system.q.len() + system.lambda.len();
        let linked = Linked::new(system, graph, &system.inertia, &[&system.w]);
        let mut matrix = SparseMatrix::zero(size + linked.len(), size + linked.len());
        linked.differentiate(graph, &mut matrix, size, &[(&system.w, 0, None)]);
        let values: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
        let mut values = graph.substitute(&values, &linked.symbols().collect()).into_iter();
        for entry in matrix.rows.iter_mut().flatten() {
            // `substitute` returns an image of each of the entries, in this order.
            entry.1 = values.next().expect("one value an entry");
        }
        Self { matrix, first: linked.order(system, size) }
    }
}
