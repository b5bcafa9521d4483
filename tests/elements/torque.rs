//! Torques on bodies and joints: their power.

use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};

#[test]
fn torque_acts_between_two_bodies() {
    assert_balance(
        &pair("", "  e: { torque: { on: b, from: a, value: 4 } }", APART),
        "4*(b.angular_velocity - a.angular_velocity)",
    );
    assert_balance(
        &spatial_pair("", "  e: { torque: { on: b, from: a, value: [1, -2, 3] } }", APART_IN_SPACE),
        "(b.omega.x - a.omega.x) - 2*(b.omega.y - a.omega.y) + 3*(b.omega.z - a.omega.z)",
    );
    assert_balance(
        &pair("  j: { revolute: [a.P, b.P] }", "  e: { torque: { on: j, value: 4 } }", "  j.angle: 0.3"),
        "4*j.angular_velocity",
    );
}
