//! Expressions with operators: a [`Scalar`] is a node together with its graph.
//!
//! Each operator is the [`Graph`] method of the same meaning, applied to its operands from left to right.

use std::cell::{Ref, RefCell};
use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::graph::Graph;
use super::node::{Binary, Expr, Unary};

/// A graph under construction, to which any number of [`Scalar`]s add nodes.
#[derive(Debug, Default)]
pub struct Builder {
    graph: RefCell<Graph>,
}

impl Builder {
    /// A builder with an empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The finished graph.
    pub fn finish(self) -> Graph {
        self.graph.into_inner()
    }

    /// The graph in its present state.
    ///
    /// # Panics
    /// Operators panic while the reference is alive: drop it before the next one.
    pub fn graph(&self) -> Ref<'_, Graph> {
        self.graph.borrow()
    }

    /// Passes the graph to a function on nodes.
    ///
    /// # Panics
    /// If `pass` itself uses the builder.
    pub fn with<R>(&self, pass: impl FnOnce(&mut Graph) -> R) -> R {
        pass(&mut self.graph.borrow_mut())
    }

    /// A node, to compute with.
    pub fn scalar(&self, expr: Expr) -> Scalar<'_> {
        Scalar { builder: self, expr }
    }

    /// A number.
    pub fn number(&self, value: f64) -> Scalar<'_> {
        self.scalar(self.with(|graph| graph.constant(value)))
    }

    /// The symbol of this name; made if it does not exist.
    pub fn variable(&self, name: &str) -> Scalar<'_> {
        self.scalar(self.with(|graph| graph.symbol(name)))
    }

    /// The sum of all terms; zero if there are none.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Scalar<'g>>) -> Scalar<'g> {
        // All terms are made before the first addition.
        let terms: Vec<Scalar<'g>> = terms.into_iter().collect();
        terms.into_iter().fold(self.number(0.0), Add::add)
    }

    /// `Σ aᵢ bᵢ`; both of one length.
    pub fn dot<'g>(&'g self, a: &[Scalar<'g>], b: &[Scalar<'g>]) -> Scalar<'g> {
        assert_eq!(a.len(), b.len(), "a dot product is of two vectors of one length");
        a.iter().zip(b).fold(self.number(0.0), |sum, (&x, &y)| sum + x * y)
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.graph.borrow().len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.graph.borrow().is_empty()
    }
}

/// A node of a graph that is being built, with operators.
///
/// ```
/// use symdiff::Builder;
///
/// let builder = Builder::new();
/// let x = builder.variable("x");
/// let y = (2.0 * x).sin() / (1.0 + x.powi(2));
/// assert_eq!(builder.graph().evaluate(&[y.expr()], |_| 0.5), [1.0_f64.sin() / 1.25]);
/// ```
#[derive(Clone, Copy)]
pub struct Scalar<'g> {
    builder: &'g Builder,
    expr: Expr,
}

impl<'g> Scalar<'g> {
    /// The node.
    pub fn expr(self) -> Expr {
        self.expr
    }

    /// The nodes of several scalars.
    pub fn exprs(scalars: &[Self]) -> Vec<Expr> {
        scalars.iter().map(|scalar| scalar.expr).collect()
    }

    /// Graph of the scalar.
    pub fn builder(self) -> &'g Builder {
        self.builder
    }

    /// Its value, if it is a number.
    pub fn as_constant(self) -> Option<f64> {
        self.builder.graph().as_constant(self.expr)
    }

    /// Whether it is the number zero.
    pub fn is_zero(self) -> bool {
        self.builder.graph().is_zero(self.expr)
    }

    fn unary(self, function: Unary) -> Self {
        self.builder.scalar(self.builder.with(|graph| graph.unary(function, self.expr)))
    }

    fn binary(self, function: Binary, other: Self) -> Self {
        debug_assert!(std::ptr::eq(self.builder, other.builder), "both operands are nodes of one graph");
        self.builder.scalar(self.builder.with(|graph| graph.binary(function, self.expr, other.expr)))
    }

    /// `√self`
    pub fn sqrt(self) -> Self {
        self.unary(Unary::Sqrt)
    }

    /// `sin self`
    pub fn sin(self) -> Self {
        self.unary(Unary::Sin)
    }

    /// `cos self`
    pub fn cos(self) -> Self {
        self.unary(Unary::Cos)
    }

    /// `tanh self`
    pub fn tanh(self) -> Self {
        self.unary(Unary::Tanh)
    }

    /// `exp self`
    pub fn exp(self) -> Self {
        self.unary(Unary::Exp)
    }

    /// The natural logarithm.
    pub fn ln(self) -> Self {
        self.unary(Unary::Log)
    }

    /// `|self|`
    pub fn abs(self) -> Self {
        self.unary(Unary::Abs)
    }

    /// −1, 0 or 1.
    pub fn sign(self) -> Self {
        self.unary(Unary::Sign)
    }

    /// An integer power, by repeated squaring.
    pub fn powi(self, exponent: i32) -> Self {
        self.builder.scalar(self.builder.with(|graph| graph.powi(self.expr, exponent)))
    }

    /// A power.
    pub fn pow(self, exponent: Self) -> Self {
        self.binary(Binary::Pow, exponent)
    }

    /// The angle of (`x`, `self`) to the x axis, between −π and π.
    pub fn atan2(self, x: Self) -> Self {
        self.binary(Binary::Atan2, x)
    }

    /// The smaller of two.
    pub fn min(self, other: Self) -> Self {
        self.binary(Binary::Min, other)
    }

    /// The larger of two.
    pub fn max(self, other: Self) -> Self {
        self.binary(Binary::Max, other)
    }

    /// Itself where `condition` is positive, exactly 0 elsewhere: [`Graph::only_where`].
    pub fn only_where(self, condition: Self) -> Self {
        condition.binary(Binary::Select, self)
    }

    /// `a` where this scalar is positive, `b` elsewhere.
    pub fn select(self, a: Self, b: Self) -> Self {
        self.builder.scalar(self.builder.with(|graph| graph.select(self.expr, a.expr, b.expr)))
    }

    /// `∂self/∂by`, where `by` is a symbol: [`Graph::derivative`].
    pub fn derivative(self, by: Self) -> Self {
        self.builder.scalar(self.builder.with(|graph| graph.derivative(self.expr, by.expr)))
    }

    /// ∫ `self` d`by` from 0, where `by` is a symbol; `None` if there is no formula for it: [`Graph::integral`].
    pub fn integral(self, by: Self) -> Option<Self> {
        let integral = self.builder.with(|graph| graph.integral(self.expr, by.expr));
        integral.map(|expr| self.builder.scalar(expr))
    }
}

impl fmt::Debug for Scalar<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.expr.fmt(f)
    }
}

/// Whether both are the same node.
impl PartialEq for Scalar<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.expr == other.expr && std::ptr::eq(self.builder, other.builder)
    }
}

impl Neg for Scalar<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.unary(Unary::Neg)
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident, $assign:ident $method_assign:ident;)*) => {$(
        impl $operator for Scalar<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.binary(Binary::$operator, other)
            }
        }

        impl $operator<f64> for Scalar<'_> {
            type Output = Self;

            fn $method(self, other: f64) -> Self {
                self.$method(self.builder.number(other))
            }
        }

        impl<'g> $operator<Scalar<'g>> for f64 {
            type Output = Scalar<'g>;

            fn $method(self, other: Scalar<'g>) -> Scalar<'g> {
                other.builder.number(self).$method(other)
            }
        }

        impl $assign for Scalar<'_> {
            fn $method_assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

operators! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
    Div div, DivAssign div_assign;
}

#[cfg(test)]
mod tests {
    use super::super::node::Node;
    use super::*;

    #[test]
    fn operators_make_the_nodes_of_the_methods() {
        let (builder, mut graph) = (Builder::new(), Graph::new());
        let [x, y] = ["x", "y"].map(|name| builder.variable(name));
        let (a, b) = (graph.symbol("x"), graph.symbol("y"));
        let mut sum = x;
        sum += y;
        let found = [x + y * x, -x / y - 1.0, 0.5 * x, x.only_where(y), y.select(x, y), (x * y).derivative(x), sum - y];
        let sum = graph.add(a, b);
        let product = graph.mul(b, a);
        let first = graph.add(a, product);
        let negative = graph.neg(a);
        let (quotient, one) = (graph.div(negative, b), graph.constant(1.0));
        let second = graph.sub(quotient, one);
        let (third, fourth, fifth) = (graph.scale(0.5, a), graph.only_where(b, a), graph.select(b, a, b));
        let sixth = graph.derivative(product, a);
        let wanted = [first, second, third, fourth, fifth, sixth, graph.sub(sum, b)];
        assert_eq!(found.map(Scalar::expr), wanted);
        let graphs = [builder.finish(), graph].map(|graph| graph.exprs_after(0).map(|expr| graph.node(expr)).collect());
        let [found, wanted]: [Vec<Node>; 2] = graphs;
        assert_eq!(found, wanted);
    }
}
