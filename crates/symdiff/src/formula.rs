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

use std::ops::Range;

use crate::builder::{Builder, Scalar};
use crate::expr::{Binary, Expr, Unary};
use crate::spline::Spline;

/// How deep parentheses, signs and powers may nest.
const MAX_DEPTH: usize = 100;

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
#[allow(missing_docs)]
pub enum Function {
    Unary(Unary),
    Binary(Binary),
}

/// One node of a formula; operands are positions of earlier nodes.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Term {
    Number(f64),
    Name(String),
    Unary(Unary, usize),
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
        let mut parser = Parser { text, tables, position: 0, depth: 0, terms: Vec::new() };
        parser.sum()?;
        parser.skip_space();
        if parser.position < text.len() {
            return Err(parser.unexpected("an operator or the end of the formula"));
        }
        Ok(Self { terms: parser.terms })
    }

    /// The formula that is just a number.
    pub fn number(value: f64) -> Self {
        Self { terms: vec![(Term::Number(value), 0..0)] }
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

struct Parser<'t> {
    text: &'t str,
    tables: &'t [(&'t str, Spline)],
    position: usize,
    depth: usize,
    terms: Vec<(Term, Range<usize>)>,
}

impl Parser<'_> {
    fn skip_space(&mut self) {
        self.position = self.text.len() - self.text[self.position..].trim_start().len();
    }

    /// The next character that is not a space.
    fn peek(&mut self) -> Option<char> {
        self.skip_space();
        self.text[self.position..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.position += wanted.len_utf8();
        }
        found
    }

    fn push(&mut self, term: Term, span: Range<usize>) -> usize {
        self.terms.push((term, span));
        self.terms.len() - 1
    }

    fn start_of(&self, term: usize) -> usize {
        self.terms[term].1.start
    }

    fn binary(&mut self, function: Binary, left: usize, right: usize) -> usize {
        let span = self.start_of(left)..self.position;
        self.push(Term::Binary(function, left, right), span)
    }

    fn unexpected(&mut self, expected: &str) -> SyntaxError {
        match self.peek() {
            Some(found) => SyntaxError {
                message: format!("unexpected `{found}` in formula"),
                span: self.position..self.position + found.len_utf8(),
                help: Some(match found {
                    '=' => "comparisons are not part of formulas".to_owned(),
                    '*' => "a power is written `^`".to_owned(),
                    _ => format!("expected {expected}"),
                }),
            },
            None => SyntaxError {
                message: "the formula ends too early".to_owned(),
                span: self.text.len()..self.text.len(),
                help: Some(format!("expected {expected}")),
            },
        }
    }

    /// Runs `inner` one level deeper.
    fn nested(&mut self, inner: impl FnOnce(&mut Self) -> Result<usize, SyntaxError>) -> Result<usize, SyntaxError> {
        if self.depth == MAX_DEPTH {
            return Err(SyntaxError {
                message: format!("the formula nests deeper than {MAX_DEPTH} levels"),
                span: self.position..self.text.len().min(self.position + 1),
                help: Some("split it into parameters".to_owned()),
            });
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    fn sum(&mut self) -> Result<usize, SyntaxError> {
        let mut left = self.product()?;
        loop {
            let function = if self.take('+') {
                Binary::Add
            } else if self.take('-') {
                Binary::Sub
            } else {
                return Ok(left);
            };
            let right = self.product()?;
            left = self.binary(function, left, right);
        }
    }

    fn product(&mut self) -> Result<usize, SyntaxError> {
        let mut left = self.signed()?;
        loop {
            let function = if self.take('*') {
                Binary::Mul
            } else if self.take('/') {
                Binary::Div
            } else {
                return Ok(left);
            };
            let right = self.signed()?;
            left = self.binary(function, left, right);
        }
    }

    fn signed(&mut self) -> Result<usize, SyntaxError> {
        self.nested(|parser| {
            parser.skip_space();
            let start = parser.position;
            if parser.take('-') {
                let inner = parser.signed()?;
                Ok(parser.push(Term::Unary(Unary::Neg, inner), start..parser.position))
            } else if parser.take('+') {
                parser.signed()
            } else {
                parser.power()
            }
        })
    }

    fn power(&mut self) -> Result<usize, SyntaxError> {
        let base = self.atom()?;
        if self.take('^') {
            let exponent = self.signed()?;
            return Ok(self.binary(Binary::Pow, base, exponent));
        }
        Ok(base)
    }

    fn atom(&mut self) -> Result<usize, SyntaxError> {
        match self.peek() {
            Some('(') => self.nested(|parser| {
                parser.take('(');
                let inner = parser.sum()?;
                parser.close()?;
                Ok(inner)
            }),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name_or_call(),
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    fn close(&mut self) -> Result<(), SyntaxError> {
        if self.take(')') { Ok(()) } else { Err(self.unexpected("`)`")) }
    }

    fn number(&mut self) -> Result<usize, SyntaxError> {
        let start = self.position;
        let rest = &self.text.as_bytes()[start..];
        let digits = |from: usize| from + rest[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut end = digits(0);
        if rest.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(rest.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        self.position = start + end;
        let span = start..self.position;
        match self.text[span.clone()].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(self.push(Term::Number(value), span)),
            _ => Err(SyntaxError {
                message: format!("`{}` is not a finite number", &self.text[span.clone()]),
                span,
                help: None,
            }),
        }
    }

    fn name_or_call(&mut self) -> Result<usize, SyntaxError> {
        let start = self.position;
        let rest = &self.text[start..];
        let mut length = 0;
        loop {
            let part = &rest[length..];
            let end = part.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(part.len());
            length += end;
            // A dot belongs to the name only if a name goes on behind it.
            let mut after = rest[length..].chars();
            match (after.next(), after.next()) {
                (Some('.'), Some(c)) if c.is_alphabetic() || c == '_' => length += 1,
                _ => break,
            }
        }
        self.position = start + length;
        let name = &rest[..length];
        let span = start..self.position;
        if self.peek() == Some('(') {
            return self.call(name, span);
        }
        if name == "pi" {
            return Ok(self.push(Term::Number(std::f64::consts::PI), span));
        }
        if FUNCTIONS.iter().any(|known| known.name == name) || self.tables.iter().any(|(table, _)| *table == name) {
            return Err(SyntaxError {
                message: format!("`{name}` is a function"),
                span,
                help: Some(format!("give it its argument: `{name}(…)`")),
            });
        }
        Ok(self.push(Term::Name(name.to_owned()), span))
    }

    fn call(&mut self, name: &str, span: Range<usize>) -> Result<usize, SyntaxError> {
        let table = self.tables.iter().find(|(known, _)| *known == name);
        let function = match table {
            Some((_, spline)) => Some(Function::Unary(Unary::Spline(*spline, 0))),
            None => FUNCTIONS.iter().find(|known| known.name == name).map(|known| known.function),
        };
        let Some(function) = function else {
            let known: Vec<&str> =
                FUNCTIONS.iter().map(|known| known.name).chain(self.tables.iter().map(|(known, _)| *known)).collect();
            return Err(SyntaxError {
                message: format!("unknown function `{name}`"),
                span,
                help: Some(format!("the functions are {}; a product needs its `*`", known.join(", "))),
            });
        };
        self.nested(|parser| {
            parser.take('(');
            let first = parser.sum()?;
            let second = if parser.take(',') { Some(parser.sum()?) } else { None };
            if second.is_some() && parser.peek() == Some(',') {
                return Err(wrong_count(name, span.start..parser.position + 1, function));
            }
            parser.close()?;
            let span = span.start..parser.position;
            match (function, second) {
                (Function::Unary(function), None) => Ok(parser.push(Term::Unary(function, first), span)),
                (Function::Binary(function), Some(second)) => {
                    Ok(parser.push(Term::Binary(function, first, second), span))
                }
                _ => Err(wrong_count(name, span, function)),
            }
        })
    }
}

fn wrong_count(name: &str, span: Range<usize>, function: Function) -> SyntaxError {
    let expected = match function {
        Function::Unary(_) => format!("one argument: `{name}(x)`"),
        Function::Binary(_) => format!("two arguments: `{name}(x, y)`"),
    };
    SyntaxError { message: format!("`{name}` takes {expected}"), span, help: None }
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
