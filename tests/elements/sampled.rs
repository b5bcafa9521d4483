//! Sampled numbers against difference equations.

use mbint::results::{Bounds, Method};

use crate::common::{band, curve, largest, nominal, output, read, run};

const PERIOD: f64 = 0.05;

/// A mass of 2 kg that a digital controller pushes.
fn text(command: &str, effects: &str, outputs: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ gain: {{ value: 40, unit: N/m, tolerance: 10% }}, rub: {{ value: 9, unit: N*s/m }} }}
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
effects:
  command: {{ sampled: {{ {command}, period: 50 ms }} }}
  push: {{ force: {{ on: m, value: [command, 0] }} }}
  {effects}
initial: {{ m.x: 0.5, m.vx: -0.2 }}
outputs: {{ {outputs} }}
simulation: {{ duration: 1.2, {simulation} }}
bounds: {{ chebyshev: {{ order: 5 }}, taylor: {{ order: 5 }}, scan: {{ points: 9 }} }}
"
    )
}

const FEEDBACK: &str = "input: -gain*m.x - rub*m.vx";
const OUTPUTS: &str = "x: m.x, v: m.vx, a: m.ax, command: command, gain: gain";

/// x, v and the force under feedback, at a time: between instants the mass moves at a constant acceleration.
fn motion(gain: f64, time: f64) -> [f64; 3] {
    let (mut x, mut v) = (0.5, -0.2);
    let instants = (time / PERIOD + 1e-9).floor() as usize;
    let mut pass = |h: f64| {
        let force = -gain * x - 9.0 * v;
        let a = force / 2.0;
        (x, v) = (x + v * h + 0.5 * a * h * h, v + a * h);
        force
    };
    (0..instants).for_each(|_| {
        pass(PERIOD);
    });
    let force = pass(time - instants as f64 * PERIOD);
    [x, v, force]
}

/// Whatever the steps: they end at the instants, also where these are no multiples of theirs, and constant
/// accelerations are integrated exactly. Rows at instants come after the change.
#[test]
fn a_held_force_moves_a_mass_by_its_difference_equation() {
    for (simulation, allowed) in [
        ("step: 1e-3, output_step: 0.025", 1e-12),
        ("step: 8e-3, output_step: 0.04", 1e-12),
        ("step: 0.1, output_step: 0.1", 1e-12),
        ("step: 8e-3, output_step: 0.04, extrapolation: 3", 1e-11),
        ("tolerance: 1e-6, output_step: 0.04", 1e-11),
        ("tolerance: 1e-6, output_step: 0.3", 1e-11),
        ("scheme: explicit, tolerance: 1e-9, output_step: 0.025", 1e-11),
        ("scheme: explicit, tolerance: 1e-9, output_step: 0.04", 1e-11),
    ] {
        let bounds = nominal(&read(&text(FEEDBACK, "", OUTPUTS, simulation)));
        for (name, index, unit) in [("x", 0, 1.0), ("v", 1, 1.0), ("a", 2, 0.5), ("command", 2, 1.0)] {
            let rows = bounds.times.iter().zip(curve(&bounds, name));
            let error = largest(rows.map(|(&t, value)| value - unit * motion(40.0, t)[index]));
            assert!(error < 20.0 * allowed, "{simulation}: {name} is off by {error:e}");
        }
    }
}

/// Bounds of all methods, over the tolerance of the gain.
#[test]
fn bounds_match_the_difference_equation() {
    for simulation in ["step: 2e-3, output_step: 0.05", "scheme: explicit, tolerance: 1e-9, output_step: 0.05"] {
        let bounds = run(&read(&text(FEEDBACK, "", OUTPUTS, simulation)));
        assert_eq!(output(&bounds, "command").unit, "N");
        for (name, index) in [("x", 0), ("command", 2)] {
            for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
                let band = band(output(&bounds, name), method);
                for (row, &t) in bounds.times.iter().enumerate() {
                    let values =
                        (0..=400).map(|index| 36.0 + 0.02 * f64::from(index)).map(|gain| motion(gain, t)[index]);
                    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                        (low.min(value), high.max(value))
                    });
                    let allowed = 1e-5 * (high - low) + 1.01 * band.error.total[row] + 1e-11;
                    let (below, above) = (band.lower[row] - low, band.upper[row] - high);
                    assert!(
                        below.abs() < allowed && above.abs() < allowed,
                        "{simulation}: {method:?} of {name} at {t}: {below:e}, {above:e}"
                    );
                }
            }
        }
    }
}

/// With the gains m/T² and 3 m/(2 T) a double integrator is at rest after two periods (Åström & Wittenmark, example
/// 4.4).
#[test]
fn deadbeat_control_brings_a_mass_to_rest_in_two_periods() {
    let command = "input: -(2 kg)/(50 ms)^2*m.x - 1.5*(2 kg)/(50 ms)*m.vx";
    let bounds = nominal(&read(&text(
        command,
        "",
        "x: m.x, v: m.vx, gain: gain + rub*(1 m/s)/(1 m)",
        "step: 5e-3, output_step: 0.05",
    )));
    for name in ["x", "v"] {
        let curve = curve(&bounds, name);
        assert!(curve[1].abs() > 1e-2, "{curve:?}");
        assert!(curve[2..].iter().all(|value| value.abs() < 1e-11), "{curve:?}");
    }
}

/// A number that refers to itself is the memory of a difference equation; other numbers see the value held until then.
#[test]
fn sampled_numbers_have_memory() {
    let effects = "
  count: { sampled: { input: count + 1, period: 0.02 } }
  before: { sampled: { input: count, period: 40 ms, initial: -7 } }
  sum: { sampled: { input: sum + 50 ms*(m.x - 0.1), period: 50 ms, initial: 0.3 } }";
    let command = "input: -gain*m.x - rub*m.vx";
    for simulation in ["step: 2e-3, output_step: 0.01", "scheme: explicit, tolerance: 1e-9, output_step: 0.01"] {
        let outputs = "x: m.x, count: count, before: before, sum: sum, gain: gain";
        let bounds = nominal(&read(&text(command, effects, outputs, simulation)));
        let [count, before, sum] = ["count", "before", "sum"].map(|name| curve(&bounds, name));
        for (row, &t) in bounds.times.iter().enumerate() {
            let counted = |t: f64| (t / 0.02 + 1e-9).floor() + 1.0;
            assert_eq!(count[row], counted(t), "{simulation}: at {t}");
            // `before` is sampled at every second count and holds the count just before it.
            let at = (t / 0.04 + 1e-9).floor() * 0.04;
            assert_eq!(before[row], counted(at) - 1.0, "{simulation}: at {t}");
            let instants = (t / PERIOD + 1e-9).floor() as usize;
            let sampled = (0..=instants).map(|k| PERIOD * (motion(40.0, k as f64 * PERIOD)[0] - 0.1)).sum::<f64>();
            assert!((sum[row] - 0.3 - sampled).abs() < 1e-11, "{simulation}: {} at {t}", sum[row]);
        }
    }
}

/// A slider crank whose torque is computed every 40 ms: jumps cost no order, whether they are at ends of steps or not.
#[test]
fn a_linkage_under_digital_control_is_of_order_two() {
    let text = |simulation: &str| {
        format!(
            "
parameters: {{ tau: {{ value: 0.4, unit: N*m, tolerance: 5% }} }}
bodies:
  crank: {{ mass: 0.37, inertia: 7e-4, points: {{ A: [-0.075, 0], B: [0.075, 0] }} }}
  rod: {{ mass: 0.77, inertia: 0.02, points: {{ B: [-0.28, 0], C: [0.28, 0] }} }}
  slider: {{ mass: 0.45, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  wrist: {{ revolute: [rod.C, slider] }}
effects:
  command: {{ sampled: {{ input: 0.1*(6 - crank.angular_velocity/(1 rad/s))*tau, period: 40 ms }} }}
  drive: {{ torque: {{ on: crank, value: command }} }}
initial: {{ crank.angle: 0.3, crank.angular_velocity: 4 }}
outputs: {{ x: slider.x, w: crank.angular_velocity, force: pivot.force.x }}
simulation: {{ duration: 1.0, output_step: 0.05, {simulation} }}
bounds: {{ taylor: {{ order: 1 }} }}
"
        )
    };
    let exact = nominal(&read(&text("scheme: explicit, tolerance: 1e-12")));
    let off = |simulation: &str, name: &str| {
        let bounds: Bounds = nominal(&read(&text(simulation)));
        largest(curve(&bounds, name).iter().zip(curve(&exact, name)).map(|(a, b)| a - b))
    };
    for name in ["x", "w", "force"] {
        for steps in [["step: 1e-3", "step: 5e-4"], ["step: 1.5625e-3", "step: 7.8125e-4"]] {
            let [coarse, fine] = steps.map(|simulation| off(simulation, name));
            println!("{name}, {steps:?}: {coarse:e}, {fine:e}");
            assert!(coarse > 3.0 * fine && coarse < 5.5 * fine, "{name}, {steps:?}: {coarse:e}, {fine:e}");
        }
        let extrapolated = off("step: 1e-3, extrapolation: 4", name);
        let plain = off("step: 1e-3", name);
        println!("{name}: {plain:e}, extrapolated {extrapolated:e}");
        assert!(extrapolated < 1e-4 * plain, "{name}: {plain:e}, extrapolated {extrapolated:e}");
    }
}

/// Samples that meet a stop at their own times take their own steps; at the instants they change as all others do.
#[test]
fn samples_with_own_steps_change_at_common_instants() {
    let effects = "
  floor: { contact: { between: [ground, m], plane: x, impact: { stiffness: 2e4, exponent: 1, dissipation: 0.5 } } }
  pull: { force: { on: m, value: [-10, 0] } }
  count: { sampled: { input: count + 1, period: 30 ms } }";
    let outputs = "x: m.x, v: m.vx, count: count, gain: gain, touch: floor.force";
    let command = "input: -gain*m.x - 2 N*s/m*m.vx";
    let of = |simulation: &str| run(&read(&text(command, effects, outputs, simulation)));
    let fine = of("step: 1e-4, output_step: 0.1");
    let controlled = of("tolerance: 1e-5, output_step: 0.1");
    let touches = curve(&of("step: 1e-3, output_step: 1e-3"), "touch").iter().filter(|force| **force > 1.0).count();
    assert!(touches > 20, "{touches}");
    for name in ["x", "v", "count"] {
        let bands = [&fine, &controlled].map(|bounds| band(output(bounds, name), Method::Scan));
        for row in 0..fine.times.len() {
            let [one, other] = [&bands[0], &bands[1]].map(|band| [band.lower[row], band.upper[row]]);
            let allowed = 2e-4 * if name == "v" { 20.0 } else { 1.0 };
            let off = largest([one[0] - other[0], one[1] - other[1]]);
            assert!(off < allowed, "{name} at {}: {one:?}, {other:?}", fine.times[row]);
        }
    }
    let counts = curve(&controlled, "count");
    for (&t, &count) in controlled.times.iter().zip(counts) {
        assert_eq!(count, (t / 0.03 + 1e-9).floor() + 1.0, "at {t}");
    }
}
