//! Antiderivatives of expressions that can be integrated term by term.
//!
//! ```text
//! polynomials p of t            Σ p⁽ᵏ⁾(0) tᵏ⁺¹/(k + 1)!
//! sin u, cos u, exp u           −cos u/u̇, sin u/u̇, exp u/u̇          u = a + b t, u̇ = b
//! uⁿ, √u                        uⁿ⁺¹/((n + 1) u̇), n ≠ −1
//! max(a, b)                     ∫ b dt + max(u, 0)²/(2 u̇), u = a − b;   min(a, b) = a + b − max(a, b)
//! p f                           p F₁ − ṗ F₂ + p̈ F₃ − …, F the repeated antiderivatives of sin u, cos u, exp u
//! ⌊u⌋, |u|                      ⌊u⌋ (u − (⌊u⌋ + 1)/2)/u̇, u |u|/(2u̇)
//! f where u > 0                 F(max(t, t₀)) or F(min(t, t₀)), u(t₀) = 0, u̇ a number
//! p(w), w = u within [a, b]     [P(w) + p(a) min(u − a, 0) + p(b) max(u − b, 0)]/u̇
//! ```
//!
//! and sums of these with factors that do not depend on t.

mod pieces;

use rustc_hash::{FxHashMap, FxHashSet};

use super::graph::Graph;
use super::node::{Binary, Expr, Node, Unary};
use crate::tuning::TUNING;

impl Graph {
    /// ∫ `of` d`by` from 0, where `by` is a symbol; `None` if it is not of the forms above.
    pub fn integral(&mut self, of: Expr, by: Expr) -> Option<Expr> {
        let moving = self.moving(of, by);
        let (one, zero) = (self.constant(1.0), self.constant(0.0));
        let mut pending = vec![(one, of)];
        let mut parts = Vec::new();
        while let Some((factor, term)) = pending.pop() {
            let steady = |expr: Expr| !moving.contains(&expr);
            match self.node(term) {
                _ if steady(term) => {
                    let rate = self.mul(factor, term);
                    parts.push(self.mul(rate, by));
                }
                Node::Unary(Unary::Neg, a) => {
                    let factor = self.neg(factor);
                    pending.push((factor, a));
                }
                Node::Binary(Binary::Add, a, b) => pending.extend([(factor, a), (factor, b)]),
                Node::Binary(Binary::Sub, a, b) => {
                    let opposite = self.neg(factor);
                    pending.extend([(factor, a), (opposite, b)]);
                }
                Node::Binary(Binary::Mul, a, b) if steady(a) => pending.push((self.mul(factor, a), b)),
                Node::Binary(Binary::Mul, a, b) if steady(b) => pending.push((self.mul(factor, b), a)),
                Node::Binary(Binary::Div, a, b) if steady(b) => pending.push((self.div(factor, b), a)),
                Node::Binary(Binary::Max, a, b) => {
                    pending.push((factor, b));
                    let above = self.sub(a, b);
                    parts.push(self.ramp(factor, above, by)?);
                }
                Node::Binary(Binary::Min, a, b) => {
                    pending.push((factor, a));
                    let (above, opposite) = (self.sub(a, b), self.neg(factor));
                    parts.push(self.ramp(opposite, above, by)?);
                }
                Node::Binary(function @ (Binary::Select | Binary::SelectElse), condition, value) => {
                    let whole = self.integral_under(function, condition, value, by)?;
                    parts.push(self.mul(factor, whole));
                }
                _ => {
                    let whole = match self.polynomial(term, by) {
                        Some(slopes) => self.integral_of_polynomial(&slopes, by),
                        None => match self.integral_of_limited(term, by) {
                            Some(whole) => whole,
                            None => self.integral_of_product(term, by)?,
                        },
                    };
                    parts.push(self.mul(factor, whole));
                }
            }
        }
        let antiderivative = self.sum(parts);
        let at_zero = self.substitute(&[antiderivative], &FxHashMap::from_iter([(by, zero)]))[0];
        Some(self.sub(antiderivative, at_zero))
    }

    /// The nodes under an expression that depend on a symbol.
    fn moving(&self, of: Expr, by: Expr) -> FxHashSet<Expr> {
        let mut moving = FxHashSet::default();
        for expr in self.reachable(&[of]) {
            if expr == by || self.node(expr).children().any(|child| moving.contains(&child)) {
                moving.insert(expr);
            }
        }
        moving
    }

    /// u̇ of u = a + b t; `None` if u is not of this form, or does not depend on t.
    fn steady_slope(&mut self, u: Expr, by: Expr) -> Option<Expr> {
        if !self.is_algebraic(u, by) {
            return None;
        }
        let slope = self.derivative(u, by);
        (!self.is_zero(slope) && self.moving(slope, by).is_empty()).then_some(slope)
    }

    /// `factor` ∫ max(u, 0)
    fn ramp(&mut self, factor: Expr, u: Expr, by: Expr) -> Option<Expr> {
        let zero = self.constant(0.0);
        let clipped = self.binary(Binary::Max, u, zero);
        if self.moving(u, by).is_empty() {
            let rate = self.mul(factor, clipped);
            return Some(self.mul(rate, by));
        }
        let slope = self.steady_slope(u, by)?;
        let (square, doubled) = (self.mul(clipped, clipped), self.scale(2.0, slope));
        let area = self.div(square, doubled);
        Some(self.mul(factor, area))
    }

    /// Whether only sums, products, quotients and powers make an expression of t: between its jumps or corners, another
    /// function may have a derivative like a polynomial's.
    fn is_algebraic(&self, of: Expr, by: Expr) -> bool {
        self.moving(of, by).into_iter().all(|expr| {
            matches!(
                self.node(expr),
                Node::Symbol(_)
                    | Node::Unary(Unary::Neg, _)
                    | Node::Binary(Binary::Add | Binary::Sub | Binary::Mul | Binary::Div | Binary::Pow, ..)
            )
        })
    }

    /// A polynomial and its derivatives.
    fn polynomial(&mut self, of: Expr, by: Expr) -> Option<Vec<Expr>> {
        if !self.is_algebraic(of, by) {
            return None;
        }
        let mut slopes = vec![of];
        while slopes.len() <= TUNING.degree_of_polynomial {
            let slope = self.derivative(slopes[slopes.len() - 1], by);
            if self.is_zero(slope) {
                return Some(slopes);
            }
            slopes.push(slope);
        }
        None
    }

    fn integral_of_polynomial(&mut self, slopes: &[Expr], by: Expr) -> Expr {
        let zero = self.constant(0.0);
        let (mut power, mut parts) = (by, Vec::new());
        for (order, coefficient) in self.substitute(slopes, &FxHashMap::from_iter([(by, zero)])).into_iter().enumerate()
        {
            parts.push(self.mul(coefficient, power));
            power = self.mul(power, by);
            power = self.scale(1.0 / (order as f64 + 2.0), power);
        }
        self.sum(parts)
    }

    /// ∫ p f, or ∫ f.
    fn integral_of_product(&mut self, term: Expr, by: Expr) -> Option<Expr> {
        let (one, mut factors, mut pending) = (self.constant(1.0), Vec::new(), vec![term]);
        while let Some(factor) = pending.pop() {
            match self.node(factor) {
                Node::Binary(Binary::Mul, a, b) => pending.extend([a, b]),
                _ => factors.push(factor),
            }
        }
        let (mut polynomial, mut other) = (one, None);
        for factor in factors {
            if self.polynomial(factor, by).is_some() {
                polynomial = self.mul(polynomial, factor);
            } else if other.replace(factor).is_some() {
                return None;
            }
        }
        let slopes = self.polynomial(polynomial, by)?;
        let (mut sum, mut repeated) = (self.constant(0.0), other?);
        for (order, slope) in slopes.into_iter().enumerate() {
            // A second antiderivative of a power is not one of a product any more.
            if order > 0 && !matches!(self.node(other?), Node::Unary(Unary::Sin | Unary::Cos | Unary::Exp, _)) {
                return None;
            }
            repeated = self.integral_of_function(repeated, by)?;
            let part = self.mul(slope, repeated);
            sum = if order % 2 == 0 { self.add(sum, part) } else { self.sub(sum, part) };
        }
        Some(sum)
    }

    /// ∫ f(u), where only f depends on t, times factors that do not.
    fn integral_of_function(&mut self, of: Expr, by: Expr) -> Option<Expr> {
        let moving = self.moving(of, by);
        match self.node(of) {
            Node::Unary(Unary::Neg, a) => {
                let whole = self.integral_of_function(a, by)?;
                Some(self.neg(whole))
            }
            Node::Binary(Binary::Div, a, b) if !moving.contains(&b) => {
                let whole = self.integral_of_function(a, by)?;
                Some(self.div(whole, b))
            }
            Node::Binary(Binary::Mul, a, b) if !moving.contains(&b) => {
                let whole = self.integral_of_function(a, by)?;
                Some(self.mul(whole, b))
            }
            Node::Binary(Binary::Mul, a, b) if !moving.contains(&a) => {
                let whole = self.integral_of_function(b, by)?;
                Some(self.mul(whole, a))
            }
            Node::Unary(function, u) => {
                let slope = self.steady_slope(u, by)?;
                let whole = match function {
                    Unary::Sin => {
                        let cos = self.cos(u);
                        self.neg(cos)
                    }
                    Unary::Cos => self.sin(u),
                    Unary::Exp => of,
                    Unary::Sqrt => {
                        let cube = self.mul(u, of);
                        self.scale(2.0 / 3.0, cube)
                    }
                    Unary::Floor => {
                        let half = self.scale(0.5, of);
                        let (middle, shift) = (self.sub(u, half), self.constant(0.5));
                        let middle = self.sub(middle, shift);
                        self.mul(of, middle)
                    }
                    Unary::Abs => {
                        let square = self.mul(u, of);
                        self.scale(0.5, square)
                    }
                    _ => return None,
                };
                Some(self.div(whole, slope))
            }
            Node::Binary(Binary::Pow, u, exponent) if !moving.contains(&exponent) => {
                let next = self.as_constant(exponent)? + 1.0;
                let slope = self.steady_slope(u, by)?;
                let exponent = self.constant(next);
                let power = self.binary(Binary::Pow, u, exponent);
                let whole = self.scale(1.0 / next, power);
                (next != 0.0).then(|| self.div(whole, slope))
            }
            _ => None,
        }
    }
}
