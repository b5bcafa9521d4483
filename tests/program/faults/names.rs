//! File names that no one would choose.

#![cfg(target_os = "linux")]

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;

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
fn a_model_that_is_called_like_its_file_stays_in_its_folder() {
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

/// What is reported of a file keeps to its lines, and sends nothing to the terminal, whatever the file is called.
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
