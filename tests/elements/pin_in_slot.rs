//! Pins in registers: the scotch yoke.

use std::f64::consts::TAU;

use crate::common::power::{assert_balance, pair};
use crate::common::{largest, model, nominal};

#[test]
fn yoke_follows_the_pin() {
    let bounds = nominal(&model("scotch_yoke").observing(&["yoke.x - radius*cos(wheel.angle)", "wheel.angle"]));
    assert!(largest(bounds.outputs[0].nominal.iter().copied()) < 1e-12);
    // Several turns were made, so that the comparison is meaningful.
    assert!(bounds.outputs[1].nominal.last().unwrap() > &(2.0 * TAU));
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { pin_in_slot: { between: [a.P, b.P], axis: [1, 2] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.angle: -0.6\n  b.angular_velocity: 1.3\n  b.x: 0.9\n  b.vx: 0.3",
        ),
        "0",
    );
}
