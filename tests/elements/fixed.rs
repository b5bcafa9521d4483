//! Fixed joints: reactions that do no work, and a weld that carries a weight.

use crate::common::power::{assert_balance, pair, spatial_pair};

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { fixed: { between: [a.P, b.P], angle: 0.3 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "",
        ),
        "0",
    );
    assert_balance(
        &spatial_pair(
            "  j: { fixed: { between: [a.P, b.P], angle: 0.3 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "",
        ),
        "0",
    );
}

#[test]
fn clamp_carries_its_beam_about_any_point() {
    // A beam of 3 kg and 2 m, clamped at 30° at its left end, which is 1 m right of the origin.
    let bounds = crate::common::nominal(&crate::common::read(
        "
bodies:
  ground: { points: { wall: [1, 0], other: [0, 5] } }
  beam: { mass: 3, inertia: 1, points: { a: [-1, 0], b: [1, 0] } }
joints: { clamp: { fixed: { between: [ground.wall, beam.a], angle: 30 deg } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
outputs:
  along: clamp.force_body.x
  across: clamp.force_body.y
  own: clamp.torque
  at_wall: clamp.torque_at.ground.wall
  at_origin: clamp.torque_at.ground
  at_other: clamp.torque_at.ground.other
  at_middle: clamp.torque_at.beam
simulation: { duration: 0.1, step: 1e-2 }
",
    ));
    let (weight, (sin, cos)) = (3.0 * 9.81, 30_f64.to_radians().sin_cos());
    for (name, expected) in [
        ("along", weight * sin),
        ("across", weight * cos),
        ("own", weight * cos),
        ("at_wall", weight * cos),
        ("at_origin", weight * (cos + 1.0)),
        ("at_other", weight * (cos + 1.0)),
        ("at_middle", 0.0),
    ] {
        let found = crate::common::curve(&bounds, name)[5];
        assert!((found - expected).abs() < 1e-9, "{name} is {found} instead of {expected}");
    }
}

#[test]
fn clamp_in_space_carries_its_beam_about_any_point() {
    // The same beam, turned about the ground's z and seen from a frame that is turned about its own x by a quarter.
    for formulation in ["absolute", "joint"] {
        let bounds = crate::common::nominal(&crate::common::read(&format!(
            "
space: spatial
bodies:
  ground: {{ points: {{ wall: {{ position: [1, 0, 0], rotation: {{ axis: z, angle: 30 deg }} }} }} }}
  post: {{ mass: 1, inertia: [1, 1, 1] }}
  beam:
    mass: 3
    inertia: [0.1, 1, 1]
    points: {{ a: {{ position: [-1, 0, 0], rotation: {{ axis: x, angle: 90 deg }} }} }}
joints:
  hinge: {{ revolute: {{ between: [ground, post], axis: y }} }}
  clamp: {{ fixed: [ground.wall, beam.a] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81, 0] }} }} }}
outputs:
  along: clamp.force_body.x
  across: clamp.force_body.y
  bend: clamp.torque_body.z
  at_origin: clamp.torque_at.ground.z
simulation: {{ duration: 0.1, step: 1e-2, formulation: {formulation} }}
"
        )));
        let (weight, (sin, cos)) = (3.0 * 9.81, 30_f64.to_radians().sin_cos());
        // The beam's frame is turned back by a quarter against the clamp's, whose z is the ground's.
        for (name, expected) in [
            ("along", weight * sin),
            ("across", weight * cos),
            ("bend", weight * cos),
            ("at_origin", weight * (cos + 1.0)),
        ] {
            let found = crate::common::curve(&bounds, name)[5];
            assert!((found - expected).abs() < 1e-9, "{formulation}: {name} is {found} instead of {expected}");
        }
    }
}
