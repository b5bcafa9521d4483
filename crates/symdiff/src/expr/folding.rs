//! Constants are folded and algebraic identities applied as nodes are made.

use super::graph::Graph;
use super::node::{Binary, Expr, Node, Unary};
use crate::eval::functions;

impl Graph {
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
            return self.constant(functions::unary(function, value));
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
            return self.constant(functions::binary(function, x, y));
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
            Binary::Select | Binary::SelectElse => self.guard_nodes(function, a, b),
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
        // A constant operand comes first.
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

    /// Simplifies a guarded value; `function` is `Select` or `SelectElse`.
    fn guard_nodes(&mut self, function: Binary, condition: Expr, value: Expr) -> Expr {
        if self.is_zero(value) {
            return value;
        }
        if let Some(number) = self.as_constant(condition) {
            let kept = (number <= 0.0) == (function == Binary::SelectElse);
            return if kept { value } else { self.constant(0.0) };
        }
        match self.node(value) {
            Node::Binary(inner, same, _) if inner == function && same == condition => value,
            Node::Binary(Binary::Select | Binary::SelectElse, same, _) if same == condition => self.constant(0.0),
            _ => self.intern(Node::Binary(function, condition, value)),
        }
    }

    /// `value` where `condition` is positive, exactly 0 elsewhere, even if `value` is not finite there:
    /// [`Binary::Select`].
    pub fn only_where(&mut self, condition: Expr, value: Expr) -> Expr {
        self.binary(Binary::Select, condition, value)
    }

    /// `a` where `condition` is positive, `b` elsewhere.
    pub fn select(&mut self, condition: Expr, a: Expr, b: Expr) -> Expr {
        // An operand that is a choice under the same condition is decided.
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
        let (a, b) = (self.binary(Binary::Select, condition, a), self.binary(Binary::SelectElse, condition, b));
        self.add(a, b)
    }

    /// `a` to an integer power, by repeated squaring.
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(g.binary(Binary::SelectElse, c, guarded), zero);
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
}
