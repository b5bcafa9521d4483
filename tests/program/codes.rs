//! Codes of messages: every code has a page whose example gives it and whose cure does not; codes keep their numbers;
//! the book has the pages.
//!
//! A page's block `yaml` is a model, or sections that stand instead of those of `codes::MODEL`; `xml` is a robot; with
//! a name behind it, a block is a file next to the model; `sh` has commands. The location of the mistake is marked by
//! the code in a comment.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use mbint::Model;
use mbint::inner::syntax::{Code, MODEL};
use rayon::prelude::*;

use crate::book::expect_page;
use crate::place::{Place, diagnostics_of};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Texts of top-level sections by their keys, in their order.
fn sections(text: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for line in text.lines() {
        match line.split_once(':').filter(|(key, _)| !key.starts_with([' ', '#', '-'])) {
            Some((key, _)) => found.push((key.to_owned(), format!("{line}\n"))),
            None => found.last_mut().into_iter().for_each(|(_, text)| *text += &format!("{line}\n")),
        }
    }
    found
}

/// The whole model of a block.
fn whole(block: &str) -> String {
    let own = sections(block);
    if block.starts_with("# whole model") {
        return block.to_owned();
    }
    let is_kept = |(key, _): &(String, String)| own.iter().all(|(known, _)| known != key);
    let kept = sections(MODEL).into_iter().filter(is_kept);
    let texts = kept.chain(own.clone()).map(|(_, text)| text);
    // A text that is no mapping of sections is wrong as a whole.
    if own.is_empty() { block.to_owned() } else { texts.collect() }
}

/// A part of a page laid out in a folder.
struct Tried {
    folder: tempfile::TempDir,
    /// The model or the robot.
    main: PathBuf,
    commands: Vec<String>,
}

impl Tried {
    fn of(part: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::write(place("model.yaml"), MODEL).unwrap();
        fs::copy(root().join("tests/bad_models/spring.fmu"), place("spring.fmu")).unwrap();
        let (mut main, mut commands) = (place("model.yaml"), Vec::new());
        for block in part.split("```").skip(1).step_by(2) {
            let (language, text) = block.split_once('\n').unwrap();
            match language.split_once(' ') {
                Some((_, name)) => fs::write(place(name), text).unwrap(),
                None if language == "yaml" => fs::write(&main, whole(text)).unwrap(),
                None if language == "xml" => {
                    main = place(if text.contains("<mujoco") { "robot.xml" } else { "robot.urdf" });
                    fs::write(&main, text).unwrap();
                }
                None if language == "sh" => commands.extend(text.lines().map(str::to_owned)),
                None => panic!("{language} is no block of an example"),
            }
        }
        Self { folder, main, commands }
    }

    /// Codes with their lines, 0 if there is no line; and the text of all messages.
    fn read(&self) -> (Vec<(Code, usize)>, String) {
        let diagnostics = diagnostics_of(Model::from_file(&self.main));
        let found = diagnostics.records().iter().map(|record| (record.code, record.line.unwrap_or(0))).collect();
        (found, diagnostics.render(false))
    }

    /// Whether the last command succeeded, if only in part; and the text of all messages.
    fn run(&self) -> (bool, String) {
        let binary = Path::new(env!("CARGO_BIN_EXE_mbint"));
        let path = format!("{}:{}", binary.parent().unwrap().display(), std::env::var("PATH").unwrap());
        let (mut said, mut is_done) = (String::new(), false);
        for command in &self.commands {
            let mut shell = Command::new("sh");
            let output =
                shell.args(["-c", command]).current_dir(self.folder.path()).env("PATH", &path).output().unwrap();
            said += &format!("{command}\n{}", String::from_utf8_lossy(&output.stderr));
            is_done = matches!(output.status.code(), Some(0 | 3 | 4));
        }
        (is_done, said)
    }
}

/// Why the page of a code is wrong, if it is.
fn fault(code: Code) -> Option<String> {
    let page = code.page();
    let (example, cure) = page.split_once("## Example\n")?.1.split_once("## Cure\n")?;
    let (example, cure) = (Tried::of(example), Tried::of(cure));
    let shown = format!("[{code}]");
    if example.commands.is_empty() {
        let (found, said) = example.read();
        let mark = [format!("# {code}"), format!("<!-- {code}")];
        let text = fs::read_to_string(&example.main).unwrap();
        let marked: BTreeSet<usize> = (1..)
            .zip(text.lines())
            .filter(|(_, line)| mark.iter().any(|mark| line.contains(mark)))
            .map(|(n, _)| n)
            .collect();
        let is_there = |&(known, line): &(Code, usize)| known == code && (marked.is_empty() || marked.contains(&line));
        if !found.iter().any(is_there) {
            return Some(format!("{code}: the example does not give it at {marked:?}:\n{text}{said}"));
        }
    } else {
        let (_, said) = example.run();
        if !said.contains(&shown) {
            return Some(format!("{code}: the example does not give it:\n{said}"));
        }
    }
    let (is_done, said) = if cure.commands.is_empty() {
        let (found, said) = cure.read();
        (found.is_empty(), said)
    } else {
        cure.run()
    };
    (!is_done || said.contains(&shown)).then(|| format!("{code}: the cure is none:\n{said}"))
}

fn expect_right(codes: impl Iterator<Item = Code>) {
    let codes: Vec<Code> = codes.collect();
    let faults: Vec<String> = codes.into_par_iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn has_commands(code: &Code) -> bool {
    code.page().contains("```sh")
}

#[test]
fn every_page_has_its_parts() {
    for code in Code::ALL {
        let page = code.page();
        let parts: Vec<&str> = page.split("\n\n").collect();
        assert_eq!(parts[0], format!("# {code}: {}", code.title()));
        assert!(parts[3] == "## Example" && parts[4].starts_with("```"), "{page}");
        assert_eq!(page.matches("\n## Cure\n").count(), 1, "{page}");
    }
}

#[test]
fn read_examples_give_their_codes_and_cures_do_not() {
    expect_right(Code::ALL.iter().copied().filter(|code| !has_commands(code)));
}

#[test]
#[cfg(unix)]
fn run_examples_give_their_codes_and_cures_do_not() {
    expect_right(Code::ALL.iter().copied().filter(has_commands));
}

/// Letters of codes mean their severity; and the source gives every code.
#[test]
fn every_code_is_given_somewhere() {
    let mut sources = String::new();
    let mut folders: Vec<PathBuf> = ["crates", "src"].map(|folder| root().join(folder)).to_vec();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                sources += &fs::read_to_string(path).unwrap();
            }
        }
    }
    // Spaces differ where a call is broken into lines.
    let sources: String = sources.split_whitespace().collect();
    for code in Code::ALL {
        let given = sources.matches(&format!("Code::{code:?}")).count();
        let ways = ["Diagnostic::warning", "Warning::coded"].map(|way| format!("{way}(Code::{code:?},"));
        let warned: usize = ways.iter().map(|way| sources.matches(way).count()).sum();
        assert!(given > 0, "{code} is given nowhere");
        assert_eq!(warned, if code.id().starts_with('W') { given } else { 0 }, "{code} as a warning");
    }
}

/// `MBINT_UPDATE=1 cargo test --test program codes` adds new ones; none goes, and none changes its number.
#[test]
fn codes_keep_their_numbers() {
    let path = root().join("crates/language/src/syntax/codes/recorded.txt");
    let recorded = fs::read_to_string(&path).unwrap_or_default();
    let recorded: BTreeMap<&str, &str> = recorded.lines().filter_map(|line| line.split_once(' ')).collect();
    let now: Vec<(&str, String)> = Code::ALL.iter().map(|code| (code.id(), format!("{code:?}"))).collect();
    let all: BTreeMap<&str, &str> = now.iter().map(|(id, name)| (*id, name.as_str())).collect();
    assert_eq!(all.len(), Code::ALL.len(), "two codes have one number");
    for (id, name) in &recorded {
        assert_eq!(all.get(id), Some(name), "{id} was {name}");
    }
    if std::env::var_os("MBINT_UPDATE").is_some() {
        let lines: Vec<String> = all.iter().map(|(id, name)| format!("{id} {name}\n")).collect();
        fs::write(&path, lines.concat()).unwrap();
    } else {
        assert_eq!(recorded, all, "MBINT_UPDATE=1 records the new ones");
    }
}

#[test]
fn explain_prints_the_page_of_a_code() {
    let place = Place::new();
    for asked in ["E0401", "e0401"] {
        assert_eq!(place.run(&format!("explain {asked}"), 0).0, Code::UnknownName.page());
    }
    let data: serde_json::Value = serde_json::from_str(&place.run("explain E0401 --format json", 0).0).unwrap();
    assert_eq!((&data["code"], &data["title"]), (&"E0401".into(), &Code::UnknownName.title().into()));
    assert!(place.run("explain --codes", 0).0.contains("E0401  a name that stands for nothing\n"));
    let (_, errors) = place.run("explain E0499", 2);
    assert_eq!(
        errors,
        "error: there is no code `E0499`; those of its block are `E0401`, `E0402`, `E0403` and `E0404`\n"
    );
    let (_, errors) = place.run("explain E9901", 2);
    assert!(errors.contains("there is no code `E9901`"), "{errors}");
    // A file of that name is a model.
    fs::write(place.path().join("E0401"), MODEL).unwrap();
    assert!(place.run("explain E0401", 0).0.contains("degree of freedom"));
}

#[test]
fn a_failed_command_names_the_page_of_its_first_error() {
    let place = Place::new();
    fs::write(place.path().join("arm.yaml"), MODEL.replace("arm.A", "amr.A").replace("mass: 2 kg", "mass: 2 m"))
        .unwrap();
    let (_, errors) = place.run("check arm.yaml", 2);
    assert!(errors.starts_with("error[E0301]: ") && errors.contains("\nerror[E0401]: "), "{errors}");
    assert!(errors.ends_with("\nmore: mbint explain E0301\n"), "{errors}");
    let (output, errors) = place.run("check arm.yaml --format json", 2);
    let data: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!((errors.as_str(), &data[0]["diagnostics"][1]["code"]), ("", &"E0401".into()));
    fs::write(place.path().join("arm.yaml"), MODEL).unwrap();
    assert_eq!(place.run("check arm.yaml", 0).1, "");
}

#[test]
fn the_book_has_the_pages() {
    let docs = root().join("docs");
    expect_page(&docs.join("errors/index.md"), &Code::index());
    for code in Code::ALL {
        expect_page(&docs.join(format!("errors/{code}.md")), &code.page());
    }
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    let line = |code: &Code| format!("  - [{code}: {}](errors/{code}.md)\n", code.title());
    let wanted: String = Code::ALL.iter().map(line).collect();
    let is_own = |line: &&str| line.contains("](errors/") && !line.contains("errors/index.md");
    let (kept, head) = ("- [Codes of messages](errors/index.md)\n", summary.split_inclusive('\n'));
    let others: String = head.filter(|line| !is_own(line)).collect();
    expect_page(&docs.join("SUMMARY.md"), &others.replacen(kept, &format!("{kept}{wanted}"), 1));
}
