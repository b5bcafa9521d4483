//! Screws: advance and inertia.

use mbint::Formulation;

use std::f64::consts::TAU;

use crate::common::power::{assert_balance, spatial_pair};
use crate::common::{curve, distance_from, largest, nominal, order, read, richardson};

/// s = pitch φ / 2π over several turns, and (J + m (pitch/2π)²) φ̈ = τ.
#[test]
fn a_screw_advances_by_its_pitch() {
    let description = read(
        "
bodies:
  ground: { points: { O: { rotation: { rpy: [0.3, -0.5, 0.2] } } } }
  nut: { mass: 2, inertia: [0.01, 0.02, 0.03] }
joints: { thread: { screw: { between: [ground.O, nut], axis: x, pitch: 40 mm } } }
effects: { drive: { torque: { on: thread, value: 0.05 } } }
initial: { thread.angle: 0, thread.angular_velocity: 3 }
outputs: { angle: thread.angle, along: thread.displacement, force: thread.force, torque: thread.torque }
simulation: { duration: 4, step: 1e-2, output_step: 0.1 }
",
    );
    let absolute = description.clone().formulation(Formulation::Absolute);
    let advance = 0.04 / TAU;
    let acceleration = 0.05 / (0.01 + 2.0 * advance * advance);
    let runs = [1e-2, 5e-3].map(|h| nominal(&absolute.clone().step(h)));
    let angle = |t: f64| 3.0 * t + 0.5 * acceleration * t * t;
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "angle"), angle));
    println!("angle {errors:?} of {}", angle(4.0));
    assert!(angle(4.0) > 7.0 * TAU);
    assert!(order(errors[0], errors[1]) > 1.9, "{errors:?}");
    let extrapolated = richardson(curve(&runs[0], "angle"), curve(&runs[1], "angle"));
    assert!(distance_from(&runs[0].times, &extrapolated, angle) < 2e-3);
    let along = runs[1].outputs[1].nominal.iter().zip(&runs[1].outputs[0].nominal);
    assert!(largest(along.map(|(along, angle)| along - advance * angle)) < 1e-10);
    // Its angle alone has a constant acceleration, which the steps follow; the displacement is defined by it.
    let run = nominal(&description);
    assert!(distance_from(&run.times, curve(&run, "angle"), angle) < 1e-9);
    assert!(distance_from(&run.times, curve(&run, "along"), |t| advance * angle(t)) < 1e-10);
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { screw: { between: [a.P, b.P], axis: [0, 1, 0.2], pitch: 0.3 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "0",
    );
}
