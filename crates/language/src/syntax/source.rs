//! The texts that diagnostics point into: the model file, and one for each `--set`.
//!
//! All texts share one range of byte offsets, each text behind the one before, so that a [`Span`] alone says which
//! text it is in.

use std::ops::Range;
use std::sync::Arc;

use super::harmless::harmless;

/// Bytes of the texts that were read.
pub type Span = Range<usize>;

/// A text and its name.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path, or the command-line option that the text came with; harmless to a terminal.
    pub name: String,
    /// The text; empty if it could not be read.
    pub text: String,
    /// Offsets of its lines, counted from its own start.
    lines: Vec<usize>,
}

/// A location as people count it, both from 1; columns are characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineColumn {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
}

impl Source {
    /// The location of a byte of this source; `offset` counts from the source's own start.
    pub fn place(&self, offset: usize) -> LineColumn {
        let offset = floor_char_boundary(&self.text, offset);
        let line = self.lines.partition_point(|&start| start <= offset);
        LineColumn { line, column: self.text[self.lines[line - 1]..offset].chars().count() + 1 }
    }
}

/// A text at an offset: as it was read, or once more for a copy in an instance.
#[derive(Clone, Debug)]
struct Placed {
    /// Offset of its first byte.
    start: usize,
    source: Arc<Source>,
    within: Option<TextInstance>,
}

/// The instance that a copy of a text belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextInstance {
    /// Its full name.
    pub instance: String,
    /// Assembly of the instance.
    pub of: String,
    /// Location of the key that declares it.
    pub span: Span,
}

/// Every text that was read.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    all: Vec<Placed>,
}

impl Sources {
    /// Adds a text and returns the offset of its first byte. A text that is present, such as a file that several scenes
    /// name, is not added again.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> usize {
        let (name, text) = (harmless(&name.into()).replace('\n', "\u{fffd}"), text.into());
        let known =
            |placed: &&Placed| placed.within.is_none() && placed.source.name == name && placed.source.text == text;
        if let Some(known) = self.all.iter().find(known) {
            return known.start;
        }
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1)).collect();
        self.place_at_end(Arc::new(Source { name, text, lines }), None)
    }

    /// Adds the text of a span once more, for a copy of it. Returns the distance of the copy's spans from those of the
    /// original.
    pub fn copy(&mut self, original: &Span, within: TextInstance) -> usize {
        let Some(placed) = self.placed(original) else { return 0 };
        let (first, source) = (placed.start, Arc::clone(&placed.source));
        self.place_at_end(source, Some(within)) - first
    }

    fn place_at_end(&mut self, source: Arc<Source>, within: Option<TextInstance>) -> usize {
        // One offset lies between two texts, so that the end of one is not the start of the next.
        let start = self.all.last().map_or(0, |last| last.start + last.source.text.len() + 1);
        self.all.push(Placed { start, source, within });
        start
    }

    /// All texts, in the order in which they were read.
    pub fn all(&self) -> impl Iterator<Item = &Source> {
        self.all.iter().filter(|placed| placed.within.is_none()).map(|placed| &*placed.source)
    }

    /// The first text: the model file.
    pub fn first(&self) -> Option<&Source> {
        self.all.first().map(|placed| &*placed.source)
    }

    fn placed(&self, span: &Span) -> Option<&Placed> {
        let behind = self.all.partition_point(|placed| placed.start <= span.start);
        self.all[..behind].last()
    }

    /// The instance whose copy contains a span.
    pub fn within(&self, span: &Span) -> Option<&TextInstance> {
        self.placed(span)?.within.as_ref()
    }

    /// The text that contains a span, and the span within it, clipped to the text.
    pub fn locate(&self, span: &Span) -> Option<(&Source, Span)> {
        let Placed { start: first, source, .. } = self.placed(span)?;
        let cut = |offset: usize| floor_char_boundary(&source.text, offset.saturating_sub(*first));
        let start = cut(span.start);
        Some((source, start..cut(span.end).max(start)))
    }
}

/// The nearest start of a character at or before `offset`.
fn floor_char_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_located_in_their_source() {
        let mut sources = Sources::default();
        assert_eq!(sources.add("a", "xyz\nü!"), 0);
        let second = sources.add("b", "hello");
        assert_eq!(second, 8);
        let (source, span) = sources.locate(&(6..7)).unwrap();
        assert_eq!((source.name.as_str(), &source.text[span.clone()]), ("a", "!"));
        assert_eq!(source.place(span.start), LineColumn { line: 2, column: 2 });
        let (source, span) = sources.locate(&(8..100)).unwrap();
        assert_eq!((source.name.as_str(), span), ("b", 0..5));
        assert_eq!(sources.locate(&(7..7)).unwrap().0.name, "a");
    }
}
