//! Points on lines: reactions that do no work.

use crate::common::power::{assert_balance, spatial_pair};

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { point_on_line: { between: [a.P, b.P], axis: [1, 2, -0.5] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.orientation: { rpy: [-0.3, 0.1, 0.5] }\n  b.omega: [-0.2, 0.5, 1.3]\n  b.x: 0.9\n  b.vx: 0.3",
        ),
        "0",
    );
}
