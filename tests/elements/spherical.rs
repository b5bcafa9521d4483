//! Spherical joints: MSC Adams.

use crate::common::adams::{Case, compared_with_adams};
use crate::common::power::{assert_balance, spatial_pair};

const ADAMS: Case = Case {
    name: "spherical_joint/Spherical",
    velocities: "revolute_joint/Revolute",
    text: "bodies:
  a: { mass: 1, inertia: [0.04, 0.1, 0.1], points: { P: [-2, 0, 0] } }
joints: { j: { spherical: [ground, a.P] } }
initial: { a.orientation: { axis: x, angle: 0 } }",
    at_one: [-0.892369, 0.0, -1.78988, 0.52622, 0.0, 0.850348, 0.0, 11.4609, 0.0, 23.227, 0.0, 2.92608, 0.0],
};

compared_with_adams!(ADAMS);

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { spherical: [a.P, b.P] }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.orientation: { rpy: [-0.3, 0.1, 0.5] }\n  b.omega: [-0.2, 0.5, 1.3]",
        ),
        "0",
    );
}
