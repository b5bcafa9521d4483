//! A function of one variable, as an expression.

use symdiff::{Expr, Scalar};

/// A function that can be evaluated at any expression.
#[derive(Clone, Copy, Debug)]
pub struct OwnFunction<'g> {
    variable: Scalar<'g>,
    value: Scalar<'g>,
}

impl<'g> OwnFunction<'g> {
    /// The function with a value that is an expression of the symbol `variable`.
    pub fn new(variable: Scalar<'g>, value: Scalar<'g>) -> Self {
        Self { variable, value }
    }

    /// Its derivative by its variable.
    pub fn derivative(&self) -> Self {
        Self { value: self.value.derivative(self.variable), ..*self }
    }

    /// Its derivative by another symbol.
    pub fn derivative_by(&self, symbol: Scalar<'g>) -> Self {
        Self { value: self.value.derivative(symbol), ..*self }
    }

    /// Its value at an expression, which replaces its variable.
    pub fn at(&self, argument: Scalar<'g>) -> Scalar<'g> {
        let g = argument.builder();
        let stands: std::iter::Once<(Expr, Expr)> = std::iter::once((self.variable.expr(), argument.expr()));
        let at = stands.collect();
        let found = g.with(|graph| graph.substitute(&[self.value.expr()], &at));
        g.scalar(found[0])
    }
}
