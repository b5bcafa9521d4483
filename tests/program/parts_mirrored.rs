//! Instances that are mirrored, against mechanisms that are written by hand, and against their images.

use super::parts_placed::{ARM, ASKED, SPATIAL, bounds, courses, same};

#[test]
fn mirrored_instance_matches_a_mechanism_written_by_hand() {
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
fn mirrored_instance_moves_symmetrically() {
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

#[test]
fn mirrored_instance_in_space_moves_symmetrically() {
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

/// A coin on a slope that is mirrored with it.
#[test]
fn mirrored_coin_rolls_symmetrically() {
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

/// A worm turns a wheel whose helical gear drives another, and that a rack; the bearings feel the teeth.
#[test]
fn mirrored_teeth_have_the_opposite_hand() {
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
fn mirrored_controller_and_wheel_move_symmetrically() {
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
