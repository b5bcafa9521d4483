//! Planar joints: reactions that do no work.

use crate::common::power::{assert_balance, spatial_pair};

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { planar: { between: [a.P, b.P], normal: [1, 2, -0.5] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.x: 0.9\n  b.vx: 0.3",
        ),
        "0",
    );
}
