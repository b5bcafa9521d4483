//! Certificates of `mbint run --certify`, and refusals by `mbint verify-certificate`.

use std::cell::Cell;
use std::fs;

use crate::measured::Case;
use crate::place::Place;

/// The pendulum of the library of benchmarks over a short time, with its length and an output that has a kink at the
/// start.
const PENDULUM: &str = "
model: pendulum
parameters: { length: 1 m ± 5 mm, g: 9.81 }
bodies: { bob: { mass: 1, coordinates: [x, y] } }
joints: { rod: { distance: { between: [ground, bob], length: length } } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { bob.y: 0, bob.vy: 0 }
guess: { bob.x: -1 }
outputs: { x: bob.x, y: bob.y, tension: rod.force }
simulation: { duration: 0.4, step: 0.01, output_step: 0.1 }
";

/// A place with the pendulum's certificate.
fn certified(text: &str) -> (Place, Vec<String>) {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), text).unwrap();
    place.run("run pendulum.yaml --certify --method certified -o out --no-report -q", 0);
    let text = fs::read_to_string(place.path().join("out/certificate.jsonl")).unwrap();
    let lines = text.lines().map(str::to_owned).collect();
    (place, lines)
}

/// The verdict on a certificate of these lines.
#[track_caller]
fn verified(place: &Place, lines: &[String], arguments: &str, status: i32) -> String {
    fs::write(place.path().join("changed.jsonl"), lines.join("\n")).unwrap();
    let (found, errors) = place.run(&format!("verify-certificate changed.jsonl {arguments}"), status);
    found + &errors
}

/// The number of the first line of a kind.
fn first(lines: &[String], kind: &str) -> usize {
    lines.iter().position(|line| line.starts_with(&format!("{{\"{kind}\""))).unwrap()
}

#[test]
fn certificates_are_proven_again_and_changed_ones_are_refused() {
    let (place, lines) = certified(PENDULUM);
    let found = verified(&place, &lines, "pendulum.yaml", 0);
    // Five rows of three outputs; at the start the tension is the size of a vanishing force.
    assert!(found.contains("pendulum: proven") && found.contains("15 bounds of outputs"), "{found}");
    let json = verified(&place, &lines, "--format json", 0);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((json["valid"].as_bool(), json["bounds"].as_u64()), (Some(true), Some(15)));

    let refused = Cell::new(0);
    let refuse = |lines: &[String], arguments: &str, status: i32| {
        refused.set(refused.get() + 1);
        verified(&place, lines, arguments, status)
    };
    let change = |at: usize, from: &str, to: &str| {
        let mut changed = lines.clone();
        assert!(changed[at].contains(from), "{} has no {from}", changed[at]);
        changed[at] = changed[at].replacen(from, to, 1);
        changed
    };
    let cell = first(&lines, "cell");
    let parsed: serde_json::Value = serde_json::from_str(&lines[cell]).unwrap();
    let own = &parsed["cell"];

    // A coefficient: the first of the first acceleration, by a millionth.
    let coefficient = own["w"][1].as_str().unwrap().split(' ').next().unwrap();
    let (mantissa, exponent) = coefficient.split_once('p').unwrap();
    let nearby = format!("{}000p{exponent}", &mantissa[..8]);
    let found = refuse(&change(cell, coefficient, &nearby), "", 4);
    assert!(
        found.contains("pendulum: refused") && found.contains("from its polynomials, and the radius is"),
        "{found}"
    );

    // A radius that is too small.
    let tube = own["tube"].as_str().unwrap().to_owned();
    let small = ["0x1p-80"; 4].join(" ");
    let found = refuse(&change(cell, &tube, &small), "", 4);
    assert!(found.contains("cell 1 from 0 s: position 0 may be"), "{found}");

    // A cell that is missing, between others and at the end.
    let mut changed = lines.clone();
    changed.remove(cell + 1);
    let found = refuse(&changed, "", 4);
    assert!(found.contains("cell 2 from") && found.contains("it begins at"), "{found}");
    let found = refuse(&lines[..lines.len() - 1], "", 4);
    assert!(found.contains("its cells end at") && found.contains("bounds are stated at 0.4 s"), "{found}");

    // A bound that is too narrow.
    let row = first(&lines, "row") + 2;
    let parsed: serde_json::Value = serde_json::from_str(&lines[row]).unwrap();
    let bound = parsed["row"]["bounds"][0].as_str().unwrap().to_owned();
    let upper = bound.split(' ').nth(1).unwrap();
    let found = refuse(&change(row, &bound, &format!("{upper} {upper}")), "", 4);
    assert!(found.contains("output x at 0.2 s is not proven to be between"), "{found}");

    // Parameters in no piece, and another position at the start.
    let piece = first(&lines, "piece");
    let parsed: serde_json::Value = serde_json::from_str(&lines[piece]).unwrap();
    let lower = parsed["piece"]["lower"].as_str().unwrap().to_owned();
    let found = refuse(&change(piece, &lower, "0x1p0"), "", 4);
    assert!(found.contains("do not cover the box"), "{found}");
    let start = parsed["piece"]["q"][0].as_str().unwrap().split(' ').next().unwrap().to_owned();
    let found = refuse(&change(piece, &start, "0x1p-4"), "", 4);
    assert!(found.contains("positions of the start"), "{found}");

    // Other equations prove something else: no model has them.
    let system = first(&lines, "system");
    let found = refuse(&change(system, "\"0x1.39eb851eb851fp3\"", "\"0x1.3p3\""), "", 4);
    assert!(found.contains("may be"), "{found}");
    let found = refuse(&change(system, "\"0x1p1\"", "\"0x1p2\""), "pendulum.yaml", 4);
    assert!(found.contains("the equations are not those of the model"), "{found}");

    // No certificate at all.
    let found = refuse(&change(cell, "0x1", "1"), "", 2);
    assert!(found.contains(&format!("line {}: `1", cell + 1)), "{found}");
    let found = refuse(&change(0, "\"version\":1", "\"version\":2"), "", 2);
    assert!(found.contains("line 1: version 2 is not known, 1 is"), "{found}");

    let case = Case::new("certified", "pendulum, certificate").source("`mbint verify-certificate`");
    case.figure("bounds proven again", 14.0).figure("changed certificates refused", f64::from(refused.get())).note();
}

#[test]
fn certificates_of_other_models_are_refused() {
    let (place, lines) = certified(PENDULUM);
    let other = PENDULUM.replace("g: 9.81", "g: 9.80");
    fs::write(place.path().join("pendulum.yaml"), &other).unwrap();
    let found = verified(&place, &lines, "pendulum.yaml", 4);
    assert!(found.contains("pendulum.yaml is not the one that was certified"), "{found}");
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    let found = verified(&place, &lines, "pendulum.yaml --set length=[0.99,1.01]", 4);
    assert!(found.contains("the box of the parameters is not that of the model"), "{found}");
    let found = verified(&place, &lines, "pendulum.yaml --set g=9.8", 4);
    assert!(found.contains("the equations are not those of the model"), "{found}");
}

/// The certificate has the tables' cubics: with others it does not hold, and it is not of the model.
#[test]
fn certificates_contain_tables() {
    let place = Place::new();
    let model = "
model: table
parameters: { k: { value: 3, tolerance: 1% } }
tables: { spring: { points: [[-1, -2], [0, 0], [0.3, 0.5], [0.8, 1.9]] } }
bodies: { mass: { mass: 1, coordinates: [x] } }
effects: { push: { force: { on: mass, value: [\"-k*spring(mass.x)\", 0] } } }
initial: { mass.x: 0.5, mass.vx: 0.2 }
outputs: { x: mass.x }
simulation: { duration: 0.4, step: 0.01, output_step: 0.1 }
";
    fs::write(place.path().join("table.yaml"), model).unwrap();
    place.run("run table.yaml --certify --method certified -o out --no-report -q", 0);
    let text = fs::read_to_string(place.path().join("out/certificate.jsonl")).unwrap();
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let found = verified(&place, &lines, "table.yaml", 0);
    assert!(found.contains("table: proven") && found.contains("its equations are those of the model"), "{found}");

    let system = first(&lines, "system");
    let parsed: serde_json::Value = serde_json::from_str(&lines[system]).unwrap();
    let cubic = parsed["system"]["tables"][0]["cubics"][3].as_str().unwrap().to_owned();
    let change = |to: &str| {
        let mut changed = lines.clone();
        changed[system] = changed[system].replacen(&cubic, to, 1);
        changed
    };
    let stiffer = format!("0x1p+3 {}", cubic.split_once(' ').unwrap().1);
    let found = verified(&place, &change(&stiffer), "", 4);
    assert!(found.contains("table: refused"), "{found}");
    let found = verified(&place, &change("0x1p+0"), "", 2);
    assert!(found.contains("a cubic has four numbers"), "{found}");
    let found = verified(&place, &change("0x1p+0 0x0p+0 0x0p+0 inf"), "", 2);
    assert!(found.contains("no hexadecimal float") || found.contains("a table has ascending knots"), "{found}");
}
