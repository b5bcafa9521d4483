//! Equations between coordinates: their power.

use crate::common::power::{assert_balance, pair};

#[test]
fn power_is_force_times_rate() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }\n  drive: { equation: \"j.angle = 0.3 + sin(3*t)\" }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "",
        ),
        "-drive.force*j.angular_velocity",
    );
}
