//! Racks, with a gear before them.

use mbint::Formulation;

use crate::common::power::assert_balance;
use crate::common::{curve, distance_from, largest, nominal, order, read};

/// Two wheels on skew axles and a rack: (J₁ + r² J₂ + R² m) φ̈ = τ.
#[test]
fn gears_and_racks_share_the_torque() {
    let description = read(
        "
bodies:
  ground:
    points:
      A: { position: [0, 0, 0], rotation: { rpy: [0.4, 0, 0] } }
      B: { position: [1, 0, 0], rotation: { rpy: [0, 1.2, 0] } }
      C: [0, 0, 2]
  pinion: { mass: 1, inertia: [0.02, 0.02, 0.02] }
  wheel: { mass: 1, inertia: [0.005, 0.005, 0.005] }
  bar: { mass: 3, inertia: [0.1, 0.1, 0.1] }
joints:
  first: { revolute: [ground.A, pinion] }
  second: { revolute: [ground.B, wheel] }
  slide: { prismatic: { between: [ground.C, bar], axis: [1, 2, 2] } }
  mesh: { gear: { between: [first, second], ratio: -2 } }
  teeth: { rack: { pinion: second, rack: slide, radius: 0.05, offset: 0.1 } }
effects: { motor: { torque: { on: first, value: 0.6 } } }
initial: { first.angle: 0, first.angular_velocity: 1 }
outputs: { first: first.angle, second: second.angle, rack: slide.displacement, force: teeth.force, torque: mesh.torque }
simulation: { duration: 1, step: 2e-3, output_step: 0.1, formulation: absolute }
",
    );
    let acceleration = 0.6 / (0.02 + 4.0 * 0.005 + 0.01 * 3.0);
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h)));
    let angle = |t: f64| t + 0.5 * acceleration * t * t;
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "first"), angle));
    println!("angle {errors:?}");
    assert!(order(errors[0], errors[1]) > 1.9 && errors[1] < 1e-4, "{errors:?}");
    // The joints' own angles speed up evenly: nothing is left to be approximated.
    let own = description.formulation(Formulation::Joint);
    let own = nominal(&own);
    assert!(distance_from(&own.times, curve(&own, "first"), angle) < 1e-12);
    let fine = &runs[1];
    let first = curve(fine, "first");
    assert!(largest(curve(fine, "second").iter().zip(first).map(|(second, first)| second + 2.0 * first)) < 1e-10);
    assert!(largest(curve(fine, "rack").iter().zip(first).map(|(s, first)| s + 0.1 * first - 0.1)) < 1e-10);
    // The force that pushes the rack, and the torque that turns the wheel with it: −2 (J₂ + r² m) φ̈.
    let after = |name: &str| curve(fine, name)[1..].iter().copied();
    assert!(largest(after("force").map(|force| force - 3.0 * 0.1 * acceleration)) < 1e-3);
    assert!(largest(after("torque").map(|torque| torque + 2.0 * (0.005 + 0.0025 * 3.0) * acceleration)) < 1e-3);
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        "
bodies:
  pinion: { mass: 1, inertia: [0.02, 0.03, 0.04], center_of_mass: [0.1, 0, 0.05] }
  bar: { mass: 3, inertia: [0.1, 0.1, 0.1] }
joints:
  turn: { revolute: [ground, pinion] }
  slide: { prismatic: { between: [ground, bar], axis: [1, 2, 2] } }
  teeth: { rack: { pinion: turn, rack: slide, radius: 0.2, offset: 0.1 } }
effects: { weight: { gravity: { acceleration: [1, -2, -9.81] } } }
initial: { turn.angle: 0.4, turn.angular_velocity: 2 }
outputs: { energy: energy }
simulation: { duration: 0.5, step: 1e-3, output_step: 1e-3 }
",
        "0",
    );
}
