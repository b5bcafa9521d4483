//! Scenes: their meaning, and that each is compiled for itself.

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

pub(super) fn explained(place: &Place, arguments: &str) -> serde_json::Value {
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
fn scene_changes_only_its_own_keys() {
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
fn scenes_may_restore_omitted_parts() {
    let text = format!("{CRANK}{EFFECTS}{ASKED}without: [weight, load]\nscenes: {{ heavy: {{ with: [weight] }} }}\n");
    let model = model::load_str("test.yaml", &text, &[]).unwrap();
    assert_eq!((model.effects.len(), model.effects[0].name.as_str(), model.outputs.len()), (14, "push", 1));
    let heavy = scene(&text, "heavy");
    assert_eq!((heavy.effects.len(), heavy.effects[0].name.as_str(), heavy.outputs.len()), (15, "weight", 1));
}

#[test]
fn references_to_omitted_parts_are_reported() {
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
   = help: `wrist` is omitted here: omit this too, or put `wrist` in
";
    assert_eq!(report.render(false), expected);
}

#[test]
#[ignore = "3 s"]
fn scenes_omit_effects_and_limits_of_a_robot() {
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
fn omission_of_an_effect_keeps_the_output_of_its_name() {
    let text = format!(
        "{CRANK}{EFFECTS}outputs: {{ drive: slider.x, spring: rod.x }}\nwithout: [drive]\nscenes: {{ slack: {{ without: [spring] }} }}\n"
    );
    let simulation = "simulation: { duration: 0.1, step: 1e-3 }\n";
    let description = scene(&format!("{text}{simulation}"), "slack");
    let outputs: Vec<&str> = description.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!(outputs, ["drive", "spring"]);
    assert!(description.effects.iter().all(|effect| effect.name != "drive" && effect.name != "spring"));
}
