//! Drives, resistance, cables and gears with play, against closed forms.

use super::common::{Vary, curve, distance_from, largest, nominal, order, read, richardson, row};

/// J θ̈ + k_d θ̇ + k_p θ = k_p θ₀ from rest: the step response of a damped oscillator.
#[test]
fn a_servo_answers_a_step() {
    let (inertia, kp, kd, target) = (0.1, 40.0, 1.2, 0.5);
    let description = read(&format!(
        "
bodies: {{ arm: {{ mass: 1, inertia: {inertia} }} }}
joints: {{ hinge: {{ revolute: [ground, arm] }} }}
effects: {{ drive: {{ servo: {{ on: hinge, target: {target}, proportional: {kp}, derivative: {kd} }} }} }}
initial: {{ arm.angle: 0, arm.angular_velocity: 0 }}
outputs: {{ angle: arm.angle }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.01 }}
"
    ));
    let decay: f64 = kd / (2.0 * inertia);
    let omega = (kp / inertia - decay * decay).sqrt();
    let exact = |t: f64| target * (1.0 - (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin()));
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let left = distance_from(&runs[0].times, &richardson(curve(&runs[0], "angle"), curve(&runs[1], "angle")), exact);
    assert!(left < 1e-7, "{left:e}");
}

/// Far from its target a servo gives what its limit allows; a moving target is followed in its rate too.
#[test]
fn a_servo_has_its_limit() {
    let bounds = nominal(&read(
        "
bodies: { cart: { mass: 2, inertia: 1 } }
joints: { rail: { prismatic: { between: [ground, cart], axis: x } } }
effects: { drive: { servo: { on: rail, target: 100 + 3*t, proportional: 1000, derivative: 20, limit: 8 } } }
initial: { cart.x: 0, cart.vx: 0 }
outputs: { x: cart.x, force: drive.force }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
",
    ));
    assert!(distance_from(&bounds.times, curve(&bounds, "force"), |_| 8.0) < 1e-6);
    assert!(distance_from(&bounds.times, curve(&bounds, "x"), |t| 2.0 * t * t) < 1e-6);
}

/// A body that falls through a fluid: v = v_T tanh(g t/v_T), v_T² = 2 m g/(ρ c_d A).
#[test]
fn a_falling_body_reaches_its_terminal_speed() {
    let description = read(
        "
bodies: { sphere: { mass: 0.5, coordinates: [x, y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  air: { drag: { on: sphere, density: 1.2 kg/m^3, drag_coefficient: 0.47, area: 0.3 m^2, wind: [2, 0] } }
initial: { sphere.x: 0, sphere.y: 0, sphere.vx: 2, sphere.vy: 0 }
outputs: { v: sphere.vy, vx: sphere.vx, force: air.force }
simulation: { duration: 3, step: 1e-3, output_step: 0.01 }
",
    );
    let terminal = (2.0 * 0.5 * 9.81 / (1.2 * 0.47 * 0.3_f64)).sqrt();
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h)));
    let exact = |t: f64| -terminal * (9.81 * t / terminal).tanh();
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "v"), exact));
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    assert!(errors[1] < 1e-5, "{errors:?}");
    assert!(distance_from(&runs[1].times, curve(&runs[1], "vx"), |_| 2.0) < 1e-12);
    assert!((curve(&runs[1], "force").last().unwrap() - 4.905).abs() < 0.05);
}

/// A jumper on a rope: free fall, then the rope: at the lowest point m g (ℓ₀ + x) = ½ k x², and back to where he was.
#[test]
fn a_cable_is_slack_and_then_taut() {
    let description = read(
        "
bodies: { jumper: { mass: 70, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rope: { cable: { between: [ground, jumper], free_length: 10, stiffness: 200 } }
initial: { jumper.y: -1, jumper.vy: 0 }
outputs: { y: jumper.y, tension: rope.force, energy: energy }
simulation: { duration: 9, step: 1e-3, output_step: 1e-3 }
",
    );
    let (weight, k): (f64, f64) = (70.0 * 9.81, 200.0);
    let stretch = (weight + (weight * weight + 2.0 * k * weight * 9.0).sqrt()) / k;
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h).rows_every(2e-3)));
    for bounds in &runs {
        let fall = (2.0 * 9.0_f64 / 9.81).sqrt();
        let early = row(bounds, 1.3);
        assert!(bounds.times[early] < fall);
        assert!(curve(bounds, "tension")[..early].iter().all(|tension| *tension == 0.0));
        assert!(distance_from(&bounds.times[..early], &curve(bounds, "y")[..early], |t| -1.0 - 4.905 * t * t) < 1e-9);
        let lowest = curve(bounds, "y").iter().copied().fold(0.0, f64::min);
        assert!((lowest + 10.0 + stretch).abs() < 1e-3, "{lowest} {stretch}");
        let energy = largest(curve(bounds, "energy").iter().map(|energy| energy + weight));
        assert!(energy < 2.0, "{energy}");
    }
}

/// Two wheels of one inertia with play between: the first turns through half the play, and then the second has its speed.
#[test]
fn a_gear_takes_up_its_play() {
    let bounds = nominal(&read(
        "
bodies:
  first: { inertia: 0.01, coordinates: [angle] }
  second: { inertia: 0.01, coordinates: [angle] }
effects: { teeth: { backlash: { between: [first, second], ratio: -1, backlash: 0.1, stiffness: 1e4 } } }
initial: { first.angle: 0, first.angular_velocity: 1, second.angle: 0, second.angular_velocity: 0 }
outputs: { first: first.angular_velocity, second: second.angular_velocity, torque: teeth.torque, energy: energy }
simulation: { duration: 0.1, step: 2e-5, output_step: 1e-3 }
",
    ));
    let before = &curve(&bounds, "torque")[..row(&bounds, 0.048)];
    assert!(before.iter().all(|torque| *torque == 0.0));
    // Elastic, and ratio −1: the first stands, the second turns back at its speed.
    assert!(curve(&bounds, "first").last().unwrap().abs() < 1e-3, "{:?}", curve(&bounds, "first").last());
    assert!((curve(&bounds, "second").last().unwrap() + 1.0).abs() < 1e-3);
    assert!(distance_from(&bounds.times, curve(&bounds, "energy"), |_| 0.005) < 1e-5);
}

/// A preload moves a mass on a spring by F/k, and a hinge with its spring by τ/k.
#[test]
fn a_preload_is_held_by_springs() {
    let bounds = nominal(&read(
        "
bodies:
  mass: { mass: 1, inertia: 0.01 }
  arm: { mass: 1, inertia: 0.01 }
joints:
  rail: { prismatic: { between: [ground, mass], axis: x } }
  hinge: { revolute: [ground, arm] }
effects:
  spring: { spring_damper: { between: [ground, mass], along: x, stiffness: 200, damping: 28, free_length: 1 } }
  pull: { preload: { between: [ground, mass], value: 10 } }
  push: { preload: { on: rail, value: 4 } }
  wire: { torsional_spring_damper: { on: hinge, stiffness: 5, damping: 0.4 } }
  twist: { preload: { on: hinge, value: 2 } }
initial: { mass.x: 1, mass.vx: 0, arm.angle: 0, arm.angular_velocity: 0 }
outputs: { x: mass.x, angle: arm.angle, length: spring.length, force: spring.force }
simulation: { duration: 4, step: 1e-3, output_step: 0.1 }
",
    ));
    for (name, value) in [("x", 1.0 - 6.0 / 200.0), ("angle", 0.4), ("length", 0.97), ("force", -6.0)] {
        let last = curve(&bounds, name).last().unwrap();
        assert!((last - value).abs() < 1e-6, "{name}: {last}, not {value}");
    }
}

/// A hardening spring by a formula of its own length: ½ m v² + ¼ k₃ x⁴ stays, and so the period is
/// 4 √(2 m/k₃)/A ∫₀¹ du/√(1 − u⁴).
#[test]
fn a_spring_may_be_a_formula_of_its_length() {
    let description = read(
        "
parameters: { k3: 400 N/m^3 }
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  hard: { spring_damper: { between: [ground, mass], along: x, force: k3*hard.length^3 } }
initial: { mass.x: 0.3, mass.vx: 0 }
outputs: { x: mass.x, v: mass.vx, rate: hard.rate }
simulation: { duration: 2, step: 1e-3, output_step: 1e-3 }
",
    );
    // ∫₀¹ du/√(1 − u⁴) = Γ(¼)²/(4 √(2π))
    let period = 4.0 * (2.0 * 0.5 / 400.0_f64).sqrt() / 0.3 * 1.311_028_777_146_06;
    let bounds = nominal(&description);
    let x = curve(&bounds, "x");
    let crossings: Vec<f64> = (1..x.len())
        .filter(|&i| x[i - 1] > 0.0 && x[i] <= 0.0)
        .map(|i| bounds.times[i - 1] + 1e-3 * x[i - 1] / (x[i - 1] - x[i]))
        .collect();
    let found = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
    assert!((found - period).abs() < 1e-4 * period, "{found} {period}");
    assert!(distance_from(&bounds.times, curve(&bounds, "rate"), |_| 0.0) > 1.0);
}
