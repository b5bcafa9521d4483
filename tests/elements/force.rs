//! Forces at a point: their power.

use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};

#[test]
fn power_is_force_times_velocity_of_its_point() {
    assert_balance(
        &pair("", "  e: { force: { on: a.P, value: [\"3 + 1*t\", \"-2*b.x\"] } }", APART),
        "(3 + t)*a.P.vx - 2*b.x*a.P.vy",
    );
    assert_balance(
        &pair("", "  e: { force: { on: a.P, value: [3, -2], frame: body } }", APART),
        "(3*cos(a.angle) + 2*sin(a.angle))*a.P.vx + (3*sin(a.angle) - 2*cos(a.angle))*a.P.vy",
    );
    assert_balance(
        &spatial_pair("", "  e: { force: { on: a.P, value: [3, -2, 5] } }", APART_IN_SPACE),
        "3*a.P.vx - 2*a.P.vy + 5*a.P.vz",
    );
}
