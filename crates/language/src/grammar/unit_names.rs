//! Units that are also names of the model, and units after fractions.

use super::names::{self, Context};
use super::own_names::{LikeName, OwnNames};
use super::reader::Reader;
use super::symbols::SymbolTable;
use super::unit::{Unit, is_part_of_name};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Words of the unit after a number that are also names of the model.
    pub(super) fn like_names(&self, value: f64, unit: &str, own: Option<&OwnNames>) -> Vec<LikeName> {
        let words = later_words(unit);
        let Ok(Unit { dimension: whole, .. }) = Unit::parse(unit) else { return Vec::new() };
        let is_own = |word: &str| !names::is_reserved(word) && self.is_name(word, own);
        let like = |(operator, span): (char, Span)| {
            let word = unit[span.clone()].to_owned();
            let before = unit[..span.start].trim_end().trim_end_matches(operator).trim_end();
            let spaced = format!("{value} {before} {operator} {word}");
            let as_unit = format!("{value} {before} {operator} 1 {word}");
            let dimension = Unit::parse(&word).ok()?.dimension;
            is_own(&word).then_some(LikeName { word, spaced, as_unit, dimension, whole })
        };
        words.into_iter().filter_map(like).collect()
    }

    /// Help if the value read last does not fit: a word of its unit is also a name of the model, or its unit is after a
    /// fraction.
    pub(super) fn other_reading(&self, node: &Node) -> Option<String> {
        let like = self.like_names.last().map(LikeName::help);
        like.or_else(|| Some(of_fraction(&node.scalar()?.text)?.help()))
    }

    /// Reports a word of the unit of the value read last if the model's name of that word would fit as well.
    pub(super) fn refuse_ambiguous(&mut self, node: &Node) {
        let is_alike = |like: &&LikeName| {
            let own =
                self.resolve(&like.word, Context::Output).ok().and_then(|symbol| self.kind_of(symbol).dimension());
            own == Some(like.dimension)
        };
        if let Some(like) = self.like_names.iter().find(is_alike).cloned() {
            self.report(node, &like);
        }
    }

    /// Reports a word of the unit of the value read last that is also a name of the model, for values of any dimension.
    pub fn refuse_like_names(&mut self, node: &Node) {
        if let Some(like) = self.like_names.first().cloned() {
            self.report(node, &like);
        }
    }

    /// The same for a parameter, unless its whole unit measures a named quantity: `N*m` is a torque, whatever `m` is.
    pub fn refuse_odd_units(&mut self, node: &Node) {
        if let Some(like) = self.like_names.iter().find(|like| !like.whole.is_named()).cloned() {
            self.report(node, &like);
        }
    }

    fn report(&mut self, node: &Node, like: &LikeName) {
        let message = format!("`{}` is a unit and a name of the model", like.word);
        let help = format!("write `{}` with spaces for the model's own, `{}` for the unit", like.spaced, like.as_unit);
        self.error(Code::AmbiguousUnit, node.span.clone(), message, help);
    }

    /// Warns of `3/4 in`, for values of any dimension.
    pub fn warn_of_fraction(&mut self, node: &Node) {
        let Some(fraction) = node.scalar().and_then(|scalar| of_fraction(&scalar.text)) else { return };
        let message = format!("`{}` is {}", fraction.text, fraction.meaning());
        let help = format!("write `{}` where that is meant, `{}` where not", fraction.as_read(), fraction.as_meant());
        self.diagnostics.push(Diagnostic::warning(Code::FractionOfUnits, node.span.clone(), message).help(help));
    }
}

/// `1/12 in^4`, or `(1/12) in^4`.
pub(super) struct Fraction<'t> {
    text: &'t str,
    above: &'t str,
    below: &'t str,
    unit: &'t str,
}

impl Fraction<'_> {
    fn meaning(&self) -> String {
        format!("{} over `{} {}`", self.above, self.below, self.unit)
    }

    fn as_read(&self) -> String {
        format!("{}/({} {})", self.above, self.below, self.unit)
    }

    fn as_meant(&self) -> String {
        format!("{} {}/{}", self.above, self.unit, self.below)
    }

    /// Help: how to write a fraction of a unit.
    pub(super) fn help(&self) -> String {
        format!("`{}` is {}; write `{}` for the part of a unit", self.text, self.meaning(), self.as_meant())
    }

    /// The same for a fraction in parentheses, after which no unit is allowed.
    pub(super) fn help_in_parentheses(&self) -> String {
        format!("a unit stands behind a number; write `{}`", self.as_meant())
    }
}

/// Parses a text that is a fraction of whole numbers with a unit after it.
pub(super) fn of_fraction(text: &str) -> Option<Fraction<'_>> {
    let text = text.trim();
    let inner = text.strip_prefix('(').unwrap_or(text);
    let (above, rest) = inner.split_once('/')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let rest = rest.trim_start();
    let length = rest.bytes().take_while(u8::is_ascii_digit).count();
    let (below, behind) = rest.split_at(length);
    let unit = behind.trim_start().strip_prefix(')').unwrap_or(behind).trim();
    let is_one =
        digits(above.trim()) && digits(below) && Unit::parse(unit).is_ok() && unit.starts_with(char::is_alphabetic);
    is_one.then_some(Fraction { text, above: above.trim(), below, unit })
}

/// Words of a unit except the first, each with the operator before it.
fn later_words(text: &str) -> Vec<(char, Span)> {
    let mut found = Vec::new();
    let mut end = 0;
    while let Some(start) = text[end..].find(|c: char| c.is_alphabetic() || c == '°').map(|start| end + start) {
        end = text[start..].find(|c: char| !is_part_of_name(c)).map_or(text.len(), |length| start + length);
        if let Some(operator) = text[..start].trim_end().chars().last().filter(|c| "*·⋅/".contains(*c)) {
            found.push((operator, start..end));
        }
    }
    found
}
