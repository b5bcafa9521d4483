//! Assemblies, instances and repetition: their models are those written out by hand, to the byte.

use std::fs;
use std::path::Path;

use mbint::results::{Bounds, Summary, Verdict};
use mbint::{Error, Model};

use super::place::{Place, diagnostics_of};

fn read(text: &str, set: &[&str]) -> Result<Model, Error> {
    set.iter().try_fold(Model::from_yaml_str("test.yaml", text)?, |model, setting| {
        let (name, value) = setting.split_once('=').unwrap();
        model.with(name, value)
    })
}

#[track_caller]
fn good(text: &str, set: &[&str]) -> Model {
    read(text, set).unwrap_or_else(|error| panic!("{error}"))
}

fn run(model: &Model) -> (Bounds, Summary) {
    let result = model.study().allow_costly().run().unwrap();
    (result.bounds().clone(), result.summary().clone())
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

const LINKS: &str = "
model: links
parameters: { N: 3, length: 0.2 m ± 1%, mass: 0.3 kg }
bodies:
  link_{i}: { repeat: { i: 1..N }, mass: mass, inertia: mass*length^2/12, points: { start: [-length/2, 0], end: [length/2, 0] } }
joints:
  pin_1: { revolute: [ground, link_1.start] }
  pin_{i}: { repeat: { i: 2..N }, revolute: [\"link_{i-1}.end\", \"link_{i}.start\"] }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rub: { joint_friction: { on: all revolute, viscous: 2e-3 } }
initial:
  link_{i}.angle: { repeat: { i: 1..N }, value: -20 deg*i }
  link_{i}.angular_velocity: { repeat: { i: 1..N }, value: 0 }
outputs: { x: \"link_{N}.end.x\", lost: \"sum(i, 1..N, rub.pin_{i}.torque)\", height: \"sum(i, 1..N, link_{i}.y)/N\" }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 }, scan: { points: 5 } }
";

const WRITTEN_OUT: &str = "
model: links
parameters: { N: 3, length: 0.2 m ± 1%, mass: 0.3 kg }
bodies:
  link_1: { mass: mass, inertia: mass*length^2/12, points: { start: [-length/2, 0], end: [length/2, 0] } }
  link_2: { mass: mass, inertia: mass*length^2/12, points: { start: [-length/2, 0], end: [length/2, 0] } }
  link_3: { mass: mass, inertia: mass*length^2/12, points: { start: [-length/2, 0], end: [length/2, 0] } }
joints:
  pin_1: { revolute: [ground, link_1.start] }
  pin_2: { revolute: [link_1.end, link_2.start] }
  pin_3: { revolute: [link_2.end, link_3.start] }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rub_1: { joint_friction: { on: pin_1, viscous: 2e-3 } }
  rub_2: { joint_friction: { on: pin_2, viscous: 2e-3 } }
  rub_3: { joint_friction: { on: pin_3, viscous: 2e-3 } }
initial:
  { link_1.angle: -20 deg, link_2.angle: -20 deg*2, link_3.angle: -20 deg*3, link_1.angular_velocity: 0, link_2.angular_velocity: 0, link_3.angular_velocity: 0 }
outputs: { x: link_3.end.x, lost: rub_1.torque + rub_2.torque + rub_3.torque, height: (link_1.y + link_2.y + link_3.y)/N }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 }, scan: { points: 5 } }
";

#[test]
fn repetition_gives_the_bytes_of_written_out_models() {
    let place = Place::new();
    let bounds = |text: &str| {
        fs::write(place.path().join("links.yaml"), text).unwrap();
        place.run("run links.yaml --no-report", 0);
        let instructions = place.run("explain links.yaml --format json", 0).0;
        let instructions: serde_json::Value = serde_json::from_str(&instructions).unwrap();
        (fs::read(place.path().join("results/links/bounds.csv")).unwrap(), instructions["instructions"].clone())
    };
    assert_eq!(bounds(LINKS), bounds(WRITTEN_OUT));
}

#[test]
fn command_line_sets_the_number_of_repetitions() {
    let counts = |set: &[&str]| good(LINKS, set).study().description().bodies.len() - 1;
    assert_eq!((counts(&[]), counts(&["N=7"]), counts(&["N=2"])), (3, 7, 2));
    let bad = diagnostics_of(read(LINKS, &["N=2.5"])).records();
    assert_eq!(bad[0].message, "`N` is not a whole number");
    assert_eq!((bad[0].line, bad[0].column), (Some(5), Some(31)));
}

/// A mass on a spring and a damper, in an assembly.
const PAIR: &str = "
assemblies:
  hanger:
    shared: [gravity]
    parameters: { mass: 2 kg ± 5%, rate: { value: 300, unit: N/m, tolerance: 3% }, gravity: 9.81 m/s^2 ± 1%, twice: 2*rate }
    bodies: { bob: { mass: mass, coordinates: [y], points: { eye: [0, 0.1] } } }
    effects:
      spring: { spring_damper: { between: [ground, bob], along: y, stiffness: twice, damping: 1, force: \"mass*gravity + 0.1*spring.rate*rate/300\" } }
    initial: { bob.y: 10 mm, bob.vy: 0 }
    ports: { hook: bob.eye, side: { on: bob, position: [0.2, mass*0.1 m/kg] } }
instances:
  one: { of: hanger }
  two: { of: hanger, parameters: { rate: 400, mass: { tolerance: 1% } } }
  three: { of: hanger, parameters: { mass: load } }
parameters: { load: 3 kg ± 2% }
outputs: { y: one.bob.y, h: one.hook.y, s: two.side.y, f: three.spring.force, k: two.twice }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 }, scan: { points: 3 } }
";

/// Nominal, lower and upper value.
fn interval(model: &Model, name: &str) -> Option<[f64; 3]> {
    let result = model.study().nominal().run().unwrap();
    let found = result.summary().parameters.iter().find(|parameter| parameter.name == name)?;
    Some([found.nominal, found.lower, found.upper])
}

#[test]
fn instances_have_separate_tolerances_unless_shared() {
    let model = good(PAIR, &[]);
    let names: Vec<&str> = model.uncertain().map(|(name, _)| name).collect();
    let expected = ["load", "hanger.gravity", "one.mass", "one.rate", "two.mass", "two.rate", "three.rate"];
    let mut sorted = names.clone();
    sorted.sort_unstable();
    let mut all = expected.to_vec();
    all.retain(|name| *name != "two.rate");
    all.sort_unstable();
    // A value stands for itself: the assembly's deviation goes with the assembly's value.
    assert_eq!(sorted, all);
    assert_eq!(interval(&model, "two.mass").unwrap(), [2.0, 1.98, 2.02]);
    let (_, summary) = run(&model);
    let [of] = summary.assemblies.as_slice() else { panic!("{:?}", summary.assemblies) };
    assert_eq!((of.assembly.as_str(), of.instances.len()), ("hanger", 3));
    assert_eq!(of.independent, ["one.mass", "one.rate", "two.mass", "three.rate"]);
    assert_eq!(of.shared, ["hanger.gravity", "load"]);
}

#[test]
fn settings_apply_to_one_or_all_instances() {
    let rates = |set: &[&str]| {
        let model = good(PAIR, set);
        ["one.rate", "two.rate", "three.rate"].map(|name| interval(&model, name).map(|[nominal, ..]| nominal))
    };
    assert_eq!(rates(&[]), [Some(300.0), None, Some(300.0)]);
    assert_eq!(rates(&["one.rate=310±1%"]), [Some(310.0), None, Some(300.0)]);
    assert_eq!(rates(&["hanger.rate=310±1%"]), [Some(310.0), None, Some(310.0)]);
    assert_eq!(interval(&good(PAIR, &["hanger.gravity=9.8±0.1"]), "hanger.gravity").unwrap()[0], 9.8);
    assert_eq!(interval(&good(PAIR, &["one.gravity=9.7±0.1"]), "one.gravity").unwrap()[0], 9.7);
    let wrong = diagnostics_of(read(PAIR, &["one.rat=3"])).records();
    assert_eq!(wrong[0].message, "unknown parameter `one.rat`");
    let scenes = format!("{PAIR}scenes: {{ stiff: {{ parameters: {{ one.rate: 500 ± 1%, hanger.gravity: 9.7 }} }} }}");
    let model = good(&scenes, &[]);
    assert_eq!(model.warnings().records(), []);
    let scene = model.scene("stiff").unwrap();
    assert_eq!(interval(&scene, "one.rate").unwrap()[0], 500.0);
    assert_eq!(interval(&scene, "hanger.gravity"), None);
}

#[test]
fn instance_matches_the_written_out_model() {
    let (bounds, _) = run(&good(PAIR, &[]));
    let alone = "
parameters: { m: 2 kg ± 5%, k: 300 N/m ± 3%, g: 9.81 m/s^2 ± 1% }
bodies: { bob: { mass: m, coordinates: [y], points: { eye: [0, 0.1] } } }
effects:
  s: { spring_damper: { between: [ground, bob], along: y, stiffness: 2*k, damping: 1, force: \"m*g + 0.1*s.rate*k/300\" } }
initial: { bob.y: 10 mm, bob.vy: 0 }
outputs: { y: bob.y, h: bob.eye.y }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 }, scan: { points: 3 } }
";
    let (expected, _) = run(&good(alone, &[]));
    for (found, expected) in bounds.outputs.iter().zip(&expected.outputs) {
        assert_eq!(found.nominal, expected.nominal);
        for (found, expected) in found.bands.iter().zip(&expected.bands) {
            // The parameters have another order, and so have sums over them.
            let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let apart = apart(&found.lower, &expected.lower).max(apart(&found.upper, &expected.upper));
            assert!(apart < 1e-14, "{:?}: {apart:e}", found.method);
        }
    }
}

#[test]
fn each_of_four_quarter_cars_matches_a_single_one() {
    let four = Model::from_file(root().join("models/quarter_cars.yaml")).unwrap();
    let text = fs::read_to_string(root().join("models/quarter_car.yaml")).unwrap();
    let text = format!(
        "{}\nbounds: {{ chebyshev: {{ order: 3 }}, scan: {{ points: 3 }} }}\n",
        text.split("bounds:").next().unwrap()
    );
    let one = text
        .replace("duration: 1.5", "duration: 1.2")
        .replace("speed:   { value: 36, unit: km/h }", "speed:   { value: 36, unit: km/h, tolerance: 5% }");
    let (four, _) = run(&four);
    for (output, set) in [("shake_front_left", &[][..]), ("shake_front_right", &["damper=1 kN*s/m±30%"])] {
        let (one, _) = run(&good(&one, set));
        let found = four.outputs.iter().find(|found| found.name == output).unwrap();
        let expected = one.outputs.iter().find(|found| found.name == "shake").unwrap();
        assert_eq!(found.nominal, expected.nominal, "{output}");
        for (found, expected) in found.bands.iter().zip(&expected.bands) {
            let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let apart = far(&found.lower, &expected.lower).max(far(&found.upper, &expected.upper));
            // The parameters have another order, and so have sums over them.
            assert!(apart < 1e-9, "{output}: {apart:e}");
        }
    }
}

#[test]
fn an_error_names_file_instance_and_definition() {
    let path = root().join("tests/bad_models/parts-inside.yaml");
    let report = diagnostics_of(Model::from_file(&path));
    let records = report.records();
    let first = records.iter().find(|record| record.message == "instance `right` has no `mas`").unwrap();
    assert!(first.file.ends_with("parts/arm.yaml"), "{}", first.file);
    assert_eq!((first.line, first.column, first.instance.as_deref()), (Some(5), Some(21), Some("right")));
    let text = report.render(false);
    assert!(text.contains("parts/arm.yaml:5:21"), "{text}");
    assert!(text.contains("parts-inside.yaml:23:3"), "{text}");
    assert!(text.contains("in `right`, an instance of `arm`"), "{text}");
}

#[test]
fn assemblies_hold_assemblies() {
    let text = "
assemblies:
  pair:
    parameters: { gap: 0.3 m }
    instances: { \"bob_{i}\": { repeat: { i: 1..2 }, of: bob, parameters: { mass: 1 kg*i + gap*1 kg/m } } }
    joints: { rod: { distance: { between: [bob_1.hook, bob_2.hook], length: gap } } }
    initial: { bob_1.ball.x: 0, bob_2.ball.x: gap }
    ports: { left: bob_1.hook }
  bob:
    parameters: { mass: 1 kg ± 1% }
    bodies: { ball: { mass: mass, coordinates: [x] } }
    ports: { hook: ball }
instances: { a: { of: pair }, b: { of: pair, parameters: { gap: 0.4 m } } }
joints: { tie: { distance: { between: [a.left, b.bob_2.hook], length: 2 } } }
initial: { a.left.x: 0, b.left.x: 1.6, b.left.vx: 1 }
effects: { push: { force: { on: a.bob_1.hook, value: [1, 0] } } }
outputs: { x: b.bob_2.ball.x, v: a.left.vx, f: a.rod.force, m: b.bob_2.mass }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.02 }
bounds: { scan: { points: 2 } }
";
    let model =
        good(&text.replace("initial: { a.left.x: 0, b.left.x: 1.6, b.left.vx: 1 }", "initial: { a.left.vx: 0 }"), &[]);
    let study = model.study();
    let model = study.description();
    let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["ground", "a.bob_1.ball", "a.bob_2.ball", "b.bob_1.ball", "b.bob_2.ball"]);
    let mass = |name: &str| model.parameters.iter().position(|parameter| parameter.name == name);
    assert!(mass("b.bob_2.mass").is_some());
}

#[test]
fn scenes_omit_parts_by_patterns() {
    let text = format!(
        "{LINKS}scenes:\n  free: {{ without: [rub.*], outputs: {{ lost: link_1.y }} }}\n  bare: {{ without: [rub], outputs: {{ lost: link_1.y }} }}\n  first: {{ extends: bare, with: [\"*.pin_1\"] }}\n"
    );
    let model = good(&text, &[]);
    assert_eq!(model.warnings().records(), [], "{}", model.warnings());
    let effects = |scene: &str| model.clone().scene(scene).unwrap().study().explain().unwrap().effects.len();
    assert_eq!((effects("free"), effects("bare"), effects("first")), (1, 1, 2));
    let wrong = diagnostics_of(read(&text.replace("rub.*", "rab.*"), &[])).records();
    assert_eq!(wrong[0].message, "there is no effect, joint or output `rab.*`");
}

/// The pages' examples are files, or stand in the pages as whole models.
#[test]
fn examples_of_pages_are_read() {
    let page = fs::read_to_string(root().join("docs/guides/parts.md")).unwrap();
    let blocks: Vec<&str> = page.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let blocks: Vec<&str> = blocks.into_iter().filter(|block| block.starts_with("model:")).collect();
    assert_eq!(blocks.len(), 2);
    for block in blocks {
        let model = good(block, &[]);
        assert!(model.warnings().is_empty(), "{}", model.warnings());
        run(&model);
    }
    let chapter = fs::read_to_string(root().join("docs/parts.md")).unwrap();
    let blocks: Vec<&str> = chapter.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [link, chain, links] = blocks.as_slice() else { panic!("{} blocks", blocks.len()) };
    run(&good(link, &[]));
    let file = |name: &str| fs::read_to_string(root().join(name)).unwrap();
    assert!(file("models/chain.yaml").ends_with(chain));
    assert_eq!(file("docs/examples/box_of_links.yaml"), *links);
    let (_, summary) = run(&Model::from_file(root().join("docs/examples/box_of_links.yaml")).unwrap());
    assert_eq!(summary.assemblies[0].independent.len(), 3);
    assert_eq!(summary.parameters.len(), 3);
}

/// The models of the guide are as short as it says.
#[test]
fn the_platform_is_short() {
    let text = fs::read_to_string(root().join("models/stewart.yaml")).unwrap();
    let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    assert!(lines.count() < 35);
}

/// The pads move without turning, so the gap is that of the offsets, lengths and thicknesses of two fingers.
#[test]
fn a_gripper_of_a_finger_and_its_image_has_its_gap() {
    let (bounds, summary) = run(&Model::from_file(root().join("models/gripper.yaml")).unwrap());
    let [gap, middle] = ["gap", "middle"].map(|name| bounds.outputs.iter().find(|output| output.name == name).unwrap());
    for (row, t) in bounds.times.iter().enumerate() {
        let u = (t / 0.4).min(1.0);
        let cos = (70.0 + 30.0 * u * u * (3.0 - 2.0 * u)).to_radians().cos();
        let nominal = 2.0 * (0.03 + 0.08 * cos - 0.012);
        let deviation = 2.0 * (0.05e-3 + 0.1e-3 * cos.abs() + 0.02e-3);
        assert!((gap.nominal[row] - nominal).abs() < 1e-9 && middle.nominal[row].abs() < 1e-9);
        let band = &gap.bands[0];
        assert!((band.lower[row] - (nominal - deviation)).abs() < 1e-9, "{} {nominal} {deviation}", band.lower[row]);
        assert!((band.upper[row] - (nominal + deviation)).abs() < 1e-9);
        assert!((middle.bands[0].upper[row] - deviation / 2.0).abs() < 1e-9);
    }
    assert!(summary.requirements.iter().all(|found| found.verdict == Verdict::Holds), "{:?}", summary.requirements);
}
