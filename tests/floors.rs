//! The stages' order: imports never run back.

use std::fs;
use std::path::{Path, PathBuf};

/// Each stage stands on those before it, and knows none after it.
const FLOORS: [&str; 15] = [
    "syntax",
    "grammar",
    "multibody",
    "numerics",
    "methods",
    "elements",
    "model",
    "reduce",
    "assemble",
    "compile",
    "simulate",
    "results",
    "export",
    "study",
    "cli",
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let files = files.into_iter().filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    folders.iter().flat_map(|folder| rust_files(folder)).chain(files).collect()
}

#[test]
fn imports_never_run_back() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in fs::read_dir(&source).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let known = FLOORS.contains(&name.as_str()) || ["lib.rs", "main.rs"].contains(&name.as_str());
        assert!(known, "which floor is {name} on?");
    }
    for (floor, name) in FLOORS.iter().enumerate() {
        for path in rust_files(&source.join(name)) {
            let text = fs::read_to_string(&path).unwrap();
            for (line, text) in text.lines().enumerate() {
                let back = FLOORS[floor + 1..].iter().find(|later| text.contains(&format!("crate::{later}")));
                assert_eq!(back, None, "{}:{}: {text}", path.display(), line + 1);
            }
        }
    }
}
