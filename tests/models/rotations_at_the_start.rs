//! Starts that name rotations: orientations, single angles of them, angular velocities, and angles beyond a whole turn.
//! All against trigonometry.

use crate::common::{curve, nominal, ran, read, refused, study_of};

/// A wheel on an arm that turns about x, then about the wheel's own y.
fn gimbal(formulation: &str, initial: &str) -> String {
    format!(
        "
bodies:
  arm: {{ mass: 1, inertia: [0.1, 0.2, 0.3] }}
  wheel: {{ mass: 1, inertia: [0.1, 0.2, 0.1] }}
joints:
  outer: {{ revolute: {{ between: [ground, arm], axis: x }} }}
  inner: {{ revolute: {{ between: [arm, wheel], axis: y }} }}
initial: {initial}
outputs:
  outer: outer.angle
  inner: inner.angle
  outer_rate: outer.angular_velocity
  inner_rate: inner.angular_velocity
  w: wheel.omega
  attitude: wheel.orientation
simulation: {{ duration: 0.1, step: 1e-3, output_step: 0.1, formulation: {formulation} }}
"
    )
}

#[test]
fn a_start_names_rotations_in_every_formulation() {
    // Roll about the ground's x is the outer angle where pitch, about the turned y, is the inner one.
    let initial = "{ wheel.orientation: { axis: x, angle: 0.4 }, wheel.omega.x: 0.3, wheel.omega_body.y: -0.7 }";
    for formulation in ["absolute", "joint"] {
        let bounds = nominal(&read(&gimbal(formulation, initial)));
        for (name, expected) in [
            ("outer", 0.4),
            ("inner", 0.0),
            ("outer_rate", 0.3),
            ("inner_rate", -0.7),
            ("w_x", 0.3),
            ("w_y", -0.7 * 0.4_f64.cos()),
            ("w_z", -0.7 * 0.4_f64.sin()),
            ("attitude_roll", 0.4),
            ("attitude_pitch", 0.0),
            ("attitude_yaw", 0.0),
        ] {
            let found = curve(&bounds, name)[0];
            assert!((found - expected).abs() < 1e-9, "{formulation}: {name} is {found} instead of {expected}");
        }
    }
}

/// With R = Rx(a) Ry(b), roll is atan2(sin a, cos a cos b) and pitch asin(cos a sin b).
#[test]
fn a_start_names_one_angle_of_an_orientation() {
    let (a, b) = (0.5_f64, 0.6_f64);
    let roll = (a.sin()).atan2(a.cos() * b.cos());
    let pitch = (a.cos() * b.sin()).asin();
    for formulation in ["absolute", "joint"] {
        for initial in [
            format!("{{ wheel.roll: {roll}, inner.angle: {b} }}"),
            format!("{{ outer.angle: {a}, wheel.pitch: {pitch} }}"),
        ] {
            let bounds = nominal(&read(&gimbal(formulation, &initial)));
            for (name, expected) in [("outer", a), ("inner", b), ("attitude_roll", roll), ("attitude_pitch", pitch)] {
                let found = curve(&bounds, name)[0];
                assert!((found - expected).abs() < 1e-9, "{formulation}, {initial}: {name} is {found}, not {expected}");
            }
        }
    }
}

#[test]
fn a_body_in_flight_starts_at_the_angles_that_are_named() {
    for (initial, angles) in [
        ("{ body.roll: 30 deg }", [30.0, 0.0, 0.0]),
        ("{ body.yaw: 170 deg }", [0.0, 0.0, 170.0]),
        ("{ body.roll: -100 deg, body.pitch: 20 deg, body.yaw: 150 deg }", [-100.0, 20.0, 150.0]),
    ] {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ body: {{ mass: 1, inertia: [1, 2, 3] }} }}
initial: {initial}
outputs: {{ attitude: body.orientation }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01 }}
"
        )));
        for (name, expected) in ["attitude_roll", "attitude_pitch", "attitude_yaw"].into_iter().zip(angles) {
            let found = curve(&bounds, name)[0].to_degrees();
            assert!((found - expected).abs() < 1e-7, "{initial}: {name} is {found}, not {expected}");
        }
    }
}

#[test]
fn a_whole_angular_velocity_is_given_in_joint_coordinates() {
    let initial = "{ outer.angle: 0.4, inner.angle: 0, wheel.omega_body: [0.3, -0.7, 0] }";
    let bounds = nominal(&read(&gimbal("joint", initial)));
    for (name, expected) in [("outer_rate", 0.3), ("inner_rate", -0.7)] {
        let found = curve(&bounds, name)[0];
        assert!((found - expected).abs() < 1e-9, "{name} is {found} instead of {expected}");
    }
}

/// Eighty links, each turned against the one before: more than a whole turn together.
#[test]
fn a_chain_that_winds_up_starts_in_every_formulation() {
    const LINKS: usize = 80;
    let each = |text: &dyn Fn(usize) -> String| (1..=LINKS).map(text).collect::<Vec<_>>().join("\n");
    let bodies = each(&|i| format!("  b{i}: {{ mass: 1, inertia: 0.01, points: {{ A: [-0.1, 0], B: [0.1, 0] }} }}"));
    let before = |i: usize| if i == 1 { "ground".to_owned() } else { format!("b{}.B", i - 1) };
    let joints = each(&|i| format!("  j{i}: {{ revolute: [{}, b{i}.A] }}", before(i)));
    let initial = each(&|i| format!("  j{i}.angle: 0.1"));
    for formulation in ["absolute", "joint"] {
        let text = format!(
            "bodies:\n{bodies}\njoints:\n{joints}\ninitial:\n{initial}\n\
             outputs: {{ x: b{LINKS}.x, y: b{LINKS}.y, angle: b{LINKS}.angle }}\n\
             simulation: {{ duration: 1e-3, step: 1e-3, formulation: {formulation} }}\nbounds: {{ scan: {{ points: 2 }} }}\n"
        );
        let bounds = nominal(&read(&text));
        let sum = |part: fn(f64) -> f64| -> f64 {
            (1..=LINKS).map(|i| part(0.1 * i as f64) * if i == LINKS { 0.1 } else { 0.2 }).sum()
        };
        for (name, expected) in [("x", sum(f64::cos)), ("y", sum(f64::sin)), ("angle", 8.0)] {
            let found = curve(&bounds, name)[0];
            assert!((found - expected).abs() < 1e-9, "{formulation}: {name} = {found} instead of {expected}");
        }
    }
}

/// A ball on a moving turntable may move along or spin.
#[test]
fn open_rotations_have_the_names_of_initial() {
    let study = study_of(
        "
bodies: { table: { mass: 1, inertia: 1 }, ball: { mass: 1, inertia: 0.01 } }
joints:
  bearing: { revolute: { between: [ground, table], axis: z } }
  drive: { motor: { on: bearing, speed: 2 } }
  roll: { rolling_on_plane: { between: [table, ball], radius: 0.1 } }
initial: { ball.x: 0.4, ball.y: 0 }
outputs: { x: ball.x }
simulation: { duration: 0.1, step: 1e-3 }
",
    );
    let shared = ran(study).1.shared_start;
    assert_eq!(shared, ["the rate of ball.y", "ball.omega"]);
}

/// A term of the constraints that is no number is reported with the constraint that it is in.
#[test]
fn a_disc_that_lies_flat_has_no_lowest_point() {
    let error = refused(
        "
bodies: { disc: { mass: 1, inertia: 0.01 } }
joints: { roll: { rolling_on_plane: { between: [ground, disc], axle: z, radius: 0.1 } } }
initial: { disc.x: 0, disc.y: 0, disc.orientation: { rpy: [0, 0, 0] }, disc.omega: [0, 0, 1] }
outputs: { x: disc.x }
simulation: { duration: 0.1, step: 1e-3 }
",
    );
    assert!(error.contains("in `roll.along` is not a finite number"), "{error}");
}
