//! `mbint show`: where bodies are, against geometry by hand, and pictures that can be read.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::place::Place;

const SLIDER_CRANK: &str = "\
model: press
parameters:
  crank: { value: 0.3, unit: m, tolerance: 1% }
  rod: { value: 0.5, unit: m }
bodies:
  wheel: { mass: 1, inertia: 0.01, points: { A: [0, 0], B: [crank, 0] } }
  link: { mass: 1, inertia: 0.01, points: { B: [0, 0], C: [rod, 0] } }
  block: { mass: 1, inertia: 0.01 }
joints:
  pivot: { revolute: [ground, wheel.A] }
  pin: { revolute: [wheel.B, link.B] }
  wrist: { revolute: [link.C, block] }
  guide: { prismatic: { between: [ground, block], axis: x } }
  drive: { motor: { on: pivot, speed: 1, from: 90 deg } }
effects:
  spring: { spring_damper: { between: [ground, block], stiffness: 10 } }
  weight: { gravity: { acceleration: [0, -9.81] } }
guess: { wheel.angle: 90 deg, block.x: 0.4 }
outputs: { x: block.x }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.1 }
";

fn shown(place: &Place, name: &str, text: &str) -> (Value, String) {
    fs::write(place.path().join(format!("{name}.yaml")), text).unwrap();
    let (json, _) = place.run(&format!("show {name}.yaml --format json -o out"), 0);
    let picture = fs::read_to_string(place.path().join("out/mechanism.svg")).unwrap();
    (serde_json::from_str(&json).unwrap(), picture)
}

#[track_caller]
fn assert_near(value: &Value, expected: &[f64]) {
    let values: Vec<f64> = value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
    let distance = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(values.len() == expected.len() && distance < 1e-9, "{values:?} instead of {expected:?}");
}

fn named<'v>(list: &'v Value, name: &str) -> &'v Value {
    list.as_array().unwrap().iter().find(|value| value["name"] == name).unwrap()
}

/// The picture as XML: numbers are numbers, and every part has a title.
#[track_caller]
fn titles(picture: &str) -> BTreeSet<String> {
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
    let document = roxmltree::Document::parse(picture).unwrap();
    let titles = document.descendants().filter(|node| node.has_tag_name("title"));
    titles.map(|node| node.text().unwrap().to_owned()).collect()
}

#[test]
fn positions_of_bodies_match_geometry() {
    let place = Place::new();
    let (drawing, picture) = shown(&place, "press", SLIDER_CRANK);
    // The crank points up: 0.3, 0.4 and 0.5 m are a right triangle.
    let bodies = &drawing["bodies"];
    assert_near(&named(bodies, "link")["position"], &[0.0, 0.3, 0.0]);
    assert_near(&named(bodies, "block")["position"], &[0.4, 0.0, 0.0]);
    assert_near(&named(&named(bodies, "link")["points"], "C")["position"], &[0.4, 0.0, 0.0]);
    assert!((named(bodies, "link")["angle"].as_f64().unwrap() + 0.75_f64.atan()).abs() < 1e-9);
    let guide = named(&drawing["elements"], "guide");
    assert_eq!((&guide["glyph"], &guide["bodies"]), (&Value::from("slider"), &serde_json::json!([0, 3])));
    assert_near(&guide["axis"], &[1.0, 0.0, 0.0]);
    // The motor stands at the joint that it drives.
    assert_near(&named(&drawing["elements"], "drive")["ends"][0], &[0.0, 0.0, 0.0]);
    assert_near(&drawing["gravity"], &[0.0, -9.81, 0.0]);
    let lengths = drawing["lengths"].as_array().unwrap();
    assert_eq!(lengths.len(), 1);
    assert_eq!(lengths[0]["parameter"], "crank");
    assert_near(&lengths[0]["between"][1], &[0.0, 0.3, 0.0]);

    let titles = titles(&picture);
    for part in
        ["wheel", "link", "block", "pivot: revolute", "guide: prismatic", "drive: motor", "spring: spring_damper"]
    {
        assert!(titles.contains(part), "{part} is not in {titles:?}");
    }
    assert!(picture.contains("crank = 0.3 m ± 0.003 m") && picture.contains("50 mm"));

    let (text, _) = place.run("show press.yaml -o out", 0);
    let row = text.lines().find(|line| line.trim_start().starts_with("block ")).unwrap();
    assert_eq!(row.split_whitespace().nth(1), Some("0.400000"), "{text}");
    assert!(text.trim_end().ends_with("mechanism.svg"), "{text}");
    // Values of `--set` are shown: a crank of 0.4 m leaves 0.3 m to the block.
    let (json, _) = place.run("show press.yaml --set crank=0.4 --format json -o out", 0);
    let drawing: Value = serde_json::from_str(&json).unwrap();
    assert_near(&named(&drawing["bodies"], "block")["position"], &[0.3, 0.0, 0.0]);
    assert_eq!(drawing["lengths"], serde_json::json!([]));
}

/// A frame at a point turns the joint's axis with it.
#[test]
fn axes_turn_with_their_frames() {
    let place = Place::new();
    let text = "\
model: gate
bodies:
  ground: { points: { post: { position: [1, 2, 3], rotation: { rpy: [90 deg, 0, 0] } } } }
  gate:
    mass: 1
    inertia: 0.01
    points: { hinge: { rotation: { rpy: [90 deg, 0, 0] } }, tip: [0, 0, 0.5] }
joints:
  hinge: { revolute: { between: [ground.post, gate.hinge], axis: z } }
outputs: { angle: hinge.angle }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.1 }
";
    let (drawing, picture) = shown(&place, "gate", text);
    let hinge = named(&drawing["elements"], "hinge");
    // z of a frame that is turned by a quarter about x is −y of the ground.
    assert_near(&hinge["axis"], &[0.0, -1.0, 0.0]);
    assert_near(&hinge["ends"][1], &[1.0, 2.0, 3.0]);
    let gate = named(&drawing["bodies"], "gate");
    assert_near(&named(&gate["points"], "tip")["position"], &[1.0, 2.0, 3.5]);
    assert_near(&gate["orientation"], &[1.0, 0.0, 0.0, 0.0]);
    assert!(picture.contains("three-quarter view") && picture.matches("hinge: revolute").count() == 4);
}

#[test]
#[ignore = "2 s"]
fn every_shipped_model_can_be_shown() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let place = Place::new();
    for entry in fs::read_dir(models).unwrap() {
        let path = entry.unwrap().path();
        if !path.extension().is_some_and(|extension| extension == "yaml" || extension == "urdf") {
            continue;
        }
        let (json, _) = place.run(&format!("show {} --format json -o out", path.display()), 0);
        let drawing: Value = serde_json::from_str(&json).unwrap();
        let titles = titles(&fs::read_to_string(place.path().join("out/mechanism.svg")).unwrap());
        for body in &drawing["bodies"].as_array().unwrap()[1..] {
            assert!(titles.contains(body["name"].as_str().unwrap()), "{}: {body}", path.display());
        }
    }
}
