//! `shape:` of bodies, and surfaces of contacts: where pictures have them, against geometry by hand; the motion is the
//! same without.

use std::fs;

use serde_json::Value;

use crate::place::Place;

const TAIL: &str = "
joints: { pin: { revolute: [ground, bar.A] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bar.angle: 90 deg }
outputs: { x: bar.x, y: bar.y }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.01 }
bounds: { chebyshev: { order: 4 }, scan: { points: 3 } }
";

/// A pendulum with shapes, or without.
fn pendulum(shape: &str) -> String {
    let (parameter, shape) = match shape {
        "" => (String::new(), String::new()),
        shape => ("  wide: { value: 20, unit: mm, tolerance: 10% }\n".to_owned(), format!("    shape: {shape}\n")),
    };
    format!(
        "model: bar\nparameters:\n  l: {{ value: 0.2, unit: m, tolerance: 1% }}\n{parameter}bodies:\n  bar:\n    mass: 1\n    \
         inertia: 0.01\n    points: {{ A: [-l/2, 0] }}\n{shape}{TAIL}"
    )
}

const SHAPES: &str = "[
      { box: { size: [l, wide, 10 mm], position: [0, 0, 5 mm], rotation: { axis: x, angle: 90 deg } } },
      { cylinder: { radius: wide, length: 10 mm, axis: x } },
      { outline: { points: [[0, 0], [l, 0], { to: [0, l], radius: l }], thickness: 2 mm } },
      { mesh: { file: corner.obj, scale: 1e-3 } },
      { sphere: { radius: wide/2, position: [l/2, 0] } },
      { capsule: { ends: [[-l/2, 0], [l/2, 0]], radius: wide/4 } } ]";

const CORNER: &str = "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 0 0 100\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

fn place_of(text: &str) -> Place {
    let place = Place::new();
    fs::write(place.path().join("bar.yaml"), text).unwrap();
    fs::write(place.path().join("corner.obj"), CORNER).unwrap();
    place
}

fn drawing(place: &Place) -> Value {
    let (json, _) = place.run("show bar.yaml --format json -o out", 0);
    let picture = fs::read_to_string(place.path().join("out/mechanism.svg")).unwrap();
    assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
    serde_json::from_str(&json).unwrap()
}

#[track_caller]
fn assert_near(value: &Value, expected: &[f64]) {
    let values: Vec<f64> = value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
    let distance = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(values.len() == expected.len() && distance < 1e-12, "{values:?} instead of {expected:?}");
}

#[test]
fn bounds_are_the_same_bits_with_shapes() {
    let bounds = |text: &str| {
        let place = place_of(text);
        let done = place.command("run -q bar.yaml").output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let motion = fs::read_to_string(place.path().join("results/bar/motion.json")).unwrap();
        (fs::read(place.path().join("results/bar/bounds.csv")).unwrap(), motion)
    };
    let (without, _) = bounds(&pendulum(""));
    let (with, motion) = bounds(&pendulum(SHAPES));
    assert!(with == without, "shapes move bounds");
    assert!(motion.contains("\"vertices\""), "no mesh in the report");
    let motion: Value = serde_json::from_str(&motion).unwrap();
    assert_eq!(motion["motion"]["visuals"].as_array().unwrap().len(), 6);
}

#[test]
fn shapes_have_given_positions_and_keep_models_planar() {
    let place = place_of(&pendulum(SHAPES));
    let drawing = drawing(&place);
    assert_eq!(drawing["spatial"], false);
    let solids = drawing["solids"].as_array().unwrap();
    let kinds: Vec<&str> = solids.iter().map(|solid| solid["shape"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["box", "cylinder", "outline", "mesh", "sphere", "capsule"]);
    assert!(solids.iter().all(|solid| solid["body"] == 1 && solid.get("surface").is_none()));
    assert_near(&solids[0]["size"], &[0.2, 0.02, 0.01]);
    assert_near(&solids[0]["position"], &[0.0, 0.0, 0.005]);
    let half = 0.5_f64.sqrt();
    assert_near(&solids[0]["orientation"], &[half, half, 0.0, 0.0]);
    assert_eq!(solids[2]["points"][2]["radius"], 0.2);
    assert_near(&solids[4]["position"], &[0.1, 0.0, 0.0]);
    assert_eq!(solids[5]["radius"], 0.005);
    // The bar hangs up: its shapes are drawn about its middle, 0.1 m over the pin.
    assert_near(&drawing["bodies"][1]["position"], &[0.0, 0.1, 0.0]);
}

/// The image of an instance has the image of its shapes: an outline the other way round, and a mesh with a negative
/// factor.
#[test]
fn shapes_are_mirrored_with_their_instance() {
    let text = "
model: bar
assemblies:
  arm:
    bodies:
      arm:
        mass: 1
        inertia: 0.01
        points: { A: [0, 0] }
        shape:
          - outline: { points: [[0, 0], [0.2, 0], { to: [0, 0.1], radius: 0.3 }], position: [0.01, 0.02] }
          - mesh: { file: corner.obj }
          - outline: [[0, 0], [0.1, 0], [0.1, 0.1]]
          - capsule: { ends: [[0, 0], [0.1, 0.05]], radius: 0.01, rotation: { axis: z, angle: 30 deg } }
    joints: { pin: { revolute: [ground, arm.A] } }
instances: { right: { of: arm }, left: { of: arm, mirror: x } }
outputs: { x: right.arm.x + left.arm.x }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.1 }
";
    let drawing = drawing(&place_of(text));
    let [right, left] = ["right.arm", "left.arm"].map(|name| {
        let bodies = drawing["bodies"].as_array().unwrap();
        let body = bodies.iter().position(|body| body["name"] == name).unwrap();
        let solids = drawing["solids"].as_array().unwrap().iter();
        solids.filter(|solid| solid["body"] == body).cloned().collect::<Vec<Value>>()
    });
    assert_near(&right[0]["position"], &[0.01, 0.02, 0.0]);
    assert_near(&left[0]["position"], &[-0.01, 0.02, 0.0]);
    assert_near(&left[0]["points"][1]["to"], &[-0.2, 0.0, 0.0]);
    assert_eq!((&right[0]["points"][2]["radius"], &left[0]["points"][2]["radius"]), (&0.3.into(), &(-0.3).into()));
    assert_near(&right[1]["scale"], &[1.0, 1.0, 1.0]);
    assert_near(&left[1]["scale"], &[-1.0, 1.0, 1.0]);
    // The short form, too.
    assert_near(&left[2]["points"][1]["to"], &[-0.1, 0.0, 0.0]);
    assert_near(&left[3]["ends"][1], &[-0.1, 0.05, 0.0]);
    let (sin, cos) = 15_f64.to_radians().sin_cos();
    assert_near(&right[3]["orientation"], &[cos, 0.0, 0.0, sin]);
    assert_near(&left[3]["orientation"], &[cos, 0.0, 0.0, -sin]);
}

#[test]
fn surfaces_of_contacts_are_drawn_with_their_geometry() {
    let contact = "impact: { stiffness: 1e5, exponent: 1, dissipation: 5 }";
    let text = format!(
        "
model: bar
parameters: {{ r: {{ value: 30, unit: mm, tolerance: 1% }} }}
bodies:
  ground: {{ points: {{ P: [0.1, 0.2] }} }}
  ball: {{ mass: 1, inertia: 1e-3 }}
  crate: {{ mass: 1, inertia: 1e-3 }}
effects:
  floor: {{ contact: {{ between: [ground.P, ball], plane: y, radius: r, {contact} }} }}
  hill: {{ contact: {{ between: [ground, ball], height: 0.1*x^2, radius: r, {contact} }} }}
  edge: {{ contact: {{ between: [ground, crate], polygon: [[0, -1], [1, -1], [0, -0.5]], rounding: 10 mm, corners: [[-0.1, -0.1], [0.1, -0.1], [0, 0.1]], {contact} }} }}
  hole: {{ contact: {{ between: [ground, ball], hollow: 2, radius: r, {contact} }} }}
initial: {{ ball.y: 0.5, crate.y: 0.6, crate.x: 0.5 }}
outputs: {{ x: ball.x + crate.x }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01 }}
"
    );
    let drawing = drawing(&place_of(&text));
    let solids = drawing["solids"].as_array().unwrap();
    let of = |body: u32, shape: &str| {
        let found: Vec<&Value> =
            solids.iter().filter(|solid| solid["body"] == body && solid["shape"] == shape).collect();
        assert_eq!(found.len(), 1, "{shape} of body {body}: {found:?}");
        found[0]
    };
    let floor = of(0, "half_space");
    assert_eq!(floor["surface"], "floor");
    assert_near(&floor["position"], &[0.1, 0.2, 0.0]);
    assert_near(&floor["normal"], &[0.0, 1.0, 0.0]);
    // One ball, however many surfaces it touches.
    assert_eq!(of(1, "sphere")["radius"], 0.03);
    let hill = of(0, "ground")["points"].as_array().unwrap();
    assert!(hill.len() > 100);
    for point in hill {
        let [x, y] = [0, 1].map(|axis| point[axis].as_f64().unwrap());
        assert!((y - 0.1 * x * x).abs() < 1e-12, "{x} {y}");
    }
    assert_eq!(of(0, "outline")["radius"], 0.01);
    assert_eq!(of(0, "bore")["radius"], 2.0);
    assert_eq!(of(2, "hull")["points"].as_array().unwrap().len(), 3);
}

#[test]
fn meshes_are_files_below_the_model() {
    let mesh = |file: &str| {
        pendulum("").replace("points: {", &format!("shape: {{ mesh: {{ file: {file} }} }}\n    points: {{"))
    };
    let place = place_of(&mesh("../outside.obj"));
    let outside = place.path().parent().unwrap().join("outside.obj");
    let (_, error) = place.run("check bar.yaml", 2);
    assert!(error.contains("is not within the model's folder") && error.contains("--root DIR"), "{error}");
    assert!(!outside.exists());
    fs::create_dir(place.path().join("folder")).unwrap();
    for (file, message) in [
        ("none.stl", "there is no such file"),
        ("bar.yaml", "it is no STL or OBJ file"),
        ("folder", "it is no regular file"),
    ] {
        fs::write(place.path().join("bar.yaml"), mesh(file)).unwrap();
        let (_, error) = place.run("check bar.yaml", 2);
        assert!(error.contains(&format!("`{file}` is no mesh: {message}")), "{error}");
    }
}
