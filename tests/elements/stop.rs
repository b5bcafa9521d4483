//! Stops: the speed that a restitution leaves.

use crate::common::power::{assert_balance, pair};
use crate::common::restitution::restitution;
use crate::common::{curve, nominal, read, row};

/// A pendulum against a stop: it swings to and fro with the angle and the speed that the restitution leaves.
#[test]
fn a_pendulum_hits_its_stop() {
    let description = read(
        "
bodies: { rod: { mass: 1, inertia: 0.02, points: { pin: [0, 0.3] } } }
joints: { hinge: { revolute: [ground, rod.pin] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  block: { stop: { on: hinge, lower: 0, impact: { stiffness: 1e5, restitution: 0.9, impact_velocity: 4, law: hunt_crossley } } }
initial: { rod.angle: 1.2, rod.angular_velocity: 0 }
outputs: { angle: rod.angle, speed: rod.angular_velocity, torque: block.torque, energy: energy }
simulation: { duration: 1.2, step: 5e-5, output_step: 1e-4 }
",
    );
    let bounds = nominal(&description);
    // Without weight's work over the stop's depth of some 1e-2 rad.
    let inertia = 0.02 + 0.09;
    let speed = (2.0 * 9.81 * 0.3 * (1.0 - 1.2_f64.cos()) / inertia).sqrt();
    let expected = restitution(1.5 * 0.1 / 4.0 * speed) * speed;
    let found = curve(&bounds, "speed").iter().copied().fold(0.0, f64::max);
    println!("speed {speed:.4}, then {found:.5}, closed form {expected:.5}");
    assert!((found - expected).abs() < 2e-3 * expected, "{found} {expected}");
    // Apart, exactly nothing acts.
    let early = &curve(&bounds, "torque")[..row(&bounds, 0.2)];
    assert!(early.iter().all(|torque| *torque == 0.0));
}

/// Pressed all the time.
#[test]
fn stored_energy_equals_work_done() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }",
            "  e: { stop: { on: j, lower: 2, impact: { stiffness: 5 } } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "0",
    );
}
