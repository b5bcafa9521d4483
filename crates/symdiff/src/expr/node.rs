//! Nodes of a graph, and the handles to them.

use super::spline::Spline;

/// A handle to a node of a [`Graph`](super::Graph); valid only for the graph that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Expr(pub(crate) u32);

impl Expr {
    /// Position of the node in its graph; children have smaller indices than their parents.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// −a.
    Neg,
    /// sin a.
    Sin,
    /// cos a.
    Cos,
    /// tan a.
    Tan,
    /// arcsin a, between −π/2 and π/2.
    Asin,
    /// arccos a, between 0 and π.
    Acos,
    /// arctan a, between −π/2 and π/2.
    Atan,
    /// √a.
    Sqrt,
    /// eᵃ.
    Exp,
    /// The natural logarithm.
    Log,
    /// |a|.
    Abs,
    /// tanh a.
    Tanh,
    /// −1, 0 or 1.
    Sign,
    /// The largest integer that is not larger.
    Floor,
    /// A derivative, of this order, of a table.
    Spline(Spline, u8),
}

/// Functions of two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a b.
    Mul,
    /// a / b.
    Div,
    /// aᵇ.
    Pow,
    /// The angle of (b, a) to the first axis, between −π and π.
    Atan2,
    /// The smaller of both.
    Min,
    /// The larger of both.
    Max,
    /// b where a is positive (or NaN), 0 elsewhere. Nodes that are needed only for b are not computed if no sample of a
    /// tile has a positive a.
    Select,
    /// b where a ≤ 0, 0 elsewhere: complementary to [`Select`](Self::Select).
    SelectElse,
}

/// Content of a node.
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
