//! Values of expressions at the guess from which assembly starts.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Scalar};

use super::mechanism::Mechanism;

/// Values of symbols: the parameters' nominal ones and the guessed coordinates; zero for all others.
pub struct AtGuess(FxHashMap<Expr, f64>);

impl AtGuess {
    /// Values with the guesses of all coordinates, expressions of `graph`.
    pub fn of(m: &Mechanism, graph: &Graph, guess: &[Expr]) -> Self {
        let mut found = Self(m.uncertain.iter().map(|parameter| (parameter.symbol, parameter.nominal)).collect());
        let places = found.values(graph, guess);
        found.set(&m.q, places);
        found
    }

    /// Gives symbols their values.
    pub fn set(&mut self, symbols: &[Scalar], values: Vec<f64>) {
        self.0.extend(symbols.iter().map(|symbol| symbol.expr()).zip(values));
    }

    /// Values of expressions.
    pub fn values(&self, graph: &Graph, exprs: &[Expr]) -> Vec<f64> {
        graph.evaluate(exprs, |symbol| self.0.get(&symbol).copied().unwrap_or(0.0))
    }
}
