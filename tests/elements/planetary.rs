//! Planetary sets: Willis' equation, torques, inertia.

use mbint::Model;
use mbint::results::Bounds;

use crate::common::closed_forms::{assert_exact, assert_exact_force};
use crate::common::{nominal, read};

/// Inertias of sun, ring and carrier, kg m²; ring teeth per tooth of the sun; torque on the first member named, N m.
const INERTIA: [f64; 3] = [0.02, 0.5, 0.3];
const RATIO: f64 = 3.0;
const DRIVE: f64 = 0.6;

fn text(members: &[&str], joints: &str, set: &str) -> String {
    let body = |(name, inertia)| format!("  {name}: {{ inertia: {inertia}, mass: 1 }}\n");
    let bodies = ["sun", "ring", "carrier"].into_iter().zip(INERTIA).filter(|(name, _)| members.contains(name));
    let bodies: String = bodies.map(body).collect();
    let initial: Vec<String> =
        members.iter().skip(1).map(|name| format!("{name}.angle: 0, {name}.angular_velocity: 0")).collect();
    let outputs: Vec<String> = members.iter().map(|name| format!("{name}: {name}.angular_velocity")).collect();
    format!(
        "
bodies:
{bodies}
joints:
{joints}
  set: {{ planetary: {set} }}
effects: {{ drive: {{ torque: {{ on: {}, value: {DRIVE} }} }} }}
initial: {{ {} }}
outputs: {{ {}, torque: set.torque }}
simulation: {{ duration: 1, step: 0.01, output_step: 0.1 }}
",
        members[0],
        initial.join(", "),
        outputs.join(", ")
    )
}

fn run(members: &[&str]) -> Bounds {
    let joints: String = members.iter().map(|name| format!("  j{name}: {{ revolute: [ground, {name}] }}\n")).collect();
    let set: Vec<String> = members.iter().map(|name| format!("{name}: j{name}")).collect();
    nominal(&read(&text(members, &joints, &format!("{{ {}, ratio: 60/20 }}", set.join(", ")))))
}

/// With the ring fixed the carrier turns 1 + ρ times slower than the sun; with the carrier fixed the ring turns
/// backwards; with the sun fixed the carrier turns with the ring. The driven member feels the other's inertia by the
/// square of the ratio.
#[test]
fn two_members_turn_in_a_ratio() {
    for (members, ratio) in [
        (["sun", "carrier"], 1.0 / (1.0 + RATIO)),
        (["sun", "ring"], -1.0 / RATIO),
        (["ring", "carrier"], RATIO / (1.0 + RATIO)),
        (["carrier", "sun"], 1.0 + RATIO),
    ] {
        let bounds = run(&members);
        let index = |name: &str| ["sun", "ring", "carrier"].iter().position(|known| *known == name).unwrap();
        let [driven, other] = members.map(|name| INERTIA[index(name)]);
        let acceleration = DRIVE / (driven + ratio * ratio * other);
        assert_exact(&bounds, members[0], |t| acceleration * t);
        assert_exact(&bounds, members[1], |t| ratio * acceleration * t);
    }
}

/// Planets that spin: a body with an angle alone, by an equation. With ρ = 3 planets and sun have the same number of
/// teeth, so that ω_p = 2 ω_c − ω_s = −ω_s/2 if the ring is fixed.
#[test]
fn spinning_planets_are_a_separate_body() {
    let of_planets = 0.09;
    let joints = "  jsun: { revolute: [ground, sun] }\n  jcarrier: { revolute: [ground, carrier] }
  spin: { equation: planets.angle = jcarrier.angle - (jsun.angle - jcarrier.angle)*20/20 }\n";
    let text = text(&["sun", "carrier"], joints, "{ sun: jsun, carrier: jcarrier, ratio: 60/20 }");
    let planets = format!("bodies:\n  planets: {{ inertia: {of_planets}, coordinates: [angle] }}\n");
    let bounds = nominal(&read(&text.replace("bodies:\n", &planets)));
    let acceleration = DRIVE / (INERTIA[0] + INERTIA[2] / 16.0 + of_planets / 4.0);
    assert_exact(&bounds, "sun", |t| acceleration * t);
    assert_exact(&bounds, "carrier", |t| acceleration * t / 4.0);
}

/// A differential: α_s + ρ α_r = (1 + ρ) α_c, with the torques 1 : ρ : −(1 + ρ).
#[test]
fn three_members_share_the_torque() {
    let bounds = run(&["sun", "ring", "carrier"]);
    let [sun, ring, carrier] = INERTIA;
    let share = 1.0 / sun + RATIO * RATIO / ring + (1.0 + RATIO) * (1.0 + RATIO) / carrier;
    let lambda = DRIVE / sun / share;
    assert_exact(&bounds, "sun", |t| (DRIVE - lambda) / sun * t);
    assert_exact(&bounds, "ring", |t| -RATIO * lambda / ring * t);
    assert_exact(&bounds, "carrier", |t| (1.0 + RATIO) * lambda / carrier * t);
    assert_exact_force(&bounds, "torque", |_| -lambda);
}

/// A joint that counts from the wheel to the housing is as good.
#[test]
fn joints_may_have_either_direction() {
    let joints = "  js: { revolute: [sun, ground] }\n  jc: { revolute: [ground, carrier] }\n";
    let bounds = nominal(&read(&text(&["sun", "carrier"], joints, "{ sun: js, carrier: jc, ratio: 3 }")));
    let acceleration = DRIVE / (INERTIA[0] + INERTIA[2] / 16.0);
    assert_exact(&bounds, "sun", |t| acceleration * t);
    assert_exact(&bounds, "carrier", |t| acceleration / 4.0 * t);
}

#[test]
fn incomplete_sets_are_refused() {
    let joints = "  js: { revolute: [ground, sun] }\n  jc: { revolute: [sun, carrier] }\n";
    for (set, message) in [
        ("{ sun: js, ratio: 3 }", "one wheel alone is no planetary set"),
        ("{ sun: js, carrier: js, ratio: 3 }", "`sun` and `carrier` are the same joint"),
        ("{ sun: js, carrier: jc, ratio: -3 }", "positive"),
    ] {
        let report = Model::from_yaml_str("test", &text(&["sun", "carrier"], joints, set)).unwrap_err().to_string();
        assert!(report.contains(message), "{set}: {report}");
    }
}

/// Models that can be read, but whose axes make no planetary set when they are assembled.
#[test]
fn axes_must_be_parallel_and_on_one_body() {
    let model = |joints: &str, set: &str| {
        read(&format!(
            "
space: spatial
bodies:
  sun: {{ mass: 1, inertia: [1, 1, 1] }}
  ring: {{ mass: 1, inertia: [1, 1, 1] }}
  carrier: {{ mass: 1, inertia: [1, 1, 1] }}
joints:
{joints}
  set: {{ planetary: {set} }}
outputs: {{ torque: set.torque }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        ))
    };
    let turned = "
  js: { revolute: [ground, sun] }
  jr: { fixed: [ground, ring] }
  jc: { revolute: { between: [ground, carrier], axis: x } }
";
    let chain =
        "  js: { revolute: [ground, sun] }\n  jr: { revolute: [sun, ring] }\n  jc: { revolute: [ring, carrier] }\n";
    // The sun's angle is that against the carrier: the body in common is the carrier, and the ground would turn on it.
    let on_carrier =
        "  jc: { revolute: [ground, carrier] }\n  js: { revolute: [carrier, sun] }\n  jr: { fixed: [ground, ring] }\n";
    for (joints, set, expected) in [
        (on_carrier, "{ sun: js, carrier: jc, ratio: 3 }", "have to turn on one body that they have in common"),
        (turned, "{ sun: js, carrier: jc, ratio: 3 }", "the axis of `jc` is not parallel to the others"),
        (chain, "{ sun: js, ring: jr, carrier: jc, ratio: 3 }", "have to turn on one body that they have in common"),
    ] {
        let wrong = model(joints, set).unbuilt();
        assert!(wrong.contains(expected), "{wrong}");
    }
}
