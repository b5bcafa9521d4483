//! Functions of the language that are composed of others.

use std::ops::Range;

use super::parser::Parser;
use super::{SyntaxError, Term};
use crate::expr::{Binary, Unary};

/// A function that is composed of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Composed {
    /// −floor(−x)
    Ceil,
    /// floor(x + ½)
    Round,
    /// a − b floor(a/b)
    Mod,
    /// a under a condition, otherwise b.
    If,
    /// min(max(x, low), high)
    Clamp,
    /// u² (3 − 2u), u = (x − a)/(b − a) between 0 and 1.
    Smoothstep,
    /// An angle in degrees, as a number.
    Degrees,
}

impl Composed {
    /// Number of arguments.
    pub fn arity(self) -> usize {
        match self {
            Self::Ceil | Self::Round | Self::Degrees => 1,
            Self::Mod => 2,
            Self::If | Self::Clamp | Self::Smoothstep => 3,
        }
    }
}

impl Parser<'_> {
    /// Adds the function's terms; the number of arguments is its arity.
    pub(super) fn composed(
        &mut self,
        function: Composed,
        arguments: &[usize],
        span: Range<usize>,
    ) -> Result<usize, SyntaxError> {
        let binary = |parser: &mut Self, function, a, b| parser.push(Term::Binary(function, a, b), span.clone());
        Ok(match (function, arguments) {
            (Composed::Ceil, &[x]) => {
                let opposite = self.push(Term::Unary(Unary::Neg, x), span.clone());
                let below = self.push(Term::Unary(Unary::Floor, opposite), span.clone());
                self.push(Term::Unary(Unary::Neg, below), span)
            }
            (Composed::Round, &[x]) => {
                let half = self.push(Term::Number(0.5), span.clone());
                let shifted = binary(self, Binary::Add, x, half);
                self.push(Term::Unary(Unary::Floor, shifted), span)
            }
            (Composed::Mod, &[a, b]) => {
                let quotient = binary(self, Binary::Div, a, b);
                let whole = self.push(Term::Unary(Unary::Floor, quotient), span.clone());
                let part = self.push(Term::Binary(Binary::Mul, b, whole), span.clone());
                self.push(Term::Binary(Binary::Sub, a, part), span)
            }
            (Composed::If, &[condition, a, b]) => self.choice(condition, a, b, span),
            (Composed::Clamp, &[x, low, high]) => {
                let above = binary(self, Binary::Max, x, low);
                binary(self, Binary::Min, above, high)
            }
            (Composed::Smoothstep, &[a, b, x]) => {
                let (from, width) = (binary(self, Binary::Sub, x, a), binary(self, Binary::Sub, b, a));
                let share = binary(self, Binary::Div, from, width);
                let [zero, one, two, three] =
                    [0.0, 1.0, 2.0, 3.0].map(|number| self.push(Term::Number(number), span.clone()));
                let above = binary(self, Binary::Max, share, zero);
                let u = binary(self, Binary::Min, above, one);
                let (square, doubled) = (binary(self, Binary::Mul, u, u), binary(self, Binary::Mul, two, u));
                let rest = binary(self, Binary::Sub, three, doubled);
                binary(self, Binary::Mul, square, rest)
            }
            (Composed::Degrees, &[x]) => self.degrees(x, span)?,
            // The caller counts the arguments.
            _ => unreachable!("{function:?} takes {} arguments", function.arity()),
        })
    }

    /// An angle in degrees; an error for a bare number.
    fn degrees(&mut self, x: usize, span: Range<usize>) -> Result<usize, SyntaxError> {
        let within = |place: &Range<usize>| span.start <= place.start && place.end <= span.end;
        let bare = |(term, place): &(Term, Range<usize>)| {
            !(within(place) && matches!(term, Term::Name(_) | Term::Quantity(..)))
        };
        if self.terms.iter().all(bare) {
            return Err(SyntaxError {
                message: "`deg(x)` is the angle x in degrees".to_owned(),
                span,
                help: Some("an angle of 30 degrees is `30 deg`".to_owned()),
            });
        }
        Ok(self.push(Term::Degrees(x), span))
    }
}
