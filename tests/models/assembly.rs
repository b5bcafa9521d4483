//! Mechanisms that cannot be put together say which joint does not fit, by how much, and for which parameters.

use mbint::batch::{self, Options};
use mbint::model::Description;

use super::common::read;

fn error(description: &Description) -> String {
    let options = Options { threads: Some(2), ..Options::default() };
    batch::run(description, options).expect_err("it cannot be assembled").to_string()
}

/// A crank of 0.1 m and a rocker of 0.2 m on a base of 0.3 m: couplers up to 0.6 m fit somewhere.
fn four_bar(coupler: &str) -> Description {
    read(&format!(
        "
parameters: {{ l: {{ {coupler} }} }}
bodies:
  ground: {{ points: {{ right: [0.3, 0] }} }}
  crank: {{ mass: 1, inertia: 0.01, points: {{ B: [0.1, 0] }} }}
  coupler: {{ mass: 1, inertia: 0.01, points: {{ C: [l, 0] }} }}
  rocker: {{ mass: 1, inertia: 0.01, points: {{ C: [0.2, 0] }} }}
joints:
  A: {{ revolute: [ground, crank] }}
  B: {{ revolute: [crank.B, coupler] }}
  C: {{ revolute: [coupler.C, rocker.C] }}
  D: {{ revolute: [ground.right, rocker] }}
initial: {{ crank.angle: 90 deg }}
guess: {{ coupler.angle: 20 deg, rocker.angle: 110 deg }}
outputs: {{ rocker: rocker.angle }}
simulation: {{ duration: 0.1, step: 1e-3, output_step: 0.05 }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
    ))
}

#[test]
fn a_coupler_that_is_too_long_is_reported() {
    // With the crank upright its end is √(0.3² + 0.1²) = 0.3162 m from D, so the coupler has at most 0.5162 m.
    let message = error(&four_bar("value: 0.71"));
    println!("{message}");
    assert!(message.contains("cannot be assembled"), "{message}");
    // The coupler spans from the crank to the rocker; what gapes is one of the loop's joints, by its part of 0.19 m.
    let joint = ["`A`", "`B`", "`C`", "`D`"].iter().any(|joint| message.contains(joint));
    assert!(joint && message.contains("gapes by"), "{message}");
    let amount = message.split("gapes by ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let amount: f64 = amount.parse().unwrap();
    assert!(amount > 0.01 && amount < 0.71 - 0.5162 + 1e-3, "{message}");
}

#[test]
fn a_sample_that_does_not_fit_names_its_parameters() {
    // The nominal coupler fits; the longest of the interval does not.
    let message = error(&four_bar("value: 0.25, plus: 0.3, minus: 0.01"));
    println!("{message}");
    assert!(message.contains("cannot be assembled with l = 0.5"), "{message}");
    assert!(message.contains("gapes by"), "{message}");
}

#[test]
fn velocities_that_do_not_fit_are_reported() {
    let message = error(&read(
        "
bodies: { rod: { mass: 1, inertia: 0.1, points: { top: [0, 0.5] } } }
joints: { hinge: { revolute: [ground, rod.top] } }
initial: { rod.angle: 0, rod.vx: 1, rod.angular_velocity: 0 }
outputs: { angle: rod.angle }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.05 }
",
    ));
    println!("{message}");
    assert!(message.contains("initial velocities do not fit joint `hinge`"), "{message}");
}
