//! Servos: step response and limit.

use crate::common::power::{assert_balance, pair};
use crate::common::{band, curve, distance, distance_from, nominal, output, read, richardson, run};
use mbint::results::Method;

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

/// Far from its target a servo gives its limit; a moving target is followed in its rate too.
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

/// The corner of the limit, half a per cent below it where the sum before it reaches it.
#[test]
fn the_corner_of_its_limit_is_round() {
    let force = |proportional: f64| {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ cart: {{ mass: 1e9, inertia: 1 }} }}
joints: {{ rail: {{ prismatic: {{ between: [ground, cart], axis: x }} }} }}
effects: {{ drive: {{ servo: {{ on: rail, target: 1, proportional: {proportional}, limit: 10 }} }} }}
initial: {{ cart.x: 0, cart.vx: 0 }}
outputs: {{ force: drive.force }}
simulation: {{ duration: 1e-3, step: 1e-3 }}
"
        )));
        curve(&bounds, "force")[0]
    };
    // √(20² + 0.1²) = 20.00025 and √(18² + 0.1²) = 18.000278, √(2² + 0.1²) = 2.002498.
    for (x, wanted) in [(10.0, 9.950_12), (8.0, 7.998_89)] {
        let found = force(x);
        assert!((found - wanted).abs() < 1e-5, "{x}: {found}, not {wanted}");
    }
}

#[test]
fn power_is_torque_times_rate() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }",
            "  e: { servo: { on: j, target: 0.5, proportional: 40, derivative: 1.2 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "(40*(0.5 - j.angle) - 1.2*j.angular_velocity)*j.angular_velocity",
    );
}

/// A target may be a state: an arm that follows a lagging command equals `states` and a torque that write it out, with
/// an uncertain gain.
#[test]
fn a_target_may_follow_a_state() {
    let text = |drive: &str| {
        format!(
            "
parameters: {{ k: {{ value: 20, unit: N*m/rad, tolerance: 10% }} }}
bodies: {{ arm: {{ mass: 1, inertia: 0.5 }} }}
joints: {{ hinge: {{ revolute: [ground, arm] }} }}
states: {{ command: {{ rate: (1 rad - command)/(0.2 s), initial: 0 rad }} }}
effects: {{ drive: {{ {drive} }} }}
initial: {{ hinge.angle: 0.1, hinge.angular_velocity: 0 }}
outputs: {{ s: arm.angle }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.05 }}
"
        )
    };
    let servo =
        "servo: { on: hinge, target: command, target_rate: (1 rad - command)/(0.2 s), proportional: k, derivative: 3 }";
    let written = "torque: { on: hinge, value: k*(command - hinge.angle) + 3 N*m*s/rad*((1 rad - command)/(0.2 s) - hinge.angular_velocity) }";
    let [servo, written] = [servo, written].map(|drive| run(&read(&text(drive))));
    let bands = [&servo, &written].map(|bounds| band(output(bounds, "s"), Method::Chebyshev));
    assert!(distance(&bands[0].lower, &bands[1].lower) < 1e-10 && distance(&bands[0].upper, &bands[1].upper) < 1e-10);
    // Without derivative nothing asks for the rate.
    nominal(&read(&text("servo: { on: hinge, target: 2*command, proportional: k }")));
}
