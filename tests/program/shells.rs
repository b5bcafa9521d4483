//! Completions in the shells themselves, and manual pages.

use std::fs;
use std::process::{Command, Stdio};

use super::place::Place;

/// Output of a shell for a script; `None`, and a line that says so, if it is not installed. The gate has all of them.
fn shell(name: &str, arguments: &[&str], script: &str) -> Option<String> {
    if Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err() {
        assert!(std::env::var_os("CI").is_none(), "{name} is not installed");
        eprintln!("ignored: {name} is not installed");
        return None;
    }
    let output = Command::new(name).args(arguments).arg(script).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && errors.is_empty(), "{name}: {errors}");
    Some(String::from_utf8(output.stdout).unwrap())
}

/// A place with the completions of a shell, and the path of their file.
fn completions(shell: &str) -> (Place, String) {
    let place = Place::new();
    let (script, _) = place.run(&format!("completions {shell}"), 0);
    let path = place.path().join("_mbint");
    fs::write(&path, script).unwrap();
    let path = path.display().to_string();
    (place, path)
}

#[test]
fn bash_completes() {
    let (_place, path) = completions("bash");
    let complete = |words: &str, current: &str, before: &str| {
        let count = words.split(' ').count() - 1;
        format!(
            "source {path}; COMP_WORDS=({words}); COMP_CWORD={count}; _mbint mbint '{current}' {before}; echo \"${{COMPREPLY[@]}}\""
        )
    };
    let Some(commands) = shell("bash", &["--norc", "-c"], &complete("mbint sn", "sn", "mbint")) else { return };
    assert_eq!(commands, "snapshot\n");
    let options = shell("bash", &["--norc", "-c"], &complete("mbint snapshot --ch", "--ch", "snapshot")).unwrap();
    assert_eq!(options, "--check\n");
}

#[test]
fn zsh_completes() {
    let (place, path) = completions("zsh");
    // A terminal of its own, in which the tabulator is pressed.
    let script = format!(
        "zmodload zsh/zpty; zpty shell 'cd {}; PS1= TERM=dumb zsh -f -i'; \
         zpty -w shell 'autoload -U compinit; compinit -u -D; source {path}; echo rea\"\"dy'; \
         zpty -r -m shell text '*ready*'; zpty -w -n shell $'mbint snap\\t'; zpty -r -m shell text '*snapshot*'; print -r -- completed; zpty -d shell",
        place.path().display()
    );
    let Some(text) = shell("zsh", &["-f", "-c"], &format!("TMOUT=0; {script}")) else { return };
    assert!(text.contains("completed"), "{text}");
}

#[test]
fn fish_completes() {
    let (place, path) = completions("fish");
    let home = place.path().display();
    let script = |line: &str| format!("set -x HOME {home}; source {path}; complete -C '{line}'");
    let Some(commands) = shell("fish", &["--no-config", "-c"], &script("mbint sn")) else { return };
    assert!(commands.starts_with("snapshot\t"), "{commands}");
    let options = shell("fish", &["--no-config", "-c"], &script("mbint snapshot --ch")).unwrap();
    assert!(options.starts_with("--check\t"), "{options}");
}

#[test]
fn every_command_has_a_manual_page() {
    let place = Place::new();
    let (written, _) = place.run("man --output pages", 0);
    let files = place.files("pages");
    for name in ["mbint.1", "mbint-run.1", "mbint-snapshot.1", "mbint-man.1"] {
        assert!(files.iter().any(|file| file == name) && written.contains(name), "{name}: {files:?}");
    }
    let (page, _) = place.run("man run", 0);
    assert_eq!(page, fs::read_to_string(place.path().join("pages/mbint-run.1")).unwrap());
    for text in [".TH mbint-run 1", "\\-\\-skip\\-infeasible", "bounds.csv"] {
        assert!(page.contains(text), "{text} in\n{page}");
    }
    assert!(place.run("man", 0).0.contains("Exit codes"));
    let (_, errors) = place.run("man rum", 2);
    assert!(errors.contains("there is no command `rum`"), "{errors}");
}
