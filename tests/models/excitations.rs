//! Bounds over functions of the time, against closed forms of linear systems, another integrator, and random functions.

use mbint::results::{Bounds, FunctionWitness, Summary, Verdict};

use crate::common::{Subject, read, run_methods};
use crate::excitation_classes::{PARTS, kernel, over_kernel};

pub fn run(text: &str) -> (Subject, Bounds, Summary) {
    let model = read(text);
    let (bounds, summary) = run_methods(&model, None);
    (model, bounds, summary)
}

/// The end of an output in the last row, and its error.
pub fn last_end(bounds: &Bounds, output: usize) -> (f64, f64) {
    let band = &bounds.outputs[output].bands[0];
    let row = bounds.times.len() - 1;
    assert!((band.lower[row] + band.upper[row]).abs() < 1e-9 + band.error.total[row], "not symmetrical");
    (band.upper[row], band.error.total[row])
}

pub const DAMPING: f64 = 1.0;
pub const HALF_PERIOD: f64 = 0.25;
pub const PERIODS: usize = 8;

/// x'' + 2 δ x' + (δ² + ω²) x = push, ω = π/0.25 s, over eight half periods.
pub fn oscillator(excitation: &str, further: &str) -> String {
    let stiffness = DAMPING.powi(2) + (std::f64::consts::PI / HALF_PERIOD).powi(2);
    format!(
        "excitations: {{ push: {excitation} }}
bodies: {{ mass: {{ mass: 1, coordinates: [x] }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: {stiffness}, damping: {} }} }}
  pusher: {{ force: {{ on: mass, value: [push, 0] }} }}
outputs: {{ x: mass.x, v: mass.vx }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.25 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
{further}",
        2.0 * DAMPING
    )
}

/// Integral of |exp(−δτ) sin(ωτ)/ω| over n half periods: a geometric series of its arches.
pub fn integral(half_periods: usize) -> f64 {
    let omega = std::f64::consts::PI / HALF_PERIOD;
    let decay = (-DAMPING * HALF_PERIOD).exp();
    let arch = (1.0 + decay) / (DAMPING * DAMPING + omega * omega);
    arch * (1.0 - decay.powi(half_periods as i32)) / (1.0 - decay)
}

/// A share of a negative middle is one of its size.
#[test]
fn percentage_of_a_negative_middle_gives_both_ends() {
    let [share, ends] =
        ["-20 N ± 10%", "[-22 N, -18 N]"].map(|within| run(&oscillator(&format!("{{ within: {within} }}"), "")).1);
    let [share, ends] = [&share, &ends].map(|bounds| &bounds.outputs[0].bands[0]);
    for row in 0..=PERIODS {
        assert!((share.lower[row] - ends.lower[row]).abs() < 1e-12, "{row}");
        assert!((share.upper[row] - ends.upper[row]).abs() < 1e-12, "{row}");
    }
    assert!(share.upper[PERIODS] - share.lower[PERIODS] > 1e-2);
}

#[test]
fn ends_of_an_oscillator_match_the_integral_of_its_kernel() {
    let (_, bounds, summary) = run(&oscillator("{ within: ± 3 N }", ""));
    let band = &bounds.outputs[0].bands[0];
    for row in 1..=PERIODS {
        let expected = 3.0 * integral(row);
        let off = (band.upper[row] - expected).abs();
        // The scheme's order is 2, of steps of 1e-3 s.
        assert!(off < 1e-4 * expected && off <= band.error.total[row], "{row}: {} {expected}", band.upper[row]);
        assert!(band.error.total[row] < 1e-3 * expected && !band.error.unresolved[row]);
    }
    // A constant force overshoots once: 1 + exp(−δ 0.25 s) times its deflection.
    let own = &summary.excitations[0];
    let overshoot = 3.0 * integral(1);
    assert!((own.as_constant - overshoot).abs() < 1e-4 * overshoot && own.output == "x", "{own:?}");
    let ratio = own.as_function / own.as_constant;
    assert!((ratio - integral(PERIODS) / integral(1)).abs() < 1e-3, "{ratio}");
}

#[test]
fn the_explicit_method_finds_the_same_end() {
    let text = oscillator("{ within: ± 3 N }", "").replace("step: 1e-3", "step: 2e-3, scheme: explicit");
    let (_, bounds, _) = run(&text);
    let (end, error) = last_end(&bounds, 0);
    let expected = 3.0 * integral(PERIODS);
    assert!((end - expected).abs() < 1e-4 * expected && (end - expected).abs() <= error, "{end} {expected} {error}");
}

fn quarter_car(steps: &str) -> String {
    format!(
        "
excitations: {{ road: {{ rate: 0.1 m/s }} }}
bodies: {{ wheel: {{ mass: 40, coordinates: [y] }}, body: {{ mass: 350, coordinates: [y] }} }}
effects:
  tyre: {{ spring_damper: {{ between: [ground, wheel], along: y, stiffness: 180 kN/m, force: -180e3*road }} }}
  suspension: {{ spring_damper: {{ between: [wheel, body], along: y, stiffness: 20 kN/m, damping: 1.5 kN*s/m }} }}
outputs: {{ shake: body.ay }}
simulation: {{ duration: 6, {steps}, output_step: 1 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
"
    )
}

/// Road of a limited slope under the shipped quarter car, 0.1 ∫|h| over six seconds by another program
/// (the classical Runge and Kutta method over 60 000 steps): 2.573452 m/s².
#[test]
fn quarter_car_on_roads_of_limited_slope_has_known_ends() {
    let (_, bounds, _) = run(&quarter_car("step: 2.5e-4"));
    let (end, error) = last_end(&bounds, 0);
    assert!((end - 2.573_452).abs() < 1e-4 && error < 3e-4, "{end} ± {error}");
}

/// The same with switches between the ends of steps of 1 ms.
#[test]
fn farthest_functions_switch_between_the_ends_of_steps() {
    let (_, bounds, _) = run(&quarter_car("step: 1e-3, scheme: explicit"));
    let (end, _) = last_end(&bounds, 0);
    assert!((end - 2.573_452).abs() < 1e-5, "{end}");
    assert!(bounds.functions[0].functions[0].points.len() < 100, "switches alone are points");
}

#[test]
fn nested_classes_have_nested_ends() {
    let end = |excitation: &str| last_end(&run(&oscillator(excitation, "")).1, 0);
    let [(free, _), (fast, _), (slow, _), (held, error)] = [
        "{ within: ± 3 N }",
        "{ within: ± 3 N, rate: 1e4 N/s }",
        "{ within: ± 3 N, rate: 20 N/s }",
        "{ within: ± 3 N, held: 0.125 s }",
    ]
    .map(end);
    assert!(fast > 0.995 * free && fast <= free * (1.0 + 1e-6) && slow < 0.8 * fast, "{free} {fast} {slow}");
    // Constant over quarters of a period, whose ends are the kernel's zeros: nothing is lost.
    assert!((held - free).abs() <= error + 1e-4 * free, "{held} {free}");
    let (coarse, _) = end("{ within: ± 3 N, held: 0.4 s }");
    assert!(coarse < 0.9 * free, "{coarse} {free}");
}

/// A stiffness within 20 %: an output goes furthest within its interval. x″ + 2x′ + kx = F, x₀ = 0, by its kernel.
#[test]
fn parameters_are_worst_within_their_intervals_too() {
    let text =
        oscillator("{ within: 2 N ± 1 N }", "parameters: { k: 1 ± 20% }").replace("stiffness: ", "stiffness: k*");
    let (_, bounds, _) = run(&text);
    let stiffness = DAMPING.powi(2) + (std::f64::consts::PI / HALF_PERIOD).powi(2);
    for row in [4, 6, PERIODS] {
        let time = row as f64 * HALF_PERIOD;
        let of = |k: f64, sign: f64| {
            let omega = (k * stiffness - DAMPING.powi(2)).sqrt();
            let at = |part: u32| {
                let t = (f64::from(part) + 0.5) * time / 4000.0;
                let h = (-DAMPING * t).exp() * (omega * t).sin() / omega;
                (2.0 * h + sign * h.abs()) * time / 4000.0
            };
            (0..4000).map(at).sum::<f64>()
        };
        let all = || (0..=400).map(|number| 0.8 + 0.001 * f64::from(number));
        let lower = all().map(|k| of(k, -1.0)).fold(f64::INFINITY, f64::min);
        let upper = all().map(|k| of(k, 1.0)).fold(f64::NEG_INFINITY, f64::max);
        let band = &bounds.outputs[0].bands[0];
        let error = band.error.total[row];
        assert!((band.lower[row] - lower).abs() <= error && (band.upper[row] - upper).abs() <= error, "{row}: {error}");
        assert!(error < 0.05 * (upper - lower), "{row}: {error}");
    }
}

/// Reductions of a motion from rest: the peak is the farthest end of all rows, the sum that of the kernel's integral.
#[test]
fn reduced_outputs_are_bounded_over_functions() {
    let further = "requirements:
  within: peak <= 0.2 m
  beyond: peak <= 0.05 m
  both: sum + peak <= 1 m";
    let text = oscillator("{ within: ± 3 N }", further)
        .replace("v: mass.vx }", "peak: { max_abs: mass.x }, sum: { integral: mass.x } }")
        .replace("output_step: 0.25", "output_step: 0.025")
        .replace("sum + peak", "sum/(1 s) + peak");
    let (model, bounds, summary) = run(&text);
    let of = |name: &str| {
        let own = summary.reduced.iter().find(|own| own.name == name).unwrap();
        (own.bands[0].lower, own.bands[0].upper, own.bands[0].error)
    };
    // ∫|h| grows with the time: the peak is at its end.
    let expected = 3.0 * integral(PERIODS);
    let (lower, peak, error) = of("peak");
    assert!((peak - expected).abs() <= error && error < 5e-3 * expected, "{peak} {expected} {error}");
    assert!(lower.abs() <= error, "at rest without a force");
    // ∫∫ h: |∫₀ᵗ h| dτ over the time that is left.
    let h = kernel();
    let mut response = 0.0;
    let mut rising = |h: &f64| {
        response += h * 2.0 / f64::from(PARTS);
        response.abs() * 2.0 / f64::from(PARTS)
    };
    let expected = 3.0 * h.iter().map(&mut rising).sum::<f64>();
    let (_, sum, error) = of("sum");
    assert!((sum - expected).abs() <= error && error < 1e-3 * expected, "{sum} {expected} {error}");
    let verdict = |index: usize| summary.requirements[index].verdict;
    assert_eq!([verdict(0), verdict(1), verdict(2)], [Verdict::Holds, Verdict::Violated, Verdict::Holds]);
    // The witness replays it.
    let witness = bounds.functions.iter().find(|own| own.name == "peak").unwrap();
    let text: String = witness.functions[0].points.iter().map(|(time, value)| format!("{time},{value}\n")).collect();
    let replayed = Subject::from(model.model.replaying(&format!("t,push\n{text}")).unwrap());
    let (_, again) = run_methods(&replayed, None);
    let nominal = again.reduced.iter().find(|own| own.name == "peak").unwrap().nominal;
    assert!((nominal - peak).abs() < 2e-3 * peak, "{nominal} {peak}");
    assert!(bounds.functions.iter().any(|own| own.name == "beyond" && own.value < 0.0));
    assert!(bounds.functions.iter().all(|own| own.name != "within"));
}

/// x = (push + pull + k)/…: each moves an oscillator from rest by its own ∫|h|, a constant by |∫h|.
#[test]
fn functions_and_parameters_have_contributions() {
    let further = "parameters: { k: 0 N ± 1 N }";
    let text = oscillator("{ within: ± 1 N }, pull: { within: ± 0.5 N }", further)
        .replace("value: [push, 0]", "value: [push + pull + k, 0]");
    let (_, bounds, summary) = run(&text);
    let response = over_kernel(|h| h);
    let parts = [("push.deviation", integral(PERIODS)), ("pull.deviation", 0.5 * integral(PERIODS)), ("k", response)];
    let (sum, squares) = parts.iter().fold((0.0, 0.0), |(sum, squares), (_, own)| (sum + own, squares + own * own));
    for (name, part) in parts {
        let own = bounds.contributions[0].iter().find(|own| own.parameter == name).unwrap();
        let band = &bounds.outputs[0].bands[0];
        let width = band.upper[PERIODS] - band.lower[PERIODS];
        assert!((own.total[PERIODS] - part * part / squares).abs() < 1e-3, "{name}: {}", own.total[PERIODS]);
        assert!((own.width_without[PERIODS] - width * (1.0 - part / sum)).abs() < 1e-3 * width, "{name}");
    }
    assert_eq!(summary.parameters.len(), 3);
}

#[test]
fn limits_that_change_in_time_weigh_the_kernel() {
    // Limits 3 N (t/2 s): no end is beyond that of ± 3 N, and the last arch keeps at least 7/8 of its own.
    let (_, bounds, _) = run(&oscillator("{ within: [\"-1.5*t\", \"1.5*t\"] }", ""));
    let (end, _) = last_end(&bounds, 0);
    assert!(end < 3.0 * integral(PERIODS) && end > 3.0 * 0.875 * integral(1), "{end}");
}

#[test]
fn uncertain_parameters_and_functions_are_bounded_together() {
    let text = oscillator("{ within: ± force }", "parameters: { force: 3 N ± 10%, k: 1 ± 1% }")
        .replace("stiffness: ", "stiffness: k*");
    let (_, bounds, summary) = run(&text);
    let band = &bounds.outputs[0].bands[0];
    let row = PERIODS;
    // The larger force and the softer spring are worst: 3.3 N ∫|h| with 99 % of the stiffness, by the midpoint rule.
    let expected = 0.145_329_05;
    let off = (band.upper[row] - expected).abs();
    assert!(off < 1e-4 * expected && off <= band.error.total[row], "{} {expected}", band.upper[row]);
    let worst = &bounds.functions[0];
    let value = |name: &str| {
        let index = summary.parameters.iter().position(|own| own.name == name).unwrap();
        worst.parameters[index]
    };
    assert!((value("force") - 3.3).abs() < 1e-12, "{worst:?}");
    assert!(summary.contributions.iter().any(|own| own.parameter == "push.deviation"));
}

#[test]
fn requirements_are_decided_over_functions() {
    let verdict = |limit: f64| {
        let further = format!("requirements: {{ stays: x <= {limit} }}");
        run(&oscillator("{ within: ± 3 N }", &further)).2.requirements[0].verdict
    };
    let [constant, end] = [3.0 * integral(1), 3.0 * integral(PERIODS)];
    assert_eq!(verdict(0.5 * (constant + end)), Verdict::Violated);
    assert_eq!(verdict(1.1 * end), Verdict::Holds);
}

const PENDULUM: &str = "
excitations: { ripple: { within: ± 4 N*m } }
bodies: { rod: { mass: 1, inertia: 0.25, points: { pin: [-0.5, 0] } } }
joints: { pin: { revolute: [ground, rod.pin] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  damper: { torque: { on: rod, value: -0.3*rod.angular_velocity } }
  drive: { torque: { on: rod, value: ripple } }
initial: { pin.angle: -90 deg, pin.angular_velocity: 0 }
outputs: { angle: pin.angle }
simulation: { duration: 3, step: 2e-3, output_step: 0.5 }
bounds: { chebyshev: { order: 4 } }
";

/// The pendulum's angle after three seconds under a function, by the classical Runge and Kutta method: φ'' of
/// (I + m l²/4) φ'' = −m g l/2 cos φ − 0.3 φ' + u, I + m/4 = 0.5 kg m².
fn angle(u: impl Fn(f64) -> f64) -> f64 {
    let rate = |t: f64, [phi, omega]: [f64; 2]| [omega, (-9.81 * 0.5 * phi.cos() - 0.3 * omega + u(t)) / 0.5];
    let (steps, mut y) = (6000, [-std::f64::consts::FRAC_PI_2, 0.0]);
    let h = 3.0 / f64::from(steps);
    let along = |y: [f64; 2], d: [f64; 2], h: f64| [y[0] + h * d[0], y[1] + h * d[1]];
    for step in 0..steps {
        let t = f64::from(step) * h;
        let a = rate(t, y);
        let b = rate(t + 0.5 * h, along(y, a, 0.5 * h));
        let c = rate(t + 0.5 * h, along(y, b, 0.5 * h));
        let d = rate(t + h, along(y, c, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    y[0]
}

fn at(witness: &FunctionWitness, time: f64) -> f64 {
    let points = &witness.functions[0].points;
    let after = points.partition_point(|(own, _)| *own < time).clamp(1, points.len() - 1);
    let ((from, a), (to, b)) = (points[after - 1], points[after]);
    a + (b - a) * ((time - from) / (to - from)).clamp(0.0, 1.0)
}

#[test]
fn worst_function_of_a_pendulum_exceeds_random_ones() {
    let (model, bounds, _) = run(PENDULUM);
    let band = &bounds.outputs[0].bands[0];
    let row = bounds.times.len() - 1;
    let worst = &bounds.functions[0];
    assert!(worst.time == Some(3.0) || worst.time == Some(2.5), "{:?}", worst.time);
    let [lower, upper] = [band.lower[row], band.upper[row]];
    // Bang-bang functions that switch at random, seven times at most.
    let mut number = 1.0_f64;
    let mut next = || {
        number = (number * 1.324_717_957_244_746 + 0.618_033_988_749_895).fract();
        number
    };
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for _ in 0..400 {
        let count = (7.0 * next()) as usize;
        let switches: Vec<f64> = (0..count).map(|_| 3.0 * next()).collect();
        let sign = if next() < 0.5 { -4.0 } else { 4.0 };
        let found = angle(|t| if switches.iter().filter(|own| **own < t).count() % 2 == 0 { sign } else { -sign });
        ends = [ends[0].min(found), ends[1].max(found)];
    }
    assert!(lower < ends[0] && upper > ends[1], "{lower} {upper} {ends:?}");
    // Attained, by the other integrator too.
    if worst.time == Some(3.0) {
        let replayed = angle(|t| at(worst, t));
        assert!((replayed - worst.value).abs() < 0.01 * (upper - lower), "{replayed} {}", worst.value);
    }
    let text: String = worst.functions[0].points.iter().map(|(time, value)| format!("{time},{value}\n")).collect();
    let replayed = Subject::from(model.model.replaying(&format!("t,ripple\n{text}")).unwrap());
    let (again, _) = run_methods(&replayed, None);
    let row = again.times.iter().position(|time| Some(*time) == worst.time).unwrap();
    assert!((again.outputs[0].nominal[row] - worst.value).abs() < 1e-3 * (upper - lower));
}

/// Torque of the slider crank within 1 %, over one second: its kernel does not change its sign.
#[test]
fn constants_are_enough_for_the_slider_crank() {
    let text = include_str!("../../models/slider_crank.yaml")
        .replace("tau: { value: -0.5, unit: N*m, tolerance: 1% }", "tau: -0.5")
        .replace("l1:  { value: 0.15, unit: m, tolerance: 1% }", "l1: 0.15")
        .replace("value: tau }", "value: tau + ripple }")
        .replace("bodies:", "excitations: { ripple: { within: ± 0.005 N*m } }\nbodies:")
        .replace("  taylor: { order: 2 }\n  scan: { points: 30 }", "")
        .replace("output_step: 0.01", "output_step: 0.2");
    let (_, _, summary) = run(&text);
    let own = &summary.excitations[0];
    assert!(own.as_constant > 0.01 && (own.as_function / own.as_constant - 1.0).abs() < 5e-3, "{own:?}");
}
