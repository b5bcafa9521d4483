//! Every effect and joint against closed forms, balances of power and published results: a file an element, called by
//! its keyword.
//!
//! A new file is found by itself.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

#[path = "../common/mod.rs"]
#[allow(dead_code, reason = "shared with the tests of models")]
mod common;

automod::dir!("tests/elements");

use std::collections::BTreeSet;
use std::path::Path;

/// The files of this folder.
fn files() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/elements");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).filter(|name| name != "main").collect()
}

/// The keywords of a kind of element, by the committed schema; `repeat` is no element, but says how often one is there.
fn keywords(kind: &str) -> Vec<String> {
    let schema: serde_json::Value = serde_json::from_str(include_str!("../../schemas/mbint.schema.json")).unwrap();
    let keywords = schema["$defs"][kind]["properties"].as_object().unwrap();
    keywords.keys().filter(|keyword| *keyword != "repeat").cloned().collect()
}

#[test]
fn every_element_has_its_tests() {
    let files = files();
    let keywords = ["Effect", "Joint"].map(keywords).concat();
    let missing: Vec<_> = keywords.iter().filter(|keyword| !files.contains(*keyword)).collect();
    assert!(missing.is_empty(), "no tests/elements/KEYWORD.rs of {missing:?}");
}

/// A build that is older than a file of this folder would pass without its tests.
#[test]
fn every_file_is_part_of_the_build() {
    let tests = std::process::Command::new(std::env::current_exe().unwrap()).arg("--list").output().unwrap();
    let tests = String::from_utf8(tests.stdout).unwrap();
    for file in files() {
        let is_its = |line: &str| line.split("::").next() == Some(&file);
        assert!(tests.lines().any(is_its), "no test of {file}.rs is in this build: touch tests/elements/main.rs");
    }
}
