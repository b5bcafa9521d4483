//! `mbint plan`, `shard`, `status`, `merge` and `run --store`: whatever is cut, lost or damaged, the results are those of `mbint run`.

use std::fs;
use std::path::Path;

use super::place::Place;

/// A pendulum, alone and in a shorter scene; with a reduced output, an adaptive surrogate and a scan.
const PENDULUM: &str = "
model: pendulum
parameters:
  length: { value: 1, unit: m, tolerance: 5 mm }
  mass: { value: 1, unit: kg, tolerance: 1% }
bodies: { bob: { mass: mass, coordinates: [x, y] } }
joints: { rod: { distance: { between: [ground, bob], length: length } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bob.y: 0, bob.vy: 0 }
guess: { bob.x: -1 }
outputs: { x: bob.x, tension: rod.force, pull: { max: rod.force } }
simulation: { duration: 0.6 s, step: 5e-3, output_step: 2e-2 }
bounds: { tolerance: 1e-3, chebyshev: {}, scan: { points: 9 } }
scenes: { whole: {}, short: { simulation: { duration: 0.3 s } } }
";

/// Number of shards in a study's plan.
fn shards(place: &Place, study: &str) -> usize {
    let plan = fs::read_to_string(place.path().join(study).join("plan.json")).unwrap();
    serde_json::from_str::<serde_json::Value>(&plan).unwrap()["shards"].as_array().unwrap().len()
}

/// All files below a folder with their bytes, by path.
fn tree(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(tree(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.push((name, fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

/// Runs rounds of shards, the last first, until the study is merged.
fn finish(place: &Place, study: &str) -> usize {
    for round in 1..30 {
        for index in (0..shards(place, study)).rev() {
            place.run(&format!("shard {study} --index {index}"), 0);
        }
        assert_eq!(place.run(&format!("status {study} --missing"), 0).0, "\n");
        let plan = fs::read_to_string(place.path().join(study).join("plan.json")).unwrap();
        assert!(plan.contains(&format!("\"round\": {round},")), "{plan}");
        let merged = place.command(&format!("merge {study} -o {study}-results -q")).output().unwrap();
        match merged.status.code() {
            Some(0) => return round,
            Some(75) => assert!(String::from_utf8_lossy(&merged.stdout).starts_with("another round: ")),
            status => panic!("{status:?}: {}", String::from_utf8_lossy(&merged.stderr)),
        }
    }
    panic!("the study never ends");
}

#[test]
fn merged_shards_are_the_run() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("run pendulum.yaml -o direct -q", 0);
    let (output, _) = place.run("plan pendulum.yaml -o study --at-once 0", 0);
    assert!(output.contains("on the disk in study"), "{output}");
    assert!(finish(&place, "study") > 1);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));

    // What is short is simulated when planning and merging.
    place.run("plan pendulum.yaml -o small", 0);
    assert_eq!(shards(&place, "small"), 0);
    assert_eq!(finish(&place, "small"), 1);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("small-results")));
}

#[test]
fn what_is_missing_is_told() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("plan pendulum.yaml -o study --at-once 0", 0);
    let (output, _) = place.run("status study", 75);
    assert!(output.starts_with("round 1: of 2 shards, 0-1 are missing\n"), "{output}");
    let (_, errors) = place.run("merge study", 1);
    assert!(errors.contains("shards 0-1 are missing; run them first"), "{errors}");
    let (_, errors) = place.run("shard study --index 2", 2);
    assert!(errors.contains("there is no shard 2; there are: 0 to 1"), "{errors}");
    let (_, errors) = place.run("status nowhere", 1);
    assert!(errors.contains("plan.json"), "{errors}");

    // The model is not what it was.
    fs::write(place.path().join("pendulum.yaml"), PENDULUM.replace("value: 1,", "value: 1.1,")).unwrap();
    let (_, errors) = place.run("shard study --index 0", 1);
    assert!(errors.contains("the model is not what it was when the study was planned; plan it again"), "{errors}");
}

#[test]
fn a_run_goes_on_from_what_is_stored() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("run pendulum.yaml -o direct -q", 0);
    place.run("run pendulum.yaml -o first -q --store kept", 0);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("first")));
    let parts = place.path().join("kept/parts");
    let names = place.files("kept/parts");
    assert!(names.len() > 4, "{names:?}");

    // One part is lost, one is damaged, and of one there is half.
    fs::remove_file(parts.join(&names[0])).unwrap();
    let mut bytes = fs::read(parts.join(&names[1])).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(parts.join(&names[1]), &bytes).unwrap();
    let bytes = fs::read(parts.join(&names[2])).unwrap();
    fs::write(parts.join(&names[2]), &bytes[..bytes.len() / 2]).unwrap();
    let (output, _) = place.run("run pendulum.yaml -o second --store kept --scene whole", 0);
    assert!(output.contains("parts from kept, "), "{output}");
    place.run("run pendulum.yaml -o second -q --store kept", 0);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("second")));
    assert_eq!(place.files("kept/parts"), names);
}
