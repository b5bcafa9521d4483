//! DC motors against scipy and their steady state.

use mbint::results::Method;

use crate::common::{band, curve, distance_from, nominal, output, read, row, run};

fn drive(motor: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ k: {{ value: 0.05, tolerance: 4% }} }}
bodies: {{ arm: {{ mass: 1, inertia: 0.3 }} }}
joints: {{ hinge: {{ revolute: [ground, arm] }} }}
effects: {{ motor: {{ dc_motor: {{ on: hinge, voltage: 12, resistance: 0.8, constant: k, ratio: 20, {motor} }} }} }}
initial: {{ hinge.angle: 0, hinge.angular_velocity: 0 }}
outputs: {{ s: arm.angle, w: arm.angular_velocity, current: motor.current, torque: motor.torque }}
simulation: {{ duration: 1, output_step: 0.005, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12: angle, rate and current.
#[test]
fn motor_start_matches_scipy() {
    let wanted = [
        (0.005, [0.00016499, 0.09182161, 9.44945489]),
        (0.02, [0.00615432, 0.73976083, 14.07577025]),
        (0.1, [0.20237546, 3.98618325, 10.23514066]),
        (0.4, [2.44484503, 9.76558292, 2.85376793]),
        (1.0, [9.16080193, 11.82629436, 0.22185454]),
    ];
    for (simulation, allowed) in [("step: 5e-5", 1e-4), ("scheme: explicit, tolerance: 1e-8", 1e-6)] {
        let bounds = nominal(&read(&drive("inductance: 4e-3", simulation)));
        for (time, values) in wanted {
            for (name, value) in ["s", "w", "current"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row(&bounds, time)];
                assert!((found - value).abs() < allowed, "{simulation}: {name} at {time}: {found}, not {value}");
            }
        }
    }
}

/// Without inductance: ω = U/(k N) (1 − e^(−t/T)) with T = J R/(k N)², so that its bounds are those of k; and a limit
/// of 6 V.
#[test]
fn motor_without_inductance_is_a_lag() {
    for (motor, volts) in [("", 12.0), ("limit: 6", 6.0)] {
        let bounds = run(&read(&drive(motor, "step: 1e-3")));
        let rate = |k: f64, t: f64| volts / (20.0 * k) * (1.0 - (-t * (20.0 * k).powi(2) / 0.24).exp());
        // The voltage at a smooth limit is within 1e-4 of it at twice the limit.
        let exact = if volts == 12.0 { 1e-5 } else { 1e-3 };
        assert!(distance_from(&bounds.times, curve(&bounds, "w"), |t| rate(0.05, t)) < exact);
        let band = band(output(&bounds, "w"), Method::Chebyshev);
        let last = bounds.times.len() - 1;
        let ends = [rate(0.052, 1.0), rate(0.048, 1.0)];
        assert!((band.lower[last] - ends[0]).abs() < exact + 1.01 * band.error.total[last]);
        assert!((band.upper[last] - ends[1]).abs() < exact + 1.01 * band.error.total[last]);
    }
}

/// A motor and its controller in an image turn the other way.
#[test]
fn an_image_turns_the_other_way() {
    let text = "
assemblies:
  arm:
    bodies: { arm: { mass: 1, inertia: 0.3, points: { end: [0.4, 0] } }, hand: { mass: 0.2, inertia: 0.02 } }
    joints: { hinge: { revolute: [ground, arm] }, wrist: { revolute: [arm.end, hand] } }
    effects:
      motor: { dc_motor: { on: hinge, voltage: 20 - 15*hinge.angle, limit: 12, resistance: 0.8, inductance: 4e-3, constant: 0.05, ratio: 20, initial: 1 } }
      holder: { pid: { on: wrist, target: 0.5 + 0.1*t, proportional: 2, integral: 3, derivative: 0.2, filter: 10 ms, limit: 0.4 N*m, initial: 0.1 N*m } }
    initial: { hinge.angle: 0.1, hinge.angular_velocity: 0, wrist.angle: 0, wrist.angular_velocity: 0 }
instances: { one: { of: arm }, two: { of: arm, mirror: y }, three: { of: arm, mirror: x } }
outputs:
  a: one.hinge.angle
  b: two.hinge.angle
  c: three.hinge.angle
  current: one.motor.current
  its: two.motor.current
  wrist: one.wrist.angle
  image: two.wrist.angle
  torque: one.holder.torque
  other: two.holder.torque
simulation: { duration: 0.4, step: 1e-3, output_step: 0.02 }
";
    let bounds = nominal(&read(text));
    for (name, other) in [("a", "b"), ("a", "c"), ("current", "its"), ("wrist", "image"), ("torque", "other")] {
        let [one, two] = [name, other].map(|name| curve(&bounds, name));
        assert!(crate::common::largest(one.iter().zip(two).map(|(one, two)| one + two)) < 1e-9);
        // The holder's torque is at its limit.
        assert!(
            name == "torque" || crate::common::largest(one.iter().map(|value| value - one[0])) > 0.01,
            "{name}: {one:?}"
        );
    }
}
