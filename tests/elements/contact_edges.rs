//! Contacts with paths and polygons, and of several corners, against plane and round surfaces and closed forms.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{curve, largest, nominal, read};
use mbint::results::Bounds;

const LAWS: &str = "radius: 0.1, impact: { stiffness: 1e6, dissipation: 0.3 }, friction: { coefficient: 0.2 }";

/// A ball of 1 kg under its weight, thrown at a surface at `between[0]`.
fn thrown(at: &str, surface: &str, [x, y, vx, vy]: [f64; 4]) -> Bounds {
    nominal(&read(&format!(
        "
bodies: {{ ground: {{ points: {{ top: [0, 0.02], corner: [1, 0] }} }}, ball: {{ mass: 1, inertia: 0.004 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  it: {{ contact: {{ between: [{at}, ball], {surface}, {LAWS} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.angle: 0, ball.vx: {vx}, ball.vy: {vy}, ball.angular_velocity: 0 }}
outputs:
  {{ x: ball.x, y: ball.y, spin: ball.angular_velocity, gap: it.gap, rate: it.rate, force: it.force, friction: it.friction }}
simulation: {{ duration: 0.5, step: 1e-4, output_step: 1e-3 }}
"
    )))
}

#[track_caller]
fn assert_same(a: &Bounds, b: &Bounds) {
    for output in &a.outputs {
        let other = curve(b, &output.name);
        let error = largest(output.nominal.iter().zip(other).map(|(a, b)| a - b));
        let size = largest(other.iter().copied());
        assert!(error <= 1e-7 * size.max(1.0), "{}: {error:e} of {size}", output.name);
    }
    assert!(curve(b, "force").iter().any(|force| *force > 1.0), "no contact");
}

/// An edge from (−1, 0) to (1, 0), drawn either way, alone, as a side of a polygon, and as another path has it, is the
/// same surface.
#[track_caller]
fn assert_drawn_alike(path: &str, start: [f64; 4], wanted: &Bounds) {
    for edges in [
        "path: [[-1, 0], [1, 0]]",
        "path: [[1, 0], [-1, 0]]",
        path,
        "polygon: [[1, 0], [-1, 0], [-1, -1], [1, -1]]",
        "polygon: [[1, 0], [1, -1], [-1, -1], [-1, 0]]",
    ] {
        println!("{edges}");
        assert_same(&thrown("ground", &format!("{edges}, rounding: 0.02"), start), wanted);
    }
}

/// A face is a plane, whichever way it is drawn, and joints of edges in line do not show.
#[test]
fn faces_are_planes() {
    let start = [0.05, 0.3, 0.6, 0.0];
    let plane = thrown("ground.top", "plane: y", start);
    assert_drawn_alike("path: [[-1, 0], [0.1, 0], [0.15, 0], [0.2, 0], [1, 0]]", start, &plane);
}

/// A corner and an end are circles of the rounding's radius.
#[test]
fn corners_are_circles() {
    let start = [1.03, 0.45, 0.1, 0.0];
    let circle = thrown("ground.corner", "circle: 0.02", start);
    assert_drawn_alike("path: [[-1, 0], [1, 0], [1, -1]]", start, &circle);
}

/// In a groove of 90° both sides carry W/√2; a corner from the inner side is not round.
#[test]
fn both_sides_of_a_groove_push() {
    let surface = "path: [[-1, 1], [0, 0], [1, 1]], rounding: 0.01";
    let height = 0.11 * 2.0_f64.sqrt();
    let bounds = thrown("ground", surface, [0.0, height, 0.0, 0.0]);
    let force = *curve(&bounds, "force").last().unwrap();
    assert!((force - 9.81 * 2.0_f64.sqrt()).abs() < 0.01, "{force}");
    assert!(largest(curve(&bounds, "x").iter().copied()) < 1e-9);
}

/// A billiard: without loss or friction the speed across a corner's normal stays, that along it is turned about. During
/// the contact the normal turns by the ball's way over the radii: as K^−0.4.
#[test]
fn a_corner_reflects() {
    // The normal is 30° from the vertical: the ball leaves at 60°.
    let errors = [1e9, 3.2e10].map(|stiffness| {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ ball: {{ mass: 1, inertia: 0.004 }} }}
effects:
  it:
    contact:
      between: [ground, ball]
      polygon: [[1, 0], [-1, 0], [-1, -1], [1, -1]]
      rounding: 0.02
      radius: 0.1
      impact: {{ stiffness: {stiffness} }}
initial: {{ ball.x: 1.06, ball.y: 0.11, ball.angle: 0, ball.vx: 0, ball.vy: -1, ball.angular_velocity: 0 }}
outputs: {{ vx: ball.vx, vy: ball.vy }}
simulation: {{ duration: 0.02, step: 1e-6, output_step: 0.01 }}
"
        )));
        let [vx, vy] = ["vx", "vy"].map(|name| *curve(&bounds, name).last().unwrap());
        (vx - 3.0_f64.sqrt() / 2.0).hypot(vy - 0.5)
    });
    println!("{errors:?}");
    assert!(errors[1] < 1e-3 && (errors[0] / errors[1] - 4.0).abs() < 0.4, "{errors:?}");
}

/// A block that rocks about a corner is an inverted pendulum until it meets the floor with the other.
#[test]
fn a_block_rocks() {
    let (b, h, tilt) = (0.1_f64, 0.3_f64, 0.1_f64);
    let (radius, slender) = (b.hypot(h), (b / h).atan());
    let inertia = 4.0 / 3.0 * radius * radius;
    let (x, y) = (-b + radius * (slender - tilt).sin(), radius * (slender - tilt).cos());
    let bounds = nominal(&read(&format!(
        "
bodies: {{ block: {{ mass: 1, inertia: {} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor:
    contact:
      between: [ground, block]
      plane: y
      corners: [[-{b}, -{h}], [{b}, -{h}], [{b}, {h}], [-{b}, {h}]]
      impact: {{ stiffness: 1e9, dissipation: 10 }}
      friction: {{ coefficient: 2, transition_velocity: 1e-5 }}
initial: {{ block.x: {x}, block.y: {y}, block.angle: {tilt}, block.vx: 0, block.vy: 0, block.angular_velocity: 0 }}
outputs: {{ angle: block.angle }}
simulation: {{ duration: 0.4, step: 1e-4, output_step: 1e-3 }}
",
        inertia - radius * radius
    )));
    let (mut angle, mut rate, step) = (tilt, 0.0_f64, 1e-5);
    let angles = curve(&bounds, "angle");
    let mut time = 0.0;
    while angle > 0.01 {
        // The corner's torque, m g R sin(α − θ), by leapfrog.
        rate -= step * 9.81 * radius * (slender - angle).sin() / inertia;
        angle += step * rate;
        time += step;
    }
    let row = angles.iter().position(|angle| *angle < 0.01).expect("it falls");
    assert!((bounds.times[row] - time).abs() < 3e-3, "{} {time}", bounds.times[row]);
}

/// Two boxes on one another stay at rest, and the floor carries both.
#[test]
fn a_stack_rests() {
    let corners = "corners: [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]";
    let laws = "impact: { stiffness: 1e7, dissipation: 5 }, friction: { coefficient: 0.5 }";
    let bounds = nominal(&read(&format!(
        "
bodies: {{ lower: {{ mass: 2, inertia: 0.01 }}, upper: {{ mass: 1, inertia: 0.01 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor: {{ contact: {{ between: [ground, lower], plane: y, {corners}, {laws} }} }}
  joint:
    contact:
      between: [lower, upper]
      polygon: [[-0.15, -0.095], [0.15, -0.095], [0.15, 0.095], [-0.15, 0.095]]
      rounding: 0.005
      {}
      radius: 0.001
      impact: {{ stiffness: 1e7, dissipation: 5 }}
      friction: {{ coefficient: 0.5 }}
initial:
  lower.x: 0
  lower.y: 0.1
  lower.angle: 0
  lower.vx: 0
  lower.vy: 0
  lower.angular_velocity: 0
  upper.x: 0.02
  upper.y: 0.301
  upper.angle: 0
  upper.vx: 0
  upper.vy: 0
  upper.angular_velocity: 0
outputs: {{ floor: floor.force, joint: joint.force, tilt: upper.angle, x: upper.x, v: upper.vy }}
simulation: {{ duration: 1, step: 2e-4, output_step: 0.1 }}
",
        corners
    )));
    let last = |name: &str| *curve(&bounds, name).last().unwrap();
    assert!((last("floor") - 3.0 * 9.81).abs() < 0.01 && (last("joint") - 9.81).abs() < 0.01);
    assert!(last("tilt").abs() < 1e-4 && (last("x") - 0.02).abs() < 1e-4 && last("v").abs() < 1e-5);
}

/// Edges and corners that penetrate each other deeply store the energy that they take.
#[test]
fn stored_energy_of_elastic_edges_equals_work_done() {
    for surface in [
        "path: [[-1, 0.3], [0.5, 0.2], [1.5, -0.5]], rounding: 1, radius: 1",
        "polygon: [[-0.5, -0.4], [0.6, -0.3], [0.1, 0.5]], rounding: 0.5, radius: 1",
        "plane: [1, 2], radius: 3, corners: [[0.1, 0.2], [-0.3, 0.1]]",
    ] {
        let effect = format!("  e: {{ contact: {{ between: [a.P, b.P], {surface}, impact: {{ stiffness: 20 }} }} }}");
        assert_balance(&pair("", &effect, APART), "0");
    }
}
