//! Contents of a folder of results after a run: its files, nothing that an older run left, and never half of a run in
//! place of a whole.

#![cfg(unix)]

use std::fs;

use super::interrupts::interrupted;
use crate::place::Place;

#[test]
fn only_files_of_an_older_run_are_removed() {
    let place = Place::new();
    place.model("crank");
    place.run("run -q crank.yaml -o out", 0);
    let before = place.files("out");
    assert!(before.contains(&"force.svg".to_owned()), "{before:?}");
    fs::write(place.path().join("out/notes.txt"), "mine").unwrap();
    fs::write(place.path().join("out/.mbint-Killed.tmp"), "half").unwrap();
    let path = place.path().join("crank.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let fewer: String =
        text.lines().filter(|line| !line.trim_start().starts_with("force:")).map(|line| format!("{line}\n")).collect();
    assert_ne!(text, fewer);
    fs::write(&path, fewer).unwrap();
    place.run("run -q crank.yaml -o out", 0);
    let mut expected: Vec<String> = before.into_iter().filter(|name| !name.starts_with("force.")).collect();
    expected.push("notes.txt".to_owned());
    expected.sort();
    assert_eq!(place.files("out"), expected);
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let mut owned: Vec<&str> = summary["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    owned.push("notes.txt");
    owned.sort_unstable();
    assert_eq!(owned, expected);
}

#[test]
#[ignore = "5 s"]
fn an_interrupted_run_does_not_replace_a_complete_one() {
    let place = Place::new();
    place.model("crank");
    place.run("run -q crank.yaml -o out", 0);
    let whole = fs::read(place.path().join("out/bounds.csv")).unwrap();
    let path = place.path().join("crank.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let slow = text.replace("duration: 0.1, step: 1e-3", "duration: 4, step: 1e-4").replace("points: 3", "points: 200");
    assert_ne!(text, slow);
    fs::write(&path, slow).unwrap();
    let (status, errors) = interrupted(&place, "run --yes crank.yaml -o out", "crank: scan", "-HUP");
    assert_eq!(status, Some(130), "{errors}");
    assert!(errors.contains("interrupted") && errors.contains("out.interrupted"), "{errors}");
    assert!(fs::read(place.path().join("out/bounds.csv")).unwrap() == whole);
    let summary = fs::read_to_string(place.path().join("out.interrupted/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["interrupted"], serde_json::Value::Bool(true));
    // 200 × 200 samples were planned, and nobody waited for them.
    for method in summary["methods"].as_array().unwrap() {
        assert!(method["simulations"].as_u64().unwrap() < 20_000, "{method}");
    }
}

#[test]
fn full_standard_output_does_not_stop_later_models() {
    let Ok(full) = fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    let place = Place::new();
    place.model("one");
    place.model("two");
    let done = place.command("run one.yaml two.yaml -o out").stdout(full).output().unwrap();
    let errors = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{errors}");
    assert_eq!(errors.matches("cannot write to standard output").count(), 1, "{errors}");
    for name in ["one", "two"] {
        assert!(place.path().join("out").join(name).join("summary.json").exists(), "{name}");
    }
}
