//! Positions that are hard: dead centres, change points, toggles, and those where a mechanism locks.

use crate::common::{curve, largest, nominal, order, ran, read, run_methods, study_of};

/// A four-bar linkage with a driven crank of `crank` m, on a base of 0.4 m, with coupler and rocker of 0.2 m and 0.25
/// m.
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
    ran(study_of(text).nominal()).1.failure.expect("the mechanism cannot go on")
}

/// The crank of 0.3 m cannot turn: coupler and rocker are stretched where B is 0.45 m from D,
/// cos θ = (a² + d² − (b + c)²)/(2ad).
#[test]
fn a_linkage_that_locks_is_reported() {
    let locks = ((0.09 + 0.16 - 0.45_f64.powi(2)) / (2.0 * 0.3 * 0.4)).acos() - 0.5;
    for stepping in ["step: 1e-2", "step: 1e-3", "tolerance: 1e-4", "tolerance: 1e-7"] {
        let failure = failure(&driven(0.3, stepping));
        println!("{stepping}: {failure}");
        assert!(failure.contains("locks at t = "), "{stepping}: {failure}");
        let time: f64 = failure.split("t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!((time - locks).abs() < 1.01e-2, "{stepping}: {time} s instead of {locks} s");
        assert!(failure.contains("the loop cannot be closed beyond this position"), "{failure}");
    }
}

#[test]
fn a_crank_that_can_turn_does_not_lock() {
    let (_, summary) = run_methods(&read(&driven(0.1, "step: 1e-2").replace("[0.4, 0]", "[0.3, 0]")), Some(Vec::new()));
    assert_eq!(summary.failure, None);
}

/// A slider crank whose rod is as long as its crank: where both stand upright the slider is at O, a change point, and
/// the crank may take the slider with it or leave it there.
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
    // The branch with the rod as the crank's mirror image is smooth; energy is conserved to second order.
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
fn positions_near_a_change_point_are_regular() {
    // With a crank 1 % shorter than the rod, the slider comes near to O and turns back.
    let (bounds, summary) = run_methods(&read(&change_point(0.495)), Some(Vec::new()));
    assert!(summary.singular_configurations.is_empty(), "{:?}", summary.singular_configurations);
    let energy = curve(&bounds, "energy");
    assert!(largest(energy.iter().map(|value| value - energy[0])) < 1e-2 * energy[0]);
}

/// A toggle: two links, the end of the second on a slider against a spring, pushed through their stretched position by
/// the weight at the knee; x = 2 L cos θ, so that the height of the knee follows from energy alone.
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

/// Two parallelograms of bars of 1 m, so far from the origin, that pass a flat position. Where constraints hold to ε
/// times that distance, the angles of a bar 1e-3 rad before it are known to a thousand times as much only.
fn parallelograms(place: f64) -> String {
    format!(
        "parameters: {{ X: {place} }}
bodies:
  ground: {{ points: {{ P0: [X, 0], P1: [X + 1, 0], P2: [X + 2, 0] }} }}
  bar0: {{ mass: 1, inertia: 1/12, points: {{ foot: [-0.5, 0], end: [0.5, 0] }} }}
  bar1: {{ mass: 1, inertia: 1/12, points: {{ foot: [-0.5, 0], end: [0.5, 0] }} }}
  bar2: {{ mass: 1, inertia: 1/12, points: {{ foot: [-0.5, 0], end: [0.5, 0] }} }}
  link0: {{ mass: 1, inertia: 1/12, points: {{ left: [-0.5, 0], right: [0.5, 0] }} }}
  link1: {{ mass: 1, inertia: 1/12, points: {{ left: [-0.5, 0], right: [0.5, 0] }} }}
joints:
  foot0: {{ revolute: [ground.P0, bar0.foot] }}
  foot1: {{ revolute: [ground.P1, bar1.foot] }}
  foot2: {{ revolute: [ground.P2, bar2.foot] }}
  left0: {{ revolute: [bar0.end, link0.left] }}
  right0: {{ revolute: [link0.right, bar1.end] }}
  left1: {{ revolute: [bar1.end, link1.left] }}
  right1: {{ revolute: [link1.right, bar2.end] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ bar0.angle: 90 deg, bar0.angular_velocity: -1 }}
guess: {{ bar0.x: X, bar1.x: X + 1, bar2.x: X + 2, bar1.angle: 90 deg, bar2.angle: 90 deg, link0.x: X + 0.5, link1.x: X + 1.5 }}
outputs: {{ angle: bar0.angle, apart: bar2.angle - bar0.angle }}
simulation: {{ duration: 1, step: 1e-4, output_step: 0.05 }}
"
    )
}

/// Measured at 100 m, 10 km and 100 km: angles 9.9e-10, 1.4e-9 and 7.6e-8 rad off, bars 1e-13, 3e-11 and 1e-10 rad
/// apart.
#[test]
fn flat_positions_are_passed_far_from_the_origin() {
    let [near, far @ ..] = [0.0, 1e2, 1e4, 1e5].map(|place| nominal(&read(&parallelograms(place))));
    for (far, place) in far.iter().zip([1e2, 1e4, 1e5]) {
        let off = largest(curve(far, "angle").iter().zip(curve(&near, "angle")).map(|(far, near)| far - near));
        let apart = largest(curve(far, "apart").iter().copied());
        println!("{place:e} m from the origin the angle is off by {off:.1e} rad, the bars lie {apart:.1e} rad apart");
        assert!(off < 1e-11 * place + 1e-8 && apart < 1e-14 * place, "{place:e}: {off:e}, {apart:e}");
    }
}
