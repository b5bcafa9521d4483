//! States against closed forms, scipy, and the balance of power.

use mbint::results::Method;

use crate::common::{band, curve, largest, model, nominal, output, read, run};

/// A first-order lag and the integral of a cosine; a mass that the lag pushes.
fn lag(simulation: &str) -> String {
    format!(
        "
parameters: {{ tau: {{ value: 0.3, unit: s, tolerance: 5% }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
states:
  lag: {{ rate: (1 - lag)/tau, initial: 0 }}
  sine: {{ rate: cos(3*t)/(0.5 s), initial: 0.5 }}
effects: {{ push: {{ force: {{ on: m, value: [1 N*lag, 0] }} }} }}
initial: {{ m.x: 0, m.vx: 0 }}
outputs: {{ lag: lag, sine: sine, x: m.x, change: lag.rate, t: t }}
simulation: {{ duration: 1, {simulation} }}
bounds: {{ chebyshev: {{ order: 5 }}, taylor: {{ order: 4 }}, scan: {{ points: 5 }} }}
"
    )
}

const TAU: f64 = 0.3;

fn lag_at(t: f64, tau: f64) -> f64 {
    1.0 - (-t / tau).exp()
}

/// Largest errors of the lag, of the sine and of the mass's position.
fn errors(simulation: &str) -> [f64; 3] {
    let bounds = nominal(&read(&lag(simulation)));
    let error = |name: &str, exact: &dyn Fn(f64) -> f64| {
        largest(bounds.times.iter().zip(curve(&bounds, name)).map(|(&t, value)| value - exact(t)))
    };
    let position = |t: f64| t * t / 2.0 - TAU * t + TAU * TAU * lag_at(t, TAU);
    [error("lag", &|t| lag_at(t, TAU)), error("sine", &|t| 0.5 + 2.0 / 3.0 * (3.0 * t).sin()), error("x", &position)]
}

#[test]
fn the_scheme_is_of_order_two() {
    let [coarse, fine] = ["step: 1e-2, output_step: 0.1", "step: 5e-3, output_step: 0.1"].map(errors);
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!((3.7..4.3).contains(&(coarse / fine)) && fine < 5e-5, "{coarse:e} {fine:e}");
    }
}

#[test]
fn explicit_and_extrapolated_steps_integrate_states() {
    for (simulation, allowed) in [
        ("scheme: explicit, tolerance: 1e-9, output_step: 0.1", 2e-9),
        ("step: 1e-2, extrapolation: 4, output_step: 0.1", 1e-9),
        ("scheme: hht, tolerance: 1e-5, output_step: 0.1", 1e-5),
    ] {
        let found = errors(simulation);
        assert!(largest(found) < allowed, "{simulation}: {found:?}");
    }
}

/// The lag falls as its time constant grows, so that the ends of its range are those of the tolerance.
#[test]
fn every_method_bounds_states() {
    let bounds = run(&read(&lag("step: 1e-3, output_step: 0.1")));
    for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
        let band = band(output(&bounds, "lag"), method);
        for (row, &t) in bounds.times.iter().enumerate() {
            let ends = [lag_at(t, 1.05 * TAU), lag_at(t, 0.95 * TAU)];
            let allowed = 1.01 * band.error.total[row] + 1e-15;
            assert!((band.lower[row] - ends[0]).abs() <= allowed && (band.upper[row] - ends[1]).abs() <= allowed);
            assert!(band.error.total[row] < 1e-5, "{method:?}: {}", band.error.total[row]);
        }
    }
}

/// A mass of 2 kg under proportional, integral and derivative control: SciPy 1.16, `solve_ivp`, DOP853, rtol 1e-13.
#[test]
fn controlled_mass_matches_scipy() {
    let text = |simulation: &str| {
        format!(
            "
parameters: {{ target: {{ value: 0.3, unit: m }}, ki: {{ value: 30, unit: N/m/s }} }}
bodies: {{ m: {{ mass: 2, coordinates: [x] }} }}
states: {{ integral: {{ rate: target - m.x, initial: 0 }} }}
effects: {{ drive: {{ force: {{ on: m, value: [40 N/m*(target - m.x) + ki*integral - 9 N*s/m*m.vx, 0] }} }} }}
initial: {{ m.x: 0, m.vx: 0 }}
outputs: {{ x: m.x, v: m.vx, integral: integral }}
simulation: {{ duration: 4, output_step: 0.5, {simulation} }}
"
        )
    };
    let wanted = [
        (1, [0.31850870, 0.59949443, 0.08095066]),
        (2, [0.39340431, -0.17177991, 0.03620777]),
        (4, [0.30259351, 0.02998042, 0.01312915]),
        (8, [0.30193085, -0.00068935, 0.00217762]),
    ];
    for (simulation, allowed) in
        [("step: 1e-3", 4e-6), ("tolerance: 1e-7", 1e-7), ("step: 1e-2, extrapolation: 3", 1e-7)]
    {
        let bounds = nominal(&read(&text(simulation)));
        assert_eq!(output(&bounds, "integral").unit, "m*s");
        for (row, values) in wanted {
            for (name, value) in ["x", "v", "integral"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row];
                assert!((found - value).abs() < allowed, "{simulation}: {name} in row {row}: {found}, not {value}");
            }
        }
    }
}

/// An arm of two links whose elbow a controller drives: the energy equals the work of the drive, which is a state too.
const ARM: &str = "
bodies:
  upper: { mass: 3, inertia: 0.06, points: { pin: [-0.25, 0], tip: [0.25, 0] } }
  fore: { mass: 2, inertia: 0.04, points: { pin: [-0.2, 0] } }
joints:
  shoulder: { revolute: [ground, upper.pin] }
  elbow: { revolute: [upper.tip, fore.pin] }
states:
  work: { rate: (40 N*m*(1 - elbow.angle) + 60 N*m/s*integral)*elbow.angular_velocity, initial: 0 J }
  integral: { rate: 1 - elbow.angle }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  drive: { torque: { on: elbow, value: 40 N*m*(1 - elbow.angle) + 60 N*m/s*integral } }
initial: { shoulder.angle: -1, elbow.angle: 0, shoulder.angular_velocity: 0, elbow.angular_velocity: 0 }
outputs: { balance: energy - work, angle: elbow.angle, work: work }
";

#[test]
fn integrated_power_equals_the_energy() {
    for (simulation, allowed) in [
        ("tolerance: 1e-8", 1e-7),
        ("step: 5e-4, extrapolation: 3, formulation: absolute", 1e-5),
        ("step: 1e-3, extrapolation: 3, formulation: joint", 2e-6),
    ] {
        let text = format!("{ARM}simulation: {{ duration: 1, output_step: 0.1, {simulation} }}\n");
        let bounds = nominal(&read(&text));
        let balance = curve(&bounds, "balance");
        let moved = largest(balance.iter().map(|value| value - balance[0]));
        assert!(moved < allowed && largest(curve(&bounds, "work").iter().copied()) > 5.0, "{simulation}: {moved:e}");
    }
}

/// In instances each has its own, and a scene can replace one.
#[test]
fn instances_have_states_of_their_own() {
    let text = "
assemblies:
  cart:
    parameters: { k: { value: 20, unit: N/m } }
    bodies: { b: { mass: 1, coordinates: [x] } }
    states: { s: { rate: 1 m - b.x, initial: 0 } }
    effects: { f: { force: { on: b, value: [k*(1 m - b.x) + k*s/(2 s), 0] } } }
    initial: { b.x: 0, b.vx: 0 }
instances: { one: { of: cart }, two: { of: cart, parameters: { k: 5 N/m } } }
outputs: { one: one.s, two: two.s, x: two.b.x }
simulation: { duration: 1, step: 1e-3, output_step: 0.5 }
";
    let alone = "
bodies: { b: { mass: 1, coordinates: [x] } }
states: { held: { rate: 1 m - b.x, initial: 0 } }
effects: { f: { force: { on: b, value: [K N/m*(1 m - b.x) + K N/m * held/(2 s), 0] } } }
initial: { b.x: 0, b.vx: 0 }
outputs: { s: held }
simulation: { duration: 1, step: 1e-3, output_step: 0.5 }
";
    let both = nominal(&read(text));
    for (name, k) in [("one", "20"), ("two", "5")] {
        let alone = nominal(&read(&alone.replace('K', k)));
        let (found, wanted) = (curve(&both, name), curve(&alone, "s"));
        assert!(largest(found.iter().zip(wanted).map(|(a, b)| a - b)) < 1e-14, "{found:?}, not {wanted:?}");
    }
}

#[test]
fn the_guide_shows_its_example() {
    let page = include_str!("../../docs/guides/states.md");
    let text = include_str!("../../docs/examples/states.yaml");
    assert!(page.contains(text), "the page shows the example");
    let bounds = run(&read(text));
    let last = |name: &str| *curve(&bounds, name).last().unwrap();
    assert!((last("x") - 0.3).abs() < 0.02 && last("hurry").abs() < 0.2);
}

/// In the end the integral carries the weight, and the arm is at its target, whatever the load is.
#[test]
fn a_held_arm_draws_the_current_of_its_weight() {
    let bounds = run(&model("held_arm"));
    let target = 40_f64.to_radians();
    let current = |load: f64, k: f64| (1.0 + load) * 9.81 * 0.6 * target.cos() / (80.0 * k);
    let end = bounds.times.len() - 1;
    let [angle, of_motor] = ["angle", "current"].map(|name| output(&bounds, name));
    assert!((angle.nominal[end] - target).abs() < 1e-4, "{}", angle.nominal[end]);
    assert!((of_motor.nominal[end] - current(1.5, 0.05)).abs() < 2e-3, "{}", of_motor.nominal[end]);
    let band = band(of_motor, Method::Chebyshev);
    let ends = [current(1.2, 0.05 * 1.03), current(1.8, 0.05 * 0.97)];
    assert!((band.lower[end] - ends[0]).abs() < 3e-3 && (band.upper[end] - ends[1]).abs() < 3e-3, "{ends:?}");
}

/// In a mirrored instance angles count the other way, and states are the same.
#[test]
fn a_mirrored_instance_has_the_same_states() {
    let text = "
assemblies:
  arm:
    bodies: { rod: { mass: 1, inertia: 0.02, points: { pin: [-0.2, 0] } } }
    joints: { hinge: { revolute: [ground, rod.pin] } }
    states: { s: { rate: 0.4 rad - hinge.angle, initial: 0 } }
    effects: { drive: { torque: { on: hinge, value: 5 N*m*(0.4 - hinge.angle) + 8 N*m/s * s } } }
    initial: { hinge.angle: 0, hinge.angular_velocity: 0 }
instances:
  left: { of: arm, at: { position: [1, 0] } }
  right: { of: arm, at: { position: [-1, 0] }, mirror: x }
outputs: { left: left.s, right: right.s, angle: left.hinge.angle, image: right.hinge.angle }
simulation: { duration: 1, step: 1e-3, output_step: 0.5 }
";
    let bounds = nominal(&read(text));
    let together = |a: &str, b: &str, sign: f64| {
        largest(curve(&bounds, a).iter().zip(curve(&bounds, b)).map(|(a, b)| a - sign * b))
    };
    assert!(together("left", "right", 1.0) < 1e-12, "{}", together("left", "right", 1.0));
    assert!(together("angle", "image", -1.0) < 1e-12 && largest(curve(&bounds, "angle").iter().copied()) > 0.1);
}
