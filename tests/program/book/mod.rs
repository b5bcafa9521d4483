//! The book is correct: commands print what pages say, generated pages are current, and the examples can be assembled.
//!
//! `MBINT_UPDATE_DOCS=1 cargo test --test program book` writes the pages anew.

use std::path::{Path, PathBuf};
use std::process::Command;

use mbint::Model;

mod gallery;
mod instructions;
mod joints;
mod keys;
mod methods;
mod shown;

const BINARY: &str = env!("CARGO_BIN_EXE_mbint");

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Compares a page with its current text, or writes it.
pub(crate) fn expect_page(file: &Path, current: &str) {
    if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
        std::fs::write(file, current).unwrap();
    }
    let written = std::fs::read_to_string(file).unwrap_or_default();
    assert!(written == current, "{} is out of date; MBINT_UPDATE_DOCS=1 writes:\n{current}", file.display());
}

/// Texts between fences of a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fences = page.split("```").skip(1).step_by(2);
    fences.filter_map(|block| block.strip_prefix(language)?.strip_prefix('\n')).collect()
}

/// Pages of the book; decisions report past states, so that their figures are not those of today.
fn pages(folder: &Path, into: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() && !path.ends_with("decisions") {
            pages(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            into.push(path);
        }
    }
}

/// Figures of pages with commands that are no results: of definitions, of laws, and of other runs, which the pages call
/// others.
const NO_RESULTS: [(&str, &[&str]); 5] = [
    // Lengths that are mixed up.
    ("guides/check.md", &["150", "150"]),
    // An angle of rims, the number of pairs, and Hertz's duration.
    ("guides/contact.md", &["120°", "400", "144,", "2.94"]),
    // A year, and the remaining angles of a model that `tests/models/controllers.rs` compares with a closed form.
    ("guides/states.md", &["(2009),", "−1.79°", "1.93°", "−3.22°", "2.81°."]),
    ("guides/trajectories.md", &["(2008),"]),
    // Figures of an allocation's first lines, and a requested yield.
    ("tolerances.md", &["3293", "99.73"]),
];

#[test]
#[ignore = "runs all commands of the book; half a minute"]
#[cfg(unix)]
fn output_of_commands_matches_the_pages() {
    let mut files = Vec::new();
    pages(&docs(), &mut files);
    let mut with_commands = 0;
    let mut wrong = String::new();
    for file in files {
        let page = std::fs::read_to_string(&file).unwrap();
        if blocks(&page, "console").is_empty() {
            continue;
        }
        with_commands += 1;
        let folder = tempfile::tempdir().unwrap();
        if let Some(current) = shown::current(&page, folder.path()) {
            if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
                std::fs::write(&file, &current).unwrap();
            }
            wrong += &format!("{} is out of date; MBINT_UPDATE_DOCS=1 writes:\n{current}\n", file.display());
        }
        let name = file.strip_prefix(docs()).unwrap().to_str().unwrap();
        let known = NO_RESULTS.iter().find(|(page, _)| *page == name).map_or(&[][..], |(_, known)| known);
        let unfounded: Vec<String> =
            shown::unfounded(&page).into_iter().filter(|word| !known.contains(&word.as_str())).collect();
        if !unfounded.is_empty() {
            wrong += &format!("{}: no command of the page prints {unfounded:?}\n", file.display());
        }
    }
    assert!(with_commands >= 12, "only {with_commands} pages have commands");
    assert!(wrong.is_empty(), "{wrong}");
}

/// Blocks with `model:` and `outputs:` have a button that runs them (`docs/run.js`), but for those that show a mistake;
/// they name files as the examples do.
#[test]
fn models_of_pages_with_a_button_can_be_read() {
    let mut files = Vec::new();
    pages(&docs(), &mut files);
    let name = docs().join("examples/example.yaml");
    let mut count = 0;
    for file in files {
        let page = std::fs::read_to_string(&file).unwrap();
        let is_mistaken = |text: &str| text.contains("# E") || text.contains("# W");
        let has = |text: &str, key: &str| text.lines().any(|line| line.starts_with(key));
        let has_button = |text: &&str| has(text, "model:") && has(text, "outputs:") && !is_mistaken(text);
        for text in blocks(&page, "yaml").into_iter().filter(has_button) {
            let model = Model::from_yaml_str(name.to_str().unwrap(), text);
            assert!(model.is_ok(), "{}: {model:?}", file.display());
            count += 1;
        }
    }
    assert!(count > 15, "only {count} models");
}

#[test]
fn page_of_methods_matches_the_registry() {
    let methods = Command::new(BINARY).args(["explain", "--methods", "--format", "json"]).output().unwrap().stdout;
    expect_page(&docs().join("reference/methods.md"), &methods::page(std::str::from_utf8(&methods).unwrap()));
}

#[test]
fn page_of_keys_matches_the_schema() {
    let schema = Command::new(BINARY).arg("schema").output().unwrap().stdout;
    expect_page(&docs().join("reference/keys.md"), &keys::page(std::str::from_utf8(&schema).unwrap()));
}

#[test]
fn page_of_joints_matches_their_files() {
    expect_page(&docs().join("reference/joints.md"), &joints::page());
}

#[test]
fn the_examples_can_be_assembled() {
    let files: Vec<PathBuf> =
        std::fs::read_dir(docs().join("examples")).unwrap().map(|entry| entry.unwrap().path()).collect();
    let files: Vec<PathBuf> = files.into_iter().filter(|file| file.is_file()).collect();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let model = Model::from_yaml_str(&file.display().to_string(), &text).unwrap_or_else(|error| panic!("{error}"));
        model.check().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }
}

#[test]
fn every_decision_is_in_the_index_and_in_the_book_once() {
    let (folder, summary) = (docs().join("decisions"), std::fs::read_to_string(docs().join("SUMMARY.md")).unwrap());
    let index = std::fs::read_to_string(folder.join("index.md")).unwrap();
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let row = format!("| [{}]({name}) |", &name[..4]);
        assert!(name == "index.md" || index.matches(&row).count() == 1, "{name} in the index");
        assert_eq!(summary.matches(&format!("(decisions/{name})")).count(), 1, "{name} in the book");
    }
}

#[test]
fn lists_of_the_language_match_the_program() {
    for page in ["units", "functions", "outputs", "tuning", "exit-codes"] {
        let list = format!("--{page}");
        let printed = Command::new(BINARY).args(["explain", &list, "--page"]).output().unwrap().stdout;
        expect_page(&docs().join(format!("reference/{page}.md")), std::str::from_utf8(&printed).unwrap());
    }
}
