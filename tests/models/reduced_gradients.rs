//! Gradients of reduced outputs and of requirements' margins, against closed forms of an oscillator.

use mbint::ReducedGradients;

use crate::common::model_of;

/// x = sin(ω t)/ω with ω = √k: a mass of 1 kg on a spring of k = 4 N/m, pushed off at 1 m/s.
fn oscillator() -> Vec<ReducedGradients> {
    let model = model_of(
        "
parameters: { k: { value: 4 N/m, tolerance: 1% } }
bodies: { mass: { mass: 1, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, mass], along: x, stiffness: k } } }
initial: { mass.x: 0, mass.vx: 1 }
outputs:
  greatest: { max: mass.x }
  least: { min: mass.x }
  stroke: { range: mass.x }
  farthest: { max_abs: mass.x, to: 2.2 }
  last: { final: mass.x }
  there: { value: mass.x, at: 1.3 }
  mean: { mean: mass.x, to: 1.2 }
  area: { integral: mass.x, from: 0.2, to: 1 }
  rms: { rms: mass.x }
  when_greatest: { time_of_max: mass.x }
  when_least: { time_of_min: mass.x }
  first: { when: mass.x >= 0.3 }
  never: { when: mass.x >= 0.7 }
  at_once: { when: mass.x <= 0.3 }
  since: { settling: mass.x, target: -0.4, band: 0.2, to: 2 }
  beyond: { overshoot: mass.x, target: 0.1 }
requirements:
  short: mass.x <= 0.6
  late: { that: mass.x >= -0.7, from: 2 }
  there_too: { that: there*2 + k*(0.01 m^2/N) <= 1 m }
simulation: { duration: 3, step: 2e-4, output_step: 0.01 }
",
    );
    model.gradients().unwrap().reduced
}

/// Asserts value and derivative by k against a closed form.
#[track_caller]
fn is(found: &[ReducedGradients], name: &str, of: impl Fn(f64) -> f64) {
    let own = found.iter().find(|own| own.name == name).unwrap_or_else(|| panic!("no {name}"));
    let (k, step) = (4.0, 1e-4);
    let derivative = (of(k + step) - of(k - step)) / (2.0 * step);
    // Cubics through four rows 0.01 s apart, and steps of 2e-4 s.
    assert!((own.value - of(k)).abs() < 1e-6, "{name} is {}, not {}", own.value, of(k));
    let by = own.by_parameters[0];
    assert!((by - derivative).abs() < 2e-5 * (1.0 + derivative.abs()), "{name} has {by}, not {derivative}");
}

#[test]
fn derivatives_match_closed_forms() {
    let found = oscillator();
    let x = |k: f64, t: f64| (k.sqrt() * t).sin() / k.sqrt();
    let pi = std::f64::consts::PI;
    is(&found, "greatest", |k| 1.0 / k.sqrt());
    is(&found, "least", |k| -1.0 / k.sqrt());
    is(&found, "stroke", |k| 2.0 / k.sqrt());
    is(&found, "farthest", |k| 1.0 / k.sqrt());
    is(&found, "last", |k| x(k, 3.0));
    is(&found, "there", |k| x(k, 1.3));
    // ∫ sin(ω t)/ω = (1 − cos ω t)/ω², ∫ sin²(ω t)/ω² = (t/2 − sin(2 ω t)/(4 ω))/ω².
    let integral = |k: f64, t: f64| (1.0 - (k.sqrt() * t).cos()) / k;
    is(&found, "mean", |k| integral(k, 1.2) / 1.2);
    is(&found, "area", |k| integral(k, 1.0) - integral(k, 0.2));
    is(&found, "rms", |k| ((1.5 - (6.0 * k.sqrt()).sin() / (4.0 * k.sqrt())) / k / 3.0).sqrt());
    is(&found, "when_greatest", |k| pi / (2.0 * k.sqrt()));
    is(&found, "when_least", |k| 3.0 * pi / (2.0 * k.sqrt()));
    is(&found, "first", |k| (0.3 * k.sqrt()).asin() / k.sqrt());
    // From −0.2 down: ω t = π + asin(0.2 ω).
    is(&found, "since", |k| (pi + (0.2 * k.sqrt()).asin()) / k.sqrt());
    is(&found, "beyond", |k| 1.0 / k.sqrt() - 0.1);
    is(&found, "short", |k| 0.6 - 1.0 / k.sqrt());
    is(&found, "late", |k| 0.7 - 1.0 / k.sqrt());
    is(&found, "there_too", |k| 1.0 - 2.0 * x(k, 1.3) - k / 100.0);
}

#[test]
fn absent_events_have_no_gradient_and_immediate_ones_zero() {
    let found = oscillator();
    assert!(found.iter().all(|own| own.name != "never"));
    let at_once = found.iter().find(|own| own.name == "at_once").unwrap();
    assert_eq!((at_once.value, at_once.time, at_once.by_parameters[0]), (0.0, Some(0.0), 0.0));
    let [short, greatest] = ["short", "greatest"].map(|name| found.iter().find(|own| own.name == name).unwrap());
    assert!(short.is_margin && !greatest.is_margin);
    assert!((greatest.time.unwrap() - std::f64::consts::FRAC_PI_4).abs() < 1e-4);
}
