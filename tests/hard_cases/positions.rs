//! Positions that are hard: dead centres, change points, toggles, and those where a mechanism locks.

use mbint::batch::{self, Options};
use mbint::bounds::Method;

use super::common::{Vary, curve, largest, nominal, order, read, run_methods};

/// A four-bar linkage with a driven crank of `crank` m, on a base of 0.4 m, with coupler and rocker of 0.2 m and 0.25 m.
fn driven(crank: f64, stepping: &str) -> String {
    format!(
        "parameters: {{ omega: {{ value: 1, unit: rad/s }} }}
bodies:
  ground: {{ points: {{ A: [0, 0], D: [0.4, 0] }} }}
  crank: {{ mass: 1, inertia: 0.01, points: {{ A: [-{crank}/2, 0], B: [{crank}/2, 0] }} }}
  coupler: {{ mass: 1, inertia: 0.01, points: {{ B: [-0.1, 0], C: [0.1, 0] }} }}
  rocker: {{ mass: 1, inertia: 0.01, points: {{ D: [-0.125, 0], C: [0.125, 0] }} }}
joints:
  A: {{ revolute: [ground.A, crank.A] }}
  B: {{ revolute: [crank.B, coupler.B] }}
  C: {{ revolute: [coupler.C, rocker.C] }}
  D: {{ revolute: [ground.D, rocker.D] }}
  motor: {{ equation: crank.angle = 0.5 + omega*t }}
guess: {{ coupler.angle: 10 deg, rocker.angle: 100 deg }}
outputs: {{ angle: crank.angle, rocker: rocker.angle }}
simulation: {{ duration: 4, {stepping}, output_step: 0.01 }}
"
    )
}

fn failure(text: &str) -> String {
    let options = Options { methods: Some(Vec::<Method>::new()), threads: Some(2), ..Options::default() };
    batch::run(&read(text), options).unwrap().1.failure.expect("the mechanism cannot go on")
}

/// The crank of 0.3 m cannot turn: coupler and rocker are stretched where B is 0.45 m from D,
/// cos θ = (a² + d² − (b + c)²)/(2ad).
#[test]
fn a_linkage_that_locks_is_told_to_lock() {
    let locks = ((0.09 + 0.16 - 0.45_f64.powi(2)) / (2.0 * 0.3 * 0.4)).acos() - 0.5;
    for stepping in ["step: 1e-2", "step: 1e-3", "tolerance: 1e-4", "tolerance: 1e-7"] {
        let failure = failure(&driven(0.3, stepping));
        println!("{stepping}: {failure}");
        assert!(failure.contains("locks at t = "), "{stepping}: {failure}");
        let time: f64 = failure.split("t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!((time - locks).abs() < 1.01e-2, "{stepping}: {time} s instead of {locks} s");
        assert!(failure.contains("stays open by"), "{failure}");
    }
}

#[test]
fn a_crank_that_can_turn_does_not_lock() {
    let (_, summary) = run_methods(&read(&driven(0.1, "step: 1e-2").replace("[0.4, 0]", "[0.3, 0]")), Some(Vec::new()));
    assert_eq!(summary.failure, None);
}

/// A slider crank whose rod is as long as its crank: where both stand upright the slider is at O, a change point, and the
/// crank may take the slider with it or leave it there.
fn change_point(crank: f64) -> String {
    format!(
        "bodies:
  crank: {{ mass: 1, inertia: 0.05, points: {{ O: [0, 0], A: [{crank}, 0] }} }}
  rod: {{ mass: 1, inertia: 0.05, points: {{ A: [-0.25, 0], B: [0.25, 0] }} }}
  slider: {{ mass: 2, coordinates: [x] }}
joints:
  O: {{ revolute: [ground, crank.O] }}
  A: {{ revolute: [crank.A, rod.A] }}
  B: {{ revolute: [rod.B, slider] }}
initial: {{ crank.angle: 30 deg, crank.angular_velocity: 5 }}
guess: {{ rod.angle: -30 deg }}
outputs: {{ energy: energy, mirrored: crank.angle + rod.angle, angle: crank.angle }}
simulation: {{ duration: 3, step: 1e-3, output_step: 0.01 }}
"
    )
}

#[test]
fn a_change_point_is_passed_on_the_branch_of_the_motion() {
    // The branch with the rod as the crank's mirror image is smooth; energy is kept to second order.
    let description = read(&change_point(0.5));
    let runs = [1e-3, 5e-4].map(|h| run_methods(&description.clone().step(h), Some(Vec::new())));
    let drifts = runs.each_ref().map(|(bounds, _)| {
        assert!(largest(curve(bounds, "mirrored").iter().copied()) < 1e-6, "the branch is left");
        let energy = curve(bounds, "energy");
        largest(energy.iter().map(|value| value - energy[0])) / energy[0]
    });
    println!("energy {drifts:?}");
    // Measured: 2.1e-4 of the energy.
    assert!(drifts[1] < 3e-4 && order(drifts[0], drifts[1]) > 1.8, "{drifts:?}");
    // Upright twice a turn.
    let (bounds, summary) = &runs[1];
    let turned = (curve(bounds, "angle").last().unwrap() - std::f64::consts::FRAC_PI_2) / std::f64::consts::PI;
    let passes = &summary.singular_configurations;
    println!("{passes:?}");
    assert_eq!(passes.len(), turned.floor() as usize + 1, "{passes:?}");
}

#[test]
fn near_a_change_point_nothing_is_singular() {
    // With a crank 1 % shorter than the rod, the slider comes near to O and turns back.
    let (bounds, summary) = run_methods(&read(&change_point(0.495)), Some(Vec::new()));
    assert!(summary.singular_configurations.is_empty(), "{:?}", summary.singular_configurations);
    let energy = curve(&bounds, "energy");
    assert!(largest(energy.iter().map(|value| value - energy[0])) < 1e-2 * energy[0]);
}

/// A toggle: two links, the end of the second on a slider against a spring, pushed through their stretched position by the
/// weight at the knee; x = 2 L cos θ, so that the height of the knee follows from energy alone.
#[test]
fn a_toggle_snaps_through() {
    let text = "bodies:
  left: { mass: 1, inertia: 1/12*0.25, points: { O: [-0.25, 0], K: [0.25, 0] } }
  right: { mass: 1, inertia: 1/12*0.25, points: { K: [-0.25, 0], B: [0.25, 0] } }
  slider: { mass: 0.5, coordinates: [x], points: { P: [0, 0] } }
  ground: { points: { wall: [3, 0] } }
joints:
  O: { revolute: [ground, left.O] }
  K: { revolute: [left.K, right.K] }
  B: { revolute: [right.B, slider.P] }
effects:
  spring: { spring_damper: { between: [slider, ground.wall], stiffness: 20, free_length: 2.2 } }
  weight: { gravity: { acceleration: [0, -9.81] } }
initial: { left.angle: 40 deg, left.angular_velocity: 0 }
guess: { right.angle: -40 deg }
outputs: { angle: left.angle, energy: energy }
simulation: { duration: 2, step: 1e-3, output_step: 0.01 }
";
    let drifts = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&read(text).step(h));
        let angle = curve(&bounds, "angle");
        assert!(angle.iter().any(|&angle| angle < -0.3), "it goes through the stretched position");
        let energy = curve(&bounds, "energy");
        largest(energy.iter().map(|value| value - energy[0]))
    });
    println!("energy {drifts:?}");
    assert!(drifts[1] < 1e-4 && order(drifts[0], drifts[1]) > 1.8, "{drifts:?}");
}
