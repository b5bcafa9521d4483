//! What the book shows is so: the tutorial's commands print what the page says, generated pages are current, and the examples can
//! be assembled.
//!
//! `MBINT_UPDATE_DOCS=1 cargo test --test program book` writes the pages anew.

use std::path::{Path, PathBuf};
use std::process::Command;

use mbint::inner::{model, study};

mod joints;
mod keys;
mod methods;

const BINARY: &str = env!("CARGO_BIN_EXE_mbint");

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Compares a page with what it should be, or writes it.
fn expect_page(file: &Path, current: &str) {
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

/// The commands of a console block, each after `$ `, with what they print.
fn run_commands(block: &str, folder: &Path) -> String {
    let path = format!("{}:{}", Path::new(BINARY).parent().unwrap().display(), std::env::var("PATH").unwrap());
    let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
    let print = |command: &str| {
        let shell = format!("{{ {command}\n}} 2>&1");
        let output = Command::new("sh").args(["-c", &shell]).current_dir(folder).env("PATH", &path).output().unwrap();
        format!("$ {command}\n{}", String::from_utf8(output.stdout).unwrap())
    };
    commands.map(print).collect()
}

/// Lines without seconds, which are the only numbers of three decimals at the end of a line.
fn without_seconds(text: &str) -> Vec<&str> {
    let is_seconds = |word: &str| word.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 3);
    let line = |line: &'_ str| match line.rsplit_once(' ') {
        Some((rest, last)) if is_seconds(last) => rest.trim_end().len(),
        _ => line.len(),
    };
    text.lines().map(|text| &text[..line(text)]).collect()
}

#[test]
#[cfg(unix)]
fn the_tutorials_commands_print_what_it_says() {
    let file = docs().join("tutorial.md");
    let page = std::fs::read_to_string(&file).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wiper.yaml"), blocks(&page, "yaml")[0]).unwrap();
    let mut current = page.clone();
    for block in blocks(&page, "console") {
        let printed = run_commands(block, folder.path());
        if without_seconds(&printed) != without_seconds(block) {
            current = current.replacen(block, &printed, 1);
        }
    }
    expect_page(&file, &current);
}

#[test]
fn the_page_of_methods_is_that_of_the_registry() {
    let methods = Command::new(BINARY).args(["explain", "--methods", "--format", "json"]).output().unwrap().stdout;
    expect_page(&docs().join("reference/methods.md"), &methods::page(std::str::from_utf8(&methods).unwrap()));
}

#[test]
fn the_page_of_keys_is_that_of_the_schema() {
    let schema = Command::new(BINARY).arg("schema").output().unwrap().stdout;
    expect_page(&docs().join("reference/keys.md"), &keys::page(std::str::from_utf8(&schema).unwrap()));
}

#[test]
fn the_page_of_joints_is_that_of_their_files() {
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
        let description =
            model::load_str(&file.display().to_string(), &text, &[]).unwrap_or_else(|e| panic!("{}", e.render(false)));
        study::prepare(&description).unwrap();
    }
}

#[test]
fn the_lists_of_the_language_are_those_of_the_program() {
    for page in ["units", "functions", "outputs", "exit-codes"] {
        let list = format!("--{page}");
        let printed = Command::new(BINARY).args(["explain", &list, "--page"]).output().unwrap().stdout;
        expect_page(&docs().join(format!("reference/{page}.md")), std::str::from_utf8(&printed).unwrap());
    }
}
