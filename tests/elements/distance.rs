//! Rods of fixed length: the conical pendulum, and MSC Adams.

use crate::common::adams::{Case, compared_with_adams};
use crate::common::power::{assert_balance, pair, spatial_pair};
use crate::common::{curve, distance_from, nominal, order, read};

/// A bob on a string goes round at ω² = g / (L cos 30°), also where it only turns about z, and as a whole body.
#[test]
fn a_conical_pendulum_goes_round() {
    let (length, height) = (0.8_f64, 0.8 * 30_f64.to_radians().cos());
    let omega = (9.81 / height).sqrt();
    for body in [
        "mass: 2, coordinates: [x, y, z]",
        "mass: 2, inertia: 0.1, coordinates: [x, y, z, angle]",
        "mass: 2, inertia: 0.1",
    ] {
        let description = read(&format!(
            "
bodies: {{ bob: {{ {body} }} }}
joints: {{ string: {{ distance: {{ between: [ground, bob], length: {length} }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial: {{ bob.x: {}, bob.y: 0, bob.vy: {}, bob.vx: 0, bob.vz: 0 }}
guess: {{ bob.z: -0.6 }}
outputs: {{ x: bob.x, z: bob.z, pull: string.force, up: string.force.z }}
simulation: {{ duration: 3, step: 2e-3, output_step: 0.02 }}
",
            0.5 * length,
            0.5 * length * omega,
        ));
        let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h)));
        let errors =
            runs.each_ref().map(|run| distance_from(&run.times, curve(run, "x"), |t| 0.5 * length * (omega * t).cos()));
        assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1 && errors[1] < 1e-4, "{body}: {errors:?}");
        assert!(distance_from(&runs[1].times, curve(&runs[1], "z"), |_| -height) < 1e-4, "{body}");
        assert!(distance_from(&runs[1].times, curve(&runs[1], "up"), |_| 2.0 * 9.81) < 1e-3, "{body}");
        // With a tolerance, the steps find themselves.
        let controlled = nominal(&description.tolerance(1e-7));
        let off = distance_from(&controlled.times, curve(&controlled, "x"), |t| 0.5 * length * (omega * t).cos());
        assert!(off < 1e-3, "{body}: {off:e}");
    }
}

const ADAMS: Case = Case {
    name: "distance_constraint/Distance",
    velocities: "distance_constraint/Distance",
    text: "bodies:
  a: { mass: 1, inertia: [0.04, 0.1, 0.1] }
joints: { j: { distance: { between: [ground, a], length: 2 } } }
initial: { a.orientation: { axis: x, angle: 0 }, a.x: 0, a.z: 0 }
guess: { a.y: 2 }",
    at_one: [0.0, -0.956545, -1.756423, 1.0, 0.0, 0.0, 0.0, 0.0, 12.35703, 22.69017, 0.0, 0.0, 0.0],
};

compared_with_adams!(ADAMS);

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { distance: { between: [a.P, b.P], length: 0.8 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.angle: -0.6\n  b.angular_velocity: 1.3\n  b.x: 0.9\n  b.vx: 0.3",
        ),
        "0",
    );
    assert_balance(
        &spatial_pair(
            "  j: { distance: { between: [a.P, b.P], length: 0.8 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.omega: [-0.2, 0.5, 1.3]",
        ),
        "0",
    );
}
