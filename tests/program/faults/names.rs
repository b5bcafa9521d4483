//! File names that no one would choose.

#![cfg(target_os = "linux")]

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::process::Command;

use crate::place::Place;

#[test]
fn files_and_folders_may_have_any_name() {
    let place = Place::new();
    place.model("crank");
    let names: [&[u8]; 6] = [b"w\xff \xfe.yaml", b"-x.yaml", "θ₁ ±.yaml".as_bytes(), b"a b'c\"d", b"$(x);&", b".yaml"];
    for name in names {
        let name = OsStr::from_bytes(name);
        fs::copy(place.path().join("crank.yaml"), place.path().join(name)).unwrap();
        let folder = OsStr::from_bytes(b"out \xff\xfe");
        let mut command = place.command("run -q -m scan -o");
        let done = command.arg(folder).arg("--").arg(name).output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{name:?}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(place.path().join(folder).join("summary.json").exists());
        fs::remove_dir_all(place.path().join(folder)).unwrap();
    }
}

/// A model without a name of its own is called like its file, and so is its folder.
#[test]
fn name_from_the_file_stays_within_the_results() {
    let place = Place::new();
    place.model("crank");
    let text = fs::read_to_string(place.path().join("crank.yaml")).unwrap().replace("\nmodel: crank\n", "\n");
    fs::create_dir(place.path().join("in")).unwrap();
    fs::write(place.path().join("in/..\u{202e}\n x.yaml"), text).unwrap();
    let done = place.command("run -q -m scan").arg("in/..\u{202e}\n x.yaml").output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(place.files(""), ["crank.yaml", "in", "results"]);
    assert_eq!(place.files("results").len(), 1);
}

/// Reports on a file keep to their lines, and send nothing to the terminal, whatever the name of the file.
#[test]
fn control_characters_of_a_name_are_not_shown() {
    let place = Place::new();
    let name = "a\n\u{1b}[31m.yaml";
    fs::write(place.path().join(name), "model: [").unwrap();
    for command in ["check", "run", "explain", "check --format json"] {
        let done = place.command(command).arg(name).output().unwrap();
        assert_eq!(done.status.code(), Some(2));
        let report = [done.stdout, done.stderr].concat();
        assert!(!report.contains(&0x1b), "{command}: {}", String::from_utf8_lossy(&report));
    }
}

/// Control characters of an argument are not shown in a message about the command line.
#[test]
fn control_characters_of_arguments_are_not_shown() {
    let place = Place::new();
    let (flag, value) = ("--\u{202e}x\u{1b}[31m\u{2066}", "\u{202e}x\u{1b}[31m\u{2066}");
    let commands: [&[&str]; 4] =
        [&["run", flag], &[flag], &["run", "a.yaml", "-j", value], &["check", "a.yaml", "--format", value]];
    for command in commands {
        for color in ["never", "always"] {
            let done = place.command("").args(command).args(["--color", color]).output().unwrap();
            assert_eq!(done.status.code(), Some(2), "{command:?}");
            let report = String::from_utf8([done.stdout, done.stderr].concat()).unwrap();
            assert!(report.contains('\u{fffd}'), "{report}");
            assert!(!report.contains(['\u{202e}', '\u{2066}']) && !report.contains("x\u{1b}[31m"), "{report}");
        }
    }
}

/// A model's own files are files; the model itself may come from a pipe.
#[test]
fn pipes_named_by_a_model_are_refused() {
    let place = Place::new();
    place.model("crank");
    let text = fs::read_to_string(place.path().join("crank.yaml")).unwrap();
    assert!(Command::new("mkfifo").arg(place.path().join("pipe")).status().unwrap().success());
    for key in ["include: pipe\n", "tables: { q: { file: pipe } }\n"] {
        fs::write(place.path().join("crank.yaml"), format!("{key}{text}")).unwrap();
        let (_, errors) = place.run("check crank.yaml", 2);
        assert!(errors.contains("this is a pipe or a device, not a file"), "{errors}");
    }
    let mut command = Command::new("bash");
    command.args(["-c", "\"$MBINT\" check <(cat given.yaml)"]).current_dir(place.path());
    fs::write(place.path().join("given.yaml"), text).unwrap();
    let done = command.env("MBINT", assert_cmd::cargo::cargo_bin!("mbint")).output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
}
