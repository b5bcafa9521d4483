//! Gravity: free fall and flight.

use crate::common::closed_forms::assert_exact;
use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};
use crate::common::{nominal, read};

#[test]
fn free_fall_and_projectile_are_exact() {
    let bounds = nominal(&read(
        "
bodies: { ball: { mass: 0.3, inertia: 0.01, points: { seam: [0.1, 0] } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { ball.x: 1, ball.y: 2, ball.angle: 0, ball.vx: 3, ball.vy: 4, ball.angular_velocity: 5 }
outputs: { x: ball.x, y: ball.y, vy: ball.vy, ay: ball.ay, seam: ball.seam.x, energy: energy }
simulation: { duration: 2, step: 0.01, output_step: 0.1 }
",
    ));
    assert_exact(&bounds, "x", |t| 1.0 + 3.0 * t);
    assert_exact(&bounds, "y", |t| 2.0 + 4.0 * t - 0.5 * 9.81 * t * t);
    assert_exact(&bounds, "vy", |t| 4.0 - 9.81 * t);
    assert_exact(&bounds, "ay", |_| -9.81);
    assert_exact(&bounds, "seam", |t| 1.0 + 3.0 * t + 0.1 * (5.0 * t).cos());
    assert_exact(&bounds, "energy", |_| 0.5 * 0.3 * 25.0 + 0.5 * 0.01 * 25.0 + 0.3 * 9.81 * 2.0);
}

/// Gravity stores the kinetic energy that it takes.
#[test]
fn stored_energy_equals_work_done() {
    assert_balance(&pair("", "", APART), "0");
    assert_balance(&spatial_pair("", "", APART_IN_SPACE), "0");
}
