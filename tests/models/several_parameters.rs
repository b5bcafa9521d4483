//! Eight parameters whose outputs no polynomial of few samples follows: x = sin(ω t)/ω with ω² = Σ k/m, whose phase
//! the box changes by more than two radians. Against closed forms.

use mbint::results::{Bounds, Summary, Uncertain, Verdict};

use crate::common::random::Random;
use crate::common::{read, run_methods};

/// Springs side by side, N/m, each ± 10 %.
const SPRINGS: [f64; 7] = [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
/// kg, ± 5 %
const MASS: f64 = 2.0;
/// s
const END: f64 = 5.0;

fn run(further: &str) -> (Bounds, Summary) {
    let springs = SPRINGS.iter().enumerate();
    let parameters: String =
        springs.map(|(n, k)| format!("  k{n}: {{ value: {k}, unit: N/m, tolerance: 10% }}\n")).collect();
    let sum = (0..SPRINGS.len()).map(|n| format!("k{n}")).collect::<Vec<_>>().join(" + ");
    let text = format!(
        "
parameters:
{parameters}  m: {{ value: {MASS}, unit: kg, tolerance: 5% }}
bodies: {{ mass: {{ mass: m, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: {sum} }} }} }}
initial: {{ mass.x: 0, mass.vx: 1 }}
outputs: {{ x: mass.x, last: {{ final: mass.x }} }}
requirements: {{ near: {{ that: mass.x <= 0.1, at: {END} s }} }}
simulation: {{ duration: {END}, output_step: 0.1 }}
bounds: {{ tolerance: 1e-3 }}
{further}"
    );
    run_methods(&read(&text), None)
}

/// sin(ω t)/ω is largest and least within the box, not at its corners.
#[test]
#[ignore = "2 s"]
fn ends_match_the_closed_form_with_or_without_statistics() {
    let (bounds, summary) = run("");
    let (with, _) = run("statistics: {}");
    let [stiffness, softest] = [1.1, 0.9].map(|share| share * SPRINGS.iter().sum::<f64>());
    let [most, least] = [stiffness / (0.95 * MASS), softest / (1.05 * MASS)].map(f64::sqrt);
    let values = |time: f64| {
        let at = move |n: usize| least + (most - least) * n as f64 / 1e4;
        let all = (0..=10_000).map(move |n| (at(n) * time).sin() / at(n));
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
    };
    for (bounds, which) in [(&bounds, "without statistics"), (&with, "with statistics")] {
        let band = &bounds.outputs[0].bands[0];
        for (row, &time) in bounds.times.iter().enumerate() {
            let [lower, upper] = values(time);
            let error = band.error.total[row] + 1e-9;
            assert!(!band.error.unresolved[row], "at {time} s {which}: {error}");
            let off = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
            assert!(off <= error, "at {time} s {which}: off by {off}, stated {error}");
        }
    }
    let [lower, upper] = values(END);
    let last = &summary.reduced[0].bands[0];
    let off = (last.lower - lower).abs().max((last.upper - upper).abs());
    assert!(!last.unresolved && off <= last.error, "{last:?}, not {lower} to {upper}");
    let near = &summary.requirements[0];
    assert_eq!(near.verdict, Verdict::Violated);
    assert!((near.margin - (0.1 - upper)).abs() <= near.error, "{near:?}, not {}", 0.1 - upper);
}

/// Against 200 000 products by the closed form.
#[test]
fn statistics_match_products() {
    const PRODUCTS: usize = 200_000;
    let (bounds, summary) = run("statistics: { quantiles: [5%, 50%, 95%] }");
    let found = summary.statistics.unwrap();
    assert_eq!(found.summary.failure, None);
    let mut random = Random(3);
    let product = |random: &mut Random| {
        let mut within = |value: f64, share: f64| value * (1.0 + share * (2.0 * random.uniform() - 1.0));
        let stiffness: f64 = SPRINGS.iter().map(|&k| within(k, 0.1)).sum();
        (stiffness / within(MASS, 0.05)).sqrt()
    };
    let products: Vec<f64> = (0..PRODUCTS).map(|_| product(&mut random)).collect();
    let count = PRODUCTS as f64;
    let is = |found: &Uncertain, value: f64, sampling: f64, what: &str| {
        let allowed = found.error + found.sampling + sampling;
        assert!((found.value - value).abs() <= allowed, "{what}: {found:?}, not {value} ± {sampling}");
    };
    let output = &found.outputs[0];
    assert!(output.resolved.iter().all(|resolved| *resolved));
    for (row, &time) in bounds.times.iter().enumerate().skip(1).step_by(7) {
        let mut values: Vec<f64> = products.iter().map(|w| (w * time).sin() / w).collect();
        values.sort_unstable_by(f64::total_cmp);
        let mean = values.iter().sum::<f64>() / count;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        // Three standard errors of the products.
        let standard = 3.0 * deviation / count.sqrt();
        is(&output.mean[row], mean, standard, &format!("mean at {time} s"));
        is(&output.deviation[row], deviation, standard, &format!("deviation at {time} s"));
        for (quantile, share) in output.quantiles.iter().zip([0.05, 0.5, 0.95]) {
            is(&quantile[row], values[(share * count) as usize], 3.0 * standard, &format!("{share} at {time} s"));
        }
        let errors = [&output.mean[row], &output.deviation[row]].map(|own| own.sampling);
        assert!(errors.iter().all(|error| *error < 0.1 * deviation), "at {time} s: {errors:?} of {deviation}");
    }
    let share = products.iter().filter(|&&w| (w * END).sin() / w <= 0.1).count() as f64 / count;
    let [least, most] = found.summary.requirements[0].interval;
    assert!((least..=most).contains(&share) && most - least < 0.1, "{least} to {most}, not {share}");
}
