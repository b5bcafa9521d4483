//! Rules about text that neither rustfmt nor clippy checks.
//!
//! A rule counts its violations in the tracked files and has a limit. Where a limit is above zero, it is the number
//! that was there when the rule was written: it may fall, never rise.

use std::path::Path;
use std::process::{Command, ExitCode};

/// Widest comment, in columns.
const COLUMNS: usize = 120;

/// A rule: its name, the violations allowed, and a test of one line of one file.
struct Rule {
    name: &'static str,
    limit: usize,
    violates: fn(path: &str, line: &str) -> usize,
}

const RULES: [Rule; 4] = [
    Rule { name: "comments wider than 120 columns", limit: LIMITS[0], violates: wide_comment },
    Rule { name: "noun clauses of the form \"what is …\"", limit: LIMITS[1], violates: noun_clauses },
    Rule { name: "tuple parameters", limit: LIMITS[2], violates: tuple_parameter },
    Rule { name: "stray files", limit: 0, violates: |_, _| 0 },
];

/// Limits of the first three rules.
const LIMITS: [usize; 3] = [0, 60, 21];

/// Endings of files that programs leave behind.
const STRAY: [&str; 6] = [".orig", ".rej", ".log", ".LOG.TXT", "_LOG.TXT", ".snap.new"];

/// Words that follow "what" in a noun clause.
const AFTER_WHAT: [&str; 9] = ["is", "it", "they", "are", "of", "that", "has", "was", "does"];

/// Checks all tracked files; prints each rule that is violated, with its lines.
pub fn run(root: &Path) -> ExitCode {
    let Some(files) = tracked(root) else {
        eprintln!("error: `git ls-files` failed");
        return ExitCode::FAILURE;
    };
    let mut found: Vec<Vec<String>> = RULES.iter().map(|_| Vec::new()).collect();
    for path in &files {
        if STRAY.iter().any(|ending| path.ends_with(ending)) {
            found[RULES.len() - 1].push(path.clone());
        }
        let Ok(text) = std::fs::read_to_string(root.join(path)) else { continue };
        for (number, line) in text.lines().enumerate() {
            for (rule, found) in RULES.iter().zip(&mut found) {
                let times = (rule.violates)(path, line);
                found.extend((0..times).map(|_| format!("{path}:{}: {}", number + 1, line.trim())));
            }
        }
    }
    let mut status = ExitCode::SUCCESS;
    for (rule, found) in RULES.iter().zip(found) {
        println!("{:5} of at most {:5}  {}", found.len(), rule.limit, rule.name);
        if found.len() > rule.limit {
            found.iter().for_each(|line| println!("        {line}"));
            status = ExitCode::FAILURE;
        }
    }
    status
}

/// Paths of all tracked files.
fn tracked(root: &Path) -> Option<Vec<String>> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root).output().ok()?;
    let text = String::from_utf8(listed.stdout).ok()?;
    listed.status.success().then(|| text.split_terminator('\0').map(str::to_owned).collect())
}

fn is_rust(path: &str) -> bool {
    path.ends_with(".rs")
}

fn wide_comment(path: &str, line: &str) -> usize {
    usize::from(is_rust(path) && line.trim_start().starts_with("//") && line.chars().count() > COLUMNS)
}

/// Noun clauses in comments of the source and in the documentation.
fn noun_clauses(path: &str, line: &str) -> usize {
    let is_source = is_rust(path) && (path.starts_with("src/") || path.starts_with("crates/"));
    let is_page = path.ends_with(".md");
    let text = match line.split_once("//") {
        _ if is_page => line,
        Some((_, comment)) if is_source => comment,
        _ => return 0,
    };
    let words: Vec<String> =
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_lowercase).collect();
    words.windows(2).filter(|pair| pair[0] == "what" && AFTER_WHAT.contains(&pair[1].as_str())).count()
}

/// A parameter that is a pattern of a tuple: `(a, b): (A, B)`.
fn tuple_parameter(path: &str, line: &str) -> usize {
    let is_parameter = is_rust(path) && line.contains("): (") && !line.trim_start().starts_with("//");
    usize::from(is_parameter && !line.trim_start().starts_with("let "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_see_their_violations_and_nothing_else() {
        let wide = format!("    /// {}", "x".repeat(COLUMNS));
        assert_eq!(
            [wide_comment("a.rs", &wide), wide_comment("a.md", &wide), wide_comment("a.rs", "/// x")],
            [1, 0, 0]
        );
        assert_eq!(noun_clauses("src/a.rs", "let what = is; // What it is, and what has none."), 2);
        assert_eq!(noun_clauses("tests/a.rs", "// what is"), 0);
        assert_eq!(noun_clauses("docs/a.md", "Whatever is here, what follows"), 0);
        assert_eq!(tuple_parameter("a.rs", "    (low, high): (f64, f64),"), 1);
        assert_eq!(tuple_parameter("a.rs", "    let (low, high): (f64, f64) = ends;"), 0);
    }
}
