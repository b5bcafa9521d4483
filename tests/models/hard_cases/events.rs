//! Steps from a tolerance through events: stiff stops, friction that reverses, a force that jumps; and runs that end
//! with a diagnosis where no step is small enough.

use std::f64::consts::PI;

use crate::common::{largest, read, run_methods};

/// Errors of the first output against a closed form, for some tolerances.
fn errors(text: &str, tolerances: &[f64], exact: impl Fn(f64) -> f64) -> Vec<f64> {
    let error = |&tolerance: &f64| {
        let (bounds, summary) = run_methods(&read(text).tolerance(tolerance), Some(Vec::new()));
        let values = bounds.times.iter().zip(&bounds.outputs[0].nominal);
        let error = largest(values.map(|(&t, value)| value - exact(t)));
        println!("tolerance {tolerance:.0e}: {} steps, error {error:.1e}", summary.methods[0].steps);
        error
    };
    tolerances.iter().map(error).collect()
}

#[test]
fn a_force_that_jumps_is_stepped_over_within_the_tolerance() {
    let text = "bodies: { block: { mass: 2, coordinates: [x] } }
effects: { push: { force: { on: block, value: [100*(1 + sign(t - 0.3217)), 0] } } }
initial: { block.x: 0, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 1, step: 1e-3, output_step: 0.1 }
";
    let tolerances = [1e-3, 1e-5, 1e-7];
    let errors = errors(text, &tolerances, |t| 50.0 * (t - 0.3217_f64).max(0.0).powi(2));
    for (error, tolerance) in errors.iter().zip(tolerances) {
        assert!(*error < 100.0 * tolerance, "{errors:?}");
    }
}

#[test]
fn a_force_that_jumps_on_a_mechanism_does_not_stop_it() {
    // A rod about its end, a torque from 0.3217 s on: θ = τ/(2J) (t − t₀)².
    let text = "bodies: { rod: { mass: 3, inertia: 0.25, points: { O: [-0.5, 0] } } }
joints: { O: { revolute: [ground, rod.O] } }
effects: { push: { torque: { on: rod, value: 5*(1 + sign(t - 0.3217)) } } }
initial: { rod.angle: 0, rod.angular_velocity: 0 }
outputs: { angle: rod.angle }
simulation: { duration: 1, step: 1e-3, output_step: 0.1 }
";
    let tolerances = [1e-3, 1e-5, 1e-7];
    let errors = errors(text, &tolerances, |t| 5.0 * (t - 0.3217_f64).max(0.0).powi(2));
    for (error, tolerance) in errors.iter().zip(tolerances) {
        assert!(*error < 100.0 * tolerance, "{errors:?}");
    }
}

/// A ball that falls on a spring and rises again: parabolas and pieces of sines.
#[test]
fn repeated_impacts_on_a_stiff_stop_are_accurate() {
    let (stiffness, drop, g) = (1e8_f64, 0.1_f64, 9.81_f64);
    let text = format!(
        "bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  stop: {{ force: {{ on: ball, value: [0, \"{stiffness:e}*max(0, -ball.y)\"] }} }}
  weight: {{ gravity: {{ acceleration: [0, -{g}] }} }}
initial: {{ ball.y: {drop}, ball.vy: 0 }}
outputs: {{ y: ball.y }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.02 }}
"
    );
    let (fall, speed, omega) = ((2.0 * drop / g).sqrt(), (2.0 * g * drop).sqrt(), stiffness.sqrt());
    let contact = 2.0 * (PI - (speed * omega / g).atan()) / omega;
    let height = |t: f64| {
        let since = t % (2.0 * fall + contact);
        match since {
            since if since < fall => drop - 0.5 * g * since * since,
            since if since < fall + contact => {
                let angle = omega * (since - fall);
                -speed / omega * angle.sin() - g / (omega * omega) * (1.0 - angle.cos())
            }
            since => {
                let rising = since - fall - contact;
                speed * rising - 0.5 * g * rising * rising
            }
        }
    };
    let errors = errors(&text, &[1e-4, 1e-5, 1e-6], height);
    assert!(errors[2] < 1e-4 && errors[2] < errors[0] / 20.0, "{errors:?}");
}

/// A block on a spring, with dry friction: each half of a swing loses 2 μmg/k, and so turns at known positions.
#[test]
fn friction_reverses_at_every_turn() {
    let text = "bodies: { block: { mass: 1, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, block], along: [1, 0], stiffness: 100, free_length: 0 } }
  friction: { force: { on: block, value: [-2*tanh(block.vx/1e-4), 0] } }
initial: { block.x: 1, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 3, step: 1e-3, output_step: 0.05 }
";
    let shift = 2.0 / 100.0;
    let place = |t: f64| {
        let half = PI / 10.0;
        let (count, since) = ((t / half).floor(), t % half);
        let side = if count % 2.0 == 0.0 { 1.0 } else { -1.0 };
        side * (shift + (1.0 - (2.0 * count + 1.0) * shift) * (10.0 * since).cos())
    };
    // The friction is not quite dry: 1e-4 m/s of 10 m/s.
    let errors = errors(text, &[1e-3, 1e-4, 1e-5, 1e-6], place);
    assert!(errors[3] < 1e-4 && errors[3] < errors[0] / 10.0, "{errors:?}");
}

fn failure(text: &str, tolerance: f64) -> String {
    read(text).tolerance(tolerance).finished(Some(Vec::new())).1.failure.expect("the run ends early")
}

#[test]
fn a_motion_that_leaves_every_bound_ends_with_a_diagnosis() {
    // ẍ = 6x² from x = 1, ẋ = 2: x = 1/(1 − t)².
    let text = "bodies: { a: { mass: 1, coordinates: [x] } }
effects: { push: { force: { on: a, value: [6*a.x^2, 0] } } }
initial: { a.x: 1, a.vx: 2 }
outputs: { x: a.x }
simulation: { duration: 2, step: 1e-3, output_step: 0.01 }
";
    let failure = failure(text, 1e-6);
    println!("{failure}");
    assert!(failure.contains("`a.x`") || failure.contains("motion of a.x"), "{failure}");
    let time: f64 = failure.split("t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((time - 1.0).abs() < 0.02, "{failure}");
}

#[test]
fn sticking_under_a_sign_law_ends_with_a_diagnosis() {
    // sign(v) has no value that holds the block: the force jumps from step to step, however short.
    let text = "bodies: { block: { mass: 1, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, block], along: [1, 0], stiffness: 100, free_length: 0 } }
  friction: { force: { on: block, value: [-30*sign(block.vx), 0] } }
initial: { block.x: 0.5, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 3, step: 1e-3, output_step: 0.05 }
";
    let failure = failure(text, 1e-5);
    println!("{failure}");
    assert!(
        failure.contains("`sign(block.vx)` in the motion of `block.x`") && failure.contains("joint_friction"),
        "{failure}"
    );
    // Half a period takes the block from 0.5 m to −0.5 + 2 · 0.3 = 0.1 m, where the spring's 10 N are less than the
    // friction's 30 N.
    let time: f64 = failure.split("t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((time - PI / 10.0).abs() < 0.01, "{failure}");
}
