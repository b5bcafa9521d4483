//! Instances that are placed, mirrored and nested: their starts, the numbers of their places, their drives, and the
//! guide's models.

use std::fs;
use std::path::Path;

use mbint::Model;
use mbint::results::{Bounds, Summary};

use super::parts_nested_in_space::ARM;

#[track_caller]
fn read(text: &str, set: &[&str]) -> Model {
    let model = Model::from_yaml_str("test.yaml", text);
    let model = set.iter().fold(model, |model, setting| {
        let (name, value) = setting.split_once('=').unwrap();
        model?.with(name, value)
    });
    model.unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn run(model: &Model) -> (Bounds, Summary) {
    let result = model.study().allow_costly().run().unwrap();
    (result.bounds().clone(), result.summary().clone())
}

#[track_caller]
pub(super) fn bounds(text: &str) -> Bounds {
    run(&read(text, &[])).0
}

/// The output's nominal course and its bounds.
fn courses(bounds: &Bounds, output: &str) -> [Vec<f64>; 3] {
    let found = bounds.outputs.iter().find(|found| found.name == output).unwrap();
    [found.nominal.clone(), found.bands[0].lower.clone(), found.bands[0].upper.clone()]
}

/// Compares all outputs of two models.
#[track_caller]
pub(super) fn same(first: &Bounds, second: &Bounds) {
    assert_eq!(first.outputs.len(), second.outputs.len());
    for output in &first.outputs {
        let [one, other] = [first, second].map(|bounds| courses(bounds, &output.name));
        let size = one[0].iter().fold(1e-3, |size: f64, value| size.max(value.abs()));
        for (value, other) in one.iter().flatten().zip(other.iter().flatten()) {
            assert!((value - other).abs() < 1e-9 * size, "{}: {value} and {other}", output.name);
        }
    }
}

pub(super) const ASKED: &str = "
simulation: { duration: 0.3, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";

/// Coordinates that a body does not have are those of its instance.
#[test]
fn missing_coordinates_follow_the_instance() {
    let text = format!(
        "
assemblies:
  hanger:
    parameters: {{ mass: 2 kg ± 1% }}
    bodies: {{ bob: {{ mass: mass, coordinates: [y], held: {{ angle: 0.1 }}, points: {{ P: [0.1, 0] }} }} }}
    effects: {{ spring: {{ force: {{ on: bob, value: [0, -300 N/m*bob.y] }} }} }}
    initial: {{ bob.y: 10 mm, bob.vy: 0 }}
instances: {{ one: {{ of: hanger }}, two: {{ of: hanger, at: [1, 2], mirror: y, parameters: {{ mass: one.mass }} }} }}
outputs: {{ y1: one.bob.y, y2: 2 - two.bob.y, x1: one.bob.P.x + 1, x2: two.bob.P.x, z1: one.bob.P.y, z2: 2 - two.bob.P.y }}
{ASKED}"
    );
    let found = bounds(&text);
    for name in ["y", "x", "z"] {
        let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}")));
        for (one, two) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!((one - two).abs() < 1e-12, "{name}: {one} and {two}");
        }
    }
}

/// All numbers of a placement are parameters, in the frame of the instance around it.
#[test]
fn numbers_of_placements_are_parameters() {
    let text = format!(
        "{ARM}
  pair: {{ instances: {{ one: {{ of: arm, at: {{ position: [0.1, 0, 0], rotation: {{ rpy: [0, 0, 10 deg ± 1 deg] }} }} }} }} }}
instances: {{ left: {{ of: pair, at: {{ position: [1, 2, 3 m ± 1 mm], angle: 90 deg }}, mirror: x }} }}
outputs: {{ x: left.one.ground.x, y: left.one.ground.y, z: left.one.ground.z, hand: left.one.hand.x }}
{ASKED}"
    );
    let at = |set: &[&str]| {
        let model = read(&text, set);
        let (found, _) = run(&model);
        ["x", "y", "z"].map(|output| courses(&found, output)[0][0])
    };
    // The image of 0.1 along x is −0.1, which a quarter turn has along −y.
    let near = |found: [f64; 3], wanted: [f64; 3]| {
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-12), "{found:?}");
    };
    near(at(&[]), [1.0, 1.9, 3.0]);
    near(at(&["left.one.at.x=0.3"]), [1.0, 1.7, 3.0]);
    near(at(&["left.at.angle=0", "left.at.z=4"]), [0.9, 2.0, 4.0]);
    let mut names: Vec<String> =
        read(&text, &["left.at.angle=90±1 deg"]).uncertain().map(|(name, _)| name.to_owned()).collect();
    names.sort_unstable();
    assert_eq!(names, ["arm.l", "left.at.angle", "left.at.z", "left.one.at.yaw"]);
    let assemblies = run(&read(&text, &[])).1.assemblies;
    assert_eq!(assemblies[0].independent, ["left.at.z"]);
    assert_eq!(assemblies[1].independent, ["left.one.at.yaw"]);
}

/// A drive of many joints that turn counts the other way in a mirror as that of one does.
#[test]
fn mirrored_drives_of_many_joints_turn_the_other_way() {
    let text = format!(
        "
assemblies:
  arm:
    shared: all
    parameters: {{ m: 1 kg ± 2% }}
    bodies:
      upper: {{ mass: m, inertia: 0.02, points: {{ end: [0.3, 0] }} }}
      lower: {{ mass: m, inertia: 0.02 }}
    joints: {{ hip: {{ revolute: [ground, upper] }}, knee: {{ revolute: [upper.end, lower] }} }}
    effects:
      hold: {{ servo: {{ on: all revolute, target: 0.5*sin(3*t), proportional: 20, derivative: 1 }} }}
      hold_knee: {{ pid: {{ on: all kn*, target: 0.2, proportional: 2, integral: 3 }} }}
      nudge: {{ torque: {{ on: knee, value: 0.2*hold_knee.knee.integral }} }}
    initial: {{ hip.angle: 0.1, hip.angular_velocity: 0, knee.angle: 0.2, knee.angular_velocity: 0 }}
instances: {{ one: {{ of: arm }}, two: {{ of: arm, mirror: y }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [9.81, 0] }} }} }}
outputs: {{ h1: one.hip.angle, h2: -two.hip.angle, k1: one.knee.angle, k2: -two.knee.angle }}
{ASKED}"
    );
    let found = bounds(&text);
    for name in ["h", "k"] {
        let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}")));
        for (one, two) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!((one - two).abs() < 1e-9, "{name}: {one} and {two}");
        }
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The gripper of the guide is that of the models, whose fingers are written without parts.
#[test]
fn gripper_of_parts_matches_the_gripper() {
    let file = "docs/examples/gripper_of_parts.yaml";
    let page = fs::read_to_string(root().join("docs/guides/parts.md")).unwrap();
    assert!(page.contains(&fs::read_to_string(root().join(file)).unwrap()));
    let [parts, whole] = [file, "models/gripper.yaml"].map(|file| {
        let model = Model::from_file(root().join(file)).unwrap();
        run(&model).0
    });
    same(&parts, &whole);
}

/// Legs that differ by their placements alone move alike, and start where plane geometry says.
#[test]
fn legs_around_a_body_move_equally() {
    let model = Model::from_file(root().join("docs/examples/hexapod.yaml")).unwrap();
    let (found, _) = run(&model);
    let bend = 80_f64.to_radians();
    for (output, start) in [("foot", -0.16 * bend.sin()), ("reach", 0.1 + 0.12 + 0.16 * bend.cos())] {
        let first = courses(&found, &format!("{output}_1"));
        assert!((first[0][0] - start).abs() < 1e-12);
        assert!(first[2][0] > first[1][0] + 1e-4, "shins differ");
        for leg in 2..=6 {
            let other = courses(&found, &format!("{output}_{leg}"));
            for (one, other) in first.iter().flatten().zip(other.iter().flatten()) {
                assert!((one - other).abs() < 1e-9, "{output}_{leg}: {one} and {other}");
            }
        }
    }
}

/// An assembly gives the starts of bodies of inner instances, by their ports too, in its own frame.
#[test]
fn starts_of_inner_bodies_are_in_the_assemblys_frame() {
    let side = |mirror: &str| {
        format!(
            r#"
assemblies:
  wheel:
    shared: all
    parameters: {{ m: 1 kg ± 2% }}
    bodies: {{ hub: {{ mass: m, inertia: 1, points: {{ P: [0.1, 0] }} }} }}
    ports: {{ centre: hub, rim: hub.P }}
  side:
    instances: {{ w: {{ of: wheel, at: [0.5, 0] }} }}
    effects:
      pull: {{ spring_damper: {{ between: [ground, w.rim], along: x, stiffness: 10 }} }}
      damp: {{ force: {{ on: w.centre, value: ["-1 N*s/m*w.rim.vx", "-1 N/m*w.centre.y"] }} }}
    initial: {{ w.rim.x: 0.7, w.rim.y: 0.1, w.centre.vx: 1, w.hub.vy: 0, w.hub.angle: 0.2, w.hub.angular_velocity: 0 }}
    ports: {{ rim: w.rim }}
instances:
  one: {{ of: side }}
  two: {{ of: side, {mirror} }}
outputs: {{ x1: one.rim.x, y1: one.rim.y, x2: two.rim.y - 1, y2: 1 - two.rim.x }}
{ASKED}"#
        )
    };
    // A quarter turn has the image's x along −y; without the mirror along y.
    for (index, sign) in
        [("at: { position: [1, 1], angle: 90 deg }", 1.0), ("at: { position: [1, 1], angle: 90 deg }, mirror: x", -1.0)]
    {
        let found = bounds(&side(index));
        for (name, sign) in [("x", sign), ("y", 1.0)] {
            let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}"))[0].clone());
            let start = if name == "x" { 0.7 } else { 0.1 };
            assert!((one[0] - start).abs() < 1e-9, "{name}: {}", one[0]);
            for (one, two) in one.iter().zip(two) {
                // Given values of points hold at the start; the courses agree up to the steps' errors.
                assert!((one - sign * two).abs() < 1e-6, "{name}: {one} and {two}");
            }
        }
    }
}
