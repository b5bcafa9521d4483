//! Backlash: an elastic blow between two wheels.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{curve, distance_from, nominal, read, row};

/// Two wheels of one inertia with play between: the first turns through half the play, and then the second has its
/// speed.
#[test]
fn a_gear_takes_up_its_play() {
    let bounds = nominal(&read(
        "
bodies:
  first: { inertia: 0.01, coordinates: [angle] }
  second: { inertia: 0.01, coordinates: [angle] }
effects: { teeth: { backlash: { between: [first, second], ratio: -1, backlash: 0.1, stiffness: 1e4 } } }
initial: { first.angle: 0, first.angular_velocity: 1, second.angle: 0, second.angular_velocity: 0 }
outputs: { first: first.angular_velocity, second: second.angular_velocity, torque: teeth.torque, energy: energy }
simulation: { duration: 0.1, step: 2e-5, output_step: 1e-3 }
",
    ));
    let before = &curve(&bounds, "torque")[..row(&bounds, 0.048)];
    assert!(before.iter().all(|torque| *torque == 0.0));
    // Elastic, and ratio −1: the first stands, the second turns back at its speed.
    assert!(curve(&bounds, "first").last().unwrap().abs() < 1e-3, "{:?}", curve(&bounds, "first").last());
    assert!((curve(&bounds, "second").last().unwrap() + 1.0).abs() < 1e-3);
    assert!(distance_from(&bounds.times, curve(&bounds, "energy"), |_| 0.005) < 1e-5);
}

#[test]
fn stored_energy_equals_work_done() {
    assert_balance(
        &pair(
            "",
            "  e: { backlash: { between: [a, b], ratio: -1.7, offset: 0.1, backlash: 0.02, stiffness: 20, transition: 0.3 } }",
            APART,
        ),
        "0",
    );
}

/// Without play, teeth are a spring: x = θ₂ − ratio θ₁ oscillates with ω² = k (1/I₂ + ratio²/I₁).
#[test]
fn teeth_without_play_are_a_spring() {
    let bounds = nominal(&read(
        "
bodies:
  pinion: { inertia: 0.02, coordinates: [angle] }
  wheel: { inertia: 0.05, coordinates: [angle] }
effects: { mesh: { backlash: { between: [pinion, wheel], ratio: -0.5, backlash: 0, stiffness: 3 } } }
initial: { pinion.angle: 0, wheel.angle: 0.02, pinion.angular_velocity: 0, wheel.angular_velocity: 0 }
outputs: { x: wheel.angle + 0.5*pinion.angle, torque: mesh.torque }
simulation: { duration: 1, step: 5e-4, output_step: 0.01 }
",
    ));
    let omega = (3.0_f64 * (1.0 / 0.05 + 0.25 / 0.02)).sqrt();
    let error = distance_from(&bounds.times, curve(&bounds, "x"), |t| 0.02 * (omega * t).cos());
    assert!(error < 1e-6, "{error:e}");
    let error = distance_from(&bounds.times, curve(&bounds, "torque"), |t| 0.06 * (omega * t).cos());
    assert!(error < 1e-5, "{error:e}");
}
