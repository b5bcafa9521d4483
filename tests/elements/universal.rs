//! Universal joints: the uneven motion of the driven shaft.

use std::f64::consts::TAU;

use crate::common::power::{assert_balance, spatial_pair};
use crate::common::{curve, distance_from, model, nominal, order, row};

/// Positions are those of closed loops: Newton ends at 1e-11 of the model's size.
const CLOSED: f64 = 1e-9;

#[test]
fn a_universal_joint_turns_unevenly() {
    let bend = 30_f64.to_radians();
    let description =
        model("universal_joint").observing(&["driven.omega_body.x", "driven.rim.x", "driven.rim.y", "driven.rim.z"]);
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    // At the start the driving arm of the cross is across the plane of the shafts: tan θ₂ = tan θ₁ cos β.
    let driven = |t: f64| {
        let (sin, cos) = (TAU * t).sin_cos();
        (sin * bend.cos()).atan2(cos)
    };
    let bounds = &runs[1];
    let rim = ["driven.rim.x", "driven.rim.y", "driven.rim.z"].map(|name| curve(bounds, name));
    for (k, &t) in bounds.times.iter().enumerate() {
        let across = -rim[0][k] * bend.sin() + rim[1][k] * bend.cos();
        let angle = (-across).atan2(rim[2][k]);
        let off = (angle - driven(t) + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        assert!(off.abs() < CLOSED, "at {t} s the angle is {angle}, not {}", driven(t));
    }
    let speed = |t: f64| TAU * bend.cos() / (1.0 - (bend.sin() * (TAU * t).sin()).powi(2));
    let first = row(bounds, 0.1);
    let errors = runs
        .each_ref()
        .map(|run| distance_from(&run.times[first..], &curve(run, "driven.omega_body.x")[first..], speed));
    println!("speed {errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    assert!(errors[1] < 1e-3, "{errors:?}");
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { universal: [a.P, b.P] }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.vx: 0.2",
        ),
        "0",
    );
}
