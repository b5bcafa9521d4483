//! Inconsistent initial velocities name the joint they are inconsistent with. (Positions that do not:
//! `tests/program/faults/infeasible.rs`.)

use crate::common::refused;

#[test]
fn inconsistent_velocities_are_reported() {
    let message = refused(
        "
bodies: { rod: { mass: 1, inertia: 0.1, points: { top: [0, 0.5] } } }
joints: { hinge: { revolute: [ground, rod.top] } }
initial: { rod.angle: 0, rod.vx: 1, rod.angular_velocity: 0 }
outputs: { angle: rod.angle }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.05 }
",
    );
    println!("{message}");
    assert!(message.contains("initial velocities are inconsistent with joint `hinge`"), "{message}");
}
