//! `mbint export --c`: what C computes is the nominal motion of `mbint run`.

use std::fs;
use std::process::Command;

use super::place::Place;

/// Shipped models: planar and spatial linkages, contacts, controllers, beams, cams, belts, redundant constraints and
/// reactions; with the largest difference that was measured, relative to the output's largest value.
const MODELS: [&str; 14] = [
    "pendulum",
    "slider_crank",
    "andrews",
    "belt",
    "braking_car",
    "bricard",
    "cam",
    "car_axis",
    "chain",
    "coin",
    "computed_torque",
    "crane",
    "delta_robot",
    "double_pendulum",
];

/// Columns of a table by name, in its order.
fn columns(text: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = text.lines();
    let mut columns: Vec<(String, Vec<f64>)> =
        lines.next().unwrap().split(',').map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for ((_, values), text) in columns.iter_mut().zip(line.split(',')) {
            values.push(text.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

#[test]
fn c_repeats_the_nominal_motion() {
    let place = Place::new();
    for name in MODELS {
        let model = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        place.run(&format!("export {model} --c -o {name}"), 0);
        let folder = place.path().join(name);
        let compiled = Command::new("gcc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-o", "motion"])
            .args([format!("{name}.c"), format!("{name}_main.c"), "-lm".to_owned()])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{name}: {}", String::from_utf8_lossy(&compiled.stderr));
        let found = Command::new(folder.join("motion")).output().unwrap();
        assert!(found.status.success(), "{name}: {}", String::from_utf8_lossy(&found.stderr));
        let found = columns(&String::from_utf8(found.stdout).unwrap());
        // A scan of the fewest points: only its nominal motion is looked at.
        place.run(&format!("run {model} --method chebyshev --yes --quiet -o {name}/run"), 0);
        let expected = columns(&fs::read_to_string(folder.join("run/bounds.csv")).unwrap());
        for (output, values) in &found[1..] {
            let (_, expected) = expected.iter().find(|(own, _)| *own == format!("{output}.nominal")).unwrap();
            assert_eq!(values.len(), expected.len(), "{name}: {output}");
            let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            let off = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-9 * size, "{name}: {output} is off by {off} of {size}");
        }
    }
}

#[test]
fn what_is_not_written_is_refused() {
    let place = Place::new();
    let ball = "bodies: { ball: { mass: 1, coordinates: [y] } }
effects: { weight: { force: { on: ball, value: [0, -9.81] } } }
initial: { ball.y: 0, ball.vy: 0 }
outputs: { y: ball.y }
";
    for (simulation, why) in [
        ("{ duration: 1, tolerance: 1e-6, scheme: hht }", "a tolerance chooses its steps; give a fixed `step`"),
        ("{ duration: 1, step: 1e-2, scheme: explicit }", "its steps are combined, explicit or cut at events"),
        ("{ duration: 1, step: 1e-2, extrapolation: 2 }", "its steps are combined, explicit or cut at events"),
    ] {
        fs::write(place.path().join("ball.yaml"), format!("{ball}simulation: {simulation}\n")).unwrap();
        let (_, message) = place.run("export ball.yaml --c", 2);
        assert!(message.contains(why), "{message}");
    }
    let (_, message) = place.run("export ball.yaml", 2);
    assert!(message.contains("--c"), "{message}");
}
