//! Preloads against springs.

use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};
use crate::common::{curve, nominal, read};

/// A preload moves a mass on a spring by F/k, and a hinge with its spring by τ/k.
#[test]
fn a_preload_is_held_by_springs() {
    let bounds = nominal(&read(
        "
bodies:
  mass: { mass: 1, inertia: 0.01 }
  arm: { mass: 1, inertia: 0.01 }
joints:
  rail: { prismatic: { between: [ground, mass], axis: x } }
  hinge: { revolute: [ground, arm] }
effects:
  spring: { spring_damper: { between: [ground, mass], along: x, stiffness: 200, damping: 28, free_length: 1 } }
  pull: { preload: { between: [ground, mass], value: 10 } }
  push: { preload: { on: rail, value: 4 } }
  wire: { torsional_spring_damper: { on: hinge, stiffness: 5, damping: 0.4 } }
  twist: { preload: { on: hinge, value: 2 } }
initial: { mass.x: 1, mass.vx: 0, arm.angle: 0, arm.angular_velocity: 0 }
outputs: { x: mass.x, angle: arm.angle, length: spring.length, force: spring.force }
simulation: { duration: 4, step: 1e-3, output_step: 0.1 }
",
    ));
    for (name, value) in [("x", 1.0 - 6.0 / 200.0), ("angle", 0.4), ("length", 0.97), ("force", -6.0)] {
        let last = curve(&bounds, name).last().unwrap();
        assert!((last - value).abs() < 1e-6, "{name}: {last}, not {value}");
    }
}

#[test]
fn stored_energy_equals_work_done() {
    assert_balance(&pair("", "  e: { preload: { between: [a.P, b.P], value: 17 } }", APART), "0");
    assert_balance(&spatial_pair("", "  e: { preload: { between: [a.P, b.P], value: 17 } }", APART_IN_SPACE), "0");
}
