//! Torsional springs and dampers: the torsional pendulum, and MSC Adams.

use crate::common::adams::{Case, compared_with_adams};
use crate::common::closed_forms::assert_converges;
use crate::common::power::{APART, assert_balance, pair};
use crate::common::read;

#[test]
fn a_torsional_pendulum_twists() {
    let description = read(
        "
bodies:
  disk: { inertia: 0.04, coordinates: [angle] }
effects:
  wire: { torsional_spring_damper: { between: [ground, disk], stiffness: 1, free_angle: 0.5 } }
initial: { disk.angle: 2, disk.angular_velocity: 0 }
outputs: { angle: disk.angle, energy: energy }
simulation: { duration: 4, step: 1e-3, output_step: 0.02 }
",
    );
    let omega = (1.0_f64 / 0.04).sqrt();
    assert_converges(&description, 1e-3, "angle", 1e-7, |t| 0.5 + 1.5 * (omega * t).cos());
    assert_converges(&description, 1e-3, "energy", 1e-7, |_| 0.5 * 1.5 * 1.5);
}

const ADAMS: Case = Case {
    name: "rotspring_force/RotSpring",
    velocities: "rotspring_force/RotSpring",
    text: "bodies:
  ground: { points: { O: { rotation: { axis: x, angle: -90 deg } } } }
  a: { mass: 1, inertia: [0.04, 0.1, 0.1], points: { P: [-2, 0, 0] } }
joints: { j: { revolute: [ground.O, a.P] } }
effects: { s: { torsional_spring_damper: { on: j, stiffness: 200, damping: 10 } } }
initial: { a.orientation: { axis: x, angle: -90 deg } }",
    at_one: [
        1.994921, 0.0, -0.1424453, 0.7066577, -0.7066577, 0.02519702, 0.02519702, -0.1710964, 0.0, 7.811281, 0.0,
        0.1201785, 0.0,
    ],
};

compared_with_adams!(ADAMS);

#[test]
fn springs_store_and_dampers_dissipate_energy() {
    assert_balance(
        &pair(
            "",
            "  e: { torsional_spring_damper: { between: [a, b], stiffness: 5, damping: 0.3, free_angle: 0.2 } }",
            APART,
        ),
        "-0.3*(b.angular_velocity - a.angular_velocity)^2",
    );
}
