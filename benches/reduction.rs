//! Parts that no output needs cost nothing: a model with ten more bodies and a scene that omits effects against the
//! bare one, and separate islands against the same in one.
//!
//! The median of the pairs' ratios is printed, with the quartiles.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod paired;

use std::fmt::Write as _;

use mbint::Model;
use paired::{Paired, paired};

/// Pairs of runs for equal times, and for unequal times.
const EQUAL: usize = 401;
const UNEQUAL: usize = 21;

fn main() {
    let crank = slider_crank(0);
    let beside_crank = |name, other| compare(EQUAL, "slider crank", &crank, name, &other);
    beside_crank("itself", slider_crank(0));
    beside_crank("with ten bodies that no output needs", slider_crank(10));
    beside_crank("a scene of one with eight effects more, none of them in", scene_without());
    for (count, mixed) in [(2, "mixed: p0.x - p1.x"), (3, "mixed: p0.x - p1.x + p2.x")] {
        let name = format!("{count} uncertain pendulums, apart");
        compare(UNEQUAL, &name, &pendulums(count, ""), "as one", &pendulums(count, mixed));
    }
}

fn compare(pairs: usize, name: &str, first: &Model, other_name: &str, other: &Model) {
    let ran = |model: &Model| {
        model.study().threads(1).allow_costly().run().expect("the model runs");
    };
    let Paired { seconds, ratio: [low, ratio, high] } = paired(pairs, [&|| ran(first), &|| ran(other)]);
    let [first, other] = seconds.map(|seconds| 1e3 * seconds);
    println!("{name}: {first:.1} ms, {other_name}: {other:.1} ms, ratio {ratio:.3} ({low:.3} to {high:.3})");
}

/// The slider crank of Wu, Luo & Zhang, with `more` bodies next to it.
fn slider_crank(more: usize) -> Model {
    let text = include_str!("../models/slider_crank.yaml");
    let (mut bodies, mut joints, mut effects) = (String::new(), String::new(), String::new());
    for i in 0..more {
        let before = if i == 0 { "ground".to_owned() } else { format!("idle{}.B", i - 1) };
        _ = writeln!(bodies, "  idle{i}: {{ mass: 1, inertia: 0.1, points: {{ A: [-0.4, 0], B: [0.4, 0] }} }}");
        _ = writeln!(joints, "  idle_joint{i}: {{ revolute: [{before}, idle{i}.A] }}");
        _ = writeln!(
            effects,
            "  idle_spring{i}: {{ spring_damper: {{ between: [ground, idle{i}.B], stiffness: 20, free_length: 0.5 }} }}"
        );
    }
    let add = |text: String, section: &str, lines: &str| text.replacen(section, &format!("{section}{lines}"), 1);
    let text = add(text.to_owned(), "\nbodies:\n", &bodies);
    let text = add(text, "\njoints:\n", &joints);
    let text = add(text, "\neffects:\n", &effects);
    assert_eq!(text.matches("idle_spring").count(), more, "the model has the sections that are added to");
    read("slider_crank.yaml", &shorter(&text))
}

/// The model with a tenth of a second of its motion.
fn shorter(text: &str) -> String {
    let shorter = text.replacen("duration: 2,", "duration: 0.1,", 1);
    assert_ne!(shorter, text, "the model lasts 2 s");
    shorter
}

/// The slider crank with effects of many kinds, in a scene that omits them.
fn scene_without() -> Model {
    let effects = "
  weight: { gravity: { acceleration: [0, -9.81] } }
  coil: { torsional_spring_damper: { on: pivot, stiffness: 0.1 } }
  rubbing: { joint_friction: { on: wrist, coefficient: 0.1, radius: 5 mm } }
  end: { stop: { on: pivot, upper: 3, impact: { stiffness: 100 } } }
  wall: { contact: { between: [ground, rod.C], plane: x, impact: { stiffness: 1e4 } } }
  air: { drag: { on: rod, quadratic: 0.3 } }
  rope: { cable: { between: [ground, rod.C], free_length: 2, stiffness: 10 } }
  pull: { preload: { between: [ground, rod.C], value: 0.1 } }
";
    let text = include_str!("../models/slider_crank.yaml").replacen("\neffects:\n", &format!("\neffects:{effects}"), 1);
    let text = shorter(&text);
    let text =
        format!("{text}\nscenes: {{ bare: {{ without: [weight, coil, rubbing, end, wall, air, rope, pull] }} }}\n");
    read("slider_crank.yaml", &text).scene("bare").unwrap_or_else(|error| panic!("{error}"))
}

/// Unconnected pendulums, the length of each uncertain.
fn pendulums(count: usize, mixed: &str) -> Model {
    let mut text = "model: pendulums\nparameters:\n".to_owned();
    let mut add = |heading: &str, line: &dyn Fn(usize) -> String, last: &str| {
        text += heading;
        (0..count).for_each(|i| _ = writeln!(text, "  {}", line(i)));
        _ = writeln!(text, "  {last}");
    };
    add("", &|i| format!("l{i}: {{ value: 0.{}, unit: m, tolerance: 2% }}", 5 + i), "");
    add("bodies:\n", &|i| format!("p{i}: {{ mass: 1, inertia: 0.02, points: {{ A: [-l{i}/2, 0] }} }}"), "");
    add("joints:\n", &|i| format!("h{i}: {{ revolute: [ground, p{i}.A] }}"), "");
    add("initial:\n", &|i| format!("p{i}.angle: 0.{i}"), "");
    add("outputs:\n", &|i| format!("x{i}: p{i}.x"), mixed);
    text += "effects: { weight: { gravity: { acceleration: [0, -9.81] } } }\n";
    text += "simulation: { duration: 0.1, step: 1e-3 }\nbounds: { chebyshev: { order: 5 } }\n";
    read("pendulums.yaml", &text)
}

fn read(name: &str, text: &str) -> Model {
    Model::from_yaml_str(name, text).unwrap_or_else(|error| panic!("{error}"))
}
