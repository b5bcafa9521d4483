//! Bodies without mass: joints or springs determine where they are.

use crate::common::closed_forms::assert_converges;
use crate::common::{curve, distance, distance_from, nominal, order, read, refused, study_of};

/// Two springs in series are one of stiffness k₁k₂/(k₁ + k₂), and the node between them divides their stretch.
#[test]
fn a_node_between_two_springs_divides_their_stretch() {
    let description = read(
        "
bodies:
  node: { mass: 0, coordinates: [x] }
  block: { mass: 2, coordinates: [x] }
effects:
  first: { spring_damper: { between: [ground, node], along: x, stiffness: 300, free_length: 0.2 } }
  second: { spring_damper: { between: [node, block], along: x, stiffness: 150, free_length: 0.3 } }
initial: { block.x: 0.56, block.vx: 0 }
outputs: { block: block.x - 0.5, node: node.x - 0.2, speed: node.vx, force: first.force, energy: energy }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
",
    );
    let (m, stiffness, stretch, share): (f64, f64, f64, f64) = (2.0, 100.0, 0.06, 1.0 / 3.0);
    let omega = (stiffness / m).sqrt();
    // The remaining error is of fourth order: (ω h)⁴ ω t of the amplitude, and rounding.
    assert_converges(&description, 1e-3, "block", 1e-9, |t| stretch * (omega * t).cos());
    assert_converges(&description, 1e-3, "node", 1e-9, |t| share * stretch * (omega * t).cos());
    assert_converges(&description, 1e-3, "speed", 1e-7, |t| -share * stretch * omega * (omega * t).sin());
    let bounds = nominal(&description);
    let kept = 0.5 * stiffness * stretch * stretch;
    let error = distance_from(&bounds.times, curve(&bounds, "energy"), |_| kept);
    assert!(error < 1e-3 * kept, "the energy is off by {error:e} J");
}

/// Springs without free length are a linear law in every direction: the weight moves on an ellipse.
#[test]
fn a_node_in_the_plane_balances_in_both_directions() {
    let description = read(
        "
bodies:
  ground: { points: { anchor: [0.1, 0.3] } }
  node: { mass: 0, coordinates: [x, y] }
  bob: { mass: 0.5, coordinates: [x, y] }
effects:
  first: { spring_damper: { between: [ground.anchor, node], stiffness: 60 } }
  second: { spring_damper: { between: [node, bob], stiffness: 20 } }
initial: { bob.x: 0.3, bob.y: 0.3, bob.vx: 0, bob.vy: 0.4 }
outputs: { x: bob.x - 0.1, y: bob.y - 0.3, u: node.x - 0.1, w: node.y - 0.3 }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
",
    );
    let omega = (15.0_f64 / 0.5).sqrt();
    assert_converges(&description, 1e-3, "x", 1e-9, |t| 0.2 * (omega * t).cos());
    assert_converges(&description, 1e-3, "y", 1e-9, |t| 0.4 / omega * (omega * t).sin());
    assert_converges(&description, 1e-3, "u", 1e-9, |t| 0.05 * (omega * t).cos());
    assert_converges(&description, 1e-3, "w", 1e-9, |t| 0.1 / omega * (omega * t).sin());
}

/// A coupler without mass is a rod that keeps a distance.
#[test]
fn a_coupler_without_mass_is_a_rod() {
    let four_bar = |coupler: &str, joints: &str| {
        read(&format!(
            "
bodies:
  ground: {{ points: {{ A: [0, 0], D: [0.35, 0] }} }}
  crank: {{ mass: 0.6, inertia: 2e-3, points: {{ A: [-0.06, 0], B: [0.06, 0] }} }}
  {coupler}
  rocker: {{ mass: 0.9, inertia: 6e-3, points: {{ D: [-0.11, 0], C: [0.11, 0] }} }}
joints:
  A: {{ revolute: [ground.A, crank.A] }}
  {joints}
  D: {{ revolute: [ground.D, rocker.D] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
guess: {{ rocker.angle: 100 deg }}
initial: {{ crank.angle: 50 deg, crank.angular_velocity: 3 }}
outputs: {{ crank: crank.angle, rocker: rocker.angle, push: A.force }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.01 }}
"
        ))
    };
    let rod = four_bar("", "rod: { distance: { between: [crank.B, rocker.C], length: 0.3 } }");
    let coupler = four_bar(
        "coupler: { mass: 0, inertia: 0, points: { B: [-0.15, 0], C: [0.15, 0] } }",
        "B: { revolute: [crank.B, coupler.B] }\n  C: { revolute: [coupler.C, rocker.C] }",
    );
    let apart = |name: &str, h: f64| {
        let [one, other] = [&rod, &coupler].map(|model| nominal(&model.clone().step(h)));
        distance(curve(&one, name), curve(&other, name))
    };
    for name in ["crank", "rocker"] {
        let error = apart(name, 1e-3);
        assert!(error < 1e-9, "{name} is off by {error:e}");
    }
    // Reactions are of order two each, with different errors: 8e-6 of 41 N where the rocker swings through.
    let [coarse, fine] = [1e-3, 5e-4].map(|h| apart("push", h));
    assert!(coarse < 1e-3 && (order(coarse, fine) - 2.0).abs() < 0.1, "the push is off by {coarse:e}, {fine:e} N");
}

/// An arm without mass on a hinge, placed by springs: joint coordinates find its balance, absolute ones report the
/// reason.
#[test]
fn springs_determine_the_angle_of_a_massless_arm() {
    let text = |formulation: &str| {
        format!(
            r#"
bodies:
  arm: {{ mass: 0, inertia: 0, points: {{ O: [0, 0], tip: [0.5, 0] }} }}
  block: {{ mass: 2, coordinates: [y] }}
joints: {{ hinge: {{ revolute: [ground, arm.O] }} }}
effects:
  hanger: {{ spring_damper: {{ between: [ground, block], along: y, stiffness: 100 }} }}
  twist: {{ torsional_spring_damper: {{ on: hinge, stiffness: 20 }} }}
  pull: {{ torque: {{ on: arm, value: 30 N*(block.y - arm.angle*1 m) }} }}
  push: {{ force: {{ on: block, value: [0, "-30 N/m*(block.y - arm.angle*1 m)"] }} }}
initial: {{ block.y: 0.3, block.vy: 0 }}
outputs: {{ y: block.y, a: arm.angle }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.05, formulation: {formulation} }}
"#
        )
    };
    // 30 (y - a) = 20 a, so that a = 0.6 y; the block feels 100 y + 30 (y - a) = 112 y.
    let bounds = nominal(&read(&text("joint")));
    let exact = |t: f64| 0.3 * (56f64.sqrt() * t).cos();
    // Second order: ω³ h² t/12 is 7e-5 of the amplitude, and the damped scheme has as much again.
    assert!(distance_from(&bounds.times, curve(&bounds, "y"), exact) < 5e-5);
    let ratio = curve(&bounds, "a").iter().zip(curve(&bounds, "y")).map(|(a, y)| (a - 0.6 * y).abs());
    assert!(ratio.fold(0.0, f64::max) < 1e-10);
    if let Err(error) = study_of(&text("absolute")).run() {
        assert!(error.to_string().contains("joints place its body only in part"), "{error}");
    }
}

#[test]
fn undetermined_massless_body_is_refused_by_name() {
    let message = |effects: &str| {
        let text = format!(
            "
bodies: {{ node: {{ mass: 0, coordinates: [x] }}, block: {{ mass: 2, coordinates: [x] }} }}
effects: {{ {effects} }}
initial: {{ block.x: 0.5, block.vx: 0 }}
outputs: {{ x: block.x, n: node.x }}
simulation: {{ duration: 1, step: 1e-3 }}
"
        );
        refused(&text)
    };
    let mount = "mount: { spring_damper: { between: [ground, block], along: x, stiffness: 10, free_length: 0.1 } }";
    let loose = message(mount);
    assert!(loose.contains("`node.x` has no inertia, and no spring and no joint determines where it is"), "{loose}");
    let damped = message(&format!(
        "{mount}, pad: {{ spring_damper: {{ between: [node, block], along: x, stiffness: 10, damping: 1 }} }}"
    ));
    assert!(damped.contains("`node.x` has no inertia, and its force depends on velocities"), "{damped}");
}
