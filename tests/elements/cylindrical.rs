//! Cylindrical joints: MSC Adams.

use crate::common::adams::{Case, compared_with_adams};
use crate::common::power::{assert_balance, spatial_pair};

const ADAMS: Case = Case {
    name: "cylindrical_joint/Cylindrical",
    velocities: "cylindrical_joint/Cylindrical",
    text: "bodies:
  a: { mass: 1, inertia: [0.04, 0.1, 0.1], points: { P: [-2, 0, 0] } }
joints: { j: { cylindrical: [ground, a.P] } }
initial: { j.displacement: 0, j.angle: 0 }",
    at_one: [2.0, 0.0, -4.90332, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
};

compared_with_adams!(ADAMS);

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { cylindrical: { between: [a.P, b.P], axis: [1, 2, -0.5] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8\n  j.displacement: 0.3\n  j.velocity: -0.8",
        ),
        "0",
    );
}
