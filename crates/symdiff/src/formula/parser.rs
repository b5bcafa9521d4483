//! Text → terms, by recursive descent.

use std::ops::Range;

use rustc_hash::FxHashSet;

use super::vocabulary::Vocabulary;
use super::{FUNCTIONS, Function, SyntaxError, Term};
use crate::expr::{Binary, Unary};
use crate::tuning::TUNING;

/// Words that join conditions.
const WORDS: [&str; 3] = ["and", "or", "not"];

/// The terms of a formula with their locations.
///
/// # Errors
/// The first syntax error.
pub(super) fn terms(text: &str, vocabulary: &Vocabulary) -> Result<Vec<(Term, Range<usize>)>, SyntaxError> {
    let truths = FxHashSet::default();
    let indices = Vec::new();
    let mut parser = Parser { text, vocabulary, position: 0, depth: 0, terms: Vec::new(), truths, indices };
    parser.condition()?;
    parser.skip_space();
    if parser.position < text.len() {
        return Err(parser.unexpected("an operator or the end of the formula"));
    }
    Ok(parser.terms)
}

pub(super) struct Parser<'t> {
    pub(super) text: &'t str,
    pub(super) vocabulary: &'t Vocabulary<'t>,
    pub(super) position: usize,
    depth: usize,
    pub(super) terms: Vec<(Term, Range<usize>)>,
    /// Terms that are 1 or 0.
    pub(super) truths: FxHashSet<usize>,
    /// Indices of the sums around the position, the innermost last.
    pub(super) indices: Vec<(String, i64)>,
}

impl Parser<'_> {
    pub(super) fn skip_space(&mut self) {
        self.position = self.text.len() - self.text[self.position..].trim_start().len();
    }

    /// The next character that is not a space.
    pub(super) fn peek(&mut self) -> Option<char> {
        self.skip_space();
        self.text[self.position..].chars().next()
    }

    pub(super) fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.position += wanted.len_utf8();
        }
        found
    }

    pub(super) fn push(&mut self, term: Term, span: Range<usize>) -> usize {
        self.terms.push((term, span));
        self.terms.len() - 1
    }

    fn start_of(&self, term: usize) -> usize {
        self.terms[term].1.start
    }

    pub(super) fn binary(&mut self, function: Binary, left: usize, right: usize) -> usize {
        let span = self.start_of(left)..self.position;
        self.push(Term::Binary(function, left, right), span)
    }

    pub(super) fn unexpected(&mut self, expected: &str) -> SyntaxError {
        match self.peek() {
            Some(found) => SyntaxError {
                message: format!("unexpected `{found}` in formula"),
                span: self.position..self.position + found.len_utf8(),
                help: Some(match found {
                    '=' => "equality is written `==`".to_owned(),
                    '*' => "a power is written `^`".to_owned(),
                    '·' | '×' => "a product is written `*`".to_owned(),
                    ',' if self.is_between_digits() => "decimals stand behind a point: `0.5`".to_owned(),
                    '.' if self.is_doubled() => "an interval is written `[0.1, 0.2]`".to_owned(),
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

    /// Whether there are digits on both sides of the next character.
    fn is_between_digits(&self) -> bool {
        let is_digit = |c: char| c.is_ascii_digit();
        let (before, after) = self.text.split_at(self.position);
        before.ends_with(is_digit) && after.chars().nth(1).is_some_and(is_digit)
    }

    /// Whether the next character is one of two full stops.
    fn is_doubled(&self) -> bool {
        let (before, after) = self.text.split_at(self.position);
        before.ends_with('.') || after.starts_with("..")
    }

    /// Runs `inner` one level deeper.
    pub(super) fn nested(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<usize, SyntaxError>,
    ) -> Result<usize, SyntaxError> {
        if self.depth == TUNING.depth_of_formulas {
            return Err(SyntaxError {
                message: format!("the formula nests deeper than {} levels", TUNING.depth_of_formulas),
                span: self.position..self.text.len().min(self.position + 1),
                help: Some("split it into parameters".to_owned()),
            });
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    pub(super) fn sum(&mut self) -> Result<usize, SyntaxError> {
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
                let inner = parser.condition()?;
                parser.close()?;
                Ok(inner)
            }),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' || c == '{' && self.has_indices() => self.name_or_call(),
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    pub(super) fn close(&mut self) -> Result<(), SyntaxError> {
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
            Ok(value) if value.is_finite() => self.measured(value, span),
            _ => Err(SyntaxError {
                message: format!("`{}` is not a finite number", &self.text[span.clone()]),
                span,
                help: None,
            }),
        }
    }

    /// A number with an optional unit behind it.
    fn measured(&mut self, number: f64, span: Range<usize>) -> Result<usize, SyntaxError> {
        let end = self.position;
        let starts_unit = |c: char| c.is_alphabetic() || c == '°';
        let rest = match self.peek() {
            Some(c) if starts_unit(c) => &self.text[self.position..],
            _ => "",
        };
        let word = rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or("");
        let Some(unit) = self.vocabulary.unit.filter(|_| !rest.is_empty() && !WORDS.contains(&word)) else {
            self.position = end;
            return Ok(self.push(Term::Number(number), span));
        };
        let start = self.position;
        let quantity = unit(number, rest)
            .map_err(|error| SyntaxError { span: start + error.span.start..start + error.span.end, ..error })?;
        self.position += quantity.length;
        Ok(self.push(Term::Quantity(quantity.value, quantity.mark), span.start..self.position))
    }

    fn name_or_call(&mut self) -> Result<usize, SyntaxError> {
        let start = self.position;
        let text = self.text;
        let rest = &text[start..];
        let braces = self.has_indices();
        let mut length = 0;
        loop {
            let part = &rest[length..];
            let end = part.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(part.len());
            length += end;
            // A dot belongs to the name only if a name continues behind it.
            let mut after = rest[length..].chars();
            match (after.next(), after.next()) {
                (Some('.'), Some(c)) if c.is_alphabetic() || c == '_' || c == '{' && braces => length += 1,
                (Some('{'), _) if braces => length += rest[length..].find('}').map_or(1, |close| close + 1),
                _ => break,
            }
        }
        self.position = start + length;
        let name = &rest[..length];
        let span = start..self.position;
        if name.contains('{') {
            return self.filled(name, span);
        }
        if self.peek() == Some('(') {
            return self.call(name, span);
        }
        if let Some(value) = self.index_of(name, &span)? {
            return Ok(self.push(Term::Number(value), span));
        }
        if name == "pi" {
            return Ok(self.push(Term::Number(std::f64::consts::PI), span));
        }
        if WORDS.contains(&name) {
            return Err(SyntaxError {
                message: format!("`{name}` joins two conditions"),
                span,
                help: Some("e.g. `a < b and c < d`".to_owned()),
            });
        }
        let is_table = self.vocabulary.tables.iter().any(|(table, _)| *table == name);
        if FUNCTIONS.iter().any(|known| known.name == name && known.is_reserved()) || is_table {
            return Err(SyntaxError {
                message: format!("`{name}` is a function"),
                span,
                help: Some(format!("give it its argument: `{name}(…)`")),
            });
        }
        Ok(self.name(name, span))
    }

    fn call(&mut self, name: &str, span: Range<usize>) -> Result<usize, SyntaxError> {
        let tables = self.vocabulary.tables;
        let called = match tables.iter().find(|(known, _)| *known == name) {
            Some((_, spline)) => Some((Function::Unary(Unary::Spline(*spline, 0)), "x")),
            None => FUNCTIONS.iter().find(|known| known.name == name).map(|known| (known.function, known.arguments)),
        };
        if name == "sum" && called.is_none() {
            return self.repeated(span.start);
        }
        let Some((function, wanted)) = called else {
            let known: Vec<&str> = FUNCTIONS
                .iter()
                .map(|known| known.name)
                .chain(["sum"])
                .chain(tables.iter().map(|(known, _)| *known))
                .collect();
            return Err(SyntaxError {
                message: format!("unknown function `{name}`"),
                span,
                help: Some(format!("the functions are {}; a product needs its `*`", known.join(", "))),
            });
        };
        self.nested(|parser| {
            parser.take('(');
            let mut arguments = vec![parser.condition()?];
            while arguments.len() < function.arity().max(2) && parser.take(',') {
                arguments.push(parser.condition()?);
            }
            if parser.peek() == Some(',') {
                return Err(wrong_count(name, span.start..parser.position + 1, function, wanted));
            }
            parser.close()?;
            let span = span.start..parser.position;
            match (function, arguments.as_slice()) {
                (Function::Unary(function), &[a]) => Ok(parser.push(Term::Unary(function, a), span)),
                (Function::Binary(function), &[a, b]) => Ok(parser.push(Term::Binary(function, a, b), span)),
                (Function::Composed(function), arguments) if arguments.len() == function.arity() => {
                    parser.composed(function, arguments, span)
                }
                _ => Err(wrong_count(name, span, function, wanted)),
            }
        })
    }
}

impl Function {
    fn arity(self) -> usize {
        match self {
            Self::Unary(_) => 1,
            Self::Binary(_) => 2,
            Self::Composed(function) => function.arity(),
        }
    }
}

fn wrong_count(name: &str, span: Range<usize>, function: Function, arguments: &str) -> SyntaxError {
    let expected = match function.arity() {
        1 => format!("one argument: `{name}({arguments})`"),
        2 => format!("two arguments: `{name}({arguments})`"),
        _ => format!("three arguments: `{name}({arguments})`"),
    };
    SyntaxError { message: format!("`{name}` takes {expected}"), span, help: None }
}
