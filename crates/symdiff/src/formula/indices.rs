//! Indices of repeated text: `{i - 1}` in names, `1..N` of ranges.

use std::fmt;
use std::ops::{Range, RangeInclusive};

use super::SyntaxError;
use crate::tuning::TUNING;

/// Value of an index in repeated text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Index {
    /// A whole number, which formulas may compute with.
    Number(i64),
    /// A part of names.
    Word(String),
}

impl fmt::Display for Index {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(formatter, "{number}"),
            Self::Word(word) => formatter.write_str(word),
        }
    }
}

/// Value of an index by its name; `None` for other names.
pub type Lookup<'l> = dyn Fn(&str) -> Option<Index> + 'l;

/// Replaces the contents of braces in a text by their values.
///
/// # Errors
/// An unclosed brace, or braces around something that is not a whole number.
pub fn fill(text: &str, lookup: &Lookup) -> Result<String, SyntaxError> {
    let mut filled = String::with_capacity(text.len());
    let mut place = 0;
    while let Some(open) = text[place..].find('{').map(|open| place + open) {
        filled += &text[place..open];
        let Some(close) = text[open..].find('}').map(|close| open + close) else {
            return Err(error("this brace does not close", open..open + 1, "e.g. `leg_{i}`"));
        };
        let inner = &text[open + 1..close];
        let index = match lookup(inner.trim()) {
            Some(index) => index,
            None => Index::Number(whole(inner, lookup).map_err(|found| found.behind(open + 1))?),
        };
        filled += &index.to_string();
        place = close + 1;
    }
    Ok(filled + &text[place..])
}

/// The ends of a range of whole numbers: `1..6`, `0..N - 1`.
///
/// # Errors
/// Not a range, or an empty range.
pub fn range(text: &str, lookup: &Lookup) -> Result<RangeInclusive<i64>, SyntaxError> {
    let Some(dots) = text.find("..") else {
        return Err(error("a range belongs here", 0..text.len(), "e.g. `1..6`, both ends included"));
    };
    let first = whole(&text[..dots], lookup)?;
    let last = whole(&text[dots + 2..], lookup).map_err(|found| found.behind(dots + 2))?;
    if last < first {
        let message = format!("there is no number from {first} to {last}");
        return Err(SyntaxError { message, span: 0..text.len(), help: Some("the smaller end comes first".to_owned()) });
    }
    Ok(first..=last)
}

/// The value of a sum of products of integers.
///
/// # Errors
/// Not an index.
pub fn whole(text: &str, lookup: &Lookup) -> Result<i64, SyntaxError> {
    let mut reader = Whole { text, position: 0, lookup, depth: 0 };
    let value = reader.sum()?;
    if reader.peek().is_some() {
        return Err(reader.unexpected());
    }
    Ok(value)
}

struct Whole<'t> {
    text: &'t str,
    position: usize,
    lookup: &'t Lookup<'t>,
    depth: usize,
}

impl Whole<'_> {
    fn peek(&mut self) -> Option<char> {
        self.position = self.text.len() - self.text[self.position..].trim_start().len();
        self.text[self.position..].chars().next()
    }

    fn unexpected(&mut self) -> SyntaxError {
        let length = self.peek().map_or(0, char::len_utf8);
        let span = self.position..self.position + length;
        error(
            "a whole number belongs here",
            span,
            "numbers, indices of `repeat` and parameters that are whole numbers, with + - *",
        )
    }

    fn checked(&self, value: Option<i64>) -> Result<i64, SyntaxError> {
        value.ok_or_else(|| {
            error("this number is too large", 0..self.text.len(), "whole numbers have at most 18 digits")
        })
    }

    fn sum(&mut self) -> Result<i64, SyntaxError> {
        let mut value = self.product()?;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.position += 1;
            let other = self.product()?;
            value = self.checked(if sign == '+' { value.checked_add(other) } else { value.checked_sub(other) })?;
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<i64, SyntaxError> {
        let mut value = self.atom()?;
        while self.peek() == Some('*') {
            self.position += 1;
            let other = self.atom()?;
            value = self.checked(value.checked_mul(other))?;
        }
        Ok(value)
    }

    fn atom(&mut self) -> Result<i64, SyntaxError> {
        if self.depth > TUNING.depth_of_indices {
            return Err(self.unexpected());
        }
        self.depth += 1;
        let value = match self.peek() {
            Some('-') => {
                self.position += 1;
                let value = self.atom()?;
                self.checked(value.checked_neg())?
            }
            Some('(') => {
                self.position += 1;
                let value = self.sum()?;
                if self.peek() != Some(')') {
                    return Err(self.unexpected());
                }
                self.position += 1;
                value
            }
            Some(c) if c.is_alphanumeric() || c == '_' => self.word()?,
            _ => return Err(self.unexpected()),
        };
        self.depth -= 1;
        Ok(value)
    }

    fn word(&mut self) -> Result<i64, SyntaxError> {
        let rest = &self.text[self.position..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.'))).unwrap_or(rest.len());
        let end = rest[..end].find("..").unwrap_or(end);
        let word = &rest[..end];
        let span = self.position..self.position + end;
        self.position = span.end;
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            let value = word.parse().ok();
            return value.ok_or_else(|| error(&format!("`{word}` is not a whole number"), span, "e.g. `6`"));
        }
        match (self.lookup)(word) {
            Some(Index::Number(value)) => Ok(value),
            _ => {
                let help = "an index of `repeat`, or a parameter that is a whole number and nothing else";
                Err(error(&format!("`{word}` is not a whole number"), span, help))
            }
        }
    }
}

impl SyntaxError {
    /// The same error for a text that begins at `start`.
    pub(super) fn behind(self, start: usize) -> Self {
        Self { span: start + self.span.start..start + self.span.end, ..self }
    }
}

fn error(message: &str, span: Range<usize>, help: &str) -> SyntaxError {
    SyntaxError { message: message.to_owned(), span, help: Some(help.to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(name: &str) -> Option<Index> {
        match name {
            "i" => Some(Index::Number(3)),
            "N" => Some(Index::Number(6)),
            "side" => Some(Index::Word("left".to_owned())),
            _ => None,
        }
    }

    #[test]
    fn braces_are_filled() {
        assert_eq!(fill("leg_{i}.force", &known).unwrap(), "leg_3.force");
        assert_eq!(fill("{side}_{i-1}_{2*(i + N)}", &known).unwrap(), "left_2_18");
        assert_eq!(fill("none", &known).unwrap(), "none");
        assert_eq!(fill("a{i", &known).unwrap_err().span, 1..2);
        assert_eq!(fill("a{j}", &known).unwrap_err().span, 2..3);
        assert_eq!(fill("a{side + 1}", &known).unwrap_err().message, "`side` is not a whole number");
        assert!(fill("a{9223372036854775807 + i}", &known).unwrap_err().message.contains("too large"));
    }

    #[test]
    fn ranges_have_both_ends() {
        assert_eq!(range("1..N", &known).unwrap(), 1..=6);
        assert_eq!(range(" -1 .. N - 4 ", &known).unwrap(), -1..=2);
        assert_eq!(range("4..i", &known).unwrap_err().message, "there is no number from 4 to 3");
        assert_eq!(range("6", &known).unwrap_err().message, "a range belongs here");
        assert_eq!(range("1..x", &known).unwrap_err().span, 3..4);
        assert!(range("1.5..2", &known).is_err());
        assert!(whole(&"(".repeat(1000), &known).is_err());
    }
}
