//! Formatting: indentation by two spaces, spaces within braces and after commas and colons, no trailing spaces, at most
//! one empty line in a row. Only white space changes, so comments stay, and so do aligned columns.

use std::ops::Range;

use super::outline::tree;
use super::text::Text;
use crate::syntax::Diagnostics;
use crate::syntax::yaml::{self, Node, Value};

/// Columns per level of indentation.
const INDENT: usize = 2;

/// The formatted text; `None` if it is not YAML, or if its meaning would change.
pub fn formatted(text: &str) -> Option<String> {
    let before = parsed(text)?;
    let spaced = with_spaces(text, &before);
    let lines = Text::new(spaced);
    let laid = indented(&lines, &tree(&lines)?);
    let after = parsed(&laid)?;
    let letters = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    (same(&before, &after) && letters(text) == letters(&laid)).then_some(laid)
}

/// The tree of a text; `None` if the text has errors.
fn parsed(text: &str) -> Option<Node> {
    let mut found = Diagnostics::new("", text);
    yaml::parse(text, &mut found).filter(|_| !found.has_errors())
}

/// Whether two trees have the same contents.
fn same(a: &Node, b: &Node) -> bool {
    match (&a.value, &b.value) {
        (Value::Scalar(a), Value::Scalar(b)) => a.text == b.text && a.plain == b.plain,
        (Value::Sequence(a), Value::Sequence(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Value::Mapping(a), Value::Mapping(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.key == b.key && same(&a.value, &b.value))
        }
        _ => false,
    }
}

fn is_flow(text: &str, node: &Node) -> bool {
    text.get(node.span.clone()).is_some_and(|text| text.starts_with(['{', '[']))
}

/// The text with spaces within braces, after commas and after the colons of keys.
fn with_spaces(text: &str, root: &Node) -> String {
    let mut gaps: Vec<(Range<usize>, String)> = Vec::new();
    add_gaps(text, root, &mut gaps);
    gaps.sort_by_key(|(gap, _)| gap.start);
    let mut found = String::with_capacity(text.len() + gaps.len());
    let mut at = 0;
    for (gap, new) in gaps.into_iter().filter(|(gap, _)| gap.start <= gap.end) {
        if gap.start < at {
            continue;
        }
        found.push_str(&text[at..gap.start]);
        found.push_str(&new);
        at = gap.end;
    }
    found.push_str(&text[at..]);
    found
}

fn add_gaps(text: &str, node: &Node, gaps: &mut Vec<(Range<usize>, String)>) {
    // A gap has white space and at most one comma or colon. Gaps with comments or line ends stay as they are.
    let mut add = |gap: Range<usize>, pad: bool| {
        let Some(written) = text.get(gap.clone()) else { return };
        let mark = written.trim();
        if written.contains(['\n', '#']) || !matches!(mark, "" | "," | ":") {
            return;
        }
        let behind = written.len() - written.trim_end().len();
        let width = match mark {
            "" => written.len().max(usize::from(pad)),
            _ => behind.max(1),
        };
        gaps.push((gap, format!("{mark}{}", " ".repeat(width))));
    };
    match &node.value {
        Value::Mapping(entries) => {
            if is_flow(text, node) {
                let mut at = node.span.start + 1;
                for (index, entry) in entries.iter().enumerate() {
                    add(at..entry.key_span.start, index == 0);
                    if !entry.value.span.is_empty() {
                        add(entry.key_span.end..entry.value.span.start, false);
                    }
                    at = entry.value.span.end.max(entry.key_span.end);
                }
                if let (Some(_), true) = (entries.last(), text[at..node.span.end].trim() == "}") {
                    add(at..node.span.end - 1, true);
                }
            }
            entries.iter().for_each(|entry| add_gaps(text, &entry.value, gaps));
        }
        Value::Sequence(items) => {
            if is_flow(text, node) {
                for pair in items.windows(2) {
                    add(pair[0].span.end..pair[1].span.start, false);
                }
            }
            items.iter().for_each(|item| add_gaps(text, item, gaps));
        }
        Value::Scalar(_) => {}
    }
}

/// Indentation of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line {
    /// Begins in this column.
    Column(usize),
    /// Moves with the line above that has a column.
    Follows,
    /// Within a text of several lines: moves as well, and retains its trailing spaces.
    Text,
}

fn indented(text: &Text, root: &Node) -> String {
    let mut lines = vec![Line::Follows; text.line_count()];
    lay(text, root, 0, &mut lines);
    let source = text.as_str();
    let mut found = String::with_capacity(source.len());
    let mut moved = 0_isize;
    for number in 0..text.line_count() {
        let line = source[text.line(number)].trim_end_matches('\r');
        let content = line.trim_start_matches(' ');
        let column = line.len() - content.len();
        let is_comment = content.starts_with('#') && lines[number] == Line::Follows;
        match lines[number] {
            Line::Column(new) => moved = new as isize - column as isize,
            Line::Follows if is_comment => {
                // A comment in the column of the line below moves with that line.
                let below = (number + 1..text.line_count()).find(|&below| {
                    let own = source[text.line(below)].trim();
                    !own.is_empty() && !own.starts_with('#')
                });
                if let Some((below, Line::Column(new))) = below.map(|below| (below, lines[below])) {
                    let own = &source[text.line(below)];
                    if own.len() - own.trim_start_matches(' ').len() == column {
                        moved = new as isize - column as isize;
                    }
                }
            }
            Line::Follows | Line::Text => {}
        }
        let kept = if lines[number] == Line::Text { content } else { content.trim_end() };
        if kept.trim().is_empty() && lines[number] != Line::Text {
            if !found.is_empty() && !found.ends_with("\n\n") {
                found.push('\n');
            }
            continue;
        }
        let column = column.saturating_add_signed(moved);
        if !kept.is_empty() {
            found.extend(std::iter::repeat_n(' ', column));
        }
        found.push_str(kept);
        found.push('\n');
    }
    let end = found.trim_end().len();
    found.truncate(end);
    found.push('\n');
    found
}

/// Sets the columns of lines on which keys and items of blocks begin.
fn lay(text: &Text, node: &Node, column: usize, lines: &mut [Line]) {
    let source = text.as_str();
    let mut place = |offset: usize, column: usize, is_item: bool| {
        let line = text.line_of(offset);
        let before = &source[text.line(line).start..offset];
        let is_first = if is_item { before.trim() == "-" } else { before.trim().is_empty() };
        if is_first && lines[line] == Line::Follows {
            lines[line] = Line::Column(column);
        }
    };
    match &node.value {
        _ if is_flow(source, node) => {}
        Value::Mapping(entries) => {
            entries.iter().for_each(|entry| place(entry.key_span.start, column, false));
            for entry in entries {
                lay(text, &entry.value, column + INDENT, lines);
            }
        }
        Value::Sequence(items) => {
            items.iter().for_each(|item| place(item.span.start, column, true));
            for item in items {
                lay(text, item, column + INDENT, lines);
            }
        }
        Value::Scalar(_) => {
            // A text in a block ends where the next key begins.
            let end = source[..node.span.end].trim_end().len().max(node.span.start + 1);
            let (first, last) = (text.line_of(node.span.start), text.line_of(end - 1));
            // A text behind `|` begins on a line of its own.
            let is_behind = source[text.line(first).start..node.span.start].trim().is_empty();
            lines[(first + usize::from(!is_behind)).min(last + 1)..=last].fill(Line::Text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formatting_changes_only_white_space() {
        let text = "\n\n# a model\nmodel:   m   \nbodies:\n    crank: {mass: 1,inertia: 2 ,points: {A: [0,1]}}   # heavy\n\n\n\n    # the rod\n    \
                    rod:\n          mass: 1\noutputs: { x: crank.x }";
        let wanted = "# a model\nmodel:   m\nbodies:\n  crank: { mass: 1, inertia: 2, points: { A: [0, 1] } }   # heavy\n\n  # the rod\n  \
                      rod:\n    mass: 1\noutputs: { x: crank.x }\n";
        assert_eq!(formatted(text).as_deref(), Some(wanted));
        assert_eq!(formatted(wanted).as_deref(), Some(wanted));
    }

    #[test]
    fn multi_line_texts_and_lists_keep_their_value() {
        let text = "a: |\n    one  \n\n      two\nb:\n- 1\n-   2\nc: [1,\n    2,\n    3]\n";
        let wanted = "a: |\n    one  \n\n      two\nb:\n  - 1\n  -   2\nc: [1,\n    2,\n    3]\n";
        assert_eq!(formatted(text).as_deref(), Some(wanted));
        for wrong in ["a: [1", "a: 1\na: 2", "", "\t"] {
            assert_eq!(formatted(wrong), None);
        }
    }
}
