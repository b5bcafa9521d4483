//! Rules about text that neither rustfmt nor clippy checks.
//!
//! A rule counts its violations in the tracked files and has a limit. A limit above zero is the number of violations
//! when the rule was written: it may fall, never rise.

use std::collections::BTreeMap;
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

const RULES: [Rule; 7] = [
    Rule { name: "comments wider than 120 columns", limit: LIMITS[0], violates: wide_comment },
    Rule { name: "clauses in place of nouns: \"what is …\", \"so many\"", limit: LIMITS[1], violates: noun_clauses },
    Rule { name: "comments that begin with \"What\" or \"Of\"", limit: LIMITS[2], violates: noun_later },
    Rule { name: "tuple parameters", limit: LIMITS[3], violates: tuple_parameter },
    Rule { name: "numeric constants outside of `tuning.rs`", limit: LIMITS[4], violates: numeric_constant },
    Rule { name: "public types of a name that another one of the crate has", limit: LIMITS[5], violates: |_, _| 0 },
    Rule { name: "stray files", limit: 0, violates: |_, _| 0 },
];

/// Limits of all rules but the last.
const LIMITS: [usize; 6] = [0, 8, 0, 21, 172, 10];

/// Indices of the rules that need more than a line.
const HOMONYMS: usize = 5;
const STRAY_FILES: usize = 6;

/// Endings of files that programs leave behind.
const STRAY: [&str; 6] = [".orig", ".rej", ".log", ".LOG.TXT", "_LOG.TXT", ".snap.new"];

/// Types of numbers.
const NUMBERS: [&str; 12] = ["f32", "f64", "i8", "i16", "i32", "i64", "isize", "u8", "u16", "u32", "u64", "usize"];

/// Words that follow "what" in a noun clause.
const AFTER_WHAT: [&str; 9] = ["is", "it", "they", "are", "of", "that", "has", "was", "does"];

/// Checks all tracked files; prints each rule that is violated, with its lines.
pub fn run(root: &Path) -> ExitCode {
    let Some(files) = tracked(root) else {
        eprintln!("error: `git ls-files` failed");
        return ExitCode::FAILURE;
    };
    let mut types: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
    let mut found: Vec<Vec<String>> = RULES.iter().map(|_| Vec::new()).collect();
    for path in &files {
        if STRAY.iter().any(|ending| path.ends_with(ending)) {
            found[STRAY_FILES].push(path.clone());
        }
        let Ok(text) = std::fs::read_to_string(root.join(path)) else { continue };
        for (number, line) in text.lines().enumerate() {
            if let Some(name) = public_type(path, line) {
                types.entry(name).or_default().push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
            for (rule, found) in RULES.iter().zip(&mut found) {
                let times = (rule.violates)(path, line);
                found.extend((0..times).map(|_| format!("{path}:{}: {}", number + 1, line.trim())));
            }
        }
    }
    found[HOMONYMS].extend(types.into_values().flat_map(|lines| lines.into_iter().skip(1)));
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

/// Noun clauses in comments and in the documentation.
fn noun_clauses(path: &str, line: &str) -> usize {
    let is_page = path.ends_with(".md");
    let text = match line.split_once("//") {
        _ if is_page => line,
        Some((_, comment)) if is_rust(path) => comment,
        _ => return 0,
    };
    let words: Vec<String> =
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_lowercase).collect();
    let is_clause = |pair: &&[String]| match pair[0].as_str() {
        "what" => AFTER_WHAT.contains(&pair[1].as_str()),
        "so" => pair[1] == "many",
        _ => false,
    };
    words.windows(2).filter(is_clause).count()
}

/// A comment in which a clause stands before the noun.
fn noun_later(path: &str, line: &str) -> usize {
    let text = line.trim_start().trim_start_matches('/').trim_start_matches('!').trim_start();
    let is_comment = is_rust(path) && line.trim_start().starts_with("//");
    usize::from(is_comment && ["What ", "Of "].iter().any(|first| text.starts_with(first)))
}

/// A parameter that is a pattern of a tuple: `(a, b): (A, B)`.
fn tuple_parameter(path: &str, line: &str) -> usize {
    let is_parameter = is_rust(path) && line.contains("): (") && !line.trim_start().starts_with("//");
    usize::from(is_parameter && !line.trim_start().starts_with("let "))
}

/// A constant of a number outside of the room's `tuning.rs`: a fact, such as a coefficient of a tableau or a width of a
/// page. Limits and thresholds are in `tuning.rs` (decision 0157).
fn numeric_constant(path: &str, line: &str) -> usize {
    let is_source = is_rust(path) && (path.starts_with("src/") || path.contains("/src/"));
    let constant =
        line.trim_start().split_once("const ").filter(|(before, _)| before.is_empty() || before.starts_with("pub"));
    let typed = constant.and_then(|(_, rest)| rest.split_once(": ")?.1.split_once(" ="));
    let counts = |(own, value): (&str, &str)| NUMBERS.contains(&own) && !value.contains("TUNING.");
    usize::from(is_source && typed.is_some_and(counts))
}

/// The crate and the name of a public type that a line at a file's outermost level declares.
fn public_type(path: &str, line: &str) -> Option<(String, String)> {
    let own = if path.starts_with("src/") { "src" } else { path.strip_prefix("crates/")?.split('/').next()? };
    let (_, rest) = line.split_once(' ').filter(|(first, _)| is_rust(path) && first.starts_with("pub"))?;
    // `pub(in path)` has a space.
    let rest = rest.split_once(") ").map_or(rest, |(_, rest)| rest);
    let (kind, rest) = rest.split_once(' ')?;
    let is_type = ["struct", "enum", "trait", "type"].contains(&kind);
    let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    is_type.then(|| (own.to_owned(), name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_count_exactly_their_violations() {
        let wide = format!("    /// {}", "x".repeat(COLUMNS));
        assert_eq!(
            [wide_comment("a.rs", &wide), wide_comment("a.md", &wide), wide_comment("a.rs", "/// x")],
            [1, 0, 0]
        );
        assert_eq!(noun_clauses("src/a.rs", "let what = is; // What it is, and what has none."), 2);
        assert_eq!(noun_clauses("tests/a.rs", "// so many points, as many as"), 1);
        assert_eq!(noun_clauses("tests/a.txt", "// what is"), 0);
        assert_eq!(noun_clauses("docs/a.md", "Whatever is here, what follows"), 0);
        assert_eq!(noun_later("src/a.rs", "    /// Of all samples the largest."), 1);
        assert_eq!(noun_later("src/a.rs", "    /// Largest of all samples. What follows."), 0);
        let named = |path: &str, line: &str| public_type(path, line).map(|(own, name)| format!("{own} {name}"));
        assert_eq!(named("crates/a/src/b.rs", "pub struct Part<'a> {"), Some("a Part".to_owned()));
        assert_eq!(named("src/b.rs", "pub(in crate::a) enum Part {"), Some("src Part".to_owned()));
        for line in ["struct Part;", "    pub struct Part;", "pub fn part() {}", "pub use a::Part;"] {
            assert_eq!(named("crates/a/src/b.rs", line), None, "{line}");
        }
        for (path, line, times) in [
            ("crates/a/src/b.rs", "    pub(super) const LEAST: f64 = 1e-3;", 1),
            ("src/b.rs", "const MOST: usize =", 1),
            ("crates/a/src/b.rs", "pub const MOST: usize = TUNING.most;", 0),
            ("crates/a/src/b.rs", "const NAME: &str = \"b\";", 0),
            ("crates/a/src/b.rs", "/// A const SIZE: usize = 3", 0),
            ("crates/a/tests/b.rs", "const MOST: usize = 3;", 0),
        ] {
            assert_eq!(numeric_constant(path, line), times, "{path}: {line}");
        }
        assert_eq!(tuple_parameter("a.rs", "    (low, high): (f64, f64),"), 1);
        assert_eq!(tuple_parameter("a.rs", "    let (low, high): (f64, f64) = ends;"), 0);
    }
}
