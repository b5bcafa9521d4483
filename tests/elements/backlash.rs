//! Backlash: an elastic blow between two wheels.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{curve, distance_from, nominal, read, row};

/// Two wheels of one inertia with play between: the first turns through half the play, and then the second has its speed.
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
fn teeth_store_what_they_take() {
    assert_balance(&pair("", "  e: { backlash: { between: [a, b], ratio: -1.7, offset: 0.1, backlash: 0.02, stiffness: 20, transition: 0.3 } }", APART), "0");
}
