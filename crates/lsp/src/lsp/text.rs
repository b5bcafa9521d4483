//! Texts with positions of the protocol: lines from 0, columns in units of UTF-16.

use std::ops::Range;

use lsp_types::{Position, Range as LspRange, TextDocumentContentChangeEvent};

/// A text with the starts of its lines.
#[derive(Clone, Debug, Default)]
pub struct Text {
    text: String,
    lines: Vec<usize>,
}

impl Text {
    /// A text, split into lines.
    pub fn new(text: impl Into<String>) -> Self {
        let text = text.into();
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1)).collect();
        Self { text, lines }
    }

    /// The whole text.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// The line that a byte is in, from 0.
    pub fn line_of(&self, offset: usize) -> usize {
        self.lines.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// Bytes of a line without its line break; an empty range after the last line.
    pub fn line(&self, line: usize) -> Range<usize> {
        let start = self.lines.get(line).copied().unwrap_or(self.text.len());
        let end = self.lines.get(line + 1).map_or(self.text.len(), |next| next - 1);
        start..end.max(start)
    }

    /// Number of lines, the empty one behind a last newline included.
    pub fn line_count(&self) -> usize {
        self.lines.len()
    }

    /// The position of a byte.
    pub fn position(&self, offset: usize) -> Position {
        let offset = self.boundary(offset);
        let line = self.line_of(offset);
        let before = &self.text[self.lines[line]..offset];
        Position { line: line as u32, character: before.encode_utf16().count() as u32 }
    }

    /// The byte of a position; the end of the line or the text if there is no such position.
    pub fn offset(&self, position: Position) -> usize {
        let line = self.line(position.line as usize);
        let mut units = 0;
        for (at, letter) in self.text[line.clone()].char_indices() {
            if units >= position.character as usize {
                return line.start + at;
            }
            units += letter.len_utf16();
        }
        line.end
    }

    /// The range of a span.
    pub fn range(&self, span: &Range<usize>) -> LspRange {
        LspRange { start: self.position(span.start), end: self.position(span.end.max(span.start)) }
    }

    /// The text after a change.
    #[must_use]
    pub fn changed(&self, change: TextDocumentContentChangeEvent) -> Self {
        let Some(range) = change.range else { return Self::new(change.text) };
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        let mut text = self.text.clone();
        text.replace_range(start..end.max(start), &change.text);
        Self::new(text)
    }

    fn boundary(&self, offset: usize) -> usize {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_units_of_utf_16() {
        let text = Text::new("a: 1\nb: 𝛼µ2\n");
        let at = |line, character| Position { line, character };
        assert_eq!(text.offset(at(1, 3)), 8);
        assert_eq!(text.offset(at(1, 5)), 12, "𝛼 has two units and four bytes");
        assert_eq!(text.position(14), at(1, 6));
        assert_eq!((text.offset(at(0, 99)), text.offset(at(9, 0))), (4, text.as_str().len()));
        for offset in [0, 5, 8, 12, 14] {
            assert_eq!(text.offset(text.position(offset)), offset);
        }
    }

    #[test]
    fn a_change_replaces_a_range_or_all() {
        let text = Text::new("a: 1\nb: 2\n");
        let range = LspRange { start: Position { line: 0, character: 3 }, end: Position { line: 1, character: 1 } };
        let change =
            |range, text: &str| TextDocumentContentChangeEvent { range, range_length: None, text: text.into() };
        assert_eq!(text.changed(change(Some(range), "7\nc")).as_str(), "a: 7\nc: 2\n");
        assert_eq!(text.changed(change(None, "x")).as_str(), "x");
    }
}
