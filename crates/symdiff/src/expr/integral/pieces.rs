//! Antiderivatives of what is another formula beyond some time.

use rustc_hash::FxHashMap;

use super::super::graph::Graph;
use super::super::node::{Binary, Expr, Node};

impl Graph {
    /// ∫ `value` where `condition`, a + b t with a number b, is positive (`Select`) or is not (`SelectElse`).
    pub(super) fn integral_under(&mut self, function: Binary, condition: Expr, value: Expr, by: Expr) -> Option<Expr> {
        let whole = self.integral(value, by)?;
        if self.moving(condition, by).is_empty() {
            return Some(self.binary(function, condition, whole));
        }
        let slope = self.steady_slope(condition, by)?;
        let is_late = (self.as_constant(slope)? > 0.0) == (function == Binary::Select);
        let zero = self.constant(0.0);
        let at_zero = self.substitute(&[condition], &FxHashMap::from_iter([(by, zero)]))[0];
        let before = self.div(at_zero, slope);
        let switch = self.neg(before);
        let within = self.binary(if is_late { Binary::Max } else { Binary::Min }, by, switch);
        Some(self.substitute(&[whole], &FxHashMap::from_iter([(by, within)]))[0])
    }

    /// ∫ of a polynomial of a straight line that is kept within limits.
    pub(super) fn integral_of_limited(&mut self, of: Expr, by: Expr) -> Option<Expr> {
        let is_limited = |node: Node| matches!(node, Node::Binary(Binary::Max | Binary::Min, ..));
        // Children are before parents: the last is under no other.
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

    /// What `max(u, a)`, `min(u, b)` or both of them in either order keep within limits, and the limits: below, above. Of two
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
