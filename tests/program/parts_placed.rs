//! Instances that are placed and mirrored, against mechanisms that are written by hand, and against their images.

use mbint::Model;
use mbint::results::Bounds;

#[track_caller]
fn bounds(text: &str) -> Bounds {
    let model = Model::from_yaml_str("test.yaml", text).unwrap_or_else(|error| panic!("{error}"));
    model.study().run().unwrap().bounds().clone()
}

/// The output's nominal course and its bounds.
fn courses(bounds: &Bounds, output: &str) -> [Vec<f64>; 3] {
    let found = bounds.outputs.iter().find(|found| found.name == output).unwrap();
    [found.nominal.clone(), found.bands[0].lower.clone(), found.bands[0].upper.clone()]
}

/// Compares two outputs, the second with a sign.
#[track_caller]
fn same(bounds: &Bounds, first: &str, (other, second): (&Bounds, &str), sign: f64) {
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
const ARM: &str = "
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

const ASKED: &str = "
simulation: { duration: 0.5, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";

#[test]
fn a_mirrored_instance_is_the_mechanism_that_is_mirrored_by_hand() {
    let instance = format!(
        "{ARM}instances: {{ one: {{ of: arm, mirror: y }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [1, -9.81] }} }} }}
outputs: {{ x: one.bar.x, y: one.bar.y, tip: one.tip.y, a: one.pin.angle, s: one.guide.displacement, f: one.pin.force, q: one.slide.y, w: one.hand.angle }}
{ASKED}"
    );
    let by_hand = format!(
        "
parameters: {{ l: 0.3 m ± 1%, m: 2 kg ± 2% }}
bodies:
  ground: {{ points: {{ A: [0.1, -0.2] }} }}
  bar: {{ mass: m, inertia: m*l^2/12, center_of_mass: [0.01, -0.02], points: {{ A: [-l/2, -0.01], B: [l/2, -0.03], tip: [l/2, -0.05] }} }}
  slide: {{ mass: 1, inertia: 0.01 }}
  hand: {{ mass: 0.2, inertia: 1e-3, points: {{ B: [0, -0.02] }} }}
joints:
  pin: {{ revolute: [ground.A, bar.A] }}
  guide: {{ prismatic: {{ between: [ground, slide], axis: [1, -0.4], angle: -0.2 }} }}
  wrist: {{ revolute: [bar.B, hand.B] }}
  drive: {{ motor: {{ on: wrist, position: -0.3*sin(5*t) }} }}
effects:
  weight: {{ gravity: {{ acceleration: [1, -9.81] }} }}
  pull: {{ spring_damper: {{ between: [bar.B, slide], stiffness: 200, free_length: 0.2, force: \"2*pull.rate\" }} }}
  coil: {{ torsional_spring_damper: {{ on: pin, stiffness: 3, free_angle: -0.5 }} }}
  push: {{ force: {{ on: bar.B, value: [1, -3] }} }}
  twist: {{ torque: {{ on: bar, value: -0.4*cos(3*t) }} }}
  turn: {{ torque: {{ on: pin, value: -0.2 - 0.1*pin.angular_velocity }} }}
  end: {{ stop: {{ on: pin, upper: 0.05, impact: {{ stiffness: 200 }} }} }}
  wind: {{ drag: {{ on: slide, linear: 0.5, wind: [1, -2] }} }}
initial: {{ pin.angle: -0.4, pin.angular_velocity: 1, slide.x: 0.4, slide.vx: 0 }}
guess: {{ slide.y: -0.1, bar.angle: -0.4 }}
outputs: {{ x: bar.x, y: bar.y, tip: bar.tip.y, a: pin.angle, s: guide.displacement, f: pin.force, q: slide.y, w: hand.angle }}
{ASKED}"
    );
    let (instance, by_hand) = (bounds(&instance), bounds(&by_hand));
    for output in ["x", "y", "tip", "a", "s", "f", "q", "w"] {
        same(&instance, output, (&by_hand, output), 1.0);
    }
}

#[test]
fn an_image_moves_as_the_mirror_shows() {
    let both = format!(
        "{ARM}instances: {{ one: {{ of: arm }}, two: {{ of: arm, mirror: y }}, three: {{ of: arm, mirror: x }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [3, 0] }} }} }}
outputs: {{ x1: one.bar.x, x2: two.bar.x, y1: one.bar.y, y2: two.bar.y, a1: one.pin.angle, a2: two.pin.angle, a3: three.pin.angle, f1: one.pin.force, f2: two.pin.force }}
{ASKED}"
    );
    let both = bounds(&both);
    same(&both, "x1", (&both, "x2"), 1.0);
    same(&both, "y1", (&both, "y2"), -1.0);
    same(&both, "a1", (&both, "a2"), -1.0);
    same(&both, "f1", (&both, "f2"), 1.0);
    // Gravity along x is another in this mirror: the image is a different motion.
    assert_ne!(courses(&both, "a1")[0], courses(&both, "a3")[0].iter().map(|a| -a).collect::<Vec<_>>());
}

/// An arm in space with skew axes, products of inertia and frames that are turned.
const SPATIAL: &str = "
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

#[test]
fn an_image_in_space_moves_as_the_mirror_shows() {
    for (axis, gravity, letter) in [("x", "[0, 2, -9]", "x"), ("y", "[2, 0, -9]", "y"), ("z", "[2, -9, 0]", "z")] {
        let text = format!(
            "{SPATIAL}instances: {{ one: {{ of: arm }}, two: {{ of: arm, mirror: {axis} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: {gravity} }} }} }}
outputs: {{ x1: one.fore.x, x2: two.fore.x, y1: one.fore.y, y2: two.fore.y, z1: one.fore.z, z2: two.fore.z, a1: one.elbow.angle, a2: two.elbow.angle, f1: one.elbow.force, f2: two.elbow.force }}
{ASKED}"
        );
        let found = bounds(&text);
        for coordinate in ["x", "y", "z"] {
            let sign = if coordinate == letter { -1.0 } else { 1.0 };
            same(&found, &format!("{coordinate}1"), (&found, &format!("{coordinate}2")), sign);
        }
        same(&found, "a1", (&found, "a2"), -1.0);
        same(&found, "f1", (&found, "f2"), 1.0);
    }
}

/// Points at the start are those of the instance, up to the error of the steps.
#[test]
fn a_placed_instance_starts_where_its_points_say() {
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

/// A coin on a slope that is mirrored with it.
#[test]
fn the_image_of_a_coin_rolls_as_the_mirror_shows() {
    let coin = "
assemblies:
  coin:
    shared: all
    parameters: { r: 12 mm ± 2% }
    bodies: { disc: { mass: 9 g, inertia: [9 g*r^2/4, 9 g*r^2/4, 9 g*r^2/2] } }
    joints: { roll: { rolling_on_plane: { between: [ground, disc], normal: [0.2, 0.1, 1], axle: [0.1, 0.2, 1], radius: r } } }
    initial: { disc.x: 0.1, disc.y: 0.05, disc.orientation: { rpy: [0.2, 1, 0.1] }, disc.omega_body: [-8, 3, -50] }
";
    let by_parts =
        coin.replace("disc.omega_body: [-8, 3, -50]", "disc.omega.x: -8, disc.omega.y: 3, disc.omega.z: -50");
    let whole = coin.replace("disc.omega_body", "disc.omega");
    for (coin, axis, gravity) in
        [(coin, "x", "[0, 0.3, -9.81]"), (&by_parts, "y", "[0.3, 0, -9.81]"), (&whole, "x", "[0, 0.3, -9.81]")]
    {
        let found = bounds(&format!(
            "{coin}instances: {{ one: {{ of: coin }}, two: {{ of: coin, mirror: {axis} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: {gravity} }} }} }}
outputs: {{ x1: one.disc.x, x2: two.disc.x, y1: one.disc.y, y2: two.disc.y, z1: one.disc.z, z2: two.disc.z }}
{}",
            ASKED.replace("0.5, step", "0.2, step")
        ));
        for coordinate in ["x", "y", "z"] {
            let sign = if coordinate == axis { -1.0 } else { 1.0 };
            same(&found, &format!("{coordinate}1"), (&found, &format!("{coordinate}2")), sign);
        }
    }
}

/// Friction in a joint of an instance is that of the model's own joint.
#[test]
fn joints_of_instances_rub() {
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

/// A worm turns a wheel whose helical gear drives another, and that a rack; the bearings feel the teeth.
#[test]
fn the_image_of_teeth_has_the_other_hand() {
    let train = "
assemblies:
  train:
    shared: all
    parameters: { drive: 0.4 N*m ± 1% }
    bodies:
      ground: { points: { W: [0, 0.1, 0], G: [0.15, 0.1, 0], R: [0.15, 0.3, 0.01] } }
      thread: { mass: 1, inertia: [0.002, 0.002, 0.002] }
      wheel: { mass: 1, inertia: [0.02, 0.02, 0.03] }
      gear: { mass: 1, inertia: [0.02, 0.02, 0.01] }
      bar: { mass: 2, inertia: [0.02, 0.02, 0.01] }
    joints:
      shaft: { revolute: { between: [ground, thread], axis: x } }
      axle: { revolute: { between: [ground.W, wheel], axis: z } }
      pin: { revolute: { between: [ground.G, gear], axis: z } }
      guide: { prismatic: { between: [ground.R, bar], axis: x } }
      first: { worm: { worm: shaft, wheel: axle, ratio: 3/40, lead_angle: 15 deg, offset: 0.1 } }
      second: { gear: { between: [axle, pin], ratio: -0.8, offset: 0.2, pressure_angle: 20 deg, helix_angle: 12 deg } }
      third: { rack: { pinion: pin, rack: guide, radius: -0.05, offset: 0.02, pressure_angle: 20 deg, helix_angle: 5 deg } }
    effects:
      motor: { torque: { on: shaft, value: drive } }
      rub: { tooth_friction: { on: first, coefficient: 0.05 } }
      lose: { tooth_friction: { on: second, efficiency: 0.95 } }
    initial: { shaft.angle: 0.3, shaft.angular_velocity: 1 }
";
    for (axis, letter) in [("x", 0), ("y", 1), ("z", 2)] {
        let measured = |instance: &str, number: usize| {
            let forces = ["shaft", "axle", "pin"].map(|joint| {
                ["x", "y", "z"]
                    .map(|along| format!("{joint}_{along}_{number}: {instance}.{joint}.force.{along}"))
                    .join(", ")
            });
            let loss = format!("loss_{number}: {instance}.rub.loss, a_{number}: {instance}.pin.angle");
            format!("{}, s_{number}: {instance}.guide.displacement, {loss}", forces.join(", "))
        };
        let text = format!(
            "{train}instances: {{ one: {{ of: train }}, two: {{ of: train, mirror: {axis} }} }}
outputs: {{ {}, {} }}
{ASKED}",
            measured("one", 1),
            measured("two", 2)
        );
        let found = bounds(&text);
        for joint in ["shaft", "axle", "pin"] {
            for (index, along) in ["x", "y", "z"].into_iter().enumerate() {
                let sign = if index == letter { -1.0 } else { 1.0 };
                same(&found, &format!("{joint}_{along}_1"), (&found, &format!("{joint}_{along}_2")), sign);
            }
        }
        same(&found, "a_1", (&found, "a_2"), -1.0);
        same(&found, "s_1", (&found, "s_2"), 1.0);
        same(&found, "loss_1", (&found, "loss_2"), 1.0);
    }
}

/// Drives that follow targets by their rates, through rate limits and in a computer's time, and a wheel on the other
/// side of its rail. Formulas of an instance refer to quantities in the frame of the instance.
#[test]
fn the_image_of_a_controller_and_of_a_wheel() {
    let cart = "
assemblies:
  cart:
    shared: all
    parameters: { m: 2 kg ± 2% }
    bodies:
      lever: { mass: m, inertia: 0.05, points: { top: [0.02, 0.03] } }
      fore: { mass: 0.5, inertia: 2e-3, points: { A: [-0.1, 0.01] } }
      wheel: { mass: 0.5, inertia: 2e-4 }
    joints:
      pin: { revolute: [ground, lever] }
      wrist: { revolute: [lever.top, fore.A] }
      roll: { rolling: { between: [lever.top, wheel], axis: [1, 0.2], radius: 0.04, offset: 0.03 } }
    effects:
      aim: { rate_limit: { input: 0.4*sin(9*t), rate: 2, lag: 20 ms } }
      felt: { sampled: { input: wrist.angle, period: 30 ms } }
      hold: { servo: { on: pin, target: aim, target_rate: 3.6*cos(9*t), proportional: 20, derivative: 1 } }
      drive: { pid: { on: wrist, target: 0.3*sin(7*t), target_rate: 2.1*cos(7*t), proportional: 4, integral: 6, derivative: 0.3 } }
      nudge: { torque: { on: wrist, value: -(0.5 N*m/rad)*felt } }
    initial: { pin.angle: 0.1, pin.angular_velocity: 0, wrist.angle: 0, wrist.angular_velocity: 0, wheel.angle: 0.4 }
";
    for (mirror, gravity, signs) in [("y", "[5, 0]", [1.0, -1.0]), ("x", "[0, -9.81]", [-1.0, 1.0])] {
        let found = bounds(&format!(
            "{cart}instances: {{ one: {{ of: cart }}, two: {{ of: cart, mirror: {mirror} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: {gravity} }} }} }}
outputs: {{ x1: one.wheel.x, x2: two.wheel.x, y1: one.wheel.y, y2: two.wheel.y, f1: one.felt, f2: two.felt, a1: one.wrist.angle, a2: two.wrist.angle }}
{ASKED}"
        ));
        for (name, sign) in [("x", signs[0]), ("y", signs[1]), ("f", 1.0), ("a", -1.0)] {
            same(&found, &format!("{name}1"), (&found, &format!("{name}2")), sign);
        }
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
fn a_place_in_space_has_a_frame() {
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
fn a_place_has_tolerances() {
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
