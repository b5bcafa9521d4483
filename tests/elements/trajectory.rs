//! Trajectories and the parts that follow them against scipy and closed forms.

use mbint::results::{Bounds, Method};

use crate::common::{band, curve, distance_from, nominal, output, read, row, run};

const POINTS: &str = "[0.2, 0.1 rad], [0.5, 0.9 rad], [1.1, 0.4 rad], [1.4, 1.2 rad]";
const WITH_RATES: &str = "[0.2, 0.1 rad], [0.5, 0.9 rad, -0.5 rad/s], [1.1, 0.4 rad, 0.8 rad/s], [1.4, 1.2 rad]";

/// A wheel that a motor turns along a trajectory, which is observed too.
fn wheel(trajectory: &str, more: &str) -> Bounds {
    nominal(&read(&format!(
        "
bodies: {{ wheel: {{ mass: 1, inertia: 0.02 }} }}
trajectories: {{ reach: {{ {trajectory} }} }}
joints:
  shaft: {{ revolute: [ground, wheel] }}
  drive: {{ motor: {{ on: shaft, position: reach }} }}
outputs: {{ angle: wheel.angle, reach: reach, rate: reach.rate, acceleration: reach.acceleration, torque: drive.torque }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.1{more} }}
"
    )))
}

/// SciPy 1.17: `CubicSpline(t, x, bc_type=((1, 0), (1, 0)))`, `BPoly.from_derivatives` of values and rates, and of
/// values, rates and accelerations 0.
#[test]
fn polynomials_and_splines_match_scipy() {
    let spline = [
        (0.3, [0.26455026, 2.91269841, 17.77777778]),
        (0.7, [0.85608466, -1.75396825, -9.20634921]),
        (1.3, [1.03544974, 2.91269841, -17.77777778]),
    ];
    let cubic = [
        (0.3, [0.31851852, 3.72222222, 17.77777778]),
        (0.7, [0.69037037, -1.37777778, -1.11111111]),
        (1.3, [1.01037037, 3.28888889, -17.77777778]),
    ];
    let quintic = [
        (0.3, [0.27901235, 4.19135802, 40.98765432]),
        (0.7, [0.70024691, -1.61975309, -4.39506173]),
        (1.3, [1.04987654, 3.5654321, -37.13580247]),
    ];
    for (timing, points, wanted) in
        [("spline", POINTS, spline), ("cubic", WITH_RATES, cubic), ("quintic", WITH_RATES, quintic)]
    {
        let bounds = wheel(&format!("timing: {timing}, points: [{points}]"), "");
        for (time, values) in wanted {
            let row = row(&bounds, time);
            for (name, value) in ["reach", "rate", "acceleration"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row];
                assert!((found - value).abs() < 1e-7, "{timing}: {name} at {time}: {found}, not {value}");
            }
            assert!((curve(&bounds, "angle")[row] - values[0]).abs() < 1e-7);
        }
        for (time, rest) in [(0.0, 0.1), (0.1, 0.1), (1.5, 1.2), (2.0, 1.2)] {
            let row = row(&bounds, time);
            assert!((curve(&bounds, "reach")[row] - rest).abs() < 1e-15 && curve(&bounds, "rate")[row] == 0.0);
        }
    }
}

/// From 0.1 to 0.9 rad in 0.8 s with ramps of 0.2 s: 1/3 of 4 rad/s between accelerations of 20/3 rad/s².
#[test]
fn trapezoids_have_their_ramps_and_the_motor_their_torque() {
    for ramp in ["", ", ramp: 0.2 s"] {
        let bounds = wheel(&format!("timing: trapezoidal, points: [[0.2, 0.1 rad], [1, 0.9 rad]]{ramp}"), "");
        let full = 0.8 / 0.6;
        let value = |t: f64| match t {
            t if t <= 0.2 => 0.1,
            t if t <= 0.4 => 0.1 + 0.5 * full / 0.2 * (t - 0.2).powi(2),
            t if t <= 0.8 => 0.1 + full * (t - 0.3),
            t if t <= 1.0 => 0.9 - 0.5 * full / 0.2 * (1.0 - t).powi(2),
            _ => 0.9,
        };
        assert!(distance_from(&bounds.times, curve(&bounds, "reach"), value) < 1e-14);
        assert!(distance_from(&bounds.times, curve(&bounds, "angle"), value) < 1e-11);
        for (time, acceleration) in [(0.1, 0.0), (0.3, full / 0.2), (0.6, 0.0), (0.9, -full / 0.2), (1.5, 0.0)] {
            let row = row(&bounds, time);
            assert!((curve(&bounds, "acceleration")[row] - acceleration).abs() < 1e-12, "at {time}");
            assert!((curve(&bounds, "torque")[row] - 0.02 * acceleration).abs() < 1e-6, "at {time}");
        }
    }
    let halves = wheel("timing: trapezoidal, ramp: 0.4 s, points: [[0.2, 0 rad], [1, 1 rad]]", "");
    assert!((curve(&halves, "rate")[row(&halves, 0.6)] - 2.5).abs() < 1e-12);
}

/// A mass is pushed by a force that comes and goes within a step: its speed is the area under the force.
#[test]
fn pulse_shorter_than_a_step_is_integrated() {
    let text = |simulation: &str| {
        format!(
            "
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
trajectories: {{ push: {{ timing: quintic, points: [[0.503, 0 N], [0.505, 40 N], [0.507, 0 N]] }} }}
effects: {{ hit: {{ force: {{ on: m, value: [push, 0] }} }} }}
initial: {{ m.x: 0, m.vx: 0 }}
outputs: {{ v: m.vx }}
simulation: {{ duration: 1, output_step: 0.1, {simulation} }}
"
        )
    };
    for (simulation, allowed) in
        [("step: 1e-2", 1e-4), ("tolerance: 1e-6", 1e-6), ("scheme: explicit, tolerance: 1e-8", 1e-8)]
    {
        let bounds = nominal(&read(&text(simulation)));
        let speed = *curve(&bounds, "v").last().unwrap();
        assert!((speed - 0.04).abs() < allowed, "{simulation}: {speed}");
    }
}

/// Uncertain end of a way: x = x₁ σ(u), with σ a smooth step, in every method.
#[test]
fn uncertain_points_are_bounded() {
    let description = read(
        "
parameters: { top: { value: 0.9, unit: rad, tolerance: 10% } }
bodies: { wheel: { mass: 1, inertia: 0.02 } }
trajectories: { reach: { timing: quintic, points: [[0, 0 rad], [1 s, top]] } }
joints: { shaft: { revolute: [ground, wheel] }, drive: { motor: { on: shaft, position: reach } } }
outputs: { angle: wheel.angle }
simulation: { duration: 1.2, step: 1e-3, output_step: 0.1 }
bounds: { chebyshev: { order: 3 }, taylor: { order: 3 }, scan: { points: 5 } }
",
    );
    let bounds = run(&description);
    for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
        let band = band(output(&bounds, "angle"), method);
        for (row, &t) in bounds.times.iter().enumerate() {
            let u = t.min(1.0);
            let shape = u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
            let allowed = 1.01 * band.error.total[row] + 1e-12;
            assert!((band.lower[row] - 0.81 * shape).abs() <= allowed, "{method:?} at {t}");
            assert!((band.upper[row] - 0.99 * shape).abs() <= allowed, "{method:?} at {t}");
            assert!(band.error.total[row] < 1e-6);
        }
    }
}

/// A trajectory through a hundred points, and a servo that follows it.
#[test]
fn a_servo_follows_a_hundred_points() {
    let points: Vec<String> =
        (0..100).map(|i| format!("[{}, {} rad]", 0.02 * f64::from(i), (0.1 * f64::from(i)).sin())).collect();
    let bounds = nominal(&read(&format!(
        "
bodies: {{ wheel: {{ mass: 1, inertia: 0.02 }} }}
trajectories: {{ wave: {{ timing: spline, points: [{}] }} }}
joints: {{ shaft: {{ revolute: [ground, wheel] }} }}
effects: {{ drive: {{ servo: {{ on: shaft, target: wave, proportional: 20, derivative: 1 }} }} }}
initial: {{ shaft.angle: 0, shaft.angular_velocity: 0 }}
outputs: {{ wave: wave, angle: wheel.angle }}
simulation: {{ duration: 1.9, step: 1e-3, output_step: 0.02 }}
",
        points.join(", ")
    )));
    assert!(distance_from(&bounds.times, curve(&bounds, "wave"), |t| (5.0 * t).sin()) < 1e-9);
    assert!(distance_from(&bounds.times, curve(&bounds, "angle"), |t| (5.0 * t).sin()) < 0.3);
}

/// The guide's example: in the end the arm is at its target, but for the sag of the servo under the load.
#[test]
fn example_of_the_guide_reaches_its_target() {
    let text = include_str!("../../docs/examples/trajectories.yaml");
    assert!(include_str!("../../docs/guides/trajectories.md").contains(text));
    let bounds = run(&read(text));
    for method in [Method::Chebyshev, Method::Scan] {
        let band = band(output(&bounds, "error"), method);
        let row = bounds.times.len() - 1;
        // (3 kg · 0.3 m + load · 0.6 m) g cos(20°)/900, by the equilibrium near the target.
        let sag = |load: f64| (3.0 * 0.3 + load * 0.6) * 9.81 * (20.0_f64.to_radians()).cos() / 900.0;
        assert!((band.lower[row] - sag(1.2)).abs() < 6e-4 && (band.upper[row] - sag(1.8)).abs() < 6e-4);
    }
}
