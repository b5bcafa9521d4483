//! Names with indices, and sums over them: `sum(i, 1..6, leg_{i}.force)`.

use std::ops::Range;

use super::indices::{self, Index};
use super::parser::Parser;
use super::{SyntaxError, Term};
use crate::expr::Binary;
use crate::tuning::TUNING;

impl Parser<'_> {
    /// Whether names may have braces.
    pub(super) fn has_indices(&self) -> bool {
        !self.indices.is_empty() || self.vocabulary.names.is_some()
    }

    fn index(&self, name: &str) -> Option<Index> {
        let own = self.indices.iter().rev().find(|(known, _)| known == name);
        let own = own.map(|(_, value)| Index::Number(*value));
        own.or_else(|| self.vocabulary.names?.index(name))
    }

    /// Integers that braces and ranges may use.
    fn whole_number(&self, name: &str) -> Option<Index> {
        self.index(name).or_else(|| self.vocabulary.names?.count(name).map(Index::Number))
    }

    /// The number of an index, if the name is one.
    pub(super) fn index_of(&self, name: &str, span: &Range<usize>) -> Result<Option<f64>, SyntaxError> {
        match self.index(name) {
            None => Ok(None),
            Some(Index::Number(value)) => Ok(Some(value as f64)),
            Some(Index::Word(_)) => Err(SyntaxError {
                message: format!("`{name}` is a word, not a number"),
                span: span.clone(),
                help: Some(format!("it can stand in braces as a part of a name: `{{{name}}}_x`")),
            }),
        }
    }

    /// A name, replaced by the caller's full one.
    pub(super) fn name(&mut self, name: &str, span: Range<usize>) -> usize {
        let full = self.vocabulary.names.map_or_else(|| name.to_owned(), |names| names.full(name));
        self.push(Term::Name(full), span)
    }

    /// A name with braces.
    pub(super) fn filled(&mut self, name: &str, span: Range<usize>) -> Result<usize, SyntaxError> {
        let filled = indices::fill(name, &|name| self.whole_number(name)).map_err(|error| error.behind(span.start))?;
        let is_name = filled.split('.').all(|part| {
            part.starts_with(|c: char| c.is_alphabetic() || c == '_')
                && part.chars().all(|c| c.is_alphanumeric() || c == '_')
        });
        if !is_name {
            let help =
                "a name is made of letters, digits and `_`, a letter first; an index alone is written without braces";
            return Err(SyntaxError { message: format!("`{filled}` is no name"), span, help: Some(help.to_owned()) });
        }
        Ok(self.name(&filled, span))
    }

    /// Reads the arguments of `sum`: an index, its range and a formula, which is read once for each value.
    pub(super) fn repeated(&mut self, start: usize) -> Result<usize, SyntaxError> {
        self.nested(|parser| {
            parser.take('(');
            let index = parser.new_index()?;
            let range = parser.range()?;
            let body = parser.position;
            let mut sum = None;
            for value in range {
                parser.position = body;
                parser.indices.push((index.clone(), value));
                let term = parser.sum();
                parser.indices.pop();
                let term = term?;
                if parser.terms.len() > TUNING.operations_of_sums {
                    let message = format!("the sum has more than {} operations", TUNING.operations_of_sums);
                    return Err(SyntaxError { message, span: start..body, help: None });
                }
                sum = Some(match sum {
                    None => term,
                    Some(before) => {
                        let span = start..parser.position;
                        parser.push(Term::Binary(Binary::Add, before, term), span)
                    }
                });
            }
            parser.close()?;
            // A range is not empty.
            sum.ok_or_else(|| parser.unexpected("a formula"))
        })
    }

    fn new_index(&mut self) -> Result<String, SyntaxError> {
        self.skip_space();
        let start = self.position;
        let rest = &self.text[start..];
        let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        self.position += length;
        let name = rest[..length].to_owned();
        let is_name = name.starts_with(|c: char| c.is_alphabetic() || c == '_');
        if !is_name || !self.take(',') {
            return Err(SyntaxError {
                message: "`sum` takes an index, its range and a formula".to_owned(),
                span: start..self.text.len().min(start + length.max(1)),
                help: Some("e.g. `sum(i, 1..6, leg_{i}.force)`".to_owned()),
            });
        }
        Ok(name)
    }

    fn range(&mut self) -> Result<std::ops::RangeInclusive<i64>, SyntaxError> {
        let start = self.position;
        let Some(comma) = self.text[start..].find(',').map(|comma| start + comma) else {
            self.position = self.text.len();
            return Err(self.unexpected("the range, a comma and a formula: `sum(i, 1..6, leg_{i}.force)`"));
        };
        let range = indices::range(&self.text[start..comma], &|name| self.whole_number(name));
        let range = range.map_err(|error| error.behind(start))?;
        if range.end().saturating_sub(*range.start()) >= TUNING.terms_of_sum {
            let message = format!("a sum has at most {} terms", TUNING.terms_of_sum);
            return Err(SyntaxError { message, span: start..comma, help: None });
        }
        self.position = comma + 1;
        Ok(range)
    }
}
