//! Scenes: their meaning, that each is compiled for itself, and how the command runs them.

use std::collections::BTreeSet;
use std::fs;

use mbint::inner::model::{self, Description, Override, ParameterValue, Stepping};

use super::place::Place;

/// A slider crank with an effect of nearly every kind, each with an uncertain parameter of its own.
const CRANK: &str = "
model: crank
parameters:
  l1: { value: 150, unit: mm, tolerance: 1% }
  l2: { value: 560, unit: mm }
  mass: { value: 0.4, unit: kg, tolerance: 2% }
  k: { value: 5, unit: N/m, tolerance: 10% }
  twice: 2*k
  rub: { value: 0.05, unit: N*m, tolerance: 10% }
  drag: { value: 0.3, tolerance: 10% }
  clear: { value: 0.2, unit: m, tolerance: 1% }
bodies:
  crank:  { mass: mass, inertia: mass*l1^2/12, points: { A: [-l1/2, 0], B: [l1/2, 0] } }
  rod:    { mass: 0.8, inertia: 0.021, points: { B: [-l2/2, 0], C: [l2/2, 0] } }
  slider: { mass: 0.45, coordinates: [x] }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin:   { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
";

/// Everything that acts; none of it is in the bare model.
const EFFECTS: &str = "
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  push:   { force: { on: rod, value: [0, 3*sin(9*t)] } }
  drive:  { torque: { on: crank, value: -0.5 } }
  spring: { spring_damper: { between: [ground, slider], along: x, stiffness: twice, damping: 1, free_length: 0.71 } }
  coil:   { torsional_spring_damper: { on: pivot, stiffness: 0.1 } }
  bush:   { bushing: { between: [ground, crank.A], stiffness: 10 } }
  rubbing: { joint_friction: { on: wrist, coefficient: 0.1, radius: 5 mm, coulomb: rub } }
  end:    { stop: { on: pivot, upper: 3, impact: { stiffness: 100 } } }
  wall:   { contact: { between: [ground, rod.C], plane: x, impact: { stiffness: 1e4 } } }
  loose:  { clearance_joint: { between: [crank.B, rod.B], clearance: clear, impact: { stiffness: 1e4 } } }
  servo:  { servo: { on: pin, target: 0, proportional: 0.1 } }
  air:    { drag: { on: rod, quadratic: drag } }
  rope:   { cable: { between: [ground, rod.C], free_length: 2, stiffness: 10 } }
  play:   { backlash: { between: [crank, rod], ratio: -1, backlash: 0.1, stiffness: 0.1 } }
  pull:   { preload: { between: [ground, rod.C], value: 0.1 } }
";

const ASKED: &str = "
initial: { crank.angle: 0, crank.angular_velocity: -6 }
outputs: { x: slider.x, load: pin.force }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.02 }
";

const BOUNDS: &str = "bounds: { chebyshev: { order: 3 }, taylor: { order: 2 }, scan: { points: 4 } }\n";

fn scene(text: &str, name: &str) -> Description {
    let reading = model::read_str("test.yaml", text, &[]);
    let report = reading.diagnostics.render(false);
    let found = reading.scenes.into_iter().find(|scene| scene.name == name);
    found.unwrap_or_else(|| panic!("no scene {name}\n{report}")).description
}

fn explained(place: &Place, arguments: &str) -> serde_json::Value {
    let (json, _) = place.run(&format!("explain --format json {arguments}"), 0);
    serde_json::from_str(&json).unwrap()
}

/// Everything that was compiled: the output of `explain`, without the model's name.
fn compiled(mut explanation: serde_json::Value) -> serde_json::Value {
    let report = explanation.as_object_mut().unwrap();
    report.remove("model").unwrap();
    explanation
}

const EXCITED: &str = "model: excited
parameters: { k: { value: 100, unit: N/m, tolerance: 5% } }
excitations:
  push: { within: ± 1 N }
  gust: { random: { white: 1 N^2*s, band: [0.5, 5], lines: 20 } }
bodies: { mass: { mass: 1, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, mass], along: x, stiffness: k, damping: 1 } }
  pusher: { force: { on: mass, value: [push, 0] } }
  blower: { force: { on: mass, value: [gust, 0] } }
initial: { mass.x: 0.1, mass.vx: 0 }
outputs: { x: mass.x }
simulation: { duration: 0.5, step: 0.01, output_step: 0.1 }
bounds: { chebyshev: { order: 3 } }
";

/// Excitations that nothing of a scene uses cost nothing: neither functions within limits, nor random ones.
#[test]
fn a_scene_without_an_excitation_is_the_model_without_it() {
    let place = Place::new();
    let scenes = "scenes: { calm: { without: [pusher, blower] }, pushed: { without: [blower] }, blown: { without: [pusher] } }\n";
    fs::write(place.path().join("full.yaml"), format!("{EXCITED}{scenes}")).unwrap();
    place.run("run -q full.yaml -o scenes", 0);
    let without = |names: &[&str]| -> String {
        let is_used = |line: &&str| !names.iter().any(|name| line.trim().starts_with(name));
        EXCITED.lines().filter(is_used).flat_map(|line| [line, "\n"]).collect()
    };
    let counts = [
        ("calm", without(&["excitations:", "push:", "gust:", "pusher:", "blower:"])),
        ("pushed", without(&["gust:", "blower:"])),
        ("blown", without(&["push:", "pusher:"])),
    ]
    .map(|(name, text)| {
        fs::write(place.path().join(format!("{name}.yaml")), text).unwrap();
        let of_scene = compiled(explained(&place, &format!("full.yaml --scene {name}")));
        let by_hand = compiled(explained(&place, &format!("{name}.yaml")));
        assert_eq!(of_scene["instructions"], by_hand["instructions"], "{name}");
        assert_eq!(of_scene, by_hand, "{name}");
        place.run(&format!("run -q {name}.yaml -o {name}"), 0);
        let table = |folder: &str| fs::read(place.path().join(folder).join("bounds.csv")).unwrap();
        assert!(table(&format!("scenes/{name}")) == table(name), "{name}: the same bytes");
        by_hand["instructions"].clone()
    });
    assert!(counts[0] != counts[1] && counts[0] != counts[2], "{counts:?}");
}

/// The proof that a scene pays for nothing but its own: one that leaves every effect out compiles to the very
/// instructions of a model that never had any, and gives the same bytes.
#[test]
fn a_scene_without_effects_is_the_bare_model() {
    let place = Place::new();
    let by_name = "{ l1: 3, mass: 2, k: 4, rub: 2, drag: 2, clear: 2 }";
    let full = format!(
        "{CRANK}{EFFECTS}{ASKED}{BOUNDS}
scenes:
  bare: {{ without: all }}
  by_name: {{ without: all, bounds: {{ chebyshev: {{ order: {by_name} }} }} }}
  sprung: {{ without: all, with: [spring] }}
"
    );
    let used: String = CRANK
        .lines()
        .filter(|line| !["k:", "twice:", "rub:", "drag:", "clear:"].iter().any(|name| line.trim().starts_with(name)))
        .map(|line| format!("{line}\n"))
        .collect();
    let bare = format!("{used}{ASKED}{BOUNDS}");
    let by_name = format!("{used}{ASKED}bounds: {{ chebyshev: {{ order: {{ l1: 3, mass: 2 }} }} }}\n");
    let k = "  k: { value: 5, unit: N/m, tolerance: 10% }\n  twice: 2*k\nbodies:";
    let spring = EFFECTS.lines().find(|line| line.contains("spring_damper:")).unwrap();
    let sprung = format!("{}\neffects:\n{spring}\n{ASKED}{BOUNDS}", used.replace("bodies:", k));
    fs::write(place.path().join("full.yaml"), full).unwrap();
    for (name, text) in [("bare", bare), ("by_name", by_name), ("sprung", sprung)] {
        fs::write(place.path().join(format!("{name}.yaml")), text).unwrap();
    }

    place.run("run -q full.yaml -o scenes", 0);
    for name in ["bare", "by_name", "sprung"] {
        let of_scene = compiled(explained(&place, &format!("full.yaml --scene {name}")));
        let by_hand = compiled(explained(&place, &format!("{name}.yaml")));
        assert_eq!(of_scene["instructions"], by_hand["instructions"], "{name}");
        assert_eq!(of_scene, by_hand, "{name}");
        place.run(&format!("run -q {name}.yaml -o {name}"), 0);
        let table = |folder: &str| fs::read(place.path().join(folder).join("bounds.csv")).unwrap();
        assert!(table(&format!("scenes/{name}")) == table(name), "{name}: the same bytes");
    }
    // The model itself has them all, and is no scene.
    let all = explained(&place, "full.yaml");
    assert_eq!(all["effects"].as_array().unwrap().len(), 15);
    assert_eq!(all["parameters"].as_array().unwrap().len(), 6);
    assert!(!place.files("scenes").iter().any(|name| name == "bounds.csv"));
}

#[test]
fn a_scene_changes_what_it_says_and_nothing_else() {
    let scenes = "
scenes:
  same: {}
  changed:
    description: Another
    without: [weight, x]
    parameters: { l2: 500, mass: { tolerance: 5% } }
    joints: { hold: { motor: { on: pivot, speed: 3 } } }
    effects: { drive: { torque: { on: rod, value: 1 } }, wind: { force: { on: rod, value: [1, 0] } } }
    initial: { crank.angle: 0.5 }
    guess: { rod.angle: 0.1 }
    outputs: { y: rod.y }
    simulation: { duration: 1, tolerance: 1e-4 }
    bounds: { scan: { points: 3 } }
  further: { extends: changed, with: [weight], without: [drive], parameters: { mass: { interval: [0.3, 0.6] } }, simulation: { step: 1e-4 } }
";
    let text = format!("{CRANK}{EFFECTS}{ASKED}{BOUNDS}{scenes}");
    let model = model::load_str("test.yaml", &text, &[]).unwrap();
    let same = scene(&text, "same");
    assert_eq!(format!("{:?}", Description { name: model.name.clone(), ..same.clone() }), format!("{model:?}"));
    assert_eq!(same.name, "crank/same");

    let changed = scene(&text, "changed");
    let names = |model: &Description| model.effects.iter().map(|effect| effect.name.clone()).collect::<Vec<_>>();
    assert_eq!(changed.description.as_deref(), Some("Another"));
    assert_eq!(names(&changed)[..3], ["push", "drive", "spring"], "what stays keeps its place");
    assert_eq!(names(&changed).last().unwrap(), "wind", "what is new comes behind");
    assert_eq!(names(&changed).len(), 15);
    let drive = changed.effects.iter().find(|effect| effect.name == "drive").unwrap();
    let kind = format!("{:?}", drive.kind);
    assert!(kind.starts_with("Torque(Torque { on: Body(2)"), "{kind}");
    assert_eq!(changed.joints.len(), model.joints.len() + 1);
    assert_eq!(changed.outputs.iter().map(|output| output.name.as_str()).collect::<Vec<_>>(), ["load", "y"]);
    assert_eq!((changed.initial.len(), changed.guess.len()), (2, 1));
    assert_eq!(changed.simulation.duration, 1.0);
    assert_eq!(changed.simulation.stepping, Stepping::Tolerance(1e-4), "instead of the step");
    assert_eq!(changed.simulation.output_step, 0.02);
    assert!(changed.bounds.scan.is_some() && changed.bounds.chebyshev.is_none() && changed.bounds.taylor.is_none());
    let interval = |model: &Description, name: &str| {
        let found = model.parameters.iter().find(|parameter| parameter.name == name).unwrap();
        match &found.value {
            ParameterValue::Interval { nominal, lower, upper } => [*nominal, *lower, *upper],
            ParameterValue::Formula(formula) => [formula.as_number().unwrap(); 3],
        }
    };
    assert_eq!(interval(&changed, "l2"), [0.5; 3], "in the model's millimetres");
    assert_eq!(interval(&changed, "mass"), [0.4, 0.4 - 0.4 * 0.05, 0.4 + 0.4 * 0.05], "of the model's value");

    let further = scene(&text, "further");
    assert_eq!(names(&further)[..3], ["weight", "push", "spring"]);
    assert_eq!(interval(&further, "mass"), [0.3 + (0.6 - 0.3) / 2.0, 0.3, 0.6]);
    assert_eq!(interval(&further, "l2"), [0.5; 3]);
    assert_eq!(further.simulation.stepping, Stepping::Fixed(1e-4));
    // A certain value has no deviation; and a setting of the command line precedes that of a scene.
    let certain = format!("{CRANK}{ASKED}scenes: {{ heavy: {{ parameters: {{ mass: 0.5 }} }} }}\n");
    assert_eq!(interval(&scene(&certain, "heavy"), "mass"), [0.5; 3]);
    let set = Override::parse("mass=0.6±0.1").unwrap();
    let reading = model::read_str("test.yaml", &certain, &[set]);
    assert_eq!(interval(&reading.scenes[0].description, "mass"), [0.6, 0.5, 0.7]);
}

#[test]
fn what_a_model_leaves_out_a_scene_can_put_in() {
    let text = format!("{CRANK}{EFFECTS}{ASKED}without: [weight, load]\nscenes: {{ heavy: {{ with: [weight] }} }}\n");
    let model = model::load_str("test.yaml", &text, &[]).unwrap();
    assert_eq!((model.effects.len(), model.effects[0].name.as_str(), model.outputs.len()), (14, "push", 1));
    let heavy = scene(&text, "heavy");
    assert_eq!((heavy.effects.len(), heavy.effects[0].name.as_str(), heavy.outputs.len()), (15, "weight", 1));
}

#[test]
fn what_is_left_out_is_reported_where_it_is_named() {
    let text = format!("{CRANK}{EFFECTS}{ASKED}scenes: {{ open: {{ without: [wrist, x] }} }}\n");
    let report = model::load_str("test.yaml", &text, &[]).unwrap_err();
    let expected = "\
error[E0401]: unknown joint `wrist`
  --> test.yaml:28:36
   |
28 |   rubbing: { joint_friction: { on: wrist, coefficient: 0.1, radius: 5 mm, coulomb: rub } }
   |                                    ^^^^^
   |
  ::: test.yaml:41:11
   |
41 | scenes: { open: { without: [wrist, x] } }
   |           ---- in this scene
   |
   = help: `wrist` is left out here: leave this out too, or put `wrist` in
";
    assert_eq!(report.render(false), expected);
}

/// A short model of two outputs, in three scenes.
fn door(place: &Place) {
    let text = "
model: door
parameters:
  mass: { value: 20, unit: kg, tolerance: 5% }
  rub: { value: 2, unit: N*m*s/rad, tolerance: 10% }
bodies: { leaf: { mass: mass, inertia: 1.4, points: { hinge: [-0.45, 0] } } }
joints: { hinge: { revolute: [ground, leaf.hinge] } }
effects:
  closer: { torsional_spring_damper: { on: hinge, stiffness: 9, damping: 9 } }
  friction: { joint_friction: { on: hinge, viscous: rub } }
initial: { hinge.angle: 1, hinge.angular_velocity: 0 }
outputs: { angle: hinge.angle }
simulation: { duration: 0.2, step: 2e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 2 }, scan: { points: 3 } }
scenes:
  ideal: { without: [friction] }
  friction: { outputs: { lost: friction.torque } }
  long: { extends: ideal, simulation: { duration: 0.4 }, bounds: { scan: { points: 4 } } }
";
    fs::write(place.path().join("door.yaml"), text).unwrap();
}

#[test]
fn scenes_are_run_each_by_itself_and_shown_side_by_side() {
    let place = Place::new();
    door(&place);
    let (output, errors) = place.run("run door.yaml", 0);
    assert_eq!(errors, "");
    let all = ["angle.svg", "friction", "ideal", "long", "report.html", "scenes.csv", "scenes.json"];
    assert_eq!(place.files("results/door"), all);
    for text in ["door: 3 scenes", "angle.chebyshev", "lost.chebyshev", "angle.scan", "seconds", "largest width"] {
        assert!(output.contains(text), "{text} in\n{output}");
    }
    assert!(
        output.ends_with("  results/door: angle.svg, scenes.csv, report.html, scenes.json; ideal/, friction/, long/\n"),
        "{output}"
    );
    let summary = fs::read_to_string(place.path().join("results/door/ideal/summary.json")).unwrap();
    assert!(summary.contains("\"model\": \"door/ideal\"") && !summary.contains("seconds"), "{summary}");

    // The long table agrees with the wide ones.
    let long = fs::read_to_string(place.path().join("results/door/scenes.csv")).unwrap();
    assert_eq!(long.lines().next(), Some("scene,output,unit,method,t,nominal,lower,upper,error,unresolved"));
    let rows: Vec<Vec<&str>> = long.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 2 * 11 + 2 * 2 * 11 + 21);
    let mut seen = BTreeSet::new();
    for scene in ["ideal", "friction", "long"] {
        let wide = fs::read_to_string(place.path().join(format!("results/door/{scene}/bounds.csv"))).unwrap();
        let headings: Vec<&str> = wide.lines().next().unwrap().split(',').collect();
        let wide: Vec<Vec<&str>> = wide.lines().skip(1).map(|line| line.split(',').collect()).collect();
        for (place, row) in rows.iter().filter(|row| row[0] == scene).enumerate() {
            let of = &wide[place % wide.len()];
            let cell = |name: String| of[headings.iter().position(|heading| *heading == name).unwrap()];
            assert_eq!(row[4], of[0]);
            assert_eq!(row[5], cell(format!("{}.nominal", row[1])));
            for (column, end) in [(6, "lower"), (7, "upper"), (8, "error")] {
                assert_eq!(row[column], cell(format!("{}.{}.{end}", row[1], row[3])));
            }
            assert_eq!(row[9], "false");
            seen.insert(format!("{}.{}.{} {}", row[0], row[1], row[3], row[2]));
        }
    }
    let expected = [
        "friction.angle.chebyshev rad",
        "friction.angle.scan rad",
        "friction.lost.chebyshev N*m",
        "friction.lost.scan N*m",
        "ideal.angle.chebyshev rad",
        "ideal.angle.scan rad",
        "long.angle.scan rad",
    ];
    assert_eq!(seen.iter().map(String::as_str).collect::<Vec<_>>(), expected);
    // Only outputs of several scenes are overlaid; where methods differ, they are named.
    let svg = fs::read_to_string(place.path().join("results/door/angle.svg")).unwrap();
    assert!(["ideal (chebyshev)", "friction (chebyshev)", "long (scan)"].iter().all(|label| svg.contains(label)));

    let again = Place::new();
    door(&again);
    assert_eq!(again.run("run door.yaml -q -j 1", 0), (String::new(), String::new()));
    for file in ["scenes.csv", "angle.svg", "friction/summary.json", "friction/lost.svg"] {
        let read = |place: &Place| fs::read(place.path().join("results/door").join(file)).unwrap();
        assert!(read(&place) == read(&again), "{file}: the same bytes on any number of threads");
    }
}

#[test]
fn scenes_are_chosen_by_name() {
    let place = Place::new();
    door(&place);
    // One by itself is run as a model is.
    let (output, _) = place.run("run door.yaml --scene friction -o one --timings", 0);
    assert!(output.starts_with("door/friction: 1 joint coordinate,"), "{output}");
    assert_eq!(place.files("one"), ["friction"]);
    assert!(fs::read_to_string(place.path().join("one/friction/summary.json")).unwrap().contains("\"seconds\""));
    let (output, _) = place.run("run door.yaml --scene long --scene ideal -o two", 0);
    assert!(output.starts_with("door: 2 scenes"), "{output}");
    assert_eq!(place.files("two"), ["angle.svg", "ideal", "long", "report.html", "scenes.csv", "scenes.json"]);
    place.run("run door.yaml --scene long,ideal -o three -q", 0);
    assert_eq!(place.files("three"), place.files("two"));
    // Scenes of several models have the models' folders.
    place.model("crank");
    place.run("run door.yaml crank.yaml -o all -q", 0);
    assert_eq!(place.files("all"), ["crank", "door"]);
    assert!(
        place.path().join("all/crank/bounds.csv").exists() && place.path().join("all/door/long/bounds.csv").exists()
    );

    for (arguments, message) in [
        ("run door.yaml --scene frction", "door.yaml: there is no scene `frction`: did you mean `friction`?"),
        (
            "run door.yaml --scene windy",
            "door.yaml: there is no scene `windy`: the scenes are `ideal`, `friction` and `long`",
        ),
        ("run crank.yaml --scene ideal", "crank.yaml: there is no scene `ideal`: the model has no `scenes`"),
        ("explain door.yaml --scene idael", "door.yaml: there is no scene `idael`: did you mean `ideal`?"),
        ("cost door.yaml --scene idael", "door.yaml: there is no scene `idael`: did you mean `ideal`?"),
        ("run door.yaml --set mas=2", "did you mean `mass`?"),
    ] {
        let output = if arguments.starts_with("explain") { "" } else { " -o nowhere" };
        let (_, errors) = place.run(&format!("{arguments}{output}"), 2);
        assert!(errors.contains(message), "{arguments}: {errors}");
        assert_eq!(errors.matches("error[").count(), 1, "said once: {errors}");
    }
    assert!(!place.path().join("nowhere").exists());
}

#[test]
fn check_and_explain_know_scenes() {
    let place = Place::new();
    door(&place);
    let (output, _) = place.run("check door.yaml", 0);
    let lines: Vec<&str> = output.lines().filter(|line| line.starts_with("ok ")).collect();
    assert_eq!(lines.len(), 3, "{output}");
    assert!(
        lines[0].starts_with("ok door/ideal: 1 joint coordinate,") && lines[0].contains("1 uncertain parameter,"),
        "{output}"
    );
    assert!(lines[1].starts_with("ok door/friction: ") && lines[1].contains("2 uncertain parameters"), "{output}");
    let (output, _) = place.run("check --format json door.yaml", 0);
    let json: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!(json[0]["ok"], true);
    assert_eq!(json[0]["scenes"][1]["scene"], "friction");
    assert_eq!(json[0]["scenes"][1]["uncertain_parameters"], serde_json::json!(["mass", "rub"]));
    let effects = |arguments: &str| explained(&place, arguments)["effects"].as_array().unwrap().len();
    assert_eq!((effects("door.yaml"), effects("door.yaml --scene ideal")), (2, 1));
    let (output, _) = place.run("explain door.yaml --scene ideal", 0);
    assert!(output.starts_with("door/ideal\n"), "{output}");
}

/// A four-bar whose rocker does not reach in one scene.
#[test]
fn a_scene_that_fails_does_not_take_the_others_with_it() {
    let place = Place::new();
    let text = "
model: rocker
parameters: { rod: { value: 1.2, tolerance: 1% }, torque: 1 }
bodies:
  ground: { points: { post: [1, 0] } }
  crank: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.3, 0] } }
  rocker: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.8, 0] } }
joints:
  pivot: { revolute: [ground, crank.A] }
  post: { revolute: [ground.post, rocker.A] }
  coupler: { distance: { between: [crank.B, rocker.B], length: rod } }
effects: { drive: { torque: { on: crank, value: torque } } }
initial: { crank.angle: 0, crank.angular_velocity: 0 }
guess: { rocker.x: 1, rocker.angle: 90 deg }
outputs: { angle: crank.angle }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.01 }
bounds: { scan: { points: 3 } }
";
    let scenes = "scenes:\n  fine: {}\n  short: { parameters: { rod: { value: 0.01, tolerance: 1% } } }\n  also_fine: { parameters: { torque: 2 } }\n";
    fs::write(place.path().join("rocker.yaml"), format!("{text}{scenes}")).unwrap();
    // `check` refuses it, too.
    let (output, errors) = place.run("run rocker.yaml", 2);
    assert!(errors.starts_with("error[E0901]: rocker/short: "), "{errors}");
    assert_eq!(errors.matches("error").count(), 1, "{errors}");
    let failed = output.lines().find(|line| line.trim_start().starts_with("short")).unwrap();
    assert!(failed.ends_with("failed"), "{output}");
    assert!(output.ends_with("angle.svg, scenes.csv, report.html, scenes.json; fine/, also_fine/\n"), "{output}");
    let table = fs::read_to_string(place.path().join("results/rocker/scenes.csv")).unwrap();
    let named: BTreeSet<&str> = table.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(named.into_iter().collect::<Vec<_>>(), ["also_fine", "fine"]);
    // `check` reports, scene by scene, whether they can be assembled.
    let (output, errors) = place.run("check rocker.yaml", 2);
    assert_eq!(output.lines().filter(|line| line.starts_with("ok ")).count(), 2, "{output}");
    assert!(errors.starts_with("error[E0901]: rocker.yaml: scene short: "), "{errors}");
}

#[test]
fn a_robots_effects_are_left_out_and_its_limits_become_stops() {
    let place = Place::new();
    let robot = r#"<robot name="r">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-0.2" upper="0.4" effort="10" velocity="1"/><dynamics damping="0.3" friction="0.1"/></joint>
</robot>"#;
    fs::write(place.path().join("arm.urdf"), robot).unwrap();
    let model = |name: &str, more: &str| {
        let text = format!(
            "model: {name}\nurdf: arm.urdf\nparameters: {{ link.arm.mass: 5%, joint.hinge.damping: 10%, joint.hinge.limit.upper: ± 0.05 }}\n\
             effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}{more}\n\
             outputs: {{ angle: hinge.angle, speed: hinge.angular_velocity }}\n\
             simulation: {{ duration: 1, step: 1e-3, output_step: 0.02 }}\nbounds: {{ scan: {{ points: 5 }} }}\n"
        );
        fs::write(place.path().join(format!("{name}.yaml")), text).unwrap();
    };
    let impact = "impact: { stiffness: 500, dissipation: 0.5 }";
    let scenes = format!(
        " }}
scenes:
  as_it_is: {{}}
  stopped: {{ limits: {{ {impact} }} }}
  undamped: {{ without: [hinge.damping], limits: {{ {impact} }} }}
  free: {{ extends: undamped, without: all, with: [weight] }}
  rubbing: {{ extends: free, with: [hinge.friction] }}"
    );
    model("robot", &scenes);
    let stop = format!(
        ", end: {{ stop: {{ on: hinge, lower: joint.hinge.limit.lower, upper: joint.hinge.limit.upper, {impact} }} }} }}"
    );
    model("by_hand", &stop);
    place.run("run -q robot.yaml", 0);
    place.run("run -q by_hand.yaml", 0);
    let table = |name: &str| fs::read_to_string(place.path().join("results").join(name).join("bounds.csv")).unwrap();
    // A limit equals the stop that is written out, but effects add up in another order.
    let numbers = |name: &str| -> Vec<f64> {
        let cells = table(name);
        let cells = cells.lines().skip(1).flat_map(|line| line.split(',').filter_map(|cell| cell.parse().ok()));
        cells.collect()
    };
    let (limited, stopped) = (numbers("robot/stopped"), numbers("by_hand"));
    assert_eq!((limited.len(), limited.len()), (stopped.len(), 51 * 9));
    for (limited, stopped) in limited.iter().zip(&stopped) {
        assert!((limited - stopped).abs() < 1e-10, "{limited} {stopped}");
    }
    let effects = |scene: &str| {
        let names: Vec<String> = explained(&place, &format!("robot.yaml --scene {scene}"))["effects"]
            .as_array()
            .unwrap()
            .iter()
            .map(|effect| effect["name"].as_str().unwrap().to_owned())
            .collect();
        names.join(" ")
    };
    assert_eq!(effects("as_it_is"), "weight hinge.damping hinge.friction");
    assert_eq!(effects("stopped"), "weight hinge.damping hinge.friction hinge.limit");
    assert_eq!(effects("undamped"), "weight hinge.friction hinge.limit");
    assert_eq!(effects("free"), "weight");
    assert_eq!(effects("rubbing"), "weight hinge.friction");
    // Parameters that act only in omitted elements are not varied.
    let uncertain = |scene: &str| explained(&place, &format!("robot.yaml --scene {scene}"))["parameters"].clone();
    assert_eq!(uncertain("as_it_is"), serde_json::json!(["link.arm.mass", "joint.hinge.damping"]));
    assert_eq!(uncertain("undamped"), serde_json::json!(["link.arm.mass", "joint.hinge.limit.upper"]));
    assert_eq!(uncertain("free"), serde_json::json!(["link.arm.mass"]));
    // Falling freely it passes the limit; the stop holds it near.
    let largest = |name: &str| {
        let column = |line: &str| line.split(',').nth(1).unwrap().parse::<f64>().unwrap();
        table(name).lines().skip(1).map(column).fold(f64::NEG_INFINITY, f64::max)
    };
    assert!(largest("robot/as_it_is") > 1.0 && largest("robot/free") > 1.0);
    assert!((0.4..0.6).contains(&largest("robot/stopped")), "{}", largest("robot/stopped"));
}

#[cfg(unix)]
#[test]
fn a_ctrl_c_keeps_the_scenes_that_are_done() {
    use std::process::{Command, Stdio};
    let place = Place::new();
    door(&place);
    let path = place.path().join("door.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let slow = "  slow: { simulation: { duration: 8, step: 1e-4 }, bounds: { scan: { points: 150 } } }\n  never: {}\n";
    fs::write(path, format!("{text}{slow}")).unwrap();
    let run =
        place.command("run --yes door.yaml -o out").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let summary = place.path().join("out/long/summary.json");
    // The scene before the slow one is done: now it is the slow one's turn.
    for _ in 0..600 {
        if summary.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    std::thread::sleep(std::time::Duration::from_millis(2000));
    assert!(Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap().success());
    let ended = run.wait_with_output().unwrap();
    let (output, errors) = (String::from_utf8(ended.stdout).unwrap(), String::from_utf8(ended.stderr).unwrap());
    assert_eq!(ended.status.code(), Some(130), "{errors}");
    assert!(errors.contains("error: door/slow: interrupted"), "{errors}");
    assert!(output.starts_with("door: 5 scenes, 1 of them was not run"), "{output}");
    assert!(!place.path().join("out/never/bounds.csv").exists());
    let table = fs::read_to_string(place.path().join("out/scenes.csv")).unwrap();
    for scene in ["ideal,", "friction,", "long,", "slow,"] {
        assert!(table.lines().any(|line| line.starts_with(scene)), "{scene}");
    }
}

#[test]
fn a_part_of_a_box_is_said_to_be_one() {
    let place = Place::new();
    let text = "
model: arm
parameters: { reach: { value: 1.0, tolerance: 0.2 } }
bodies:
  ground: { points: { post: [1.1, 0] } }
  crank: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.3, 0] } }
joints:
  pivot: { revolute: [ground, crank.A] }
  rod: { distance: { between: [ground.post, crank.B], length: reach } }
outputs: { angle: crank.angle }
guess: { crank.angle: 1 }
initial: {}
simulation: { duration: 0.02, step: 1e-3, output_step: 0.01 }
bounds: { scan: { points: 3 } }
scenes: { part: { parameters: { reach: { interval: [0.7, 1.2] } } }, whole: { parameters: { reach: { interval: [0.9, 1.2] } } } }
";
    fs::write(place.path().join("arm.yaml"), text).unwrap();
    place.run("run arm.yaml -q --skip-infeasible", 0);
    let table = fs::read_to_string(place.path().join("results/arm/scenes.csv")).unwrap();
    assert!(table.lines().next().unwrap().ends_with(",covered"), "{table}");
    let covered = |scene: &str| {
        let row = table.lines().find(|line| line.starts_with(scene)).unwrap();
        row.rsplit(',').next().unwrap().parse::<f64>().unwrap()
    };
    assert!(covered("part,") < 0.9 && covered("whole,") == 1.0, "{table}");
}

/// `docs/guides/scenes.md` shows models that are right.
#[test]
fn the_examples_are_right() {
    let page = include_str!("../../docs/guides/scenes.md");
    let blocks: Vec<&str> =
        page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("yaml\n")).collect();
    let model = include_str!("../../models/door.yaml");
    assert!(model.contains(blocks[0].trim_end()), "the first example is a part of models/door.yaml");
    for text in &blocks[1..] {
        let report = model::read_str("models/page.yaml", text, &[]).diagnostics;
        assert!(!report.has_errors(), "{}", report.render(false));
    }
}

/// An output that is called like an effect or a joint stays when the effect or joint is omitted.
#[test]
fn what_is_left_out_is_the_effect_and_not_the_output_of_its_name() {
    let text = format!(
        "{CRANK}{EFFECTS}outputs: {{ drive: slider.x, spring: rod.x }}\nwithout: [drive]\nscenes: {{ slack: {{ without: [spring] }} }}\n"
    );
    let simulation = "simulation: { duration: 0.1, step: 1e-3 }\n";
    let description = scene(&format!("{text}{simulation}"), "slack");
    let outputs: Vec<&str> = description.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!(outputs, ["drive", "spring"]);
    assert!(description.effects.iter().all(|effect| effect.name != "drive" && effect.name != "spring"));
}
