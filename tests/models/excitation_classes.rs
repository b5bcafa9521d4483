//! Ends over functions with a mean, an energy, a band or limits that move, against integrals of an oscillator's kernel.

use crate::excitations::{DAMPING, HALF_PERIOD, PERIODS, integral, last_end, oscillator, run};

/// exp(−δτ) sin(ωτ)/ω at the middles of many parts of the duration, which is 2 s.
pub fn kernel() -> Vec<f64> {
    let omega = std::f64::consts::PI / HALF_PERIOD;
    let at = |t: f64| (-DAMPING * t).exp() * (omega * t).sin() / omega;
    (0..PARTS).map(|part| at((f64::from(part) + 0.5) * 2.0 / f64::from(PARTS))).collect()
}

pub const PARTS: u32 = 200_000;

/// Integral of a function of the kernel.
pub fn over_kernel(of: impl Fn(f64) -> f64) -> f64 {
    kernel().into_iter().map(|h| of(h) * 2.0 / f64::from(PARTS)).sum()
}

/// The number at which a falling function is a value, between two.
fn solved(mut from: f64, mut to: f64, value: f64, of: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (from + to);
        if of(middle) > value { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

#[test]
fn a_mean_lifts_the_threshold_of_the_kernel() {
    for (mean, own) in [(1.5, "1.5 N"), (2.0, "[2 N, 2.4 N]"), (-2.0, "-2 N")] {
        let (_, bounds, summary) = run(&oscillator(&format!("{{ within: ± 3 N, mean: {own} }}"), ""));
        let band = &bounds.outputs[0].bands[0];
        // 3 N sign(h − μ) with the mean: μ by bisection.
        let mu = solved(-1.0, 1.0, mean, |mu| 1.5 * over_kernel(|h| (h - mu).signum()));
        let expected = 3.0 * over_kernel(|h| h * (h - mu).signum());
        let (upper, error) = (band.upper[PERIODS], band.error.total[PERIODS]);
        assert!((upper - expected).abs() < 1e-4 * integral(PERIODS) * 3.0, "{own}: {upper} {expected}");
        assert!((upper - expected).abs() <= error, "{own}: {upper} {expected} {error}");
        // A constant is its own mean.
        let constant = 0.5 * if own.starts_with('[') { 0.4 } else { 0.0 } * integral(1);
        assert!((summary.excitations[0].as_constant - constant).abs() < 1e-5, "{own}");
    }
}

#[test]
fn an_energy_is_spent_along_the_kernel() {
    // √(E ∫h²), by Cauchy and Schwarz.
    let norm = over_kernel(|h| h * h).sqrt();
    let (_, bounds, summary) = run(&oscillator("{ energy: 4 N^2*s }", ""));
    let (end, error) = last_end(&bounds, 0);
    assert!((end - 2.0 * norm).abs() < 1e-4 * norm && (end - 2.0 * norm).abs() <= error, "{end} {error}");
    // The constant of this energy is √(4/2) N.
    assert!((summary.excitations[0].as_constant - 2.0_f64.sqrt() * integral(1)).abs() < 1e-5);
    // With limits: the kernel times a factor, cut off at 2 N.
    let cut = |factor: f64, h: f64| (factor * h).clamp(-2.0, 2.0);
    let factor = solved(0.0, 1e4, -4.0, |factor| -over_kernel(|h| cut(factor, h).powi(2)));
    let expected = over_kernel(|h| h * cut(factor, h));
    let (_, bounds, _) = run(&oscillator("{ within: ± 2 N, energy: 4 N^2*s }", ""));
    let (end, error) = last_end(&bounds, 0);
    assert!(expected < 0.99 * 2.0 * norm, "nothing is cut off");
    assert!((end - expected).abs() < 1e-4 * norm && (end - expected).abs() <= error, "{end} {expected} {error}");
}

#[test]
fn worst_function_of_a_band_is_a_sine() {
    let sizes = |from: f64, to: f64| {
        let h = kernel();
        let size = |frequency: f64| {
            let part = |function: fn(f64) -> f64| {
                let at = |(part, h): (usize, &f64)| {
                    h * function(std::f64::consts::TAU * frequency * (part as f64 + 0.5) * 2.0 / f64::from(PARTS))
                };
                h.iter().enumerate().map(at).sum::<f64>() * 2.0 / f64::from(PARTS)
            };
            part(f64::sin).hypot(part(f64::cos))
        };
        (0..=40).map(|number| size(from + (to - from) * f64::from(number) / 40.0)).fold(0.0, f64::max)
    };
    // About the resonance, and below it, where the upper end of the band is worst.
    for (band, expected, constant) in
        [("[1.5, 2.5]", sizes(1.5, 2.5), 0.0), ("[0, 1]", sizes(0.0, 1.0), 3.0 * integral(1))]
    {
        let (_, bounds, summary) = run(&oscillator(&format!("{{ within: ± 3 N, band: {band} }}"), ""));
        let (end, error) = last_end(&bounds, 0);
        let off = (end - 3.0 * expected).abs();
        assert!(off < 1e-3 * 3.0 * expected && off <= error + 5e-4 * expected, "{band}: {end} {expected} {error}");
        assert!((summary.excitations[0].as_constant - constant).abs() < 1e-4, "{band}");
    }
}

/// Limits that are written as if they moved are those that do not; all forces are 10 % larger if limits and rate are.
#[test]
#[ignore = "10 s"]
fn limits_that_move_bound_functions_with_a_rate() {
    let end = |excitation: &str, further: &str| last_end(&run(&oscillator(excitation, further)).1, 0).0;
    let still = end("{ within: ± 3 N, rate: 20 N/s }", "");
    let moving = end("{ within: ['-3 N + 0 N/s*t', '3 N + 0 N/s*t'], rate: 20 N/s }", "");
    assert!((still - moving).abs() < 1e-9, "{still} {moving}");
    let limits = "{ within: ['-1.5*t*force/(1 s)', '1.5*t*force/(1 s)'], rate: 20*force/(1 s) }";
    let opening = end(limits, "parameters: { force: 1 N }");
    let fast = end("{ within: ['-1.5 N/s*t', '1.5 N/s*t'] }", "");
    assert!(opening < fast && opening < still && opening > 0.5 * fast, "{opening} {fast} {still}");
    let larger = end(limits, "parameters: { force: 1 N ± 10% }");
    assert!((larger - 1.1 * opening).abs() < 1e-6, "{larger} {opening}");
}
