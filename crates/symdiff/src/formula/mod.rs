//! The formula language: text → [`Formula`] → [`Expr`].
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = ("+" | "-") signed | power
//! power   = atom [ "^" signed ]                   right-associative; binds tighter than a sign: -a^2 = -(a^2)
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! name    = letter { letter | digit | "_" } { "." name }
//! ```
//!
//! `pi` is the number; every other name, `t` included, is for the caller to resolve.

mod parser;

use std::ops::Range;

use crate::expr::{Binary, Builder, Expr, Scalar, Spline, Unary};

/// The functions of the language.
pub const FUNCTIONS: [NamedFunction; 15] = [
    NamedFunction::new("sin", Function::Unary(Unary::Sin), "x", "all x, rad", "sine"),
    NamedFunction::new("cos", Function::Unary(Unary::Cos), "x", "all x, rad", "cosine"),
    NamedFunction::new("tan", Function::Unary(Unary::Tan), "x", "x ≠ π/2 + kπ, rad", "tangent"),
    NamedFunction::new("asin", Function::Unary(Unary::Asin), "x", "−1 ≤ x ≤ 1", "angle with this sine, −π/2 to π/2"),
    NamedFunction::new("acos", Function::Unary(Unary::Acos), "x", "−1 ≤ x ≤ 1", "angle with this cosine, 0 to π"),
    NamedFunction::new("atan", Function::Unary(Unary::Atan), "x", "all x", "angle with this tangent, −π/2 to π/2"),
    NamedFunction::new(
        "atan2",
        Function::Binary(Binary::Atan2),
        "y, x",
        "not both 0",
        "angle of the point (x, y), −π to π",
    ),
    NamedFunction::new("sqrt", Function::Unary(Unary::Sqrt), "x", "x ≥ 0", "square root"),
    NamedFunction::new("exp", Function::Unary(Unary::Exp), "x", "all x", "exponential"),
    NamedFunction::new("log", Function::Unary(Unary::Log), "x", "x > 0", "natural logarithm"),
    NamedFunction::new("abs", Function::Unary(Unary::Abs), "x", "all x", "magnitude"),
    NamedFunction::new("tanh", Function::Unary(Unary::Tanh), "x", "all x", "hyperbolic tangent"),
    NamedFunction::new("sign", Function::Unary(Unary::Sign), "x", "all x", "−1, 0 or 1"),
    NamedFunction::new("min", Function::Binary(Binary::Min), "a, b", "all a, b", "the smaller of two"),
    NamedFunction::new("max", Function::Binary(Binary::Max), "a, b", "all a, b", "the larger of two"),
];

/// A function as formulas call it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedFunction {
    /// Its name.
    pub name: &'static str,
    /// What it computes.
    pub function: Function,
    /// Its arguments.
    pub arguments: &'static str,
    /// The arguments for which it has a value.
    pub domain: &'static str,
    /// Its value in words.
    pub value: &'static str,
}

impl NamedFunction {
    const fn new(
        name: &'static str,
        function: Function,
        arguments: &'static str,
        domain: &'static str,
        value: &'static str,
    ) -> Self {
        Self { name, function, arguments, domain, value }
    }
}

/// A function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Of one argument.
    Unary(Unary),
    /// Of two arguments.
    Binary(Binary),
}

/// One node of a formula; operands are positions of earlier nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// A literal number.
    Number(f64),
    /// A name, dots included.
    Name(String),
    /// A function of one term.
    Unary(Unary, usize),
    /// A function of two terms.
    Binary(Binary, usize, usize),
}

/// A parsed formula: its nodes, operands first, the result last, each with its place (bytes) in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    terms: Vec<(Term, Range<usize>)>,
}

/// What is wrong with a formula, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// What is wrong.
    pub message: String,
    /// Bytes of the text that are wrong; empty at its end.
    pub span: Range<usize>,
    /// What would be right, where that is known.
    pub help: Option<String>,
}

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// The first syntax error, with its place.
    pub fn parse(text: &str) -> Result<Self, SyntaxError> {
        Self::parse_with(text, &[])
    }

    /// Reads a formula in which tables, by their names, are functions of one argument.
    ///
    /// # Errors
    /// The first syntax error, with its place.
    pub fn parse_with(text: &str, tables: &[(&str, Spline)]) -> Result<Self, SyntaxError> {
        Ok(Self { terms: parser::terms(text, tables)? })
    }

    /// The formula that is just a number.
    pub fn number(value: f64) -> Self {
        Self { terms: vec![(Term::Number(value), 0..0)] }
    }

    /// The formula that is just a name.
    pub fn name(name: &str) -> Self {
        Self { terms: vec![(Term::Name(name.to_owned()), 0..0)] }
    }

    /// `function(self, other)`; places are those in either's own text.
    #[must_use]
    pub fn combined(&self, function: Binary, other: &Self) -> Self {
        let shift = self.terms.len();
        let shifted = |(term, span): &(Term, Range<usize>)| {
            let term = match term {
                Term::Unary(function, a) => Term::Unary(*function, a + shift),
                Term::Binary(function, a, b) => Term::Binary(*function, a + shift, b + shift),
                Term::Number(_) | Term::Name(_) => term.clone(),
            };
            (term, span.clone())
        };
        let mut terms = self.terms.clone();
        terms.extend(other.terms.iter().map(shifted));
        let last = terms.len() - 1;
        terms.push((Term::Binary(function, shift - 1, last), 0..0));
        Self { terms }
    }

    /// The number, if the formula is a literal one (a sign in front is allowed).
    pub fn as_number(&self) -> Option<f64> {
        match self.terms.as_slice() {
            [(Term::Number(value), _)] => Some(*value),
            [(Term::Number(value), _), (Term::Unary(Unary::Neg, _), _)] => Some(-value),
            _ => None,
        }
    }

    /// All nodes, operands first, the result last.
    pub fn terms(&self) -> &[(Term, Range<usize>)] {
        &self.terms
    }

    /// Every use of a name with its place.
    pub fn names(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        self.terms.iter().filter_map(|(term, span)| match term {
            Term::Name(name) => Some((name.as_str(), span.clone())),
            _ => None,
        })
    }

    /// The formula as an expression, names given by `resolve`.
    ///
    /// # Errors
    /// Whatever `resolve` says.
    pub fn build<'g, E>(
        &self,
        builder: &'g Builder,
        mut resolve: impl FnMut(&str) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        let mut built: Vec<Expr> = Vec::with_capacity(self.terms.len());
        for (term, _) in &self.terms {
            let expr = match term {
                Term::Number(value) => builder.with(|graph| graph.constant(*value)),
                Term::Name(name) => resolve(name)?.expr(),
                Term::Unary(function, a) => builder.with(|graph| graph.unary(*function, built[*a])),
                Term::Binary(function, a, b) => builder.with(|graph| graph.binary(*function, built[*a], built[*b])),
            };
            built.push(expr);
        }
        Ok(builder.scalar(*built.last().expect("parse and number make at least one term")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let builder = Builder::new();
        let built = Formula::parse(text).unwrap().build(&builder, |name| Err(name.to_owned())).unwrap();
        built.as_constant().unwrap()
    }

    #[test]
    fn precedence_and_associativity_are_those_of_mathematics() {
        assert_eq!(value("1 + 2*3"), 7.0);
        assert_eq!(value("10 - 4 - 3"), 3.0);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("-2^2"), -4.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("12/3/2"), 2.0);
        assert_eq!(value("2*-3"), -6.0);
        assert_eq!(value("1.5e2 + .5 + 2."), 152.5);
        assert_eq!(value("max(1, 2) + min(3, 4) + abs(-1) + sign(-5)"), 5.0);
        assert!((value("sin(pi/6)") - 0.5).abs() < 1e-15);
        assert!((value("atan2(1, -1)") - 0.75 * std::f64::consts::PI).abs() < 1e-15);
    }

    #[test]
    fn names_keep_their_dots_and_places() {
        let formula = Formula::parse("crank.angle + rod.C.y*l1").unwrap();
        let names: Vec<_> = formula.names().collect();
        assert_eq!(names, [("crank.angle", 0..11), ("rod.C.y", 14..21), ("l1", 22..24)]);
    }

    #[test]
    fn errors_say_where() {
        let span = |text: &str| Formula::parse(text).unwrap_err().span;
        assert_eq!(span("1 + * 2"), 4..5);
        assert_eq!(span("1 +"), 3..3);
        assert_eq!(span("(1 + 2"), 6..6);
        assert_eq!(span("1 2"), 2..3);
        assert_eq!(span("foo(1)"), 0..3);
        assert_eq!(span("2 + sin"), 4..7);
        assert_eq!(span("sin(1, 2)"), 0..9);
        assert_eq!(span("1e999"), 0..5);
        assert_eq!(span(""), 0..0);
        assert!(Formula::parse(&"(".repeat(10_000)).unwrap_err().message.contains("nests deeper"));
        assert!(Formula::parse(&"-".repeat(10_000)).unwrap_err().message.contains("nests deeper"));
    }

    #[test]
    fn long_sums_do_not_nest() {
        assert_eq!(value(&vec!["1"; 100_000].join("+")), 100_000.0);
    }
}
