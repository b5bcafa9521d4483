//! Gears between bodies.

use mbint::Model;

use crate::common::closed_forms::{assert_exact, assert_exact_force};
use crate::common::power::{assert_balance, pair};
use crate::common::{nominal, read};

#[test]
fn a_gear_pair_shares_the_torque() {
    // With θ₂ = −2 θ₁ both wheels weigh on the first shaft: (I₁ + 4 I₂) θ̈₁ = τ.
    let bounds = nominal(&read(
        "
bodies:
  pinion: { inertia: 0.02, coordinates: [angle] }
  wheel: { inertia: 0.005, coordinates: [angle] }
joints: { mesh: { gear: { between: [pinion, wheel], ratio: -2 } } }
effects: { motor: { torque: { on: pinion, value: 0.6 } } }
initial: { pinion.angle: 0, pinion.angular_velocity: 1 }
outputs: { pinion: pinion.angle, wheel: wheel.angle, speed: wheel.angular_velocity, torque: mesh.torque }
simulation: { duration: 1, step: 0.01, output_step: 0.1 }
",
    ));
    let acceleration = 0.6 / (0.02 + 4.0 * 0.005);
    let angle = |t: f64| t + 0.5 * acceleration * t * t;
    assert_exact(&bounds, "pinion", angle);
    assert_exact(&bounds, "wheel", |t| -2.0 * angle(t));
    assert_exact(&bounds, "speed", |t| -2.0 * (1.0 + acceleration * t));
    // The mesh turns the wheel backwards.
    assert_exact_force(&bounds, "torque", |_| -2.0 * 0.005 * acceleration);
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { gear: { between: [a, b], ratio: -2, offset: 0.1 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.x: 0.9\n  b.y: 0.5\n  b.vx: -0.4\n  b.vy: 0.8",
        ),
        "0",
    );
}

/// A ratio does not determine where teeth touch: the reaction of a bearing is refused, with the reason.
#[test]
fn the_reaction_of_a_bearing_is_refused() {
    let text = |what: &str| {
        format!(
            "
bodies:
  ground: {{ points: {{ B: [0.5, 0] }} }}
  a: {{ mass: 1, inertia: 0.1 }}
  b: {{ mass: 2, inertia: 0.3 }}
joints:
  ja: {{ revolute: [ground, a] }}
  jb: {{ revolute: [ground.B, b] }}
  mesh: {{ gear: {{ between: [ja, jb], ratio: -1.5 }} }}
{what}
initial: {{ ja.angle: 0, ja.angular_velocity: 1 }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        )
    };
    for (what, joint) in [
        ("outputs: { push: jb.force.x }", "jb"),
        ("outputs: { push: 2*ja.force }", "ja"),
        (
            "effects: { f: { joint_friction: { on: ja, coefficient: 0.1, radius: 0.01 } } }\noutputs: { a: ja.angle }",
            "ja",
        ),
    ] {
        let report = Model::from_yaml_str("test", &text(what)).unwrap_err().to_string();
        let message = format!("the reaction of `{joint}` is not known: the teeth of `mesh` push on it");
        assert!(report.contains(&message), "{what}: {report}");
    }
    for what in [
        "outputs: { torque: mesh.torque }",
        "effects: { f: { joint_friction: { on: ja, coulomb: 0.1 } } }\noutputs: { a: ja.angle }",
    ] {
        read(&text(what));
    }
}
