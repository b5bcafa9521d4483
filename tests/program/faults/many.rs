//! Very many questions: memory grows with their number, and a run that would not find room is refused before it begins.

#![cfg(unix)]

use std::fs;
use std::process::{Command, Output};

use crate::place::Place;

/// A mass that is pushed, with questions `asked` and settings `simulation` of its motion.
fn pushed(place: &Place, asked: &str, simulation: &str) {
    let text = format!(
        "model: pushed\n\
         parameters: {{ m: 1 kg ± 1%, c: 1 N*s/m ± 5% }}\n\
         bodies: {{ b: {{ mass: m, inertia: 1, coordinates: [x] }} }}\n\
         effects: {{ f: {{ force: {{ on: b, value: [1, 0] }} }}, air: {{ drag: {{ on: b, linear: c }} }} }}\n\
         {asked}\n\
         simulation: {{ {simulation} }}\n\
         bounds: {{ chebyshev: {{ order: 1 }} }}\n"
    );
    fs::write(place.path().join("pushed.yaml"), text).unwrap();
}

/// A run whose data may take `kilobytes` kilobytes. (A limit of addresses would count the program's size and the
/// reserve of the allocator for a thread: 64 MB each, at random.)
fn limited(place: &Place, kilobytes: u64) -> Output {
    let run =
        format!("ulimit -d {kilobytes} && exec \"$MBINT\" run -q --yes --no-report --threads 1 pushed.yaml -o out");
    let mut command = Command::new("sh");
    command.args(["-c", &run]).env("MBINT", assert_cmd::cargo::cargo_bin!("mbint")).current_dir(place.path());
    command.output().unwrap()
}

/// Every requirement is known at its own ends, not at those of all: 900 took 0.3 GB.
#[test]
fn memory_of_requirements_is_linear() {
    let place = Place::new();
    let limits: Vec<String> = (0..900).map(|n| format!("r{n}: {} < {} m", ["x", "2*x"][n % 2], n + 5)).collect();
    pushed(
        &place,
        &format!("outputs: {{ x: b.x }}\nrequirements: {{ {} }}", limits.join(", ")),
        "duration: 4e-3, step: 1e-3",
    );
    let done = limited(&place, 100_000);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    assert_eq!(summary.matches("\"holds\"").count(), 900);
}

/// Statistics hold the samples of few requirements at once: 50 took 168 MB, 100 took 297.
#[test]
#[ignore = "2 s"]
fn memory_of_statistics_does_not_grow_with_requirements() {
    let place = Place::new();
    let limits: Vec<String> = (0..50).map(|n| format!("r{n}: {} < {} m", ["x", "2*x"][n % 2], n + 5)).collect();
    pushed(
        &place,
        &format!("outputs: {{ x: b.x }}\nrequirements: {{ {} }}\nstatistics: {{}}", limits.join(", ")),
        "duration: 4e-3, step: 1e-3",
    );
    let done = limited(&place, 100_000);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    assert_eq!(summary.matches("\"ppm\": 0").count(), 51);
}

#[cfg(target_os = "linux")]
#[test]
fn run_without_enough_memory_is_refused_before_it_begins() {
    let place = Place::new();
    let outputs: Vec<String> = (0..300).map(|n| format!("o{n}: \"{}*b.x\"", n + 1)).collect();
    pushed(&place, &format!("outputs: {{ {} }}", outputs.join(", ")), "duration: 1000, step: 1e-3, output_step: 1e-3");
    let done = limited(&place, 8_000_000);
    let errors = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(2), "{errors}");
    assert!(
        errors.contains("bounds of 300 outputs in 1000001 rows take ") && errors.contains(" GB are free"),
        "{errors}"
    );
}
