//! `mbint sample`: outputs at chosen points are those of closed forms, on one machine or on many.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::place::Place;

/// Two balls of 1 kg, each with a force of its own: y = −g t²/2. Trapezoidal steps are exact.
const FALL: &str = "
model: fall
parameters:
  g: { value: 9.81, unit: N, tolerance: 1% }
  k: { value: 2, unit: N, tolerance: 10% }
bodies: { near: { mass: 1, coordinates: [y] }, far: { mass: 1, coordinates: [y] } }
effects:
  weight: { force: { on: near, value: [0, -g] } }
  pull: { force: { on: far, value: [0, -k] } }
initial: { near.y: 0, near.vy: 0, far.y: 0, far.vy: 0 }
outputs: { near: near.y, far: far.y, speed: near.vy }
simulation: { duration: 1 s, step: 1e-2, output_step: 0.25 }
";

/// An array of an archive that is not compressed: its shape and its numbers.
fn array(path: &Path, name: &str) -> (Vec<usize>, Vec<f64>) {
    let bytes = fs::read(path).unwrap();
    let name = format!("{name}.npy");
    let at = bytes.windows(name.len()).position(|window| window == name.as_bytes()).unwrap();
    let magic = at + bytes[at..].windows(6).position(|window| window == b"\x93NUMPY").unwrap();
    let header = usize::from(bytes[magic + 8]) + 256 * usize::from(bytes[magic + 9]);
    let text = String::from_utf8_lossy(&bytes[magic + 10..magic + 10 + header]).into_owned();
    let shape = text.split_once("'shape': (").unwrap().1.split(')').next().unwrap();
    let shape: Vec<usize> = shape.split(',').filter_map(|length| length.trim().parse().ok()).collect();
    let values = &bytes[magic + 10 + header..][..8 * shape.iter().product::<usize>()];
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    (shape, values.chunks_exact(8).map(number).collect())
}

/// Columns of a table by their names.
fn columns(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in lines {
        for (name, value) in names.iter().zip(line.split(',')) {
            columns.entry((*name).to_owned()).or_default().push(value.parse().unwrap());
        }
    }
    columns
}

#[test]
fn samples_of_a_design_match_free_fall() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    for design in ["sobol:1500", "lhs:1500"] {
        let (output, _) = place.run(&format!("sample fall.yaml --design {design}"), 0);
        assert!(output.contains("1500 samples in samples.npz"), "{output}");
        let file = place.path().join("samples.npz");
        let (shape, values) = array(&file, "values");
        let (of_parameters, parameters) = array(&file, "parameters");
        let (_, times) = array(&file, "times");
        assert_eq!((&shape[..], &of_parameters[..]), (&[1500, 5, 3][..], &[1500, 2][..]));
        assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
        for (of_sample, point) in values.chunks_exact(15).zip(parameters.chunks_exact(2)) {
            assert!((point[0] - 9.81).abs() <= 0.0981 + 1e-12 && (point[1] - 2.0).abs() <= 0.2 + 1e-12);
            for (values, t) in of_sample.chunks_exact(3).zip(&times) {
                let expected = [-point[0] * t * t / 2.0, -point[1] * t * t / 2.0, -point[0] * t];
                assert!(values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-11));
            }
        }
        // Evenly: means are those of the box.
        let mean = |axis: usize| parameters.iter().skip(axis).step_by(2).sum::<f64>() / 1500.0;
        assert!((mean(0) - 9.81).abs() < 2e-4 && (mean(1) - 2.0).abs() < 4e-4, "{} {}", mean(0), mean(1));
    }
}

#[test]
fn samples_of_a_table_match_its_rows() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    // One parameter is not among the columns, and one value lies outside its tolerance.
    fs::write(place.path().join("points.csv"), "g\n9.8\n20\n").unwrap();
    place.run("sample fall.yaml --points points.csv -o s.csv -q", 0);
    let found = columns(&place.path().join("s.csv"));
    assert_eq!(found.keys().map(String::as_str).collect::<Vec<_>>(), ["far", "g", "k", "near", "sample", "speed", "t"]);
    assert_eq!(found["sample"], [[0.0; 5], [1.0; 5]].concat());
    assert_eq!(found["k"], [2.0; 10]);
    assert!((found["near"][4] + 4.9).abs() < 1e-11 && (found["speed"][9] + 20.0).abs() < 1e-11, "{found:?}");

    // The same of a spreadsheet.
    fs::write(place.path().join("points.csv"), "g;k\n9,8;2\n20;2\n").unwrap();
    place.run("sample fall.yaml --points points.csv -o s.csv -q", 0);
    assert_eq!(columns(&place.path().join("s.csv"))["speed"], found["speed"]);

    for (table, message) in [
        ("g,h\n1,2\n", "`h` is no uncertain parameter of the model; there are: g, k"),
        ("g\n", "there are no points"),
        ("g\n9.8\n9,8\n", "line 3: 2 cells, but the first line has 1"),
        ("g\n9.8 m\n", "line 2, `g`: `9.8 m` is not a number; values are plain numbers in SI units"),
        ("g,g\n1,2\n", "there are two columns `g`"),
    ] {
        fs::write(place.path().join("points.csv"), table).unwrap();
        let (_, errors) = place.run("sample fall.yaml --points points.csv", 2);
        assert!(errors.contains(message), "{errors}");
    }
    let (_, errors) = place.run("sample fall.yaml --design halton:100", 2);
    assert!(errors.contains("`halton:100` is no design"), "{errors}");
    let (_, errors) = place.run("sample fall.yaml", 2);
    assert!(errors.contains("--design sobol:1000"), "{errors}");
}

#[test]
fn samples_of_shards_have_the_same_bytes() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    place.run("sample fall.yaml --design lhs:2500 --seed 3 -o direct.npz -j 1", 0);
    place.run("plan fall.yaml --design lhs:2500 --seed 3 --at-once 0 --shard-seconds 0 -o study", 0);
    let plan = fs::read_to_string(place.path().join("study/plan.json")).unwrap();
    let plan: serde_json::Value = serde_json::from_str(&plan).unwrap();
    // Two subsystems, and three parts of each.
    assert_eq!(plan["shards"].as_array().unwrap().len(), 6);
    place.run("merge study -o merged.npz", 1);
    for shard in [5, 0, 3, 1, 4, 2] {
        place.run(&format!("shard study --index {shard}"), 0);
    }
    place.run("merge study -o merged.npz", 0);
    place.run("sample fall.yaml --design lhs:2500 --seed 3 -o stored.npz --store study -q", 0);
    let bytes = |name: &str| fs::read(place.path().join(name)).unwrap();
    assert_eq!(bytes("direct.npz"), bytes("merged.npz"));
    assert_eq!(bytes("direct.npz"), bytes("stored.npz"));
}

/// A crank whose rod may be too short to go round: some samples cannot be assembled, some stop.
#[test]
fn samples_without_motion_have_no_values() {
    let place = Place::new();
    let model = "
model: rod
parameters:
  reach: { value: 0.5, unit: m, interval: [0.2, 1.5] }
bodies: { bob: { mass: 1, coordinates: [x, y] } }
joints: { rod: { distance: { between: [ground, bob], length: 1 } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bob.x: reach, bob.vx: 0 }
guess: { bob.y: -1 }
outputs: { x: bob.x }
simulation: { duration: 0.1 s, step: 1e-3, output_step: 0.05 }
";
    fs::write(place.path().join("rod.yaml"), model).unwrap();
    fs::write(place.path().join("points.csv"), "reach\n0.5\n1.4\n0.8\n").unwrap();
    let (_, errors) = place.run("sample rod.yaml --points points.csv -o s.csv", 0);
    assert!(errors.contains("of 3 samples, 1 cannot be assembled and 0 stopped before the end"), "{errors}");
    let x = &columns(&place.path().join("s.csv"))["x"];
    let known: Vec<bool> = x.iter().map(|x| x.is_finite()).collect();
    assert_eq!(known, [true, true, true, false, false, false, true, true, true]);
    assert!((x[0] - 0.5).abs() < 1e-9 && (x[6] - 0.8).abs() < 1e-9, "{x:?}");
}

/// A throw that some samples take to a stiff ceiling. Steps of the model are as long as a fifth of the contact.
#[test]
fn samples_are_cut_at_their_own_events() {
    let place = Place::new();
    let model = "
model: ceiling
parameters: { v0: { value: 5, unit: m/s, tolerance: 10% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ceiling: { force: { on: ball, value: [0, \"-1e5*max(ball.y - 1.3, 0)\"] } }
initial: { ball.y: 0, ball.vy: v0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 0.8, step: 2e-3, output_step: 0.1 }
";
    fs::write(place.path().join("ceiling.yaml"), model).unwrap();
    // Parabolas; in contact a spring that is hit with a speed of `left`.
    let (g, omega) = (9.81_f64, 1e5_f64.sqrt());
    let truth = |speed: f64, t: f64| {
        let left = (speed * speed - 2.0 * g * 1.3).max(0.0).sqrt();
        let (begins, contact) = ((speed - left) / g, 2.0 / omega * (left * omega / g).atan());
        let since = t - begins - contact;
        if left == 0.0 || t < begins {
            [speed * t - 0.5 * g * t * t, speed - g * t]
        } else if since < 0.0 {
            let (sin, cos) = (omega * (t - begins)).sin_cos();
            let push = g / (omega * omega);
            [1.3 + left / omega * sin - push * (1.0 - cos), left * cos - push * omega * sin]
        } else {
            [1.3 - left * since - 0.5 * g * since * since, -left - g * since]
        }
    };
    // Alone, on both sides of the one that grazes, and many.
    let many: Vec<f64> = (0..61).map(|place| 4.5 + f64::from(place) / 60.0).collect();
    for speeds in [&[5.3][..], &[4.8], &[4.8, 5.3], &many] {
        let table: String = std::iter::once("v0\n".to_owned()).chain(speeds.iter().map(|v| format!("{v}\n"))).collect();
        fs::write(place.path().join("points.csv"), table).unwrap();
        place.run("sample ceiling.yaml --points points.csv", 0);
        let (shape, values) = array(&place.path().join("samples.npz"), "values");
        assert_eq!(shape, [speeds.len(), 9, 2]);
        for (speed, of_sample) in speeds.iter().zip(values.chunks_exact(18)) {
            for (row, found) in of_sample.chunks_exact(2).enumerate() {
                let expected = truth(*speed, 0.1 * row as f64);
                let distance = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(distance < 1e-6, "{speed} m/s, row {row}: {found:?}, not {expected:?}");
            }
        }
    }
}
