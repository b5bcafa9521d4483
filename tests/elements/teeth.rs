//! Forces of teeth on bearings, against F_t = T/r, F_r = F_t tan α / cos β, F_a = F_t tan β and those of bevel gears.

use mbint::Formulation;
use mbint::results::Bounds;

use crate::common::{curve, nominal, read};

/// The value of an output at the end.
fn last(bounds: &Bounds, name: &str) -> f64 {
    *curve(bounds, name).last().unwrap()
}

/// Runs a model in both formulations and compares outputs at the end with expected values, relative to 1 + |expected|.
fn assert_loads(text: &str, expected: &[(&str, f64)], tolerance: f64) {
    for formulation in [Formulation::Absolute, Formulation::Joint] {
        let description = read(text).formulation(formulation);
        let bounds = nominal(&description);
        for &(name, expected) in expected {
            let found = last(&bounds, name);
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error < tolerance, "{formulation:?} {name}: {found} instead of {expected}");
        }
    }
}

fn degrees(angle: f64) -> f64 {
    angle.to_radians()
}

/// A pinion of 40 mm drives a wheel of 100 mm against a brake, in a frame that lies askew; the second bearing may be
/// listed backwards, and its axis may point the other way.
fn helical(backwards: bool, against: bool, torque: f64, hand: f64) -> String {
    let (pair, axis) =
        (if backwards { "[b, housing.B]" } else { "[housing.B, b]" }, if against { "[0, 0, -1]" } else { "z" });
    // ψ̇₂ = −0.4 ψ̇₁ about the first axis.
    let sign = if backwards { -1.0 } else { 1.0 } * if against { -1.0 } else { 1.0 };
    let (ratio, brake) = (-0.4 * sign, sign * torque / 0.4);
    format!(
        "
bodies:
  housing: {{ mass: 5, inertia: [1, 1, 1], points: {{ A: [0.01, 0.02, 0], B: [0.01, 0.16, 0.05] }} }}
  ground: {{ points: {{ F: {{ position: [1, 2, 3], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }} }} }}
  a: {{ mass: 1, inertia: [0.1, 0.1, 0.1] }}
  b: {{ mass: 1, inertia: [0.3, 0.3, 0.3] }}
joints:
  base: {{ fixed: [ground.F, housing] }}
  ja: {{ revolute: [housing.A, a] }}
  jb: {{ revolute: {{ between: {pair}, axis: {axis} }} }}
  mesh: {{ gear: {{ between: [ja, jb], ratio: {ratio}, pressure_angle: 20 deg, helix_angle: {hand} deg, face: 30 mm }} }}
effects:
  drive: {{ torque: {{ on: ja, value: {torque} }} }}
  brake: {{ torque: {{ on: jb, value: {brake} }} }}
initial: {{ ja.angle: 0.3, ja.angular_velocity: 0 }}
outputs:
  push: mesh.force
  a_x: ja.force_body.x*cos(ja.angle) - ja.force_body.y*sin(ja.angle)
  a_y: ja.force_body.x*sin(ja.angle) + ja.force_body.y*cos(ja.angle)
  a_z: ja.force_body.z
  tilt_x: ja.torque_body.x*cos(ja.angle) - ja.torque_body.y*sin(ja.angle)
  b_axial: jb.axial
  b_radial: jb.radial
  b_force: jb.force
  speed: jb.angular_velocity
  thrust: mesh.axial
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01 }}
"
    )
}

#[test]
fn helical_gears_push_on_their_bearings() {
    for (torque, hand) in [(12.0, 25.0), (-12.0, 25.0), (12.0, -25.0)] {
        for (backwards, against) in [(false, false), (true, false), (false, true), (true, true)] {
            let transmitted: f64 = torque / 0.04;
            let apart = transmitted.abs() * degrees(20.0).tan() / degrees(hand).cos();
            let thrust = transmitted * degrees(hand).tan();
            // The wheel's teeth, at +y of the pinion, push it back along +x and away along −y; the bearing has the
            // opposites.
            let expected = [
                ("push", transmitted.abs() / (degrees(20.0).cos() * degrees(hand).cos())),
                ("a_x", -transmitted),
                ("a_y", apart),
                ("a_z", -thrust),
                // About the bearing the bearing's torque holds (0, 40, 30) mm × the force of the wheel's teeth.
                ("tilt_x", -(0.04 * thrust + 0.03 * apart)),
                ("b_axial", if against { -thrust } else { thrust } * if backwards { -1.0 } else { 1.0 }),
                ("b_radial", transmitted.hypot(apart)),
                ("b_force", transmitted.hypot(apart).hypot(thrust)),
                ("speed", 0.0),
                ("thrust", if against { thrust } else { -thrust }),
            ];
            assert_loads(&helical(backwards, against, torque, hand), &expected, 1e-7);
        }
    }
}

/// The flanks do not change the motion: J₁ + κ² J₂ as without them.
#[test]
fn the_motion_does_not_depend_on_the_flanks() {
    let text = |flanks: &str, output: &str| {
        format!(
            "
bodies:
  ground: {{ points: {{ B: [0.3, 0.4] }} }}
  a: {{ mass: 1, inertia: 0.1, center_of_mass: [0.02, 0] }}
  b: {{ mass: 2, inertia: 0.3 }}
joints:
  ja: {{ revolute: [ground, a] }}
  jb: {{ revolute: [ground.B, b] }}
  mesh: {{ gear: {{ between: [ja, jb], ratio: -1.5{flanks} }} }}
effects: {{ g: {{ gravity: {{ acceleration: [0, -9.81] }} }}, drive: {{ torque: {{ on: ja, value: 3 }} }} }}
initial: {{ ja.angle: 0, ja.angular_velocity: 1 }}
outputs: {{ angle: ja.angle{output} }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.1, formulation: FORM }}
"
        )
    };
    for formulation in ["absolute", "joint"] {
        let run = |flanks: &str, output: &str| {
            let bounds = nominal(&read(&text(flanks, output).replace("FORM", formulation)));
            curve(&bounds, "angle").to_vec()
        };
        let plain = run("", "");
        let observed = run(", pressure_angle: 25 deg", ", push: jb.force");
        let unasked = run(", pressure_angle: 25 deg", "");
        assert_eq!(plain, unasked, "{formulation}: what nothing asks for costs nothing");
        for (a, b) in plain.iter().zip(observed) {
            assert!((a - b).abs() < 1e-9, "{formulation}: {a} {b}");
        }
    }
}

/// A wheel within a ring: the pinion is pushed towards its own centre, whichever is the first.
#[test]
fn internal_gears_push_the_pinion_inwards() {
    for first in ["pinion", "ring"] {
        let (between, ratio) = if first == "pinion" { ("[p, r]", 0.25) } else { ("[r, p]", 4.0) };
        let text = format!(
            "
bodies:
  ground: {{ points: {{ P: [0.09, 0] }} }}
  pinion: {{ mass: 1, inertia: 0.01 }}
  ring: {{ mass: 1, inertia: 0.3 }}
joints:
  p: {{ revolute: [ground.P, pinion] }}
  r: {{ revolute: [ground, ring] }}
  mesh: {{ gear: {{ between: {between}, ratio: {ratio}, pressure_angle: 20 deg }} }}
effects:
  drive: {{ torque: {{ on: p, value: 6 }} }}
  brake: {{ torque: {{ on: r, value: -24 }} }}
initial: {{ p.angle: 0, p.angular_velocity: 0 }}
outputs: {{ px: p.force.x, py: p.force.y, rx: r.force.x, ry: r.force.y, push: mesh.force }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01 }}
"
        );
        // Radii 30 and 120 mm touch at x = 120 mm; the ring holds the pinion back along −y, and the bearing pushes it
        // on.
        let (transmitted, apart) = (200.0, 200.0 * degrees(20.0).tan());
        let push = 200.0 / degrees(20.0).cos();
        let expected = [("py", transmitted), ("px", apart), ("ry", -transmitted), ("rx", -apart), ("push", push)];
        assert_loads(&text, &expected, 1e-9);
    }
}

/// A planet between sun and ring: its pin has twice the force at its teeth, along the way, and nothing across.
#[test]
fn a_planets_pin_has_twice_its_teeth() {
    let text = "
bodies:
  sun: { mass: 1, inertia: 1e-3 }
  carrier: { mass: 1, inertia: 1e-2, points: { P: [0.06, 0] } }
  planet: { mass: 1, inertia: 1e-4 }
joints:
  c: { revolute: [ground, carrier] }
  s: { revolute: [carrier, sun] }
  p: { revolute: [carrier.P, planet] }
  inner: { gear: { between: [s, p], ratio: -2, pressure_angle: 22 deg } }
  outer: { gear: { between: [c, p], ratio: -4, pressure_angle: 22 deg } }
effects:
  drive: { torque: { on: sun, value: 8 } }
  load: { torque: { on: carrier, value: -24 } }
initial: { c.angle: 0, c.angular_velocity: 0 }
outputs: { x: p.force.x, y: p.force.y, inner: inner.force, outer: outer.force, cx: c.force.x, cy: c.force.y, sx: s.force.x }
simulation: { duration: 0.01, step: 1e-3, output_step: 0.01 }
";
    // Radii: sun 40, planet 20, ring 80 mm; 200 N at each mesh.
    let push = 200.0 / degrees(22.0).cos();
    let apart = 200.0 * degrees(22.0).tan();
    // The ground is the ring: its force on the planet comes back through the carrier's bearing.
    let expected = [("y", -400.0), ("x", 0.0), ("inner", push), ("outer", push), ("sx", apart)];
    assert_loads(text, &expected, 1e-8);
}

#[test]
fn a_rack_lifts_off_its_pinion() {
    for (radius, at) in [(0.05, 1.0), (-0.05, -1.0)] {
        let text = format!(
            "
bodies:
  pinion: {{ mass: 1, inertia: [0.1, 0.1, 0.1] }}
  bar: {{ mass: 2, inertia: [1, 1, 1] }}
joints:
  turn: {{ revolute: [ground, pinion] }}
  slide: {{ prismatic: {{ between: [ground, bar], axis: x }} }}
  mesh: {{ rack: {{ pinion: turn, rack: slide, radius: {radius}, pressure_angle: 20 deg, helix_angle: 10 deg }} }}
effects:
  drive: {{ torque: {{ on: turn, value: {} }} }}
  load: {{ force: {{ on: bar, value: [-100, 0, 0] }} }}
initial: {{ turn.angle: 0, turn.angular_velocity: 0 }}
outputs: {{ px: turn.force.x, py: turn.force.y, pz: turn.force.z, gy: slide.force.y, gz: slide.force.z, push: mesh.force }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 0.01 }}
",
            100.0 * radius
        );
        // A positive radius moves the rack with the angle: it lies below the pinion's axis.
        let (apart, thrust) = (100.0 * degrees(20.0).tan() / degrees(10.0).cos(), 100.0 * degrees(10.0).tan());
        let expected = [
            ("px", 100.0),
            ("py", -at * apart),
            ("gy", at * apart),
            ("pz", -at * thrust),
            ("gz", at * thrust),
            ("push", 100.0 / (degrees(20.0).cos() * degrees(10.0).cos())),
        ];
        assert_loads(&text, &expected, 1e-9);
    }
}

/// Bevel gears at a right angle, 2 : 1: F_r = F_t tan α cos δ, F_a = F_t tan α sin δ of the pinion, and the other way
/// round of the wheel.
#[test]
fn bevel_gears_push_along_their_axes() {
    let text = "
bodies:
  ground: { points: { A: [0.2, 0, 0], B: [0, 0.3, 0] } }
  pinion: { mass: 1, inertia: [0.1, 0.1, 0.1] }
  wheel: { mass: 1, inertia: [0.1, 0.1, 0.1] }
joints:
  a: { revolute: { between: [ground.A, pinion], axis: x } }
  b: { revolute: { between: [ground.B, wheel], axis: y } }
  mesh: { gear: { between: [a, b], ratio: -0.5, pressure_angle: 20 deg, cone_distance: 100 mm } }
effects:
  drive: { torque: { on: a, value: 10 } }
  brake: { torque: { on: b, value: 20 } }
initial: { a.angle: 0, a.angular_velocity: 0 }
outputs: { ax: a.force.x, ay: a.force.y, az: a.force.z, bx: b.force.x, by: b.force.y, bz: b.force.z }
simulation: { duration: 0.01, step: 1e-3, output_step: 0.01 }
";
    // The pitch cone's half angle is atan(1/2), the pinion's mean radius 100 mm sin δ.
    let delta = 0.5f64.atan();
    let transmitted = 10.0 / (0.1 * delta.sin());
    let (across, along) =
        (transmitted * 0.36397023426620234 * delta.cos(), transmitted * 0.36397023426620234 * delta.sin());
    // Teeth press the pinion away from the apex and towards its axis (−y); its bearing has the opposites. They touch at
    // +y of the pinion, whose teeth move along +z there.
    let expected =
        [("ax", -along), ("ay", across), ("az", transmitted), ("bx", along), ("by", -across), ("bz", -transmitted)];
    assert_loads(text, &expected, 1e-8);
}

/// Friction of a bearing grows with the load of the teeth on it.
#[test]
fn bearing_friction_grows_with_the_tooth_load() {
    let text = "
bodies:
  ground: { points: { B: [0.15, 0] } }
  a: { mass: 1, inertia: 0.1 }
  b: { mass: 1, inertia: 0.3 }
joints:
  ja: { revolute: [ground, a] }
  jb: { revolute: [ground.B, b] }
  mesh: { gear: { between: [ja, jb], ratio: -0.5, pressure_angle: 20 deg } }
  drive: { motor: { on: ja, speed: 10 } }
effects:
  brake: { torque: { on: jb, value: 20 } }
  rub: { joint_friction: { on: ja, coefficient: 0.1, radius: 10 mm, transition_velocity: 1e-6 } }
outputs: { needed: drive.torque, load: rub.load }
simulation: { duration: 0.01, step: 1e-3, output_step: 0.01 }
";
    let bounds = nominal(&read(text));
    let load = 200.0 / degrees(20.0).cos();
    assert!((last(&bounds, "load") - load).abs() < 1e-6, "{}", last(&bounds, "load"));
    let needed = 10.0 + 0.1 * 0.01 * load;
    assert!((last(&bounds, "needed") - needed).abs() < 1e-6, "{}", last(&bounds, "needed"));
}

/// Bearings between which teeth cannot touch are reported.
#[test]
fn teeth_that_cannot_touch_are_refused() {
    let text = |joints: &str, gear: &str| {
        format!(
            "
bodies:
  ground: {{ points: {{ B: [0, 0.3, 0], C: [0, 0.3, 0.4] }} }}
  a: {{ mass: 1, inertia: [0.1, 0.1, 0.1] }}
  b: {{ mass: 1, inertia: [0.1, 0.1, 0.1] }}
joints:
{joints}
  mesh: {{ {gear} }}
initial: {{ ja.angle: 0, ja.angular_velocity: 1 }}
outputs: {{ push: ja.force }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        )
    };
    let parallel = "  ja: { revolute: [ground, a] }\n  jb: { revolute: [ground.B, b] }";
    let crossed = "  ja: { revolute: [ground, a] }\n  jb: { revolute: { between: [ground.C, b], axis: x } }";
    let chain = "  ja: { revolute: [ground, a] }\n  jb: { revolute: [a, b] }";
    let skew = "  ja: { revolute: [ground, a] }\n  jb: { prismatic: { between: [ground.B, b], axis: [1, 0, 1] } }";
    for (joints, gear, why) in [
        (parallel, "gear: { between: [ja, jb], ratio: 1, pressure_angle: 20 deg }", "turn alike"),
        (parallel, "gear: { between: [ja, jb], ratio: -1, pressure_angle: 20 deg, cone_distance: 1 }", "parallel"),
        (crossed, "gear: { between: [ja, jb], ratio: -1, pressure_angle: 20 deg }", "`cone_distance`"),
        (chain, "gear: { between: [ja, jb], ratio: -1, pressure_angle: 20 deg }", "coincide"),
        (skew, "rack: { pinion: ja, rack: jb, radius: 0.1, pressure_angle: 20 deg }", "slide across"),
    ] {
        let wrong = read(&text(joints, gear)).unbuilt();
        assert!(wrong.contains("mesh") && wrong.contains(why), "{gear}: {wrong}");
    }
}
