//! Modes of mechanisms with controllers, against roots of characteristic polynomials and scipy.

use mbint::results::Method;

use crate::common::{nominal, read, run};
use crate::modes_with_states::{Complex, TAU, are, largest_growth, one_of_each, roots};
use crate::statics::{close, ends, example, value};

#[test]
fn modes_of_an_arm_with_two_controllers_match_scipy() {
    // scipy.linalg.eigvals of the 8 × 8 matrix of angles, rates, integrals and filtered rates, with M(θ₂) and ∂²V/∂θ²
    // written out by hand.
    let wanted = [
        Complex::new(-2.801_687_372_373_063_8, 0.0),
        Complex::new(-4.128_185_741_622_606, 0.272_048_618_925_988_64),
        Complex::new(-3.779_633_070_792_856_5, 5.949_653_162_817_95),
        Complex::new(-34.289_892_371_662_475, 0.0),
        Complex::new(-15.213_057_982_233_405, 62.308_045_493_116_985),
    ];
    for formulation in ["absolute", "joint"] {
        let text = format!(
            "
analysis: modes
modes: {{ at: equilibrium, number: 20 }}
bodies:
  upper: {{ mass: 3, inertia: 0.05, points: {{ A: [-0.2, 0], B: [0.25, 0] }} }}
  lower: {{ mass: 2, inertia: 0.03, points: {{ B: [-0.25, 0] }} }}
joints: {{ shoulder: {{ revolute: [ground, upper.A] }}, elbow: {{ revolute: [upper.B, lower.B] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  lift: {{ pid: {{ on: shoulder, target: 0.4, proportional: 90, integral: 150, derivative: 12, filter: 20 ms }} }}
  bend: {{ pid: {{ on: elbow, target: 0.7, proportional: 40, integral: 80, derivative: 4, filter: 30 ms }} }}
guess: {{ upper.angle: 0.3, lower.angle: 0.9 }}
outputs: {{ a: shoulder.angle, b: elbow.angle }}
simulation: {{ duration: 1, formulation: {formulation} }}
"
        );
        let bounds = nominal(&read(&text));
        close(value(&bounds, "a"), 0.4, 1e-10);
        are(&bounds, &wanted, 1e-9);
    }
}

/// J s² + K under a torque that follows 30 (0.6 − θ) − 0.6 ω with a lag of 50 ms: J, K and the equilibrium by mpmath,
/// from the crank's angle alone.
#[test]
fn growth_of_a_slider_crank_with_servo_matches_equation() {
    let text = "
analysis: modes
modes: { at: equilibrium }
parameters: { lag: { value: 50 ms, tolerance: 2% } }
bodies:
  crank: { mass: 1, inertia: 0.002, points: { A: [-0.05, 0], B: [0.05, 0] } }
  rod: { mass: 0.8, inertia: 0.004, points: { B: [-0.125, 0], C: [0.125, 0] } }
  slider: { mass: 1.5, coordinates: [x] }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin: { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
states: { pull: { rate: (30 N*m*(0.6 - crank.angle) - 0.6 N*m*s*crank.angular_velocity - pull)/lag, initial: 0 N*m } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  spring: { spring_damper: { between: [ground, slider], along: x, stiffness: 200, damping: 0, free_length: 0.3 } }
  drive: { torque: { on: pivot, value: pull } }
guess: { crank.angle: 0.6, crank.x: 0.04, crank.y: 0.03, rod.angle: -0.23, rod.x: 0.2, rod.y: 0.03, slider.x: 0.33 }
outputs: { angle: crank.angle, pull: pull }
bounds: { chebyshev: { order: 6 }, scan: { points: 5 } }
";
    let bounds = run(&read(text));
    close(value(&bounds, "angle"), 0.588_889_962_273_067, 1e-11);
    let [pair, lag] =
        [Complex::new(5.923_087_356_049_157, 31.800_020_732_071_23), Complex::new(-31.846_174_712_098_313, 0.0)];
    // |31.85| of the lag is less than |32.35| of the pair.
    are(&bounds, &[lag, pair], 1e-9);
    let (inertia, stiffness) = (0.018_054_119_710_410_21, 0.079_450_607_644_190_1);
    let growth = |lag: f64| roots(&[lag * inertia, inertia, lag * stiffness + 0.6, stiffness + 30.0])[2].re;
    for method in [Method::Chebyshev, Method::Scan] {
        let [lower, upper, error] = ends(&bounds, "mode2.growth", method);
        let mut wanted = [growth(0.049), growth(0.051)];
        wanted.sort_by(f64::total_cmp);
        assert!(
            (lower - wanted[0]).abs() <= error + 1e-9 && (upper - wanted[1]).abs() <= error + 1e-9,
            "{lower} {upper} {wanted:?}"
        );
    }
}

#[test]
fn a_reaction_has_a_part_in_modes() {
    // b is fixed to a, which has a spring of 80 N/m: 5 s² x + 80 x = y, s y = −30 x − 5 y.
    let text = "
analysis: modes
bodies: { a: { mass: 3, coordinates: [x] }, b: { mass: 2, coordinates: [x] } }
joints: { glue: { distance: { between: [a, b], length: 0.5 } } }
states: { y: { rate: -30 N/m/s*a.x - y/(0.2 s), initial: 0 N } }
effects:
  spring: { spring_damper: { between: [ground, a], along: x, stiffness: 80, damping: 0, free_length: 0 } }
  push: { force: { on: a, value: [y, 0] } }
initial: { a.x: 0 }
guess: { b.x: 0.5 }
outputs: { x: a.x, y: y, f: glue.force.x }
";
    let bounds = nominal(&read(text));
    // (5 s² + 80)(s + 5) + 30 = 0.
    let wanted = one_of_each(roots(&[5.0, 25.0, 80.0, 430.0]));
    are(&bounds, &wanted, 1e-9);
    // The force on b is its mass times its acceleration.
    for (mode, root) in wanted.iter().enumerate() {
        let shape = |output: &str| value(&bounds, &format!("mode{}.shape.{output}", mode + 1));
        let (force, y) = (2.0 * root * root, 5.0 * root * root + 80.0);
        let most = if force.norm() > y.norm() { force } else { y };
        close(shape("f"), (force / most).re, 1e-8);
        close(shape("x"), (1.0 / most).re, 1e-8);
    }
}

#[test]
fn modes_of_a_controlled_motion_are_given_in_every_row() {
    // A pendulum of θ that an integral swings: J s³ + d s² + (m g l cos θ + 3) s + ki = 0 in its own row.
    let text = "
analysis: modes
modes: { at: motion }
bodies: { bar: { mass: 2, inertia: 0.1, points: { pin: [0, 0.6] } } }
joints: { pin: { revolute: [ground, bar.pin] } }
states: { sum: { rate: -pin.angle, initial: 0.2 rad*s } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  drive: { torque: { on: pin, value: 4 N*m/s*sum - 3 N*m*pin.angle - 0.5 N*m*s*pin.angular_velocity } }
initial: { bar.angle: 0.8 }
outputs: { angle: bar.angle }
simulation: { duration: 0.4, step: 1e-3, output_step: 0.1 }
";
    let bounds = nominal(&read(text));
    let row = |name: &str| bounds.outputs.iter().find(|output| output.name == name).unwrap().nominal.clone();
    let angles = row("angle");
    assert!(angles.len() == 5 && angles[4] < 0.2, "{angles:?}");
    for (index, angle) in angles.iter().enumerate() {
        let found = one_of_each(roots(&[0.1 + 2.0 * 0.36, 0.5, 2.0 * 9.81 * 0.6 * angle.cos() + 3.0, 4.0]));
        close(row("mode1.growth")[index], found[0].re, 1e-9);
        close(TAU * row("mode2.frequency")[index], found[1].norm(), 1e-9);
        close(row("mode2.growth")[index], found[1].re, 1e-8);
    }
}

#[test]
fn the_example_of_the_guide_is_stable_with_every_load() {
    let bounds = run(&example("stability.yaml"));
    // (J s² + K)(T s + 1) s + k_p (T s + 1) s + k_i (T s + 1) + k_d s² = 0, J = 0.05 + m 0.4², K = −m g 0.4 sin 0.5, T
    // = 0.02.
    let own = |load: f64, integral: f64| {
        let (inertia, stiffness) = (0.05 + load * 0.16, 60.0 - load * 9.81 * 0.4 * 0.5_f64.sin());
        let lag = 0.02;
        let s1 = stiffness + lag * integral;
        one_of_each(roots(&[lag * inertia, inertia, lag * stiffness + 6.0, s1, integral]))
    };
    are(&bounds, &own(3.0, 300.0), 1e-9);
    let corners = [(2.5, 270.0), (2.5, 330.0), (3.5, 270.0), (3.5, 330.0)]
        .map(|(load, integral)| largest_growth(&own(load, integral)));
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| corners.into_iter().reduce(of).unwrap());
    for method in [Method::Chebyshev, Method::Scan] {
        let [lower, upper, error] = ends(&bounds, "growth", method);
        assert!(
            (lower - least).abs() <= error + 1e-9 && (upper - most).abs() <= error + 1e-9,
            "{method:?} {lower} {upper} {corners:?}"
        );
    }
    let page = include_str!("../../docs/guides/modes.md");
    assert!(page.contains(include_str!("../../docs/examples/stability.yaml")), "the page shows the example");
}
