//! Inputs: real models with some of their words and lines exchanged, and formulas from the grammar's words.

use std::path::Path;

use proptest::prelude::*;

/// Text that is seldom written, and text that readers stumble over.
const ODD: [&str; 46] = [
    "0",
    "-0",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e999",
    ".nan",
    ".inf",
    "-.inf",
    "0x10",
    "1_000",
    "0.1",
    "-1",
    "1e-9",
    "1e9",
    "%",
    "±",
    "1%",
    "200%",
    "[]",
    "{}",
    "[0, 0]",
    "[1, 0, 0]",
    "[[",
    "{a: ",
    "~",
    "null",
    "true",
    "*a",
    "&a",
    "!x",
    "|",
    ">",
    "? ",
    "- ",
    ": ",
    "#",
    "\t",
    "\"",
    "'",
    "\u{feff}",
    "\u{2028}",
    "θ",
    "---",
    "...",
];

/// Words of formulas.
const WORDS: [&str; 40] = [
    "x",
    "y",
    "t",
    "pi",
    "crank.angle",
    "a.",
    ".5",
    "1e5",
    "1e",
    "1e-",
    "2",
    "0",
    "1e308",
    "(",
    ")",
    "(",
    ")",
    "((((((((",
    "+",
    "-",
    "*",
    "/",
    "^",
    "^-",
    "**",
    ",",
    "=",
    " ",
    "sin(",
    "atan2(",
    "min(",
    "sqrt",
    "log(0",
    "±",
    "%",
    "[",
    "]",
    "θ",
    "\u{a0}",
    "x=",
];

/// A change of a text. Each number is taken modulo the count of the items that it selects from.
#[derive(Clone, Debug)]
pub enum Edit {
    /// Replaces a word by another one of the same file, of another file, or by an odd one.
    Exchange {
        word: usize,
        by: usize,
    },
    Insert {
        word: usize,
        odd: usize,
    },
    DeleteWord(usize),
    DeleteLine(usize),
    /// Adds a line of any file behind one.
    AddLine {
        line: usize,
        added: usize,
    },
    SwapLines(usize, usize),
    /// The text from here on is cut off.
    End(usize),
}

/// The index of a file, and the changes to it.
pub fn edits() -> impl Strategy<Value = (usize, Vec<Edit>)> {
    let place = || 0..1_000_000_usize;
    let edit = prop_oneof![
        6 => (place(), place()).prop_map(|(word, by)| Edit::Exchange { word, by }),
        2 => (place(), place()).prop_map(|(word, odd)| Edit::Insert { word, odd }),
        2 => place().prop_map(Edit::DeleteWord),
        2 => place().prop_map(Edit::DeleteLine),
        2 => (place(), place()).prop_map(|(line, added)| Edit::AddLine { line, added }),
        1 => (place(), place()).prop_map(|(a, b)| Edit::SwapLines(a, b)),
        1 => place().prop_map(Edit::End),
    ];
    (place(), prop::collection::vec(edit, 1..8))
}

/// Words in any order.
pub fn formula() -> impl Strategy<Value = String> {
    prop::collection::vec(prop::sample::select(&WORDS[..]), 0..40).prop_map(|words| words.concat())
}

/// Files to change.
pub struct Corpus {
    /// Cut into words and the text between them.
    texts: Vec<Vec<String>>,
    lines: Vec<String>,
}

impl Corpus {
    /// The files in some folders with this extension.
    pub fn of(folders: &[&str], extension: &str) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut paths: Vec<_> = folders
            .iter()
            .flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap())
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.is_file() && path.extension().is_some_and(|found| found == extension))
            .collect();
        paths.sort();
        let texts: Vec<String> = paths.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
        let lines = texts.iter().flat_map(|text| text.lines()).map(|line| format!("{line}\n")).collect();
        Self { texts: texts.iter().map(|text| words(text)).collect(), lines }
    }

    /// A file, changed.
    pub fn apply(&self, (file, edits): &(usize, Vec<Edit>)) -> String {
        let mut text = self.texts[file % self.texts.len()].clone();
        for edit in edits {
            if text.is_empty() {
                break;
            }
            let count = text.len();
            match *edit {
                Edit::Exchange { word, by } => {
                    let other = &self.texts[by % self.texts.len()];
                    text[word % count] = match by % 3 {
                        0 => text[by % count].clone(),
                        1 => other[by / 7 % other.len()].clone(),
                        _ => ODD[by / 7 % ODD.len()].to_owned(),
                    };
                }
                Edit::Insert { word, odd } => text.insert(word % count, ODD[odd % ODD.len()].to_owned()),
                Edit::DeleteWord(word) => drop(text.remove(word % count)),
                Edit::End(word) => text.truncate(word % count),
                Edit::DeleteLine(line) => text = with_lines(&text, |lines| drop(lines.remove(line % lines.len()))),
                Edit::AddLine { line, added } => {
                    let added = self.lines[added % self.lines.len()].clone();
                    text = with_lines(&text, |lines| lines.insert(line % lines.len(), added));
                }
                Edit::SwapLines(a, b) => {
                    text = with_lines(&text, |lines| {
                        let count = lines.len();
                        lines.swap(a % count, b % count);
                    });
                }
            }
        }
        text.concat()
    }
}

/// Letters and digits that stand together are a word; every other character is one.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut inside = false;
    for c in text.chars() {
        let of_word = c.is_alphanumeric() || c == '_';
        match words.last_mut().filter(|_| inside && of_word) {
            Some(word) => word.push(c),
            None => words.push(c.to_string()),
        }
        inside = of_word;
    }
    words
}

/// The text with its lines changed.
fn with_lines(text: &[String], change: impl FnOnce(&mut Vec<String>)) -> Vec<String> {
    let mut lines: Vec<String> = text.concat().split_inclusive('\n').map(str::to_owned).collect();
    if !lines.is_empty() {
        change(&mut lines);
    }
    words(&lines.concat())
}
