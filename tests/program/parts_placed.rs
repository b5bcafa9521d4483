//! Instances that are placed, against instances at the origin and mechanisms that are written by hand.

use mbint::Model;
use mbint::results::Bounds;

#[track_caller]
pub(super) fn bounds(text: &str) -> Bounds {
    let model = Model::from_yaml_str("test.yaml", text).unwrap_or_else(|error| panic!("{error}"));
    model.study().run().unwrap().bounds().clone()
}

/// The output's nominal course and its bounds.
pub(super) fn courses(bounds: &Bounds, output: &str) -> [Vec<f64>; 3] {
    let found = bounds.outputs.iter().find(|found| found.name == output).unwrap();
    [found.nominal.clone(), found.bands[0].lower.clone(), found.bands[0].upper.clone()]
}

/// Compares two outputs, the second with a sign.
#[track_caller]
pub(super) fn same(bounds: &Bounds, first: &str, (other, second): (&Bounds, &str), sign: f64) {
    let [nominal, lower, upper] = courses(bounds, first);
    let [images, low, high] = courses(other, second);
    let (low, high) = if sign > 0.0 { (low, high) } else { (high, low) };
    let size = nominal.iter().fold(1e-3, |size: f64, value| size.max(value.abs()));
    for (value, image) in [(nominal, images), (lower, low), (upper, high)] {
        for (value, image) in value.iter().zip(image) {
            assert!((value - sign * image).abs() < 1e-9 * size, "{first}: {value} and {image}");
        }
    }
}

/// A crank with a motor's image, a spring, a stop and a slider in a slanted guide.
pub(super) const ARM: &str = "
assemblies:
  arm:
    shared: all
    parameters: { l: 0.3 m ± 1%, m: 2 kg ± 2% }
    bodies:
      ground: { points: { A: [0.1, 0.2] } }
      bar: { mass: m, inertia: m*l^2/12, center_of_mass: [0.01, 0.02], points: { A: [-l/2, 0.01], B: [l/2, 0.03] } }
      slide: { mass: 1, inertia: 0.01 }
      hand: { mass: 0.2, inertia: 1e-3, points: { B: [0, 0.02] } }
    joints:
      pin: { revolute: [ground.A, bar.A] }
      guide: { prismatic: { between: [ground, slide], axis: [1, 0.4], angle: 0.2 } }
      wrist: { revolute: [bar.B, hand.B] }
      drive: { motor: { on: wrist, position: 0.3*sin(5*t) } }
    effects:
      pull: { spring_damper: { between: [bar.B, slide], stiffness: 200, free_length: 0.2, force: \"2*pull.rate\" } }
      coil: { torsional_spring_damper: { on: pin, stiffness: 3, free_angle: 0.5 } }
      push: { force: { on: bar.B, value: [1, 3] } }
      twist: { torque: { on: bar, value: 0.4*cos(3*t) } }
      turn: { torque: { on: pin, value: 0.2 - 0.1*pin.angular_velocity } }
      end: { stop: { on: pin, lower: -0.05, impact: { stiffness: 200 } } }
      wind: { drag: { on: slide, linear: 0.5, wind: [1, 2] } }
    initial: { pin.angle: 0.4, pin.angular_velocity: -1, slide.x: 0.4, slide.vx: 0 }
    guess: { slide.y: 0.1, bar.angle: 0.4 }
    ports: { tip: { on: bar, position: [l/2, 0.05] } }
";

pub(super) const ASKED: &str = "
simulation: { duration: 0.5, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";

/// An arm in space with skew axes, products of inertia and frames that are turned.
pub(super) const SPATIAL: &str = "
assemblies:
  arm:
    shared: all
    parameters: { l: 0.3 m ± 1% }
    bodies:
      base: { mass: 2, inertia: { xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.002, yz: -0.003, xz: 0.001 }, center_of_mass: [0.02, 0.03, 0.01],
              points: { A: [-0.1, 0.02, 0.03], B: { position: [l, 0.05, -0.02], rotation: { rpy: [0.3, -0.4, 0.5] } } } }
      fore: { mass: 1, inertia: [0.01, 0.02, 0.015], points: { B: { position: [-0.1, 0, 0.02], rotation: { axis: [1, 2, -1], angle: 0.7 } } } }
    joints:
      shoulder: { revolute: { between: [ground, base.A], axis: [0.3, 1, 0.5] } }
      elbow: { revolute: [base.B, fore.B] }
    effects:
      drive: { servo: { on: elbow, target: 0.5*sin(4*t), proportional: 3, derivative: 0.2 } }
      brake: { torque: { on: fore, value: [0.1, 0.2, -0.3] } }
    initial: { shoulder.angle: 0.2, shoulder.angular_velocity: 1, elbow.angle: -0.3, elbow.angular_velocity: 0 }
";

/// Points at the start are those of the instance, up to the error of the steps.
#[test]
fn placed_instance_starts_at_given_points() {
    let arm = "
assemblies:
  arm:
    shared: all
    parameters: { m: 1 kg ± 1% }
    bodies: { bar: { mass: m, inertia: 0.01, points: { A: [-0.1, 0], B: [0.1, 0] } }, bar_2: { mass: 1, inertia: 0.01 } }
    joints: { pin: { revolute: [ground, bar.A] }, slide: { prismatic: { between: [ground, bar_2], axis: x } } }
    initial: { bar.B.x: 0.12, bar.B.vy: 0.3, bar_2.x: 0.2, bar_2.vx: 0.1 }
    guess: { bar.angle: -0.8 }
";
    let found = bounds(&format!(
        "{arm}instances: {{ one: {{ of: arm }}, two: {{ of: arm, at: [1, 2] }}, three: {{ of: arm, mirror: x }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
outputs: {{ x1: one.bar.B.x, x2: two.bar.B.x - 1, x3: three.bar.B.x, y1: one.bar.B.y, y2: two.bar.B.y - 2, y3: three.bar.B.y, v1: one.bar.B.vy, v2: two.bar.B.vy, v3: three.bar.B.vy }}
{ASKED}"
    ));
    for (name, sign) in [("x", -1.0), ("y", 1.0), ("v", 1.0)] {
        let [[one, ..], [two, ..], [three, ..]] = [1, 2, 3].map(|place| courses(&found, &format!("{name}{place}")));
        for ((one, two), three) in one.iter().zip(two).zip(three) {
            assert!((one - two).abs() < 1e-5 && (one - sign * three).abs() < 1e-5, "{name}: {one}, {two}, {three}");
        }
    }
    assert!((courses(&found, "x1")[0][0] - 0.12).abs() < 1e-9);
}

/// Friction in a joint of an instance is that of the model's own joint.
#[test]
fn joints_of_instances_have_friction() {
    let parts = |of: &str| {
        format!(
            "bodies: {{ bar: {{ mass: 1, inertia: 0.02, points: {{ A: [-0.1, 0] }} }} }}{of}joints: {{ pin: {{ revolute: [ground, bar.A] }} }}{of}effects: {{ rub: {{ joint_friction: {{ on: pin, viscous: 0.5, coefficient: 0.2, radius: 0.02 }} }} }}{of}initial: {{ pin.angle: 0 }}"
        )
    };
    let rest = "parameters: { g: 9 m/s^2 ± 1% }
simulation: { duration: 0.5, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";
    let weight = "weight: { gravity: { acceleration: [0, -g] } }";
    let own = bounds(&format!(
        "{}\noutputs: {{ a: pin.angle, t: rub.torque }}\n{rest}",
        parts("\n").replace("effects: {", &format!("effects: {{ {weight}, "))
    ));
    let instance = bounds(&format!(
        "assemblies:\n  arm:\n    {}\ninstances: {{ one: {{ of: arm }} }}\neffects: {{ {weight} }}\noutputs: {{ a: one.pin.angle, t: one.rub.torque }}\n{rest}",
        parts("\n    ")
    ));
    for output in ["a", "t"] {
        same(&own, output, (&instance, output), 1.0);
    }
}

/// A motion without weight does not depend on its placement.
#[test]
fn a_placed_instance_moves_in_its_frame() {
    let arm = ARM
        .replace("      push: { force: { on: bar.B, value: [1, 3] } }\n", "")
        .replace("      wind: { drag: { on: slide, linear: 0.5, wind: [1, 2] } }\n", "")
        .replace("slide.vx: 0 }", "slide.y: 0.16 m, slide.vx: 0.1, slide.vy: 0.04 }")
        .replace("guess: { slide.y: 0.1, bar.angle: 0.4 }", "guess: { bar.angle: 0.4, bar.x: 0.2, bar.y: 0.2 }");
    for mirror in ["", ", mirror: y"] {
        let text = format!(
            "{arm}instances: {{ one: {{ of: arm {mirror} }}, two: {{ of: arm, at: {{ position: [0.5 m, -0.2], angle: 30 deg }} {mirror} }}, three: {{ of: arm, at: [-1, 2] {mirror} }} }}
outputs:
  x1: 0.5 + cos(30 deg)*one.bar.x - sin(30 deg)*one.bar.y
  y1: -0.2 + sin(30 deg)*one.slide.x + cos(30 deg)*one.slide.y
  x2: two.bar.x
  y2: two.slide.y
  a1: one.bar.angle + 30 deg
  a2: two.bar.angle
  p1: one.pin.angle
  p2: two.pin.angle
  p3: three.pin.angle
  x3: three.bar.x + 1
  x4: one.bar.x
{ASKED}"
        );
        let found = bounds(&text);
        for (first, second) in [("x1", "x2"), ("y1", "y2"), ("a1", "a2"), ("p1", "p2"), ("p1", "p3"), ("x4", "x3")] {
            same(&found, first, (&found, second), 1.0);
        }
    }
}

#[test]
fn placement_in_space_sets_the_frame() {
    let text = format!(
        "{SPATIAL}instances: {{ one: {{ of: arm }}, two: {{ of: arm, at: {{ position: [1, 2 m, 3], rotation: {{ axis: x, angle: 90 deg }} }} }} }}
outputs: {{ x1: one.fore.x + 1, y1: 2 - one.fore.z, z1: 3 + one.fore.y, x2: two.fore.x, y2: two.fore.y, z2: two.fore.z, a1: one.elbow.angle, a2: two.elbow.angle }}
{ASKED}"
    )
    .replace("      brake: { torque: { on: fore, value: [0.1, 0.2, -0.3] } }\n", "");
    let found = bounds(&text);
    for output in ["x", "y", "z", "a"] {
        same(&found, &format!("{output}1"), (&found, &format!("{output}2")), 1.0);
    }
}

/// The placement of each instance may be uncertain by itself.
#[test]
fn placements_may_have_tolerances() {
    let text = format!(
        "{ARM}instances: {{ one: {{ of: arm, at: [0.1 m ± 1 mm, 0] }}, two: {{ of: arm, at: [0.1 m, 0] }} }}
outputs: {{ x: one.bar.x, y: two.bar.y }}
{ASKED}"
    );
    let model = Model::from_yaml_str("test", &text).unwrap();
    let names: Vec<&str> = model.uncertain().map(|(name, _)| name).collect();
    assert_eq!(names, ["arm.l", "arm.m", "one.at.x"]);
    let model = model.with("two.at.x", "0.2±0.01").unwrap();
    assert_eq!(model.uncertain().count(), 4);
}

/// Without guesses, a loop is assembled on the branch on which the assembly itself is.
#[test]
fn a_placed_loop_keeps_its_branch() {
    let text = format!(
        "
assemblies:
  four_bar:
    shared: all
    parameters: {{ l: 0.3 m ± 1% }}
    bodies:
      ground: {{ points: {{ A: [0, 0], D: [0.4, 0.02] }} }}
      crank: {{ mass: 0.4, inertia: 1e-3, points: {{ A: [-0.05, 0], B: [0.05, 0] }} }}
      coupler: {{ mass: 1, inertia: 0.01, points: {{ B: [-0.17, 0], C: [0.17, 0] }} }}
      rocker: {{ mass: 0.8, inertia: 0.01, points: {{ D: [-l/2, 0], C: [l/2, 0] }} }}
      puck: {{ mass: 0.1, inertia: 1e-4, points: {{ P: [0, 0] }} }}
    joints:
      a: {{ revolute: [ground.A, crank.A] }}
      b: {{ revolute: [crank.B, coupler.B] }}
      c: {{ revolute: [coupler.C, rocker.C] }}
      d: {{ revolute: [ground.D, rocker.D] }}
    effects:
      band: {{ spring_damper: {{ between: [ground.D, puck.P], stiffness: 20, free_length: 0.1 }} }}
    initial: {{ a.angle: 0.8, a.angular_velocity: 2 }}
instances:
  one: {{ of: four_bar }}
  two: {{ of: four_bar, at: {{ position: [1 m, -2], angle: 200 deg }} }}
  three: {{ of: four_bar, mirror: y }}
  four: {{ of: four_bar, mirror: x, at: {{ position: [3, 1], angle: 100 deg }} }}
outputs:
  d1: one.d.angle
  d2: two.d.angle
  d3: three.d.angle
  d4: four.d.angle
  p1: one.puck.x
  p2: cos(200 deg)*(two.puck.x - 1) + sin(200 deg)*(two.puck.y + 2)
  p3: three.puck.x
  p4: -cos(100 deg)*(four.puck.x - 3) - sin(100 deg)*(four.puck.y - 1)
{ASKED}"
    );
    let found = bounds(&text);
    for (other, sign) in [("d2", 1.0), ("d3", -1.0), ("d4", -1.0)] {
        // The joint's angle is counted from −π to π at the start: compare its change.
        let (first, second) = (courses(&found, "d1"), courses(&found, other));
        for (value, image) in first[0].iter().zip(&second[0]) {
            let [turned, image] = [value - first[0][0], sign * (image - second[0][0])];
            assert!((turned - image).abs() < 1e-9, "{other}: {turned} and {image}");
        }
    }
    for other in ["p2", "p3", "p4"] {
        same(&found, "p1", (&found, other), 1.0);
    }
}
