//! Starts that name quantities other than coordinates of the equations: points and bodies in joint coordinates; values
//! that depend on t where they are prescribed; guesses. All against trigonometry or another method.

use crate::common::dormand_prince::dormand_prince;
use crate::common::{curve, distance, distance_from, largest, nominal, order, ran, read, refused, study_of};

/// Two bars that hang from the ground, 0.7 m and 0.5 m long, described by `formulation`, with this start.
fn two_bars(formulation: &str, initial: &str) -> String {
    format!(
        "
bodies:
  upper: {{ mass: 1, inertia: 0.05, points: {{ a: [-0.35, 0], b: [0.35, 0] }} }}
  lower: {{ mass: 2, inertia: 0.04, points: {{ a: [-0.25, 0], tip: [0.25, 0] }} }}
joints:
  shoulder: {{ revolute: [ground, upper.a] }}
  elbow: {{ revolute: [upper.b, lower.a] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
guess: {{ shoulder.angle: -1.5, elbow.angle: 0.8 }}
initial: {initial}
outputs: {{ upper: upper.angle, lower: lower.angle, x: lower.tip.x, y: lower.tip.y, vx: lower.tip.vx, vy: lower.tip.vy, turn: lower.angular_velocity }}
simulation: {{ duration: 0.2, step: 1e-3, output_step: 0.1, formulation: {formulation} }}
"
    )
}

/// Angles of both bars against the ground where the tip is at (x, y), the elbow being on the left of the way to the
/// tip.
fn bars_to(x: f64, y: f64) -> [f64; 2] {
    let (a, b) = (0.7, 0.5);
    let square = x * x + y * y;
    let bend = ((square - a * a - b * b) / (2.0 * a * b)).acos();
    let upper = y.atan2(x) - (b * bend.sin()).atan2(a + b * bend.cos());
    [upper, upper + bend]
}

#[test]
fn a_start_names_a_point_in_every_formulation() {
    let initial = "{ lower.tip.x: 0.3, lower.tip.y: -0.9, lower.tip.vx: 0.4, lower.tip.vy: -0.2 }";
    let [upper, lower] = bars_to(0.3, -0.9);
    for formulation in ["absolute", "joint", "auto"] {
        let bounds = nominal(&read(&two_bars(formulation, initial)));
        for (name, expected) in [("upper", upper), ("lower", lower), ("x", 0.3), ("y", -0.9), ("vx", 0.4), ("vy", -0.2)]
        {
            let found = curve(&bounds, name)[0];
            assert!((found - expected).abs() < 1e-9, "{formulation}: {name} is {found} instead of {expected}");
        }
    }
}

#[test]
fn a_start_names_a_body_in_joint_coordinates() {
    let [upper, lower] = bars_to(0.3, -0.9);
    let (x, y) = (0.3 - 0.25 * lower.cos(), -0.9 - 0.25 * lower.sin());
    let initial = format!("{{ lower.x: {x}, lower.y: {y}, upper.angular_velocity: 0, lower.angular_velocity: 0.5 }}");
    let runs = ["absolute", "joint"].map(|formulation| nominal(&read(&two_bars(formulation, &initial))));
    for run in &runs {
        for (name, expected) in [("upper", upper), ("lower", lower), ("turn", 0.5)] {
            let found = curve(run, name)[0];
            assert!((found - expected).abs() < 1e-9, "{name} is {found} instead of {expected}");
        }
    }
    // The same motion follows.
    assert!(distance(curve(&runs[0], "x"), curve(&runs[1], "x")) < 1e-6);
}

#[test]
fn a_start_out_of_reach_names_its_entry() {
    for formulation in ["absolute", "joint"] {
        let message = refused(&two_bars(formulation, "{ lower.tip.x: 1.25, lower.tip.y: 0 }"));
        println!("{message}");
        assert!(message.contains("cannot be closed"), "{message}");
    }
}

#[test]
fn a_string_gets_shorter_as_it_swings() {
    // l θ'' + 2 l' θ' + g sin θ = 0
    let length = |t: f64| 1.0 - 0.2 * t;
    let swing = |t: f64, [angle, rate]: [f64; 2]| [rate, -(2.0 * -0.2 * rate + 9.81 * angle.sin()) / length(t)];
    let expected = dormand_prince(swing, [0.5, 0.0], 0.05, 41, 1e-10);
    let x: Vec<f64> = expected.iter().enumerate().map(|(row, y)| length(row as f64 * 0.05) * y[0].sin()).collect();
    let text = format!(
        "
parameters: {{ length: {{ value: 1, unit: m }}, pull: {{ value: 0.2, unit: m/s }} }}
bodies: {{ bob: {{ mass: 2, coordinates: [x, y] }} }}
joints: {{ string: {{ distance: {{ between: [ground, bob], length: length - pull*t }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ bob.x: {}, bob.vx: {} }}
guess: {{ bob.y: -1 }}
outputs: {{ x: bob.x }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.05 }}
",
        0.5_f64.sin(),
        -0.2 * 0.5_f64.sin(),
    );
    let errors = [2e-3, 1e-3].map(|h| distance(curve(&nominal(&read(&text).step(h)), "x"), &x));
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1 && errors[1] < 1e-5, "{errors:?}");
}

#[test]
fn a_held_coordinate_follows_the_time() {
    // A mass on a spring on a table that shakes: y'' = (k/m) (table − y) for heights from where the mass is at rest.
    let (natural, driven) = (10.0_f64, 7.0_f64);
    let amplitude = 0.01 * natural * natural / (natural * natural - driven * driven);
    let exact = |t: f64| amplitude * ((driven * t).sin() - driven / natural * (natural * t).sin());
    let text = "
bodies:
  table: { coordinates: [], held: { y: 0.01*sin(7*t) }, points: { top: [0, 0.2] } }
  mass: { mass: 2, coordinates: [y] }
effects: { spring: { spring_damper: { between: [table.top, mass], along: y, stiffness: 200 } } }
initial: { mass.y: 0.2, mass.vy: 0 }
outputs: { height: mass.y - 0.2, speed: table.vy }
simulation: { duration: 2, step: 1e-3, output_step: 0.05 }
";
    let errors = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&read(text).step(h));
        let speed = distance_from(&bounds.times, curve(&bounds, "speed"), |t| 0.07 * (7.0 * t).cos());
        assert!(speed < 1e-14, "{speed:e}");
        distance_from(&bounds.times, curve(&bounds, "height"), exact)
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1 && errors[1] < 1e-5, "{errors:?}");
}

/// Message for a mechanism that cannot be assembled since joints fix too much.
fn refusal(joints: &str) -> String {
    let text = format!(
        "
bodies:
  ground: {{ points: {{ end: [0.5, 0.1] }} }}
  crank: {{ mass: 1, inertia: 0.1, points: {{ a: [0, 0], b: [0.2, 0] }} }}
  rod: {{ mass: 1, inertia: 0.1, points: {{ b: [0, 0], c: [0.5, 0] }} }}
  slider: {{ mass: 1, inertia: 0.1 }}
joints:
  A: {{ revolute: [ground, crank.a] }}
  B: {{ revolute: [crank.b, rod.b] }}
{joints}
outputs: {{ x: slider.x, push: C.force.x }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
    );
    let message = refused(&text);
    println!("{message}");
    message
}

#[test]
fn over_constrained_mechanisms_are_reported_with_joints() {
    let message = refusal(
        "  drive: { motor: { on: A, from: 1, speed: 1 } }
  C: { fixed: [rod.c, slider] }
  slide: { prismatic: { between: [ground, slider], axis: x } }",
    );
    assert!(message.contains("9 coordinates, 10 constraints: over-constrained by one"), "{message}");
    assert!(message.contains("`slide` fixes the rotation that `C` needs"), "{message}");

    let message = refusal(
        "  C: { revolute: [rod.c, slider] }
  slide: { prismatic: { between: [ground, slider], axis: x } }
  pin: { revolute: [ground.end, slider] }",
    );
    assert!(message.contains("9 coordinates, 10 constraints: over-constrained by one"), "{message}");
    assert!(message.contains("`slide` fixes `pin.y` already"), "{message}");
}

#[test]
fn spring_without_a_direction_is_reported_by_name() {
    let spring = |free_length: &str| {
        format!(
            "
bodies: {{ ball: {{ mass: 1, coordinates: [x, y] }} }}
effects: {{ rope: {{ spring_damper: {{ between: [ground, ball], stiffness: 100, free_length: {free_length} }} }} }}
initial: {{ ball.x: 0, ball.y: 0 }}
outputs: {{ x: ball.x }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        )
    };
    let message = refused(&spring("0.5"));
    println!("{message}");
    assert!(message.contains("the direction of `rope`, whose points coincide"), "{message}");
    // Without a free length it is an ordinary spring, and the ball stays at rest.
    let bounds = nominal(&read(&spring("0")));
    assert!(curve(&bounds, "x").iter().all(|x| x.abs() < 1e-15));
}

/// A guess of a body chooses the branch in either formulation, whether the body has coordinates of its own or not.
#[test]
fn guesses_of_children_choose_the_branch() {
    let angle = |formulation: &str, guess: f64| {
        let description = read(&format!(
            "
bodies:
  upper: {{ mass: 0.7, inertia: 4e-3, points: {{ p: [-0.13, 0], q: [0.13, 0] }} }}
  lower: {{ mass: 0.4, inertia: 3e-3, points: {{ p: [-0.11, 0], q: [0.11, 0] }} }}
joints:
  shoulder: {{ revolute: [ground, upper.p] }}
  elbow: {{ revolute: [upper.q, lower.p] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ shoulder.angle: -40 deg, shoulder.angular_velocity: 0, lower.x: 0.25 }}
guess: {{ lower.angle: {guess} deg }}
outputs: {{ angle: lower.angle }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01, formulation: {formulation} }}
"
        ));
        curve(&nominal(&description), "angle")[0]
    };
    let (reach, left): (f64, f64) = (0.11, 0.25 - 0.26 * (40_f64).to_radians().cos());
    let branch = (left / reach).acos();
    for formulation in ["joint", "absolute"] {
        for (guess, exact) in [(70.0, branch), (-70.0, -branch)] {
            let found = angle(formulation, guess);
            assert!((found - exact).abs() < 1e-9, "{formulation}, {guess}°: {found} for {exact}");
        }
    }
}

/// A guess of a coordinate that joints leave free is its start, named by the joint or by the body, in every
/// formulation.
#[test]
fn guess_sets_otherwise_free_coordinates() {
    let start = |formulation: &str, guess: &str| {
        let bounds = nominal(&read(&format!(
            "
bodies:
  rod: {{ mass: 1, inertia: 0.1, points: {{ A: [-0.5, 0], B: [0.5, 0] }} }}
  cart: {{ mass: 2, inertia: 0.1 }}
  bob: {{ mass: 1, inertia: 0.1, points: {{ A: [-0.5, 0] }} }}
joints:
  rail: {{ prismatic: {{ between: [ground, cart], axis: x }} }}
  hinge: {{ revolute: [cart, rod.A] }}
  wrist: {{ revolute: [rod.B, bob.A] }}
guess: {{ {guess} }}
outputs: {{ cart: cart.x, rod: rod.angle, bob: bob.angle }}
simulation: {{ duration: 0.01, step: 1e-3, formulation: {formulation} }}
"
        )));
        ["cart", "rod", "bob"].map(|name| curve(&bounds, name)[0])
    };
    for formulation in ["absolute", "joint", "auto"] {
        for (guess, exact) in [
            ("rod.angle: 60 deg", [0.0, 60.0, 60.0]),
            ("hinge.angle: 60 deg", [0.0, 60.0, 60.0]),
            ("cart.x: 0.3, hinge.angle: 20 deg, bob.angle: -30 deg", [0.3, 20.0, -30.0]),
        ] {
            let found = start(formulation, guess);
            let exact = [exact[0], f64::to_radians(exact[1]), f64::to_radians(exact[2])];
            let off = largest(found.iter().zip(exact).map(|(found, exact)| found - exact));
            assert!(off < 1e-9, "{formulation}, {guess}: {found:?} for {exact:?}");
        }
    }
}

/// A ball on a floor may be turned in any way, but not lifted: its height is no choice.
#[test]
fn determined_coordinates_are_not_reported_as_open() {
    let shared = |name: &str, height: &str| {
        let text = format!(
            "
space: spatial
bodies: {{ ball: {{ mass: 1, inertia: 0.01 }} }}
joints: {{ floor: {{ point_on_plane: {{ between: [{name}, ball], normal: {height} }} }} }}
initial: {{ ball.x: 0.1, ball.vx: 1, ball.vy: 0.5 }}
outputs: {{ x: ball.x }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        )
        .replace("bodies: {", "bodies: { ground: { points: { high: [0, 0.2, 0.3] } },");
        ran(study_of(&text).nominal()).1.shared_start
    };
    assert_eq!(shared("ground.high", "z"), Vec::<String>::new());
    // Here height and side share the freedom that the plane leaves.
    assert_eq!(shared("ground.high", "[1, 1, 2]"), ["ball.y", "ball.z"]);
}
