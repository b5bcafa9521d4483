//! Reduced outputs and requirements of many parameters, against closed forms.

use std::f64::consts::FRAC_PI_2;

use mbint::results::{Criterion, Summary, Uncertain, Verdict};

use crate::common::random::Random;
use crate::common::{read, run_methods, study_of};

/// Springs side by side.
const SPRINGS: usize = 14;
/// kg
const MASS: [f64; 2] = [1.9, 2.1];

const REQUIREMENTS: &str = "
  short: mass.x <= 0.2
  light: { that: greatest*2 + m*(0.01 m/kg) <= 0.42 m }
  quick: { that: first <= 0.105 }";

/// Nominal stiffness of a spring, N/m, and its tolerance.
fn spring(number: usize) -> (f64, f64) {
    (3.0 + 0.1 * number as f64, 0.05 + 0.01 * (number % 3) as f64)
}

/// A mass on springs side by side, pushed off at 1 m/s: x = sin(ω t)/ω with ω² = Σ k/m.
fn summary(further: &str) -> Summary {
    run_methods(&read(&text(REQUIREMENTS, further)), None).1
}

fn text(requirements: &str, further: &str) -> String {
    let stiffness = |number: usize| {
        let (value, tolerance) = spring(number);
        format!("  k{number}: {{ value: {value}, unit: N/m, tolerance: {}% }}\n", 100.0 * tolerance)
    };
    let parameters: String = (0..SPRINGS).map(stiffness).collect();
    let sum = (0..SPRINGS).map(|number| format!("k{number}")).collect::<Vec<_>>().join(" + ");
    format!(
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
{requirements}
simulation: {{ duration: 1, output_step: 0.01 }}
{further}
"
    )
}

/// Ends over the box: all functions below are monotonous in the mass and in the stiffness there.
fn ends(of: impl Fn(f64, f64) -> f64) -> [f64; 2] {
    let stiffness =
        |sign: f64| -> f64 { (0..SPRINGS).map(spring).map(|(value, share)| value * (1.0 + sign * share)).sum() };
    let corners = [-1.0, 1.0].iter().flat_map(|&sign| MASS.map(|mass| of((stiffness(sign) / mass).sqrt(), mass)));
    corners.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

#[test]
fn ends_of_fifteen_parameters_match_closed_forms() {
    let summary = summary("bounds: { tolerance: 1e-3 }");
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
fn margins_of_fifteen_parameters_match_closed_forms() {
    let summary = summary("bounds: { tolerance: 1e-3 }");
    let check = |name: &str, verdict: Verdict, of: &dyn Fn(f64, f64) -> f64| {
        let own = summary.requirements.iter().find(|own| own.name == name).unwrap();
        let [least, _] = ends(of);
        assert_eq!(own.verdict, verdict, "{name}: {own:?}");
        assert!((own.margin - least).abs() <= own.error && own.error < 5e-5, "{name}: {own:?}, not {least}");
    };
    check("short", Verdict::Violated, &|w, _| 0.2 - 1.0 / w);
    check("light", Verdict::Violated, &|w, mass| 0.42 - 2.0 / w - 0.01 * mass);
    check("quick", Verdict::Violated, &|w, _| 0.105 - (0.1 * w).asin() / w);
}

/// Against 200 000 products by the closed forms.
#[test]
#[ignore = "4 s"]
fn statistics_of_fifteen_parameters_match_products() {
    const PRODUCTS: usize = 200_000;
    let summary = summary("bounds: { tolerance: 1e-2 }\nstatistics: { quantiles: [5%, 95%] }");
    let statistics = &summary.statistics.as_ref().unwrap().summary;
    assert_eq!(statistics.failure, None);
    let mut random = Random(7);
    let product = |random: &mut Random| {
        let mut within = |value: f64, share: f64| value * (1.0 + share * (2.0 * random.uniform() - 1.0));
        let stiffness: f64 = (0..SPRINGS).map(spring).map(|(value, share)| within(value, share)).sum();
        let mass = within(2.0, 0.05);
        ((stiffness / mass).sqrt(), mass)
    };
    let products: Vec<(f64, f64)> = (0..PRODUCTS).map(|_| product(&mut random)).collect();
    let is = |found: &Uncertain, value: f64, sampling: f64, what: &str| {
        let allowed = found.error + found.sampling + sampling;
        assert!((found.value - value).abs() <= allowed, "{what}: {found:?}, not {value} ± {sampling}");
    };
    let check = |name: &str, of: &dyn Fn(f64, f64) -> f64| {
        let found = statistics.reduced.iter().find(|own| own.name == name).unwrap();
        let mut values: Vec<f64> = products.iter().map(|&(w, mass)| of(w, mass)).collect();
        values.sort_unstable_by(f64::total_cmp);
        let count = PRODUCTS as f64;
        let mean = values.iter().sum::<f64>() / count;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        // Three standard errors of the products.
        let standard = deviation / count.sqrt();
        is(&found.mean, mean, 3.0 * standard, name);
        is(&found.deviation, deviation, 3.0 * standard, name);
        for (quantile, share) in found.quantiles.iter().zip([0.05, 0.95]) {
            is(quantile, values[(share * count) as usize], 10.0 * standard, name);
        }
        let errors = [&found.mean, &found.deviation].map(|own| own.error + own.sampling);
        println!("{name}: {errors:?} of {deviation}");
        assert!(errors.iter().all(|error| *error < 0.1 * deviation), "{name}: {found:?} of {deviation}");
    };
    check("greatest", &|w, _| 1.0 / w);
    check("last", &|w, _| w.sin() / w);
    check("mean", &|w, _| (1.0 - w.cos()) / (w * w));
    check("first", &|w, _| (0.1 * w).asin() / w);
    let share = |holds: &dyn Fn(f64, f64) -> bool| {
        products.iter().filter(|(w, mass)| holds(*w, *mass)).count() as f64 / PRODUCTS as f64
    };
    for (name, expected) in [
        ("short", share(&|w, _| 1.0 / w <= 0.2)),
        ("light", share(&|w, mass| 2.0 / w + 0.01 * mass <= 0.42)),
        ("quick", share(&|w, _| (0.1 * w).asin() / w <= 0.105)),
    ] {
        let found = statistics.requirements.iter().find(|own| own.requirement == name).unwrap();
        let [least, most] = found.interval;
        println!("{name}: {expected} in [{least}, {most}]");
        assert!((least..=most).contains(&expected) && most - least < 0.1, "{name}: {found:?}, not {expected}");
    }
}

/// One factor for all tolerances, so that m/Σ k is 0.215² in the worst case: a study of the result holds, and little of
/// the margin is left.
#[test]
fn tolerances_of_fifteen_parameters_use_the_margin() {
    let study = study_of(&text("  short: mass.x <= 0.215", "bounds: { tolerance: 1e-2 }"));
    let found = study.allocate(Criterion::WorstCase, 3.0).unwrap();
    let (nominal, spread) = (0..SPRINGS)
        .map(spring)
        .fold((0.0, 0.0), |(sum, spread), (value, share)| (sum + value, spread + value * share));
    let ratio: f64 = 0.215 * 0.215;
    let factor = (ratio * nominal - 2.0) / (0.1 + ratio * spread);
    assert!(found.is_confirmed && found.tightest == "short", "{found:?}");
    for own in &found.tolerances {
        let of = own.after.above / own.before.above / factor;
        // The rest is the study's own error, and digits of the tolerances.
        assert!((0.93..=1.0).contains(&of), "{}: {of} of {factor}", own.parameter);
    }
}
