//! Contents of pages: commands with their output, and the figures of their text.
//!
//! A block `console` has commands, each after `$ `, and their output; a line `…` stands for any lines. Commands run in
//! a folder of the page, with the repository's `docs` and `models` in it; a block `yaml` that begins with `# NAME.yaml`
//! is a file there. Numbers are compared with a tolerance, since a page shows results and not their last digits.

use std::path::Path;
use std::process::Command;

use super::{BINARY, blocks};

/// Relative difference of numbers that are the same to a reader.
const SAME: f64 = 2e-3;

/// Smaller values are errors of rounding: their size is of no interest.
const ROUNDING: f64 = 1e-7;

/// A page's blocks as they should be; `None` where they are.
pub fn current(page: &str, folder: &Path) -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for shared in ["docs", "models"] {
        std::os::unix::fs::symlink(root.join(shared), folder.join(shared)).unwrap();
    }
    for text in blocks(page, "yaml") {
        let first = text.lines().next().unwrap();
        if let Some(name) =
            first.strip_prefix("# ").filter(|name| name.ends_with(".yaml") && !name.contains([' ', '/']))
        {
            std::fs::write(folder.join(name), text).unwrap();
        }
    }
    let mut current = page.to_owned();
    for block in blocks(page, "console") {
        let printed = run_commands(block, folder);
        if !is_shown(block, &printed) {
            current = current.replacen(block, &printed, 1);
        }
    }
    (current != page).then_some(current)
}

/// The commands of a console block with their output.
fn run_commands(block: &str, folder: &Path) -> String {
    let path = format!("{}:{}", Path::new(BINARY).parent().unwrap().display(), std::env::var("PATH").unwrap());
    let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
    let print = |command: &str| {
        let shell = format!("{{ {command}\n}} 2>&1");
        let output = Command::new("sh").args(["-c", &shell]).current_dir(folder).env("PATH", &path).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        // Lines of progress depend on the machine.
        let text: String =
            text.lines().filter(|line| !line.contains(" % done")).flat_map(|line| [line, "\n"]).collect();
        format!("$ {command}\n{text}")
    };
    commands.map(print).collect()
}

/// Whether a block has the printed text.
fn is_shown(block: &str, printed: &str) -> bool {
    let mut rest: Vec<&str> = printed.lines().collect();
    let parts: Vec<Vec<&str>> =
        block.lines().collect::<Vec<_>>().split(|line| *line == "…").map(<[_]>::to_vec).collect();
    let last = parts.len() - 1;
    for (index, part) in parts.iter().enumerate() {
        let matches = |from: usize| {
            from + part.len() <= rest.len() && part.iter().zip(&rest[from..]).all(|(shown, line)| is_same(shown, line))
        };
        let latest = rest.len().saturating_sub(part.len());
        let found = match index {
            0 if last == 0 => (rest.len() == part.len() && matches(0)).then_some(0),
            0 => matches(0).then_some(0),
            _ if index == last => matches(latest).then_some(latest),
            _ => (0..=latest).find(|&from| matches(from)),
        };
        let Some(from) = found else { return false };
        rest.drain(..from + part.len());
    }
    true
}

/// Whether two lines say the same: words by words, without the seconds at their end, which are the only numbers with
/// three decimals there.
fn is_same(shown: &str, line: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        let mut words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
        let is_seconds = |word: &String| word.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 3);
        if words.len() > 4 && words.last().is_some_and(is_seconds) {
            words.pop();
        }
        words
    };
    let (shown, line) = (words(shown), words(line));
    shown.len() == line.len() && shown.iter().zip(&line).all(|(shown, word)| is_same_word(shown, word))
}

fn is_same_word(shown: &str, word: &str) -> bool {
    let (shown, word) = (pieces(shown), pieces(word));
    let is_near = |a: &Piece, b: &Piece| match (a, b) {
        (Piece::Text(a), Piece::Text(b)) => a == b,
        (Piece::Number(a, _), Piece::Number(b, _)) => {
            let size = a.abs().max(b.abs());
            (a - b).abs() <= SAME * size || size < ROUNDING
        }
        _ => false,
    };
    shown.len() == word.len() && shown.iter().zip(&word).all(|(a, b)| is_near(a, b))
}

/// A part of a word.
#[derive(Debug)]
enum Piece {
    Text(String),
    /// Its value, and how many decimals it has.
    Number(f64, i32),
}

/// A word's texts and numbers.
fn pieces(word: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut rest = word;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let before = &rest[..start];
        let sign = if before.ends_with(['-', '−']) { -1.0 } else { 1.0 };
        if !before.is_empty() {
            pieces.push(Piece::Text(before.trim_end_matches(['-', '−']).to_owned()));
        }
        rest = &rest[start..];
        let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let mut end = digits(rest);
        let mut decimals = 0;
        if rest[end..].starts_with('.') && digits(&rest[end + 1..]) > 0 {
            decimals = digits(&rest[end + 1..]);
            end += 1 + decimals;
        }
        if let Some(exponent) = rest[end..].strip_prefix('e') {
            let signed = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
            if digits(signed) > 0 {
                end += 1 + (exponent.len() - signed.len()) + digits(signed);
            }
        }
        pieces.push(Piece::Number(sign * rest[..end].parse::<f64>().unwrap(), decimals as i32));
        rest = &rest[end..];
    }
    if !rest.is_empty() {
        pieces.push(Piece::Text(rest.to_owned()));
    }
    pieces
}

/// Figures of a page's text, of three digits or more, that none of its blocks has, rounded: a page concludes only from
/// the output that it shows.
pub fn unfounded(page: &str) -> Vec<String> {
    let mut founded: Vec<f64> = Vec::new();
    let mut text = String::new();
    for (index, part) in page.split("```").enumerate() {
        match index % 2 {
            0 => text += part,
            _ => founded.extend(part.split_whitespace().flat_map(pieces).filter_map(|piece| match piece {
                Piece::Number(value, _) => Some(value.abs()),
                Piece::Text(_) => None,
            })),
        }
    }
    let outside_of_code: String = text.split('`').step_by(2).collect();
    // A link's address is no text.
    let words = outside_of_code.split_whitespace().map(|word| word.split("](").next().unwrap());
    let mut unfounded = Vec::new();
    for word in words {
        for piece in pieces(word.trim_matches(['(', ')', ',', '.', ';', ':'])) {
            let Piece::Number(value, decimals) = piece else { continue };
            let value = value.abs();
            let half = 0.5 * 10_f64.powi(-decimals);
            let has_three_digits = value / (2.0 * half) >= 99.5;
            // A prefix of the unit, or degrees instead of radians.
            let scales = [1.0, 1e3, 1e-3, 180.0 / std::f64::consts::PI];
            let is_founded =
                founded.iter().any(|x| scales.iter().any(|scale| (scale * x - value).abs() <= half * (1.0 + 1e-9)));
            if has_three_digits && !is_founded {
                unfounded.push(word.to_owned());
            }
        }
    }
    unfounded
}

#[test]
fn figures_are_compared_with_a_tolerance() {
    let printed =
        "$ mbint run a.yaml\na: 3 bodies\n\n  x.scan   1.390e0  3.63e-10  m\n  nominal  1  1000  1138  0.004\nend\n";
    for same in [
        printed,
        "$ mbint run a.yaml\n…\n  x.scan  1.391e0  9.99e-12  m\n…\n",
        "$ mbint run a.yaml\n…\nnominal  1  1000  1138  0.123\nend\n",
    ] {
        assert!(is_shown(same, printed), "{same}");
    }
    for other in [
        "$ mbint run a.yaml\na: 3 bodies\n",
        "$ mbint run a.yaml\n…\n  x.scan  1.40e0  3.63e-10  m\n…\n",
        "$ mbint run a.yaml\n…\n  x.scan  1.39e0  3.63e-10  mm\n…\n",
        "$ mbint run a.yaml\n…\n  x.scan  -1.39e0  3.63e-10  m\n…\n",
        "$ mbint run a.yaml\n…\n  nominal  1  1000  1198  0.004\nend\n",
    ] {
        assert!(!is_shown(other, printed), "{other}");
    }
}

#[test]
fn a_conclusion_needs_a_figure() {
    let page = "It takes 61 runs.\n```console\n$ mbint run a.yaml\n  x  76.8186  0.012\n```\nIt is at 76.82°, or 76.819 (`77.77`); 12.0 mm are left, not 76.83° of [it](a/1234.md).\n";
    assert_eq!(unfounded(page), ["76.83°"]);
}
