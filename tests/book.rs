//! What the book shows is so: the tutorial's commands print what the page says, and models of the book can be assembled.
//!
//! `MBINT_UPDATE_DOCS=1 cargo test --test book` writes the output of the tutorial's commands into the page.

use std::path::{Path, PathBuf};
use std::process::Command;

use mbint::{model, study};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Texts between fences of a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fences = page.split("```").skip(1).step_by(2);
    fences.filter_map(|block| block.strip_prefix(language)?.strip_prefix('\n')).collect()
}

/// The commands of a console block, each after `$ `, with what they print.
fn run_commands(block: &str, folder: &Path) -> String {
    let binary = Path::new(env!("CARGO_BIN_EXE_mbint")).parent().unwrap();
    let path = format!("{}:{}", binary.display(), std::env::var("PATH").unwrap());
    let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
    commands
        .map(|command| {
            let shell = format!("{{ {command}\n}} 2>&1");
            let output =
                Command::new("sh").arg("-c").arg(shell).current_dir(folder).env("PATH", &path).output().unwrap();
            format!("$ {command}\n{}", String::from_utf8(output.stdout).unwrap())
        })
        .collect()
}

/// The text without seconds, which are the only numbers of three decimals at the end of a line.
fn without_seconds(text: &str) -> Vec<String> {
    let is_seconds = |word: &str| word.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 3);
    let line = |line: &str| match line.rsplit_once(' ') {
        Some((rest, last)) if is_seconds(last) => rest.trim_end().to_owned(),
        _ => line.trim_end().to_owned(),
    };
    text.lines().map(line).collect()
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
    if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
        std::fs::write(&file, &current).unwrap();
    } else {
        assert!(current == page, "the tutorial should be\n{current}");
    }
}

#[test]
fn the_examples_of_the_book_can_be_assembled() {
    let mut count = 0;
    for entry in std::fs::read_dir(docs().join("examples")).unwrap() {
        let file = entry.unwrap().path();
        let text = std::fs::read_to_string(&file).unwrap();
        let description =
            model::load_str(&file.display().to_string(), &text, &[]).unwrap_or_else(|e| panic!("{}", e.render(false)));
        study::prepare(&description).unwrap();
        count += 1;
    }
    assert!(count > 0);
}
