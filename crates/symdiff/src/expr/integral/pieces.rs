//! Antiderivatives of functions defined piecewise in time.

use rustc_hash::FxHashMap;

use super::super::graph::Graph;
use super::super::node::{Binary, Expr, Node, Unary};
use crate::tuning::TUNING;

impl Graph {
    /// ∫ `value` where `condition`, a + b t with a number b, is positive (`Select`) or is not (`SelectElse`).
    pub(super) fn integral_under(&mut self, function: Binary, condition: Expr, value: Expr, by: Expr) -> Option<Expr> {
        let whole = self.integral(value, by)?;
        if self.moving(condition, by).is_empty() {
            return Some(self.binary(function, condition, whole));
        }
        let Some(slope) = self.steady_slope(condition, by) else {
            return self.integral_under_joined(function, condition, value, whole, by);
        };
        let is_late = (self.as_constant(slope)? > 0.0) == (function == Binary::Select);
        let zero = self.constant(0.0);
        let at_zero = self.substitute(&[condition], &FxHashMap::from_iter([(by, zero)]))[0];
        let before = self.div(at_zero, slope);
        let switch = self.neg(before);
        let within = self.binary(if is_late { Binary::Max } else { Binary::Min }, by, switch);
        Some(self.substitute(&[whole], &FxHashMap::from_iter([(by, within)]))[0])
    }

    /// The same for joined conditions: `and` is their product, `or` is a + b − a b.
    fn integral_under_joined(
        &mut self,
        function: Binary,
        condition: Expr,
        value: Expr,
        whole: Expr,
        by: Expr,
    ) -> Option<Expr> {
        if !self.is_truth(condition)? {
            return None;
        }
        let under = self.where_joined(condition, value)?;
        let under = self.integral(under, by)?;
        Some(if function == Binary::Select { under } else { self.sub(whole, under) })
    }

    /// `value` times a sum of products of conditions.
    fn where_joined(&mut self, condition: Expr, value: Expr) -> Option<Expr> {
        if let Some(number) = self.as_constant(condition) {
            return Some(self.scale(number, value));
        }
        match self.node(condition) {
            Node::Unary(Unary::Neg, a) => {
                let a = self.where_joined(a, value)?;
                Some(self.neg(a))
            }
            Node::Binary(function @ (Binary::Add | Binary::Sub), a, b) => {
                let (a, b) = (self.where_joined(a, value)?, self.where_joined(b, value)?);
                Some(self.binary(function, a, b))
            }
            Node::Binary(Binary::Mul, a, b) => {
                let inner = self.where_joined(b, value)?;
                self.where_joined(a, inner)
            }
            Node::Binary(function @ (Binary::Select | Binary::SelectElse), under, one)
                if self.as_constant(one) == Some(1.0) =>
            {
                Some(self.binary(function, under, value))
            }
            _ => None,
        }
    }

    /// Whether an expression of conditions is 0 or 1 for all their combinations; `None` if it contains anything else,
    /// or too many conditions.
    fn is_truth(&self, of: Expr) -> Option<bool> {
        let mut conditions = Vec::new();
        let mut pending = vec![of];
        while let Some(expr) = pending.pop() {
            match self.node(expr) {
                _ if self.as_constant(expr).is_some() => {}
                Node::Unary(Unary::Neg, a) => pending.push(a),
                Node::Binary(Binary::Add | Binary::Sub | Binary::Mul, a, b) => pending.extend([a, b]),
                Node::Binary(Binary::Select | Binary::SelectElse, _, one) if self.as_constant(one) == Some(1.0) => {
                    if !conditions.contains(&expr) {
                        conditions.push(expr);
                    }
                }
                _ => return None,
            }
        }
        let held = (0..1usize << conditions.len().min(TUNING.most_conditions))
            .map(|held| self.truth_where(of, &conditions, held));
        (conditions.len() <= TUNING.most_conditions).then(|| held.into_iter().all(|value| value == 0.0 || value == 1.0))
    }

    /// The value of an expression of conditions, of which those hold whose bits in `held` are set.
    fn truth_where(&self, of: Expr, conditions: &[Expr], held: usize) -> f64 {
        let value = |expr| self.truth_where(expr, conditions, held);
        if let Some(index) = conditions.iter().position(|&condition| condition == of) {
            return f64::from(u8::from(held >> index & 1 == 1));
        }
        match self.node(of) {
            Node::Unary(_, a) => -value(a),
            Node::Binary(Binary::Add, a, b) => value(a) + value(b),
            Node::Binary(Binary::Sub, a, b) => value(a) - value(b),
            Node::Binary(_, a, b) => value(a) * value(b),
            _ => self.as_constant(of).unwrap_or(0.0),
        }
    }

    /// ∫ of a polynomial of a straight line that is limited.
    pub(super) fn integral_of_limited(&mut self, of: Expr, by: Expr) -> Option<Expr> {
        let is_limited = |node: Node| matches!(node, Node::Binary(Binary::Max | Binary::Min, ..));
        // Children come before parents: the last one is not below any other.
        let limited = self.moving(of, by).into_iter().filter(|&expr| is_limited(self.node(expr))).max()?;
        let (line, limits) = self.limited_line(limited, by)?;
        let slope = self.steady_slope(line, by)?;
        // A name that no file can give to anything else.
        let own = self.symbol("own:limited");
        let polynomial = self.substitute(&[of], &FxHashMap::from_iter([(limited, own)]))[0];
        if !self.moving(polynomial, by).is_empty() {
            return None;
        }
        let slopes = self.polynomial(polynomial, own)?;
        let within = self.integral_of_polynomial(&slopes, own);
        let mut parts = self.substitute(&[within], &FxHashMap::from_iter([(own, limited)]));
        let zero = self.constant(0.0);
        for (function, limit) in [(Binary::Min, limits[0]), (Binary::Max, limits[1])] {
            let Some(limit) = limit else { continue };
            let value = self.substitute(&[polynomial], &FxHashMap::from_iter([(own, limit)]))[0];
            let beyond = self.sub(line, limit);
            let beyond = self.binary(function, beyond, zero);
            parts.push(self.mul(value, beyond));
        }
        let whole = self.sum(parts);
        Some(self.div(whole, slope))
    }

    /// The argument of `max(u, a)`, `min(u, b)` or both of them in either order, and its limits: below, above. Two
    /// limits both have to be numbers, the lower one first.
    fn limited_line(&self, of: Expr, by: Expr) -> Option<(Expr, [Option<Expr>; 2])> {
        let parts = |expr: Expr| match self.node(expr) {
            Node::Binary(function @ (Binary::Max | Binary::Min), a, b) => {
                let [moves, steady] = if self.moving(b, by).is_empty() { [a, b] } else { [b, a] };
                self.moving(steady, by).is_empty().then_some((function, moves, steady))
            }
            _ => None,
        };
        let side = |function: Binary| usize::from(function == Binary::Min);
        let (outer, inside, limit) = parts(of)?;
        let mut limits = [None; 2];
        limits[side(outer)] = Some(limit);
        let Some((inner, line, other)) = parts(inside) else { return Some((inside, limits)) };
        limits[side(inner)] = Some(other);
        let [Some(low), Some(high)] = limits else { return None };
        (self.as_constant(low)? <= self.as_constant(high)?).then_some((line, limits))
    }
}
