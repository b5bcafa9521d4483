//! Equilibria of mechanisms with controllers: states rest, too.

use mbint::results::Method;

use crate::common::{band, curve, largest, nominal, output, read, refused, run};

const WEIGHT: f64 = 2.0 * 9.81 * 0.15;

/// An arm that hangs on a drive, with its effects and states.
fn arm(effects: &str, states: &str, outputs: &str, rest: &str) -> String {
    format!(
        "
parameters: {{ m: {{ value: 2, unit: kg, tolerance: 10% }}, target: {{ value: 0.5, unit: rad }} }}
bodies: {{ arm: {{ mass: m, inertia: 0.02, points: {{ A: [-0.15, 0] }} }} }}
joints: {{ elbow: {{ revolute: [ground, arm.A] }} }}
states: {{ {states} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  {effects}
outputs: {{ {outputs} }}
bounds: {{ chebyshev: {{ order: 5 }}, taylor: {{ order: 4 }}, scan: {{ points: 5 }} }}
{rest}
"
    )
}

const INTEGRAL: &str = "integral: { rate: target - elbow.angle, initial: 0 rad*s }";
const DRIVE: &str = "drive: { torque: { on: elbow, value: 20 N*m*(target - elbow.angle) + 8 N*m/s*integral - 2 N*m*s*elbow.angular_velocity } }";

/// The integral holds the weight at the target: k ∫e dt = m g l cos(target).
#[test]
fn integral_rests_at_the_value_that_carries_the_weight() {
    let bounds = run(&read(&arm(
        DRIVE,
        INTEGRAL,
        "angle: elbow.angle, integral: integral, rate: integral.rate, height: arm.y",
        "analysis: statics",
    )));
    for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
        for (name, lower, upper) in [
            ("angle", 0.5, 0.5),
            ("rate", 0.0, 0.0),
            ("integral", 0.9 * WEIGHT * 0.5_f64.cos() / 8.0, 1.1 * WEIGHT * 0.5_f64.cos() / 8.0),
            ("height", 0.15 * 0.5_f64.sin(), 0.15 * 0.5_f64.sin()),
        ] {
            let band = band(output(&bounds, name), method);
            let off = [band.lower[0] - lower, band.upper[0] - upper];
            assert!(largest(off) < 1e-10, "{method:?} of {name} is off by {off:?}");
        }
    }
}

/// Without an integral the arm sags until the torque, which follows it through a filter and a motor, holds it: found by
/// bisection.
#[test]
fn a_drive_rests_where_the_arm_sags() {
    let effects = "felt: { filter: { input: elbow.angle, numerator: [1], denominator: [0.01 s^2, 0.14 s, 1] } }
  motor: { dc_motor: { on: elbow, voltage: 60*(target - felt)/(1 rad), resistance: 2, inductance: 0.01, constant: 0.3, ratio: 2 } }
  late: { delay: { input: motor.current, time: 0.1 } }
  rub: { torque: { on: elbow, value: -1 N*m*s*elbow.angular_velocity } }";
    let outputs = "angle: elbow.angle, felt: felt, current: motor.current, late: late";
    let bounds = run(&read(&arm(effects, "", outputs, "analysis: statics")));
    let angle = |m: f64| {
        let missing = |angle: f64| 0.3 * 2.0 * 30.0 * (0.5 - angle) - m * 9.81 * 0.15 * angle.cos();
        let (mut low, mut high) = (-1.0, 0.5);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if missing(middle) > 0.0 { low = middle } else { high = middle }
        }
        low
    };
    for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
        for (name, of) in [
            ("angle", (|angle| angle) as fn(f64) -> f64),
            ("felt", |angle| angle),
            ("current", |angle| 30.0 * (0.5 - angle)),
            ("late", |angle| 30.0 * (0.5 - angle)),
        ] {
            let ends = [of(angle(1.8)), of(angle(2.2))];
            let band = band(output(&bounds, name), method);
            let off = [band.lower[0] - ends[0].min(ends[1]), band.upper[0] - ends[0].max(ends[1])];
            assert!(largest(off) < 1.01 * band.error.total[0] + 1e-10, "{method:?} of {name} is off by {off:?}");
        }
    }
}

/// A motion that starts there stays there, whatever the sample: by steps, by the explicit method, by jets, with digital
/// controllers.
#[test]
fn a_motion_that_starts_at_an_equilibrium_stays_there() {
    let digital = "integral: { sampled: { input: integral + 10 ms*(target - elbow.angle), period: 10 ms } }
  command: { sampled: { input: 20 J*(target - elbow.angle) + 8 W*integral, period: 10 ms } }
  drive: { torque: { on: elbow, value: command - 2 J*s*elbow.angular_velocity } }";
    for simulation in
        ["step: 1e-3", "tolerance: 1e-6", "scheme: explicit, tolerance: 1e-8", "step: 2e-3, extrapolation: 3"]
    {
        for (effects, states) in [(DRIVE, INTEGRAL), (digital, "")] {
            let rest = format!("initial: equilibrium\nsimulation: {{ duration: 1, output_step: 0.1, {simulation} }}");
            let bounds = run(&read(&arm(effects, states, "angle: elbow.angle, integral: integral", &rest)));
            for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
                let held = 8.0_f64.recip() * WEIGHT * 0.5_f64.cos();
                for (name, lower, upper) in [("angle", 0.5, 0.5), ("integral", 0.9 * held, 1.1 * held)] {
                    let band = band(output(&bounds, name), method);
                    let off = largest(
                        band.lower.iter().map(|end| end - lower).chain(band.upper.iter().map(|end| end - upper)),
                    );
                    assert!(off < 1e-9, "{simulation}: {method:?} of {name} is off by {off:e}");
                }
            }
        }
    }
}

/// It starts to move from there when something changes.
#[test]
fn step_of_the_target_ends_the_equilibrium() {
    let drive = DRIVE.replace("target", "(target + 0.05*(1 + sign(t - 0.5 s)))");
    let rest = "initial: equilibrium\nsimulation: { duration: 1, step: 1e-3, output_step: 0.1 }";
    let bounds = nominal(&read(&arm(&drive, INTEGRAL, "angle: elbow.angle, m: m", rest)));
    let angle = curve(&bounds, "angle");
    assert!(largest(angle[..5].iter().map(|angle| angle - 0.5)) < 1e-10 && angle[8] > 0.52, "{angle:?}");
}

/// A state that nothing brings to rest has no equilibrium, and the message names it.
#[test]
fn a_state_that_cannot_rest_is_named() {
    for (states, what) in [
        ("clock: { rate: 1, initial: 0 s }", "the state `clock` still changes by 1.000e0 a second"),
        ("clock: { rate: 2 + elbow.angle, initial: 0 }", "no rate or force depends on it"),
    ] {
        let effects = "hold: { torsional_spring_damper: { between: [ground, arm], stiffness: 40 } }";
        let error = refused(&arm(effects, states, "clock: clock, m: m", "analysis: statics"));
        assert!(error.contains(what), "{error}");
    }
}
