//! The formula language: text → [`Formula`] → [`Expr`].
//!
//! ```text
//! formula    = both { "or" both }
//! both       = negation { "and" negation }
//! negation   = "not" negation | comparison
//! comparison = sum [ ("<" | "<=" | ">" | ">=" | "==" | "!=") sum ]      1 where it holds, 0 elsewhere
//! sum        = product { ("+" | "-") product }
//! product    = signed { ("*" | "/") signed }
//! signed     = ("+" | "-") signed | power
//! power      = atom [ "^" signed ]               right-associative; binds tighter than a sign: -a^2 = -(a^2)
//! atom       = number [ unit ] | name | function "(" formula { "," formula } ")" | "(" formula ")" | repeated
//! repeated   = "sum" "(" index "," whole ".." whole "," formula ")"
//! name       = letter { letter | digit | "_" } { "." name }
//! ```
//!
//! In a repeated formula, and if the caller knows indices, names may have integers in braces: `leg_{i - 1}.force`.
//!
//! `pi` is the number; the caller resolves every other name, `t` included, and units.

mod composed;
mod conditions;
pub mod indices;
mod parser;
mod repeated;
mod vocabulary;

pub use composed::Composed;
pub use vocabulary::{Names, Quantity, ReadUnit, Vocabulary};

use std::ops::Range;

use crate::expr::{Binary, Builder, Expr, Scalar, Unary};

/// The functions of the language.
pub const FUNCTIONS: [NamedFunction; 23] = [
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
    NamedFunction::new(
        "floor",
        Function::Unary(Unary::Floor),
        "x",
        "all x",
        "the largest whole number that is not larger",
    ),
    NamedFunction::new(
        "ceil",
        Function::Composed(Composed::Ceil),
        "x",
        "all x",
        "the smallest whole number that is not smaller",
    ),
    NamedFunction::new(
        "round",
        Function::Composed(Composed::Round),
        "x",
        "all x",
        "the nearest whole number; of a half, the larger one",
    ),
    NamedFunction::new("mod", Function::Composed(Composed::Mod), "a, b", "b ≠ 0", "a − b floor(a/b), of the sign of b"),
    NamedFunction::new(
        "if",
        Function::Composed(Composed::If),
        "condition, a, b",
        "all",
        "a where the condition is true (or a positive number), else b",
    ),
    NamedFunction::new(
        "clamp",
        Function::Composed(Composed::Clamp),
        "x, low, high",
        "low ≤ high",
        "x, but not below low nor above high",
    ),
    NamedFunction::new(
        "smoothstep",
        Function::Composed(Composed::Smoothstep),
        "a, b, x",
        "a ≠ b",
        "0 up to x = a, 1 from x = b on, between them 3u² − 2u³ with u = (x − a)/(b − a)",
    ),
    NamedFunction::new(
        "deg",
        Function::Composed(Composed::Degrees),
        "x",
        "all x, rad",
        "the angle x in degrees, a pure number",
    ),
];

/// A function as named in formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedFunction {
    /// Its name.
    pub name: &'static str,
    /// Expression of the formula.
    pub function: Function,
    /// Its arguments.
    pub arguments: &'static str,
    /// The arguments for which it is defined.
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

    /// Whether nothing else may have the name. Names like `floor` and `round` are functions only in a call, since
    /// models may have a floor, too.
    pub fn is_reserved(&self) -> bool {
        !matches!(self.function, Function::Composed(_) | Function::Unary(Unary::Floor))
    }
}

/// A function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Function of one argument.
    Unary(Unary),
    /// Function of two arguments.
    Binary(Binary),
    /// Function composed of several.
    Composed(Composed),
}

/// One node of a formula; operands are positions of earlier nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// A literal number.
    Number(f64),
    /// A literal number with a unit: its value, and the mark of the caller's reader of units, such as its dimension.
    Quantity(f64, u64),
    /// A name, dots included.
    Name(String),
    /// A function of one term.
    Unary(Unary, usize),
    /// A function of two terms.
    Binary(Binary, usize, usize),
    /// The difference of two terms of which only the sign matters.
    Compared(usize, usize),
    /// An angle in degrees, as a number.
    Degrees(usize),
}

impl Term {
    /// The positions of its operands.
    pub fn operands(&self) -> impl Iterator<Item = usize> {
        let [first, second] = match self {
            Self::Unary(_, a) | Self::Degrees(a) => [Some(*a), None],
            Self::Binary(_, a, b) | Self::Compared(a, b) => [Some(*a), Some(*b)],
            Self::Number(_) | Self::Quantity(..) | Self::Name(_) => [None; 2],
        };
        first.into_iter().chain(second)
    }

    /// The same term with its operands at other positions.
    fn moved(&self, place: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Unary(function, a) => Self::Unary(*function, place(*a)),
            Self::Binary(function, a, b) => Self::Binary(*function, place(*a), place(*b)),
            Self::Compared(a, b) => Self::Compared(place(*a), place(*b)),
            Self::Degrees(a) => Self::Degrees(place(*a)),
            Self::Number(_) | Self::Quantity(..) | Self::Name(_) => self.clone(),
        }
    }
}

/// A parsed formula: its nodes, operands first, the result last, each with its location (bytes) in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    terms: Vec<(Term, Range<usize>)>,
}

/// An error in a formula, with its span.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct SyntaxError {
    /// Description of the error.
    pub message: String,
    /// Bytes of the text that are wrong; empty at its end.
    pub span: Range<usize>,
    /// A correction, if known.
    pub help: Option<String>,
}

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// The first syntax error, with its location.
    pub fn parse(text: &str) -> Result<Self, SyntaxError> {
        Self::parse_with(text, &Vocabulary::default())
    }

    /// Reads a formula with tables and units.
    ///
    /// # Errors
    /// The first syntax error, with its location.
    pub fn parse_with(text: &str, vocabulary: &Vocabulary) -> Result<Self, SyntaxError> {
        Ok(Self { terms: parser::terms(text, vocabulary)? })
    }

    /// The formula that is just a number.
    pub fn number(value: f64) -> Self {
        Self { terms: vec![(Term::Number(value), 0..0)] }
    }

    /// The formula that is just a name.
    pub fn name(name: &str) -> Self {
        Self { terms: vec![(Term::Name(name.to_owned()), 0..0)] }
    }

    /// `function(self, other)`; locations are those in either's own text.
    #[must_use]
    pub fn combined(&self, function: Binary, other: &Self) -> Self {
        let shift = self.terms.len();
        let shifted = |(term, span): &(Term, Range<usize>)| (term.moved(|place| place + shift), span.clone());
        let mut terms = self.terms.clone();
        terms.extend(other.terms.iter().map(shifted));
        let last = terms.len() - 1;
        terms.push((Term::Binary(function, shift - 1, last), 0..0));
        Self { terms }
    }

    /// The same formula with some names replaced by formulas, whose nodes have the name's location.
    #[must_use]
    pub fn with_names(&self, formula: impl Fn(&str) -> Option<Self>) -> Self {
        let mut terms: Vec<(Term, Range<usize>)> = Vec::with_capacity(self.terms.len());
        let mut places = Vec::with_capacity(self.terms.len());
        for (term, span) in &self.terms {
            match term {
                Term::Name(name) => match formula(name) {
                    Some(other) => {
                        let first = terms.len();
                        terms.extend(
                            other.terms.iter().map(|(term, _)| (term.moved(|index| index + first), span.clone())),
                        );
                    }
                    None => terms.push((term.clone(), span.clone())),
                },
                _ => terms.push((term.moved(|index| places[index]), span.clone())),
            }
            places.push(terms.len() - 1);
        }
        Self { terms }
    }

    /// `function(self)`.
    #[must_use]
    pub fn applied(&self, function: Unary) -> Self {
        let mut terms = self.terms.clone();
        terms.push((Term::Unary(function, self.terms.len() - 1), 0..0));
        Self { terms }
    }

    /// The argument of a function, if the whole formula is its call.
    pub fn argument_of(&self, function: Unary) -> Option<Self> {
        match self.terms.split_last() {
            Some(((Term::Unary(outer, argument), _), before))
                if *outer == function && *argument + 1 == before.len() =>
            {
                Some(Self { terms: before.to_vec() })
            }
            _ => None,
        }
    }

    /// The number, if the formula is a literal one (with or without a sign).
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

    /// The formula of one of its nodes.
    #[must_use]
    pub fn part(&self, node: usize) -> Self {
        let mut is_in = vec![false; self.terms.len()];
        is_in[node] = true;
        // Operands come before their results.
        for index in (0..=node).rev() {
            if let (true, term) = (is_in[index], &self.terms[index].0) {
                term.operands().for_each(|operand| is_in[operand] = true);
            }
        }
        let mut places = vec![0; self.terms.len()];
        let mut terms = Vec::new();
        for (index, (term, span)) in self.terms.iter().enumerate().filter(|(index, _)| is_in[*index]) {
            places[index] = terms.len();
            terms.push((term.moved(|place| places[place]), span.clone()));
        }
        Self { terms }
    }

    /// Every use of a name with its location.
    pub fn names(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        self.terms.iter().filter_map(|(term, span)| match term {
            Term::Name(name) => Some((name.as_str(), span.clone())),
            _ => None,
        })
    }

    /// Builds the formula as an expression, with the names given by `resolve`.
    ///
    /// # Errors
    /// Those of `resolve`.
    pub fn build<'g, E>(
        &self,
        builder: &'g Builder,
        mut resolve: impl FnMut(&str) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        let mut built: Vec<Expr> = Vec::with_capacity(self.terms.len());
        for (term, _) in &self.terms {
            let expr = match term {
                Term::Number(value) | Term::Quantity(value, _) => builder.with(|graph| graph.constant(*value)),
                Term::Name(name) => resolve(name)?.expr(),
                Term::Unary(function, a) => builder.with(|graph| graph.unary(*function, built[*a])),
                Term::Binary(function, a, b) => builder.with(|graph| graph.binary(*function, built[*a], built[*b])),
                Term::Compared(a, b) => builder.with(|graph| graph.sub(built[*a], built[*b])),
                Term::Degrees(a) => builder.with(|graph| graph.scale(180.0 / std::f64::consts::PI, built[*a])),
            };
            built.push(expr);
        }
        // Each of the terms was pushed.
        Ok(builder.scalar(*built.last().expect("parse and number make at least one term")))
    }
}

#[cfg(test)]
mod tests;
