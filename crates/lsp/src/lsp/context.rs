//! Surroundings of a cursor in a model's text: keys around it, and whether it is in a key or a value. Half-typed texts
//! have no tree, so this module reads lines: indentation, braces, brackets and quotes up to the cursor.

use std::ops::Range;

/// A step from a mapping or a list to one of its values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// The value of a key.
    Key(String),
    /// An item of a list.
    Item,
}

/// Kind of text at the cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// A key.
    Key,
    /// A value, or an item of a list.
    Value,
    /// A comment.
    Comment,
}

/// The surroundings of a cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Context {
    /// Steps from the root to the mapping of the key, or to the value.
    pub path: Vec<Step>,
    /// Kind of text at the cursor.
    pub slot: Slot,
    /// Bytes of the dotted word before the cursor.
    pub word: Range<usize>,
    /// Part of the word before its last dot: `crank.B` of `crank.B.v`.
    pub owner: String,
    /// Part of the word after it.
    pub typed: String,
    /// Bytes of the value, or of the key, up to the cursor.
    pub written: Range<usize>,
    /// Keys of the same mapping before the cursor.
    pub siblings: Vec<String>,
}

/// A mapping or a list around the cursor.
#[derive(Debug)]
struct Frame {
    /// Column of a block; `None` for braces and brackets.
    indent: Option<usize>,
    is_list: bool,
    /// The key whose value is being read.
    key: Option<String>,
    siblings: Vec<String>,
}

impl Frame {
    fn new(indent: Option<usize>, is_list: bool) -> Self {
        Self { indent, is_list, key: None, siblings: Vec::new() }
    }

    fn set_key(&mut self, key: &str) {
        let key = key.trim().trim_matches(['"', '\'']).to_owned();
        self.siblings.push(key.clone());
        self.key = Some(key);
    }
}

/// The surroundings of a byte of a text.
pub fn context(text: &str, offset: usize) -> Context {
    let before = &text[..offset];
    let mut frames = vec![Frame::new(Some(0), false)];
    // First byte of the piece that is being read.
    let mut start = 0;
    let mut is_comment = false;
    let mut line_start = 0;
    for line in before.split_inclusive('\n') {
        let is_last = line_start + line.len() == before.len() && !line.ends_with('\n');
        (start, is_comment) = read_line(line, line_start, &mut frames, start);
        line_start += line.len();
        if is_last {
            break;
        }
    }
    if before.is_empty() || before.ends_with('\n') {
        // An empty line up to the cursor.
        is_comment = false;
        if frames.last().is_some_and(|own| own.indent.is_some()) {
            leave(&mut frames, 0);
            start = offset;
        }
    }
    let piece = &before[start.min(offset)..];
    let written = offset - piece.trim_start().len()..offset;
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '{' | '}');
    let in_braces = |text: &str| text.trim_start_matches(['"', '\'']).len();
    let word_len = piece.chars().rev().take_while(|&c| is_part(c)).map(char::len_utf8).sum::<usize>();
    let word = offset - in_braces(&before[offset - word_len..])..offset;
    let last = frames.last();
    let is_value = last.is_some_and(|own| own.is_list || own.key.is_some());
    let slot = if is_comment {
        Slot::Comment
    } else if is_value {
        Slot::Value
    } else {
        Slot::Key
    };
    let siblings = last.map_or_else(Vec::new, |own| own.siblings.clone());
    let mut path = Vec::new();
    for frame in &frames {
        match &frame.key {
            Some(key) => path.push(Step::Key(key.clone())),
            None if frame.is_list => path.push(Step::Item),
            None => {}
        }
    }
    let (owner, typed) = text[word.clone()].rsplit_once('.').unwrap_or(("", &text[word.clone()]));
    let (owner, typed) = (owner.to_owned(), typed.to_owned());
    Context { path, slot, word, owner, typed, written, siblings }
}

/// Closes the blocks that a line in column `indent` ends, and the key of the block in that column; opens the block that
/// a deeper line begins.
fn leave(frames: &mut Vec<Frame>, indent: usize) {
    while frames.len() > 1 && frames.last().is_some_and(|own| own.indent.is_some_and(|column| column > indent)) {
        frames.pop();
    }
    match frames.last_mut() {
        Some(own) if own.indent.is_some_and(|column| column >= indent) => own.key = None,
        // Deeper than the key above: the mapping that is its value.
        Some(own) if own.key.is_some() || own.is_list => frames.push(Frame::new(Some(indent), false)),
        _ => {}
    }
}

/// Reads a line. Returns the first byte of the piece that is open at its end, and whether a comment is open there.
fn read_line(line: &str, offset: usize, frames: &mut Vec<Frame>, open: usize) -> (usize, bool) {
    let content = line.trim_end_matches(['\n', '\r']);
    let mut at = 0;
    let mut start = open;
    if frames.last().is_some_and(|own| own.indent.is_some()) {
        at = content.len() - content.trim_start().len();
        let rest = &content[at..];
        if rest.starts_with('#') {
            return (offset + at, true);
        }
        if rest.is_empty() && line.ends_with('\n') {
            return (start, false);
        }
        leave(frames, at);
        start = offset + at;
        while content[at..].starts_with("- ") || &content[at..] == "-" {
            let own = at;
            at += 1 + content[at + 1..].len() - content[at + 1..].trim_start().len();
            // The list is the value of the key above, in its column or deeper.
            if frames
                .last()
                .is_some_and(|frame| frame.indent == Some(own) && !frame.is_list && frame.siblings.is_empty())
            {
                frames.pop();
            } else if let Some(frame) = frames.last_mut().filter(|frame| frame.indent == Some(own) && !frame.is_list) {
                frame.key = frame.siblings.last().cloned();
            }
            if !frames.last().is_some_and(|frame| frame.is_list && frame.indent == Some(own)) {
                frames.push(Frame::new(Some(own), true));
            }
            start = offset + at;
            if content[at..].contains(':') {
                frames.push(Frame::new(Some(at), false));
            }
        }
    }
    let mut letters = content[at..].char_indices().map(|(index, letter)| (at + index, letter)).peekable();
    let mut quote = None;
    let mut before = ' ';
    while let Some((index, letter)) = letters.next() {
        let next = letters.peek().map(|(_, next)| *next);
        let ends_key = next.is_none_or(|next| next.is_whitespace() || matches!(next, '{' | '[' | '"'));
        match (quote, letter) {
            (Some(open), letter) if letter == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') if content[..index].trim_end().ends_with([':', ',', '{', '[']) || index == at => {
                quote = Some(letter);
            }
            (None, '#') if before.is_whitespace() => return (offset + index, true),
            (None, '{' | '[') if is_begin(content, index, at, offset, start) => {
                frames.push(Frame::new(None, letter == '['));
                start = offset + index + 1;
            }
            (None, '}' | ']')
                if frames.last().is_some_and(|own| own.indent.is_none() && own.is_list == (letter == ']')) =>
            {
                frames.pop();
                start = offset + index + 1;
            }
            (None, ',') if frames.last().is_some_and(|own| own.indent.is_none()) => {
                if let Some(own) = frames.last_mut() {
                    own.key = None;
                }
                start = offset + index + 1;
            }
            (None, ':') if ends_key => {
                let from = start.max(offset) - offset;
                if let Some(own) = frames.last_mut().filter(|own| !own.is_list && own.key.is_none()) {
                    own.set_key(content.get(from..index).unwrap_or_default());
                    start = offset + index + 1;
                }
            }
            _ => {}
        }
        before = letter;
    }
    (start, false)
}

/// Whether a brace or a bracket opens a collection: it begins a piece. Others are indices in names, `leg_{i}`.
fn is_begin(content: &str, index: usize, at: usize, offset: usize, start: usize) -> bool {
    let from = (start.max(offset) - offset).max(at).min(index);
    content.get(from..index).is_some_and(|piece| piece.trim().is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Path, slot and word at the `|`.
    fn at(text: &str) -> (String, Slot, String) {
        let offset = text.find('|').unwrap();
        let text = text.replacen('|', "", 1);
        let found = context(&text, offset);
        let steps = found.path.iter().map(|step| match step {
            Step::Key(key) => key.as_str(),
            Step::Item => "-",
        });
        (steps.collect::<Vec<_>>().join("/"), found.slot, text[found.word].to_owned())
    }

    fn is(text: &str, path: &str, slot: Slot, word: &str) {
        assert_eq!(at(text), (path.to_owned(), slot, word.to_owned()), "{text}");
    }

    #[test]
    fn keys_and_values_of_blocks() {
        is("|", "", Slot::Key, "");
        is("bod|", "", Slot::Key, "bod");
        is("bodies:\n  cr|", "bodies", Slot::Key, "cr");
        is("bodies:\n  crank:\n    ma|", "bodies/crank", Slot::Key, "ma");
        is("bodies:\n  crank:\n    mass: m|", "bodies/crank/mass", Slot::Value, "m");
        is("bodies:\n  crank:\n    mass: 1\n  r|", "bodies", Slot::Key, "r");
        is("bodies:\n  crank:\n    mass: 1\njo|", "", Slot::Key, "jo");
        is("bodies:\n  crank:\n    mass: 1\n\n    |", "bodies/crank", Slot::Key, "");
        is("outputs:\n  x: crank.A.v|", "outputs/x", Slot::Value, "crank.A.v");
        is("outputs:\n  x: 2*(crank.A.v|", "outputs/x", Slot::Value, "crank.A.v");
        is("model: a  # bod|", "model", Slot::Comment, "bod");
        is("include:\n  - a.yaml\n  - b|", "include/-", Slot::Value, "b");
        is("include:\n- a.yaml\n- b|", "include/-", Slot::Value, "b");
        is("a:\n  - b: 1\n    c|", "a/-", Slot::Key, "c");
    }

    #[test]
    fn keys_and_values_in_braces() {
        is("bodies:\n  crank: { ma|", "bodies/crank", Slot::Key, "ma");
        is("bodies:\n  crank: { mass: m1, ine|", "bodies/crank", Slot::Key, "ine");
        is("bodies:\n  crank: { mass: m1, inertia: m|", "bodies/crank/inertia", Slot::Value, "m");
        is("joints:\n  pin: { revolute: [crank.B, ro|", "joints/pin/revolute/-", Slot::Value, "ro");
        is("joints:\n  pin: { revolute: [a, b] }\n  q|", "joints", Slot::Key, "q");
        is("bodies:\n  a: { points: { A: [0, 1], B: [0, |", "bodies/a/points/B/-", Slot::Value, "");
        is("a: { b: {\n  c: 1,\n  d|", "a/b", Slot::Key, "d");
        is("a: { b: \"max(1, x|", "a/b", Slot::Value, "x");
        is("\"leg_{i}\": { re|", "leg_{i}", Slot::Key, "re");
    }
}
