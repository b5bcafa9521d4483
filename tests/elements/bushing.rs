//! Bushings: energy stored by springs and taken by dampers.

use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};

#[test]
fn stored_energy_of_springs_equals_work_done() {
    assert_balance(
        &pair(
            "",
            "  e: { bushing: { between: [a.P, b.P], stiffness_matrix: [[30, 4, 0, 0, 0, 2], [4, 50, 0, 0, 0, -3], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [2, -3, 0, 0, 0, 5]] } }",
            APART,
        ),
        "0",
    );
    assert_balance(
        &spatial_pair(
            "",
            "  e: { bushing: { between: [a.P, b.P], stiffness: [30, 50, 80], torsional_stiffness: [3, 5, 8] } }",
            APART_IN_SPACE,
        ),
        "0",
    );
}

/// Seen from the first body.
#[test]
fn dampers_resist_only_relative_motion() {
    assert_balance(
        &pair("", "  e: { bushing: { between: [a.P, b.P], damping: 3, torsional_damping: 2 } }", APART),
        "-3*((b.P.vx - a.P.vx + a.angular_velocity*(b.P.y - a.P.y))^2 + (b.P.vy - a.P.vy - a.angular_velocity*(b.P.x - a.P.x))^2) - 2*(b.angular_velocity - a.angular_velocity)^2",
    );
}
