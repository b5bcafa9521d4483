//! Suggested corrections of texts that are not YAML.

use granit_parser::ErrorKind;

use super::suggest::clip;

/// Suggested correction of a common mistake; `at` is the byte at which reading ended.
pub(super) fn help(text: &str, at: usize, kind: &ErrorKind) -> Option<String> {
    use ErrorKind::*;
    let is_indented_by_tab =
        text[..at].rsplit('\n').next().is_some_and(|line| line.trim_start_matches(' ').starts_with('\t'));
    if is_indented_by_tab || text[at..].starts_with('\t') {
        return Some("YAML is indented with spaces, not tabs".to_owned());
    }
    if let Some(name) = name_with_index(text, at) {
        return Some(format!("within braces and brackets, quote a name with an index: `\"{}\"`", clip(name)));
    }
    match kind {
        UnclosedQuotedScalar | InvalidQuotedScalarIndent | DocumentIndicatorInQuotedScalar => {
            return open_quote(text, at);
        }
        MismatchedFlowCollectionEnd { open, .. } | UnclosedFlowCollection { open } => {
            return Some(format!("a `{open}` is closed by `{}`", if *open == '[' { ']' } else { '}' }));
        }
        _ => {}
    }
    if let Some(interval) = interval_before(text, at) {
        return Some(format!("quote the interval: `\"{}\"`", clip(interval)));
    }
    let help = match kind {
        ExpectedBlockMappingKey | InvalidIndentation | ExpectedBlockSequenceEntry => return columns(text, at),
        SimpleKeyExpected | InvalidSimpleKey => "a key is followed by `:` and a space",
        ExpectedFlowMappingSeparator | UnexpectedEofFlowMapping | UnexpectedEofImplicitFlowMapping => {
            "a comma stands between the entries in braces, and `}` behind the last"
        }
        ExpectedFlowSequenceSeparator | UnexpectedEofFlowSequence => {
            "a comma stands between the items in brackets, and `]` behind the last"
        }
        _ => return None,
    };
    Some(help.to_owned())
}

/// Help if this line and the one above begin in different columns.
fn columns(text: &str, at: usize) -> Option<String> {
    let column = |line: &str| line.chars().take_while(|c| *c == ' ').count() + 1;
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let here = column(text[start..].lines().next()?);
    let is_content = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let (number, above) = text[..start].lines().enumerate().filter(|(_, line)| is_content(line)).last()?;
    let (number, above) = (number + 1, column(above));
    let told = format!("keys of one mapping begin in the same column: here in {here}, in line {number} in {above}");
    (here != above).then_some(told)
}

/// Help that names the line above in which a quote is not closed.
fn open_quote(text: &str, at: usize) -> Option<String> {
    let lines: Vec<&str> = text[..at].lines().collect();
    let is_open = |line: &str| line.matches('"').count() % 2 == 1 || line.matches('\'').count() % 2 == 1;
    let index = lines.iter().position(|line| !line.trim_start().starts_with('#') && is_open(line))?;
    Some(format!("a quote of line {} is not closed", index + 1))
}

/// The name with an index in braces, `leg_{i}`, from which on the text is not YAML.
fn name_with_index(text: &str, at: usize) -> Option<&str> {
    let start_of_line = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let before = &text[start_of_line..text[at..].find(' ').map_or(text.len(), |space| at + space)];
    let open = before.rfind('{').filter(|open| before[..*open].ends_with(|c: char| c.is_alphanumeric() || c == '_'))?;
    let start = before[..open].rfind([' ', '[', '{', ',', '"']).map_or(0, |space| space + 1);
    let close = open + before[open..].find('}')? + 1;
    Some(&before[start..close])
}

/// The interval with a unit after it, `[0.49, 0.51] m`, from which on the text is not YAML.
fn interval_before(text: &str, at: usize) -> Option<&str> {
    // The error is at the unit or after it.
    let start_of_line = text[..at].trim_end().rfind('\n').map_or(0, |newline| newline + 1);
    let end_of_line = text[at..].find('\n').map_or(text.len(), |newline| at + newline);
    let line = &text[start_of_line..end_of_line];
    let open = line[..(at - start_of_line).min(line.len())].rfind('[')?;
    let close = open + line[open..].find(']')?;
    let behind = line[close + 1..].find([',', '}', '#', '\n']).map_or(line.len(), |end| close + 1 + end);
    let unit = line[close + 1..behind].trim();
    (unit.starts_with(char::is_alphabetic) || unit.starts_with('°')).then(|| line[open..behind].trim())
}
