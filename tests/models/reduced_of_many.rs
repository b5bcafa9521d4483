//! Reduced outputs and requirements of many parameters, against closed forms.

use std::f64::consts::FRAC_PI_2;

use mbint::inner::results::{Summary, Verdict};

use crate::common::{read, run_methods};

/// Springs side by side.
const SPRINGS: usize = 14;
/// kg
const MASS: [f64; 2] = [1.9, 2.1];

/// Nominal stiffness of a spring, N/m, and its tolerance.
fn spring(number: usize) -> (f64, f64) {
    (3.0 + 0.1 * number as f64, 0.05 + 0.01 * (number % 3) as f64)
}

/// A mass on springs side by side, pushed off at 1 m/s: x = sin(ω t)/ω with ω² = Σ k/m.
fn summary() -> Summary {
    let stiffness = |number: usize| {
        let (value, tolerance) = spring(number);
        format!("  k{number}: {{ value: {value}, unit: N/m, tolerance: {}% }}\n", 100.0 * tolerance)
    };
    let parameters: String = (0..SPRINGS).map(stiffness).collect();
    let sum = (0..SPRINGS).map(|number| format!("k{number}")).collect::<Vec<_>>().join(" + ");
    let text = format!(
        "
parameters:
{parameters}  m: {{ value: 2, unit: kg, tolerance: 5% }}
bodies: {{ mass: {{ mass: m, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: {sum} }} }} }}
initial: {{ mass.x: 0, mass.vx: 1 }}
outputs:
  x: mass.x
  greatest: {{ max: mass.x }}
  stroke: {{ range: mass.x }}
  last: {{ final: mass.x }}
  mean: {{ mean: mass.x }}
  rms: {{ rms: mass.x }}
  when_greatest: {{ time_of_max: mass.x }}
  first: {{ when: mass.x >= 0.1 }}
requirements:
  short: mass.x <= 0.22
  light: {{ that: greatest*2 + m*(0.01 m/kg) <= 0.5 m }}
  quick: {{ that: first <= 0.105 }}
simulation: {{ duration: 1, output_step: 0.01 }}
bounds: {{ tolerance: 1e-3 }}
"
    );
    run_methods(&read(&text), None).1
}

/// Ends over the box: all functions below are monotonous in the mass and in the stiffness there.
fn ends(of: impl Fn(f64, f64) -> f64) -> [f64; 2] {
    let stiffness =
        |sign: f64| -> f64 { (0..SPRINGS).map(spring).map(|(value, share)| value * (1.0 + sign * share)).sum() };
    let corners = [-1.0, 1.0].iter().flat_map(|&sign| MASS.map(|mass| of((stiffness(sign) / mass).sqrt(), mass)));
    corners.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

#[test]
fn ends_of_fifteen_parameters_are_those_of_closed_forms() {
    let summary = summary();
    let check = |name: &str, of: &dyn Fn(f64, f64) -> f64| {
        let band = &summary.reduced.iter().find(|own| own.name == name).unwrap().bands[0];
        let [lower, upper] = ends(of);
        let off = (band.lower - lower).abs().max((band.upper - upper).abs());
        println!("{name}: off by {off:.1e}, stated {:.1e}", band.error);
        assert!(!band.unresolved && band.error <= 2e-3 * (upper - lower), "{name}: {band:?}");
        assert!(off <= band.error, "{name}: {band:?} instead of [{lower}, {upper}]");
    };
    check("greatest", &|w, _| 1.0 / w);
    // ω > 3π/2: it has been at both ends.
    check("stroke", &|w, _| 2.0 / w);
    check("last", &|w, _| w.sin() / w);
    check("mean", &|w, _| (1.0 - w.cos()) / (w * w));
    check("rms", &|w, _| (0.5 - (2.0 * w).sin() / (4.0 * w)).sqrt() / w);
    check("when_greatest", &|w, _| FRAC_PI_2 / w);
    check("first", &|w, _| (0.1 * w).asin() / w);
}

#[test]
fn margins_of_fifteen_parameters_are_those_of_closed_forms() {
    let summary = summary();
    let check = |name: &str, verdict: Verdict, of: &dyn Fn(f64, f64) -> f64| {
        let own = summary.requirements.iter().find(|own| own.name == name).unwrap();
        let [least, _] = ends(of);
        assert_eq!(own.verdict, verdict, "{name}: {own:?}");
        assert!((own.margin - least).abs() <= own.error && own.error < 5e-5, "{name}: {own:?}, not {least}");
    };
    check("short", Verdict::Holds, &|w, _| 0.22 - 1.0 / w);
    check("light", Verdict::Holds, &|w, mass| 0.5 - 2.0 / w - 0.01 * mass);
    check("quick", Verdict::Violated, &|w, _| 0.105 - (0.1 * w).asin() / w);
}
