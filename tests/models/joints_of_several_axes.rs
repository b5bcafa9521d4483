//! Spherical, universal and planar joints that carry bodies in joint coordinates: the same motions and reactions as in
//! absolute coordinates, and those of closed forms and invariants.

use std::f64::consts::TAU;
use std::fmt::Write;

use mbint::results::Explanation;
use mbint::{Formulation, SchemeChoice};

use crate::common::{Subject, curve, distance_from, largest, nominal, read};

const BOTH: [Formulation; 2] = [Formulation::Absolute, Formulation::Joint];

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

fn explicit(description: Subject, tolerance: f64) -> Subject {
    description.scheme(SchemeChoice::Explicit).tolerance(tolerance)
}

fn extrapolated(description: Subject, levels: usize) -> Subject {
    description.extrapolation(levels)
}

fn explained(description: &Subject) -> Explanation {
    description.study().explain().unwrap()
}

#[track_caller]
fn is_in_joint_coordinates(explained: &Explanation) {
    assert!(explained.formulation.starts_with("joint coordinates"), "{}", explained.formulation);
}

/// Three bodies in a row on two joints and a pin, with frames that stand askew, driven by a spring, a torque and their
/// weight.
fn row_of_three(first: &str, second: &str, initial: &str) -> Subject {
    let text = format!(
        "
bodies:
  ground: {{ points: {{ O: {{ position: [0.2, 0.1, -0.3], rotation: {{ rpy: [0.1, 0.7, -0.3] }} }} }} }}
  a:
    mass: 2
    inertia: {{ xx: 0.1, yy: 0.14, zz: 0.12, xy: 0.01, xz: -0.02, yz: 0.015 }}
    center_of_mass: [0.1, 0.2, -0.05]
    points:
      P: {{ position: [0.3, -0.5, 0.2], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }}
      Q: {{ position: [-0.1, -0.2, 0.2], rotation: {{ rpy: [1.3, -0.4, 0.5] }} }}
  b: {{ mass: 1, inertia: [0.2, 0.15, 0.1], points: {{ P: {{ position: [-0.2, 0.6, 0.1], rotation: {{ rpy: [0, 0.2, 1] }} }} }} }}
  c: {{ mass: 0.5, inertia: [0.02, 0.015, 0.01], center_of_mass: [0.1, 0.1, 0], points: {{ P: [-0.2, 0.3, 0.1] }} }}
joints:
  one: {{ {first} }}
  two: {{ {second} }}
  pin: {{ revolute: {{ between: [b, c.P], axis: [1, 0.3, 0] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [1, -2, -9.81] }} }}
  spring: {{ spring_damper: {{ between: [ground.O, c], stiffness: 30, free_length: 0.2 }} }}
  turn: {{ torque: {{ on: b, value: [0.2, 0.1, -0.3] }} }}
initial: {{ {initial}, pin.angle: 0.3 }}
outputs: {{ x: b.x, y: a.P.y, z: c.z, omega: c.omega.z, fx: one.force.x, fy: two.force.y, fz: pin.force.z, tx: one.torque.x, ty: two.torque.y, tz: two.torque.z, energy: energy }}
simulation: {{ duration: 0.4, step: 4e-3, output_step: 0.04 }}
"
    );
    read(&text)
}

const THROWN: &str = "a.orientation: { rpy: [0.2, -0.5, 0.8] }, a.omega: [0.6, -0.9, 0.4]";
/// A universal joint whose axes are askew leaves open which way they are turned.
const PLACED: &str = "a.orientation: { rpy: [0.2, -0.5, 0.8] }, a.omega: [0.6, -0.9, 0.4], b.x: -0.25, b.y: 0.05";
const TURNED: &str = "one.angle: 0.2, one.angular_velocity: 0.5";

/// Pairs of joints, each first in one direction and then in the other, their start, and the first coordinate.
const ROWS: [(&str, &str, &str, &str); 8] = [
    ("spherical: [ground.O, a.P]", "spherical: [a.Q, b.P]", THROWN, "one.p0"),
    ("spherical: [a.P, ground.O]", "spherical: [b.P, a.Q]", THROWN, "one.p0"),
    ("spherical: [ground.O, a.P]", "universal: [a.Q, b.P]", THROWN, "one.p0"),
    (
        "spherical: [a.P, ground.O]",
        "universal: { between: [b.P, a.Q], axes: [[1, 0.2, 0], [0.1, 1, 0.3]] }",
        PLACED,
        "one.p0",
    ),
    ("spherical: [ground.O, a.P]", "planar: { between: [a.Q, b.P], normal: [1, 0.2, 0.3] }", THROWN, "one.p0"),
    ("spherical: [a.P, ground.O]", "planar: { between: [b.P, a.Q], normal: [1, 0.2, 0.3] }", THROWN, "one.p0"),
    (
        "planar: { between: [ground.O, a.P], normal: [0.2, 1, 0.3] }",
        "universal: [a.Q, b.P]",
        TURNED,
        "one.displacement_1",
    ),
    (
        "planar: { between: [a.P, ground.O], normal: [0.2, 1, 0.3] }",
        "spherical: [b.P, a.Q]",
        TURNED,
        "one.displacement_1",
    ),
];

/// Largest difference of an output between the formulations, relative to its largest value.
fn apart(description: &Subject) -> f64 {
    let [absolute, joint] = BOTH.map(|formulation| nominal(&within(description.clone(), formulation)));
    let pairs = absolute.outputs.iter().zip(&joint.outputs);
    largest(pairs.map(|(a, b)| {
        let size = largest(a.nominal.iter().copied()).max(1.0);
        largest(a.nominal.iter().zip(&b.nominal).map(|(a, b)| a - b)) / size
    }))
}

#[test]
#[ignore = "2 s"]
fn motions_and_reactions_match_absolute_coordinates() {
    for (first, second, initial, name) in ROWS {
        let description = row_of_three(first, second, initial);
        let in_joints = explained(&within(description.clone(), Formulation::Joint));
        assert_eq!(in_joints.coordinates[0], name, "{first}, {second}");
        // The explicit method's tolerance is 1e-9 of each coordinate's movement; accelerations lose a digit.
        let by_explicit = apart(&explicit(description.clone(), 1e-9));
        // Four levels from 4e-3 s.
        let by_hht = apart(&extrapolated(description, 4));
        println!("{first}, {second}: explicit {by_explicit:.1e}, hht {by_hht:.1e}");
        assert!(by_explicit < 1e-8, "{first}, {second}: {by_explicit:e}");
        assert!(by_hht < 1e-6, "{first}, {second}: {by_hht:e}");
    }
}

/// A body of revolution that circles about the vertical as a whole: m g l = Ω² cos θ (J_t + m l² − J_a).
#[test]
fn a_conical_pendulum_circles() {
    let (mass, length, axial, across, tilt) = (2.0, 0.7, 0.01, 0.03, 0.6_f64);
    let rate = (mass * 9.81 * length / (tilt.cos() * (across + mass * length * length - axial))).sqrt();
    let text = format!(
        "
bodies: {{ bob: {{ mass: {mass}, inertia: [{across}, {across}, {axial}], points: {{ hook: [0, 0, {length}] }} }} }}
joints: {{ ball: {{ spherical: [ground, bob.hook] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial: {{ bob.orientation: {{ axis: y, angle: {} }}, bob.omega: [0, 0, {rate}] }}
outputs: {{ x: bob.x, y: bob.y, z: bob.z, force: ball.force.z, pull: ball.force, torque: ball.torque }}
simulation: {{ duration: 5, step: 1e-3, formulation: joint, output_step: 0.1 }}
",
        -tilt
    );
    let description = explicit(read(&text), 1e-10);
    let explained = explained(&description);
    is_in_joint_coordinates(&explained);
    assert_eq!(explained.coordinates, ["ball.p0", "ball.p1", "ball.p2", "ball.p3"]);
    let bounds = nominal(&description);
    let radius = length * tilt.sin();
    let off = |name: &str, exact: &dyn Fn(f64) -> f64| distance_from(&bounds.times, curve(&bounds, name), exact);
    let errors = [
        off("x", &|t| radius * (rate * t).cos()),
        off("y", &|t| radius * (rate * t).sin()),
        off("z", &|_| -length * tilt.cos()),
    ];
    println!("{errors:?}");
    assert!(largest(errors) < 1e-8, "{errors:?}");
    let side = mass * rate * rate * radius;
    let forces = [off("force", &|_| mass * 9.81), off("pull", &|_| (mass * 9.81).hypot(side)), off("torque", &|_| 0.0)];
    println!("{forces:?}");
    assert!(largest(forces) < 1e-6, "{forces:?}");
}

/// A body of any inertia on a ball keeps its energy and its angular momentum about the vertical through the ball.
#[test]
fn a_spherical_pendulum_keeps_energy_and_angular_momentum() {
    let momentum = "2*(bob.x*bob.vy - bob.y*bob.vx) + 2*(bob.p1*bob.p3 - bob.p0*bob.p2)*0.1*bob.omega_body.x
        + 2*(bob.p2*bob.p3 + bob.p0*bob.p1)*0.16*bob.omega_body.y
        + (bob.p0^2 - bob.p1^2 - bob.p2^2 + bob.p3^2)*0.07*bob.omega_body.z";
    let text = format!(
        "
bodies: {{ bob: {{ mass: 2, inertia: [0.1, 0.16, 0.07], points: {{ hook: [0.1, -0.2, 0.6] }} }} }}
joints: {{ ball: {{ spherical: [ground, bob.hook] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial: {{ bob.orientation: {{ rpy: [1.2, 0.3, 0] }}, bob.omega: [1, -2, 3] }}
outputs: {{ energy: energy, momentum: \"{}\", norm: bob.p0^2 + bob.p1^2 + bob.p2^2 + bob.p3^2 }}
simulation: {{ duration: 10, step: 1e-3, formulation: joint, output_step: 0.1 }}
",
        momentum.replace('\n', " ")
    );
    let description = explicit(read(&text), 1e-10);
    is_in_joint_coordinates(&explained(&description));
    let bounds = nominal(&description);
    for name in ["energy", "momentum", "norm"] {
        let values = curve(&bounds, name);
        let change = largest(values.iter().map(|value| value - values[0]));
        println!("{name} {} changes by {change:.1e}", values[0]);
        assert!(change < 1e-8, "{name} changes by {change:e}");
    }
}

/// Bars that hang from one another by balls.
fn chain(links: usize) -> Subject {
    let [mut bodies, mut joints, mut initial] = [const { String::new() }; 3];
    for i in 0..links {
        writeln!(
            bodies,
            "  b{i}: {{ mass: 0.5, inertia: [0.001, 0.004, 0.005], points: {{ A: [-0.2, 0, 0], B: [0.2, 0.02, 0] }} }}"
        )
        .unwrap();
        let before = if i == 0 { "ground".to_owned() } else { format!("b{}.B", i - 1) };
        writeln!(joints, "  j{i}: {{ spherical: [{before}, b{i}.A] }}").unwrap();
        let angle = 0.1 * (i % 7) as f64;
        writeln!(initial, "  b{i}.orientation: {{ rpy: [0.1, {angle:?}, 0.2] }}\n  b{i}.omega: [0.3, {angle:?}, 0]")
            .unwrap();
    }
    let last = links - 1;
    read(&format!(
        "bodies:\n{bodies}joints:\n{joints}effects:\n  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
initial:\n{initial}outputs: {{ x: b{last}.x, z: b{last}.B.z, force: j0.force.z, energy: energy }}
simulation: {{ duration: 0.3, step: 1e-3, output_step: 0.03, formulation: joint }}\n"
    ))
}

#[test]
fn a_chain_on_balls_moves_as_in_absolute_coordinates() {
    let description = explicit(chain(5), 1e-10);
    let difference = apart(&description);
    println!("{difference:.1e}");
    assert!(difference < 1e-8, "{difference:e}");
    let energy = nominal(&description);
    let energy = curve(&energy, "energy");
    assert!(largest(energy.iter().map(|value| value - energy[0])) < 1e-8);
}

/// Instructions of a step with one correction.
fn instructions(description: &Subject) -> usize {
    let counts = explained(description).instructions;
    counts.step + counts.factor + counts.first_correction + counts.advance
}

/// Link by link: with its multiplier, each takes the same number of instructions.
#[test]
#[ignore = "2 s"]
fn chains_on_balls_are_eliminated_link_by_link() {
    let [ten, twenty] = [10, 20].map(|links| instructions(&chain(links)) as f64);
    println!("{ten} {twenty}");
    assert!(twenty < 2.2 * ten, "{ten} {twenty}");
}

/// Two universal joints in line, the forks of the shaft between them in one plane: the first turns it unevenly, ω cos
/// β/(1 − sin² β cos² φ), and the second evenly again.
#[test]
fn a_double_cardan_shaft_turns_evenly() {
    let bend = 25_f64.to_radians();
    let (sin, cos) = bend.sin_cos();
    let text = format!(
        "
bodies:
  ground: {{ points: {{ out: [{}, {}, 0] }} }}
  driving: {{ mass: 1, inertia: [0.01, 0.02, 0.02] }}
  middle: {{ mass: 1, inertia: [0.01, 0.02, 0.02], points: {{ A: [-0.2, 0, 0], B: [0.2, 0, 0] }} }}
  driven: {{ mass: 1, inertia: [0.01, 0.02, 0.02] }}
joints:
  in: {{ revolute: {{ between: [ground, driving], axis: x }} }}
  first: {{ universal: {{ between: [driving, middle.A], axes: [y, z] }} }}
  second: {{ universal: {{ between: [middle.B, driven], axes: [z, y] }} }}
  out: {{ cylindrical: {{ between: [ground.out, driven], axis: x }} }}
  motor: {{ equation: in.angle = 6*t }}
guess: {{ middle.orientation: {{ axis: z, angle: {bend} }}, driven.x: {}, driven.y: {} }}
outputs: {{ middle: middle.omega_body.x, driven: driven.omega.x, angle: out.angle }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.02 }}
",
        0.4 * cos,
        0.4 * sin,
        0.4 * cos,
        0.4 * sin
    );
    let description = extrapolated(read(&text), 4);
    let explained = explained(&description);
    is_in_joint_coordinates(&explained);
    let named = explained.coordinates;
    assert!(named.iter().any(|name| name.ends_with("angle_2")), "{named:?}");
    let bounds = nominal(&description);
    // φ counts from where the driving arm, y, is in the plane of the shafts.
    let uneven = |t: f64| 6.0 * cos / (1.0 - (sin * (6.0 * t).cos()).powi(2));
    let off = |name: &str, exact: &dyn Fn(f64) -> f64| distance_from(&bounds.times, curve(&bounds, name), exact);
    let errors = [off("middle", &uneven), off("driven", &|_| 6.0), off("angle", &|t| 6.0 * t)];
    println!("{errors:?}");
    assert!(largest(errors) < 1e-8, "{errors:?}");
}

/// A puck slides down a slope without friction: in a parabola, turning evenly, whichever body of the joint it is.
#[test]
fn a_puck_flies_over_a_slope() {
    let slope = 0.4_f64;
    for between in ["[ground.O, puck]", "[puck, ground.O]"] {
        let text = format!(
            "
bodies:
  ground: {{ points: {{ O: {{ position: [0.1, 0, 0.2], rotation: {{ axis: x, angle: {slope} }} }} }} }}
  puck: {{ mass: 0.3, inertia: [0.01, 0.01, 0.02] }}
joints: {{ table: {{ planar: {{ between: {between} }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial: {{ puck.orientation: {{ axis: x, angle: {slope} }}, puck.x: 0.1, puck.y: 0, puck.vx: 1.5, puck.omega_body.z: 4 }}
outputs: {{ x: puck.x, y: puck.y, z: puck.z, spin: puck.omega_body.z, angle: table.angle, force: table.force, tilt: table.torque }}
simulation: {{ duration: 1, step: 1e-2, output_step: 0.1 }}
"
        );
        let description = explicit(within(read(&text), Formulation::Joint), 1e-10);
        let named = explained(&description).coordinates;
        assert_eq!(named, ["table.displacement_1", "table.displacement_2", "table.angle"]);
        let bounds = nominal(&description);
        let down = |t: f64| 0.5 * 9.81 * slope.sin() * t * t;
        let sign = if between.starts_with("[ground") { 1.0 } else { -1.0 };
        let exact: [(&str, &dyn Fn(f64) -> f64); 7] = [
            ("x", &|t| 0.1 + 1.5 * t),
            ("y", &|t| -down(t) * slope.cos()),
            ("z", &|t| 0.2 - down(t) * slope.sin()),
            ("spin", &|_| 4.0),
            ("angle", &|t| sign * 4.0 * t),
            ("force", &|_| 0.3 * 9.81 * slope.cos()),
            ("tilt", &|t| 0.0 * t),
        ];
        for (name, exact) in exact {
            let off = distance_from(&bounds.times, curve(&bounds, name), exact);
            println!("{between} {name} {off:.1e}");
            // On the second body's side the torque is about a point that the puck leaves.
            let is_about_own_point = name != "tilt" || sign > 0.0;
            assert!(off < 1e-8 || !is_about_own_point, "{between}: {name} is off by {off:e}");
        }
    }
}

/// The angle of a planar joint is a coordinate like another: a spring on it makes it swing with √(k/J), in both
/// formulations.
#[test]
fn the_angle_of_a_planar_joint_has_a_name() {
    for formulation in BOTH {
        let text = "
bodies: { puck: { mass: 0.3, inertia: [0.01, 0.01, 0.02] } }
joints: { table: { planar: [ground, puck] } }
effects: { spring: { torsional_spring_damper: { on: table, stiffness: 0.5, free_angle: 0 } } }
initial: { table.angle: 0.3, table.angular_velocity: 0, puck.x: 0, puck.y: 0, puck.vx: 0, puck.vy: 0 }
outputs: { angle: table.angle, rate: table.angular_velocity, torque: table.torque }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
";
        let bounds = nominal(&explicit(within(read(text), formulation), 1e-10));
        let rate = 5.0_f64;
        let off = distance_from(&bounds.times, curve(&bounds, "angle"), |t| 0.3 * (rate * t).cos());
        assert!(off < 1e-8, "{formulation:?}: {off:e}");
        let off = distance_from(&bounds.times, curve(&bounds, "rate"), |t| -0.3 * rate * (rate * t).sin());
        assert!(off < 1e-7, "{formulation:?}: {off:e}");
        // The spring is no part of the reaction.
        assert!(largest(curve(&bounds, "torque").iter().copied()) < 1e-8, "{formulation:?}");
    }
}

/// The loop of a spatial four-bar linkage is cut where its steps are shortest, whatever the order of its joints.
#[test]
fn loop_of_a_coupler_is_cut_at_one_joint() {
    let explained = explained(&crate::common::model("spatial_four_bar"));
    assert_eq!(explained.coordinates, ["A.angle", "D.angle", "C.angle_1", "C.angle_2"]);
    let cut = explained.formulation.split_once("; loops are cut at ").unwrap().1;
    assert!(!cut.contains(','), "{cut}");
}

/// Turns about the vertical, back to the same orientation: Euler parameters pass through all signs.
#[test]
fn a_ball_turns_any_number_of_times() {
    let text = "
bodies: { top: { mass: 1, inertia: [0.02, 0.02, 0.03] } }
joints: { ball: { spherical: [ground, top] } }
initial: { top.orientation: { axis: x, angle: 0.4 }, top.omega: [0, 0, 6.283185307179586] }
outputs: { p0: top.p0, momentum: energy, yaw: top.yaw }
simulation: { duration: 4, step: 1e-3, formulation: joint, output_step: 0.25 }
";
    let text = text.replace("inertia: [0.02, 0.02, 0.03]", "inertia: [0.02, 0.02, 0.02]");
    let description = explicit(read(&text), 1e-10);
    is_in_joint_coordinates(&explained(&description));
    let bounds = nominal(&description);
    let off = distance_from(&bounds.times, curve(&bounds, "p0"), |t| 0.2_f64.cos() * (0.5 * TAU * t).cos());
    assert!(off < 1e-8, "{off:e}");
}
