//! Comparisons and their connectives. A condition is a number: 1 where it is true, 0 elsewhere.

use std::ops::Range;

use super::parser::Parser;
use super::{SyntaxError, Term};
use crate::expr::Binary;

/// Signs of comparisons, longer ones first.
const SIGNS: [&str; 6] = ["<=", ">=", "==", "!=", "<", ">"];

impl Parser<'_> {
    /// A formula of the lowest precedence.
    pub(super) fn condition(&mut self) -> Result<usize, SyntaxError> {
        let mut left = self.both()?;
        while self.take_word("or") {
            let right = self.both()?;
            let (a, b) = (self.truth(left), self.truth(right));
            // a + b − ab
            let sum = self.joined(Binary::Add, a, b);
            let product = self.joined(Binary::Mul, a, b);
            left = self.joined(Binary::Sub, sum, product);
            self.truths.insert(left);
        }
        Ok(left)
    }

    fn both(&mut self) -> Result<usize, SyntaxError> {
        let mut left = self.negation()?;
        while self.take_word("and") {
            let right = self.negation()?;
            let (a, b) = (self.truth(left), self.truth(right));
            left = self.joined(Binary::Mul, a, b);
            self.truths.insert(left);
        }
        Ok(left)
    }

    fn negation(&mut self) -> Result<usize, SyntaxError> {
        if !self.take_word("not") {
            return self.comparison();
        }
        self.nested(|parser| {
            let inner = parser.negation()?;
            let inner = parser.truth(inner);
            Ok(parser.opposite(inner))
        })
    }

    fn comparison(&mut self) -> Result<usize, SyntaxError> {
        let left = self.sum()?;
        let Some(sign) = self.take_sign() else { return Ok(left) };
        let right = self.sum()?;
        self.skip_space();
        let end = self.position;
        if self.take_sign().is_some() {
            return Err(SyntaxError {
                message: "comparisons do not chain".to_owned(),
                span: end..self.position,
                help: Some("write `a < b and b < c`".to_owned()),
            });
        }
        let compared = match sign {
            "<" => self.difference(right, left, Binary::Select),
            ">" => self.difference(left, right, Binary::Select),
            "<=" => self.difference(left, right, Binary::SelectElse),
            ">=" => self.difference(right, left, Binary::SelectElse),
            _ => {
                let above = self.difference(left, right, Binary::SelectElse);
                let below = self.difference(right, left, Binary::SelectElse);
                let equal = self.joined(Binary::Mul, above, below);
                if sign == "==" { equal } else { self.opposite(equal) }
            }
        };
        self.truths.insert(compared);
        Ok(compared)
    }

    fn take_sign(&mut self) -> Option<&'static str> {
        self.skip_space();
        let sign = SIGNS.iter().find(|sign| self.text[self.position..].starts_with(**sign))?;
        self.position += sign.len();
        Some(sign)
    }

    /// Takes a word that joins conditions.
    fn take_word(&mut self, word: &str) -> bool {
        self.skip_space();
        let rest = &self.text[self.position..];
        let ends = |c: char| !(c.is_alphanumeric() || c == '_' || c == '.');
        let found = rest.strip_prefix(word).is_some_and(|behind| behind.is_empty() || behind.starts_with(ends));
        if found {
            self.position += word.len();
        }
        found
    }

    /// A term of two others, from the beginning of the first one up to here.
    fn joined(&mut self, function: Binary, a: usize, b: usize) -> usize {
        let span = self.whole(a, b);
        self.push(Term::Binary(function, a, b), span)
    }

    fn whole(&self, a: usize, b: usize) -> Range<usize> {
        let [a, b] = [a, b].map(|term| &self.terms[term].1);
        a.start.min(b.start)..a.end.max(b.end)
    }

    /// 1 where `a` − `b` is positive (`Select`), or where it is not (`SelectElse`).
    fn difference(&mut self, a: usize, b: usize, where_: Binary) -> usize {
        let span = self.whole(a, b);
        let difference = self.push(Term::Compared(a, b), span.clone());
        let one = self.push(Term::Number(1.0), span.clone());
        self.push(Term::Binary(where_, difference, one), span)
    }

    /// 1 − `truth`.
    fn opposite(&mut self, truth: usize) -> usize {
        let span = self.terms[truth].1.clone();
        let one = self.push(Term::Number(1.0), span.clone());
        let opposite = self.push(Term::Binary(Binary::Sub, one, truth), span);
        self.truths.insert(opposite);
        opposite
    }

    /// A condition as 1 or 0; other numbers are true where they are positive.
    fn truth(&mut self, term: usize) -> usize {
        if self.truths.contains(&term) {
            return term;
        }
        let span = self.terms[term].1.clone();
        let one = self.push(Term::Number(1.0), span.clone());
        let truth = self.push(Term::Binary(Binary::Select, term, one), span);
        self.truths.insert(truth);
        truth
    }

    /// `a` under a condition, otherwise `b`. For a comparison, its difference decides directly.
    pub(super) fn choice(&mut self, condition: usize, a: usize, b: usize, span: Range<usize>) -> usize {
        let (condition, first, second) = match self.terms[condition].0 {
            Term::Binary(Binary::Select, difference, _) if self.truths.contains(&condition) => {
                (difference, Binary::Select, Binary::SelectElse)
            }
            Term::Binary(Binary::SelectElse, difference, _) if self.truths.contains(&condition) => {
                (difference, Binary::SelectElse, Binary::Select)
            }
            _ => (condition, Binary::Select, Binary::SelectElse),
        };
        let first = self.push(Term::Binary(first, condition, a), span.clone());
        let second = self.push(Term::Binary(second, condition, b), span.clone());
        self.push(Term::Binary(Binary::Add, first, second), span)
    }
}
