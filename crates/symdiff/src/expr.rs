//! The expression graph: an arena of hash-consed nodes.
//!
//! Equal subexpressions are one node, so common subexpressions cost nothing to find. Children always come before
//! their parents in the arena, so every pass over a graph is a loop over ascending indices and none recurses.

use rustc_hash::FxHashMap;

use crate::scalar;
use crate::spline::Spline;

/// A handle to a node of a [`Graph`]; valid only for the graph that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Expr(u32);

impl Expr {
    /// Position of the node in its graph; children have smaller indices than their parents.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum Unary {
    Neg,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sqrt,
    Exp,
    Log,
    Abs,
    Tanh,
    Sign,
    /// A derivative, of this order, of a table.
    Spline(Spline, u8),
}

/// Functions of two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Atan2,
    Min,
    Max,
    /// b where a is positive (or not a number), 0 elsewhere. What is needed for such b alone is not computed where no sample
    /// of a tile has a positive a.
    Where,
    /// b where a ≤ 0, 0 elsewhere: together with [`Where`](Self::Where) one of both, always.
    Elsewhere,
}

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number, by its bits, so that nodes can be hashed.
    Constant(u64),
    /// An input, by its position among the graph's symbols.
    Symbol(u32),
    /// A function of one argument.
    Unary(Unary, Expr),
    /// A function of two arguments.
    Binary(Binary, Expr, Expr),
}

impl Node {
    /// The node's children, in order.
    pub fn children(self) -> impl Iterator<Item = Expr> {
        let (a, b) = match self {
            Node::Constant(_) | Node::Symbol(_) => (None, None),
            Node::Unary(_, a) => (Some(a), None),
            Node::Binary(_, a, b) => (Some(a), Some(b)),
        };
        a.into_iter().chain(b)
    }
}

/// A sum of something under a condition and something elsewhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub condition: Expr,
    /// Both summands, and what they guard: wanted where the condition is positive, and elsewhere.
    pub halves: [(Expr, Expr); 2],
}

/// An arena of expressions. Constant folding and the algebraic identities are applied as nodes are made.
///
/// The identities are those of real algebra (`0 x = 0` also where x could be infinite); none changes the order of
/// floating-point operations otherwise.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    known: FxHashMap<Node, Expr>,
    names: Vec<String>,
    symbols: FxHashMap<String, Expr>,
    most: Option<usize>,
    pub(crate) derivatives: FxHashMap<(Expr, Expr), Expr>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the graph has no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// From now on the graph is full where it has more nodes; it goes on growing, but who fills it may look and give up.
    pub fn limit(&mut self, most: Option<usize>) {
        self.most = most;
    }

    /// Whether there are more nodes than the limit, if there is one.
    pub fn is_full(&self) -> bool {
        self.most.is_some_and(|most| self.nodes.len() > most)
    }

    /// Every node but the first `known`, children before parents.
    pub fn exprs_after(&self, known: usize) -> impl Iterator<Item = Expr> + use<> {
        (known as u32..self.nodes.len() as u32).map(Expr)
    }

    /// The node behind a handle.
    pub fn node(&self, expr: Expr) -> Node {
        self.nodes[expr.index()]
    }

    /// The symbol of this name; made if it does not exist.
    pub fn symbol(&mut self, name: &str) -> Expr {
        if let Some(&known) = self.symbols.get(name) {
            return known;
        }
        let position = self.names.len() as u32;
        self.names.push(name.to_owned());
        let expr = self.intern(Node::Symbol(position));
        self.symbols.insert(name.to_owned(), expr);
        expr
    }

    /// Name of a symbol; `None` for any other node.
    pub fn symbol_name(&self, expr: Expr) -> Option<&str> {
        match self.node(expr) {
            Node::Symbol(position) => Some(&self.names[position as usize]),
            _ => None,
        }
    }

    /// A number. Negative zero becomes zero, so that there is one of it.
    pub fn constant(&mut self, value: f64) -> Expr {
        let value = if value == 0.0 { 0.0 } else { value };
        self.intern(Node::Constant(value.to_bits()))
    }

    /// The number a node stands for, if it is one.
    pub fn as_constant(&self, expr: Expr) -> Option<f64> {
        match self.node(expr) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Whether the node is the number zero.
    pub fn is_zero(&self, expr: Expr) -> bool {
        self.as_constant(expr) == Some(0.0)
    }

    fn intern(&mut self, node: Node) -> Expr {
        if let Some(&known) = self.known.get(&node) {
            return known;
        }
        let expr = Expr(u32::try_from(self.nodes.len()).expect("a graph has fewer than 2^32 nodes: memory ends first"));
        self.nodes.push(node);
        self.known.insert(node, expr);
        expr
    }

    /// The argument of a negation, if the node is one.
    fn negated(&self, expr: Expr) -> Option<Expr> {
        match self.node(expr) {
            Node::Unary(Unary::Neg, inner) => Some(inner),
            _ => None,
        }
    }

    /// `function(a)`.
    pub fn unary(&mut self, function: Unary, a: Expr) -> Expr {
        if let Some(value) = self.as_constant(a) {
            return self.constant(scalar::unary(function, value));
        }
        match (function, self.node(a)) {
            (Unary::Neg, Node::Unary(Unary::Neg, inner)) => inner,
            (Unary::Neg, Node::Binary(Binary::Sub, x, y)) => self.binary(Binary::Sub, y, x),
            (Unary::Cos | Unary::Abs, Node::Unary(Unary::Neg, inner)) => self.unary(function, inner),
            (
                Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan | Unary::Tanh | Unary::Sign,
                Node::Unary(Unary::Neg, inner),
            ) => {
                let positive = self.unary(function, inner);
                self.neg(positive)
            }
            _ => self.intern(Node::Unary(function, a)),
        }
    }

    /// `function(a, b)`.
    pub fn binary(&mut self, function: Binary, a: Expr, b: Expr) -> Expr {
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(scalar::binary(function, x, y));
        }
        match function {
            Binary::Add => self.add_nodes(a, b),
            Binary::Sub => self.sub_nodes(a, b),
            Binary::Mul => self.mul_nodes(a, b),
            Binary::Div => self.div_nodes(a, b),
            Binary::Pow => self.pow_nodes(a, b),
            Binary::Min | Binary::Max if a == b => a,
            Binary::Min | Binary::Max => self.intern(Node::Binary(function, a.min(b), a.max(b))),
            Binary::Atan2 => self.intern(Node::Binary(function, a, b)),
            Binary::Where | Binary::Elsewhere => self.guard_nodes(function, a, b),
        }
    }

    fn add_nodes(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) {
            b
        } else if self.is_zero(b) {
            a
        } else if let Some(inner) = self.negated(b) {
            self.binary(Binary::Sub, a, inner)
        } else if let Some(inner) = self.negated(a) {
            self.binary(Binary::Sub, b, inner)
        } else {
            self.intern(Node::Binary(Binary::Add, a.min(b), a.max(b)))
        }
    }

    fn sub_nodes(&mut self, a: Expr, b: Expr) -> Expr {
        if a == b {
            self.constant(0.0)
        } else if self.is_zero(b) {
            a
        } else if self.is_zero(a) {
            self.neg(b)
        } else if let Some(inner) = self.negated(b) {
            self.binary(Binary::Add, a, inner)
        } else if let Some(inner) = self.negated(a) {
            let sum = self.binary(Binary::Add, inner, b);
            self.neg(sum)
        } else {
            self.intern(Node::Binary(Binary::Sub, a, b))
        }
    }

    fn mul_nodes(&mut self, a: Expr, b: Expr) -> Expr {
        // The constant, where there is one, stands first.
        let (a, b) = if self.as_constant(b).is_some() { (b, a) } else { (a, b) };
        if let Some(factor) = self.as_constant(a) {
            if factor == 0.0 {
                return a;
            } else if factor == 1.0 {
                return b;
            } else if factor == -1.0 {
                return self.neg(b);
            } else if let Some(inner) = self.negated(b) {
                let opposite = self.constant(-factor);
                return self.binary(Binary::Mul, opposite, inner);
            }
            return self.intern(Node::Binary(Binary::Mul, a, b));
        }
        match (self.negated(a), self.negated(b)) {
            (Some(x), Some(y)) => self.binary(Binary::Mul, x, y),
            (Some(x), None) => {
                let product = self.binary(Binary::Mul, x, b);
                self.neg(product)
            }
            (None, Some(y)) => {
                let product = self.binary(Binary::Mul, a, y);
                self.neg(product)
            }
            (None, None) => self.intern(Node::Binary(Binary::Mul, a.min(b), a.max(b))),
        }
    }

    fn div_nodes(&mut self, a: Expr, b: Expr) -> Expr {
        if self.is_zero(a) || self.as_constant(b) == Some(1.0) {
            return a;
        }
        if self.as_constant(b) == Some(-1.0) {
            return self.neg(a);
        }
        if a == b {
            return self.constant(1.0);
        }
        // Dividing by a power of two is multiplying by its inverse, to the bit.
        if let Some(divisor) = self.as_constant(b)
            && divisor.to_bits() << 12 == 0
            && divisor.is_normal()
            && (1.0 / divisor).is_normal()
        {
            let inverse = self.constant(1.0 / divisor);
            return self.binary(Binary::Mul, inverse, a);
        }
        match (self.negated(a), self.negated(b)) {
            (Some(x), Some(y)) => self.binary(Binary::Div, x, y),
            (Some(x), None) => {
                let quotient = self.binary(Binary::Div, x, b);
                self.neg(quotient)
            }
            (None, Some(y)) => {
                let quotient = self.binary(Binary::Div, a, y);
                self.neg(quotient)
            }
            (None, None) => self.intern(Node::Binary(Binary::Div, a, b)),
        }
    }

    fn pow_nodes(&mut self, a: Expr, b: Expr) -> Expr {
        match self.as_constant(b) {
            Some(0.5) => self.sqrt(a),
            Some(exponent) if exponent.fract() == 0.0 && exponent.abs() <= 32.0 => self.powi(a, exponent as i32),
            _ => self.intern(Node::Binary(Binary::Pow, a, b)),
        }
    }

    /// `function` is one of the two.
    fn guard_nodes(&mut self, function: Binary, condition: Expr, value: Expr) -> Expr {
        if self.is_zero(value) {
            return value;
        }
        if let Some(number) = self.as_constant(condition) {
            let kept = (number <= 0.0) == (function == Binary::Elsewhere);
            return if kept { value } else { self.constant(0.0) };
        }
        match self.node(value) {
            Node::Binary(inner, same, _) if inner == function && same == condition => value,
            Node::Binary(Binary::Where | Binary::Elsewhere, same, _) if same == condition => self.constant(0.0),
            _ => self.intern(Node::Binary(function, condition, value)),
        }
    }

    /// `value` where `condition` is positive, exactly 0 elsewhere, whatever `value` is there: [`Binary::Where`].
    pub fn only_where(&mut self, condition: Expr, value: Expr) -> Expr {
        self.binary(Binary::Where, condition, value)
    }

    /// `a` where `condition` is positive, `b` elsewhere.
    pub fn select(&mut self, condition: Expr, a: Expr, b: Expr) -> Expr {
        // A choice under the same condition has been made.
        let half = |expr: Expr, which: usize| match self.node(expr) {
            Node::Binary(Binary::Add, x, y) => match self.choice(x, y) {
                Some(choice) if choice.condition == condition => choice.halves[which].1,
                _ => expr,
            },
            _ => expr,
        };
        let (a, b) = (half(a, 0), half(b, 1));
        if a == b {
            return a;
        }
        let (a, b) = (self.binary(Binary::Where, condition, a), self.binary(Binary::Elsewhere, condition, b));
        self.add(a, b)
    }

    /// What `x + y` is where it is a [choice](Self::select).
    pub(crate) fn choice(&self, x: Expr, y: Expr) -> Option<Choice> {
        let half = |wanted: Binary, expr: Expr| match self.node(expr) {
            Node::Binary(function, condition, value) if function == wanted => Some((condition, value)),
            _ => None,
        };
        [(x, y), (y, x)].into_iter().find_map(|(x, y)| {
            let ((condition, a), (same, b)) = (half(Binary::Where, x)?, half(Binary::Elsewhere, y)?);
            (condition == same).then_some(Choice { condition, halves: [(x, a), (y, b)] })
        })
    }

    /// `roots` as they are where `condition` is positive (`holds`), or where it is not.
    pub fn assume(&mut self, roots: &[Expr], condition: Expr, holds: bool) -> Vec<Expr> {
        let zero = self.constant(0.0);
        self.rebuild(roots, |_, node, image| match node {
            Node::Binary(function @ (Binary::Where | Binary::Elsewhere), given, value) if given == condition => {
                Some(if holds == (function == Binary::Where) { image[&value] } else { zero })
            }
            _ => None,
        })
    }

    /// `a` to a whole power, by repeated squaring.
    pub fn powi(&mut self, a: Expr, exponent: i32) -> Expr {
        let mut result = self.constant(1.0);
        let mut square = a;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.mul(result, square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.mul(square, square);
            }
        }
        if exponent < 0 {
            let one = self.constant(1.0);
            return self.div(one, result);
        }
        result
    }

    /// `a + b`.
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Add, a, b)
    }

    /// `a - b`.
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Sub, a, b)
    }

    /// `a b`.
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Mul, a, b)
    }

    /// `a / b`.
    pub fn div(&mut self, a: Expr, b: Expr) -> Expr {
        self.binary(Binary::Div, a, b)
    }

    /// `-a`.
    pub fn neg(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Neg, a)
    }

    /// `sin a`.
    pub fn sin(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Sin, a)
    }

    /// `cos a`.
    pub fn cos(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Cos, a)
    }

    /// `√a`.
    pub fn sqrt(&mut self, a: Expr) -> Expr {
        self.unary(Unary::Sqrt, a)
    }

    /// `factor · a`.
    pub fn scale(&mut self, factor: f64, a: Expr) -> Expr {
        let factor = self.constant(factor);
        self.mul(factor, a)
    }

    /// The sum of all terms; zero if there are none.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = Expr>) -> Expr {
        let mut total = self.constant(0.0);
        for term in terms {
            total = self.add(total, term);
        }
        total
    }

    /// `Σ aᵢ bᵢ`; both of one length.
    pub fn dot(&mut self, a: &[Expr], b: &[Expr]) -> Expr {
        assert_eq!(a.len(), b.len(), "a dot product is of two vectors of one length");
        let mut total = self.constant(0.0);
        for (&x, &y) in a.iter().zip(b) {
            let product = self.mul(x, y);
            total = self.add(total, product);
        }
        total
    }

    /// All nodes that `roots` need, themselves included, children before parents.
    pub fn reachable(&self, roots: &[Expr]) -> Vec<Expr> {
        let mut seen = rustc_hash::FxHashSet::default();
        let mut stack = roots.to_vec();
        let mut found = Vec::new();
        while let Some(expr) = stack.pop() {
            if seen.insert(expr) {
                found.push(expr);
                stack.extend(self.node(expr).children());
            }
        }
        found.sort_unstable();
        found
    }

    /// The symbols that `roots` depend on, in the order they were made.
    pub fn symbols_of(&self, roots: &[Expr]) -> Vec<Expr> {
        let mut found = self.reachable(roots);
        found.retain(|&expr| matches!(self.node(expr), Node::Symbol(_)));
        found
    }

    /// `roots` with every key of `replacements` replaced by its value.
    pub fn substitute(&mut self, roots: &[Expr], replacements: &FxHashMap<Expr, Expr>) -> Vec<Expr> {
        self.rebuild(roots, |expr, _, _| replacements.get(&expr).copied())
    }

    /// `roots` anew, with those nodes replaced for which there is something else, by the images of what is below them.
    fn rebuild(
        &mut self,
        roots: &[Expr],
        replaced: impl Fn(Expr, Node, &FxHashMap<Expr, Expr>) -> Option<Expr>,
    ) -> Vec<Expr> {
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        for expr in self.reachable(roots) {
            let node = self.node(expr);
            let new = match (replaced(expr, node, &image), node) {
                (Some(replacement), _) => replacement,
                (None, Node::Constant(_) | Node::Symbol(_)) => expr,
                (None, Node::Unary(function, a)) => self.unary(function, image[&a]),
                (None, Node::Binary(function, a, b)) => self.binary(function, image[&a], image[&b]),
            };
            image.insert(expr, new);
        }
        roots.iter().map(|root| image[root]).collect()
    }

    /// Values of `roots` where each symbol has the value that `value_of` gives it: one pass, in index order, with the
    /// same arithmetic as the tapes.
    pub fn evaluate(&self, roots: &[Expr], mut value_of: impl FnMut(Expr) -> f64) -> Vec<f64> {
        let mut values: FxHashMap<Expr, f64> = FxHashMap::default();
        for expr in self.reachable(roots) {
            let value = match self.node(expr) {
                Node::Constant(bits) => f64::from_bits(bits),
                Node::Symbol(_) => value_of(expr),
                Node::Unary(function, a) => scalar::unary(function, values[&a]),
                // A sum would lose the sign of zero, which instructions keep.
                Node::Binary(Binary::Add, x, y) if let Some(choice) = self.choice(x, y) => {
                    let [(_, a), (_, b)] = choice.halves;
                    scalar::select(values[&choice.condition], values[&a], values[&b])
                }
                Node::Binary(function, a, b) => scalar::binary(function, values[&a], values[&b]),
            };
            values.insert(expr, value);
        }
        roots.iter().map(|root| values[root]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_subexpressions_are_one_node() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        assert_eq!(g.add(x, y), g.add(y, x));
        let (p, q) = (g.mul(x, y), g.mul(y, x));
        assert_eq!(p, q);
        assert_eq!(g.sub(p, q), g.constant(0.0));
    }

    #[test]
    fn identities_are_applied_as_nodes_are_made() {
        let mut g = Graph::new();
        let x = g.symbol("x");
        let (zero, one, two) = (g.constant(0.0), g.constant(1.0), g.constant(2.0));
        assert_eq!(g.add(x, zero), x);
        assert_eq!(g.mul(x, one), x);
        assert_eq!(g.mul(x, zero), zero);
        let negative = g.neg(x);
        assert_eq!(g.neg(negative), x);
        assert_eq!(g.mul(negative, negative), g.powi(x, 2));
        let (s, c) = (g.sin(negative), g.cos(negative));
        let sine = g.sin(x);
        assert_eq!(s, g.neg(sine));
        assert_eq!(c, g.cos(x));
        assert_eq!(g.div(x, two), g.scale(0.5, x));
        assert_eq!(g.add(two, one), g.constant(3.0));
    }

    #[test]
    fn guards_fold_and_can_be_assumed() {
        let mut g = Graph::new();
        let (c, x, y, zero, one) = (g.symbol("c"), g.symbol("x"), g.symbol("y"), g.constant(0.0), g.constant(1.0));
        assert_eq!((g.only_where(one, x), g.only_where(zero, x)), (x, zero));
        let guarded = g.only_where(c, x);
        assert_eq!(g.only_where(c, guarded), guarded);
        assert_eq!(g.binary(Binary::Elsewhere, c, guarded), zero);
        assert_eq!(g.select(c, x, x), x);
        let [one_way, other_way] = [g.select(c, x, y), g.select(c, y, x)];
        assert_eq!(g.select(c, one_way, other_way), x);
        let either = g.select(c, x, y);
        let square = g.mul(either, guarded);
        assert_eq!(g.assume(&[square, either], c, true), [g.mul(x, x), x]);
        assert_eq!(g.assume(&[square, either], c, false), [zero, y]);
        let values = |condition: f64| {
            let value = |symbol: Expr| if symbol == c { condition } else { f64::from(symbol.index() as u32) };
            g.evaluate(&[either, guarded], value)
        };
        let [x, y] = [x, y].map(|symbol| symbol.index() as f64);
        assert_eq!(values(1e-300), [x, x]);
        assert_eq!(values(0.0), [y, 0.0]);
        assert_eq!(values(f64::NAN), [x, x]);
    }

    #[test]
    fn substitution_rebuilds_and_folds() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let product = g.mul(x, y);
        let sum = g.add(product, y);
        let zero = g.constant(0.0);
        let replaced = g.substitute(&[sum], &FxHashMap::from_iter([(x, zero)]));
        assert_eq!(replaced, [y]);
    }
}
