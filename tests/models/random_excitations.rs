//! Random excitations, against Lyapunov's equation, closed forms of linear systems, the stationary law of Duffing's
//! oscillator and Rice's formula.

use mbint::results::{Bounds, StatisticsResult, Summary, YieldSummary};

use crate::common::{Subject, load, output, read, run_methods};

fn run(text: &str) -> (Subject, Bounds, Summary) {
    let model = read(text);
    let (bounds, summary) = run_methods(&model, None);
    (model, bounds, summary)
}

/// A quarter car on a road, linearised.
fn quarter_car(class: &str, body: &str) -> String {
    format!(
        "analysis: modes
parameters: {{ body_m: {body} }}
excitations: {{ road: {{ random: {{ road: {class}, speed: 20 m/s }} }} }}
bodies: {{ wheel: {{ mass: 40, coordinates: [y] }}, body: {{ mass: body_m, coordinates: [y] }} }}
effects:
  tyre: {{ spring_damper: {{ between: [ground, wheel], along: y, stiffness: 180 kN/m, force: -180e3*road }} }}
  suspension: {{ spring_damper: {{ between: [wheel, body], along: y, stiffness: 20 kN/m, damping: 1.5 kN*s/m }} }}
outputs: {{ shake: body.ay }}
bounds: {{ chebyshev: {{ order: 6 }} }}
requirements: {{ quiet: shake.rms <= 1 m/s^2 }}
"
    )
}

/// x of A x = b by elimination with the largest pivots.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for column in 0..n {
        let pivot = (column..n).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs())).unwrap();
        rows.swap(column, pivot);
        let head = rows[column].clone();
        for row in &mut rows[column + 1..] {
            let factor = row[column] / head[column];
            row.iter_mut().zip(&head).for_each(|(entry, head)| *entry -= factor * head);
        }
    }
    let mut x = vec![0.0; n];
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|column| rows[row][column] * x[column]).sum();
        x[row] = (rows[row][n] - known) / rows[row][row];
    }
    x
}

/// RMS of the body's acceleration: the road's rate is white noise of (2π)² G(n₀) n₀² v, A P + P Aᵀ = −b bᵀ W/2.
fn by_lyapunov(roughness: f64, body: f64) -> f64 {
    let (wheel, spring, damper, tyre) = (40.0, 20e3, 1.5e3, 180e3);
    let a = [
        [0.0, 1.0, 0.0, 0.0],
        [-tyre / wheel, -damper / wheel, spring / wheel, damper / wheel],
        [0.0, -1.0, 0.0, 1.0],
        [0.0, damper / body, -spring / body, -damper / body],
    ];
    let noise = 0.5 * std::f64::consts::TAU.powi(2) * roughness * 0.01 * 20.0;
    let mut rows = vec![vec![0.0; 17]; 16];
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        for k in 0..4 {
            rows[4 * i + j][4 * k + j] += a[i][k];
            rows[4 * i + j][4 * i + k] += a[j][k];
        }
    }
    // The road moves the tyre's compression alone.
    rows[0][16] = -noise;
    let p = solved(rows);
    let square: f64 =
        (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| a[3][i] * a[3][j] * p[4 * i + j]).sum();
    square.sqrt()
}

#[test]
fn response_of_a_quarter_car_matches_lyapunovs_equation() {
    for (class, roughness) in [("A", 16e-6), ("B", 64e-6), ("C", 256e-6)] {
        let (_, bounds, summary) = run(&quarter_car(class, "350 kg ± 60 kg"));
        let found = output(&bounds, "shake.rms");
        let band = &found.bands[0];
        // Lyapunov's road has all frequencies, that of ISO 8608 those from 0.011/m to 2.83/m.
        let near = |value: f64, body: f64| {
            let expected = by_lyapunov(roughness, body);
            assert!((value / expected - 1.0).abs() < 1e-3, "{class} {body}: {value} {expected}");
        };
        near(found.nominal[0], 350.0);
        near(band.upper[0], 290.0);
        near(band.lower[0], 410.0);
        assert!(band.error.total[0] < 1e-4 * band.upper[0] && !band.error.unresolved[0]);
        let holds = summary.requirements[0].verdict == mbint::results::Verdict::Holds;
        assert_eq!(holds, class != "C");
    }
}

/// RMS of the driver's acceleration in `docs/examples/ride_comfort.yaml`, summed over frequencies:
/// (K + iω D − ω² M) x = k (e₃ + e₄ exp(−iω L/v)) for heave, pitch and both wheels.
fn on_a_rough_road(body: f64, damper: f64, tyre: f64) -> f64 {
    let (inertia, wheel, spring, speed) = (900.0, 40.0, 22e3, 25.0);
    let arms = [1.2, -1.5];
    let square = |n: f64| {
        let omega = std::f64::consts::TAU * speed * n;
        // Real and imaginary rows, and the load.
        let mut rows = vec![vec![0.0; 9]; 8];
        let mut add = |row: usize, column: usize, re: f64, im: f64| {
            rows[row][column] += re;
            rows[4 + row][4 + column] += re;
            rows[row][4 + column] -= im;
            rows[4 + row][column] += im;
        };
        for (index, mass) in [body, inertia, wheel, wheel].into_iter().enumerate() {
            add(index, index, -omega * omega * mass, 0.0);
        }
        for (axle, arm) in arms.into_iter().enumerate() {
            // The suspension pulls along (1, arm, −1) of heave, pitch and its wheel.
            let along = [(0, 1.0), (1, arm), (2 + axle, -1.0)];
            for (row, own) in along {
                along
                    .iter()
                    .for_each(|(column, other)| add(row, *column, spring * own * other, omega * damper * own * other));
            }
            add(2 + axle, 2 + axle, tyre, 0.0);
        }
        let later = omega * (arms[0] - arms[1]) / speed;
        (rows[2][8], rows[3][8], rows[7][8]) = (tyre, tyre * later.cos(), -tyre * later.sin());
        let x = solved(rows);
        let driver = [x[0] + 0.2 * x[1], x[4] + 0.2 * x[5]];
        omega.powi(4) * (driver[0] * driver[0] + driver[1] * driver[1]) * 64e-6 * 0.01 / (n * n)
    };
    // The midpoint rule in equal factors.
    let (from, to, count) = (0.011_f64, 2.83_f64, 6000);
    let factor = (to / from).ln() / f64::from(count);
    let sum: f64 =
        (0..count).map(|index| from * ((f64::from(index) + 0.5) * factor).exp()).map(|n| square(n) * n * factor).sum();
    sum.sqrt()
}

#[test]
fn response_of_a_half_car_matches_sums_over_frequencies() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/ride_comfort.yaml");
    let (bounds, _) = run_methods(&load(&path), None);
    let found = output(&bounds, "driver.rms");
    let nominal = on_a_rough_road(700.0, 1500.0, 190e3);
    // It rests at a pitch of 0.014 rad, which turns its arms: they are 1e-4 shorter.
    assert!((found.nominal[0] / nominal - 1.0).abs() < 1e-4, "{} {nominal}", found.nominal[0]);
    let band = &found.bands[0];
    let corners = [600.0, 800.0].into_iter().flat_map(|body| {
        [1200.0, 1800.0]
            .into_iter()
            .flat_map(move |damper| [171e3, 209e3].map(|tyre| on_a_rough_road(body, damper, tyre)))
    });
    let [mut least, mut most] = [nominal; 2];
    corners.for_each(|value| (least, most) = (least.min(value), most.max(value)));
    // The damper has an optimum inside of its interval, at most a little below the corners.
    let error = band.error.total[0] + 1e-4 * nominal;
    assert!((band.upper[0] - most).abs() < error, "{} {most}", band.upper[0]);
    assert!(band.lower[0] < least + error && band.lower[0] > 0.95 * least, "{} {least}", band.lower[0]);
}

const RATE: f64 = 1.5;
const STIFFNESS: f64 = 160.0;
const NOISE: f64 = 40.0;

/// x″ + 2 δ x′ + k x + a x³ = noise of a density of 40 N²/Hz.
fn oscillator(stiffness: &str, cubic: f64, further: &str) -> String {
    format!(
        "parameters: {{ k: {stiffness} }}
excitations: {{ noise: {{ random: {{ white: {NOISE} N^2*s, band: [0.02, 25], lines: 60 }} }} }}
bodies: {{ mass: {{ mass: 1, coordinates: [x] }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: k, damping: {} }} }}
  push: {{ force: {{ on: mass, value: [\"noise - {cubic}*mass.x^3\", 0] }} }}
initial: {{ mass.x: 0, mass.vx: 0 }}
outputs: {{ x: mass.x }}
{further}",
        2.0 * RATE
    )
}

/// σ² of the linear oscillator under white noise: S/(4 c k) (S. H. Crandall & W. D. Mark, Random Vibration in
/// Mechanical Systems (1963)).
fn variance(stiffness: f64) -> f64 {
    NOISE / (4.0 * 2.0 * RATE * stiffness)
}

#[test]
fn response_to_white_noise_matches_closed_forms() {
    let (_, bounds, _) = run(&format!("analysis: modes\n{}", oscillator("160 ± 10%", 0.0, "")));
    let (rms, crossings) = (output(&bounds, "x.rms"), output(&bounds, "x.crossings"));
    // The band omits 0.02 % of the variance, and 4 % of that of the rate, S/(4 c m), above 25 Hz: S/(4π² f).
    let near = |found: f64, expected: f64, share: f64| {
        assert!((found / expected - 1.0).abs() < share, "{found} {expected}");
    };
    near(rms.nominal[0], variance(STIFFNESS).sqrt(), 5e-3);
    let band = &rms.bands[0];
    near(band.upper[0], variance(0.9 * STIFFNESS).sqrt(), 5e-3);
    near(band.lower[0], variance(1.1 * STIFFNESS).sqrt(), 5e-3);
    let rate = NOISE * (1.0 / (8.0 * RATE) - 1.0 / (4.0 * std::f64::consts::PI.powi(2) * 25.0));
    near(crossings.nominal[0], (rate / variance(STIFFNESS)).sqrt() / std::f64::consts::TAU, 5e-3);
}

#[test]
fn delayed_excitation_is_the_same_function() {
    // The variance of x(t) − x(t − τ) is ∫ 2 (1 − cos 2π f τ) G df.
    let text = "
excitations:
  front: { random: { white: 2 m^2*s, band: [1, 6], lines: 40 } }
  rear: { follows: front, after: 0.1 s }
bodies: { mass: { mass: 1, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, mass], along: x, stiffness: 100, damping: 2, force: 100*(rear - front) } }
outputs: { between: front - rear }
";
    let (tau, turn) = (0.1, std::f64::consts::TAU);
    let wave = |f: f64| (turn * f * tau).sin() / (turn * tau);
    let expected = (4.0 * (5.0 - wave(6.0) + wave(1.0))).sqrt();
    let (_, bounds, _) = run(&format!("analysis: modes\n{text}"));
    let found = output(&bounds, "between.rms").nominal[0];
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    let sampled = statistics(&format!(
        "{text}initial: {{ mass.x: 0, mass.vx: 0 }}\nsimulation: {{ duration: 0.4, step: 0.01, output_step: 0.2 }}\nstatistics: {{ samples: 4000 }}\n"
    ));
    for own in &sampled.outputs[0].deviation {
        assert!((own.value - expected).abs() < 2.0 * own.sampling && own.sampling < 0.03 * expected, "{own:?}");
    }
}

fn statistics(text: &str) -> StatisticsResult {
    let (_, _, summary) = run(text);
    let found = *summary.statistics.expect("statistics are asked for");
    assert_eq!(found.summary.failure, None);
    found
}

const MOTION: &str = "simulation: { duration: 4, step: 5e-3, output_step: 1 }";

#[test]
#[ignore = "2 s"]
fn samples_follow_the_law_of_an_uncertain_oscillator() {
    let asked = format!("{MOTION}\nstatistics: {{ samples: 3000, quantiles: [50%, 99%] }}\n");
    let found = statistics(&oscillator("160 ± 40%", 0.0, &asked));
    let [own, ..] = &found.outputs[..] else { panic!("one output") };
    // The mean of S/(4 c k) over a uniform law of k.
    let (low, high) = (0.6 * STIFFNESS, 1.4 * STIFFNESS);
    let expected = (variance(1.0) * (high / low).ln() / (high - low)).sqrt();
    let last = own.deviation.len() - 1;
    let deviation = own.deviation[last];
    assert!((deviation.value - expected).abs() < 1.5 * deviation.total(), "{deviation:?} {expected}");
    assert!(deviation.total() < 0.06 * expected);
    let [median, high] = [own.quantiles[0][last], own.quantiles[1][last]];
    assert!(median.value.abs() < 1.5 * median.total(), "{median:?}");
    // A mixture of normal laws: 2.326 deviations of one law, a little more of several.
    assert!((high.value - 2.36 * expected).abs() < 1.5 * high.total(), "{high:?} {expected}");
    assert_eq!(found.summary.parameters.len(), 1);
    assert_eq!(found.summary.random.as_ref().unwrap().excitations, ["noise"]);
}

#[test]
#[ignore = "2 s"]
fn samples_have_the_stationary_law_of_duffings_oscillator() {
    // Fokker and Planck's equation: p(x) ~ exp(−4 c V/S), V = k x²/2 + a x⁴/4 (T. K. Caughey, J. Acoust. Soc. Am. 35
    // (1963) 1683).
    let cubic = 6000.0;
    let weight = |x: f64| {
        let potential = 0.5 * STIFFNESS * x * x + 0.25 * cubic * x.powi(4);
        (-8.0 * RATE * potential / NOISE).exp()
    };
    let grid = || (-4000..=4000).map(|index| f64::from(index) * 5e-4);
    let expected = (grid().map(|x| x * x * weight(x)).sum::<f64>() / grid().map(weight).sum::<f64>()).sqrt();
    assert!(expected < 0.8 * variance(STIFFNESS).sqrt(), "not far from linear");
    let asked = format!("{MOTION}\nstatistics: {{ samples: 4000 }}\n");
    let found = statistics(&oscillator("160", cubic, &asked));
    let own = found.outputs[0].deviation[4];
    assert!((own.value - expected).abs() < 1.5 * own.total() && own.total() < 0.06 * expected, "{own:?} {expected}");
}

fn passage(duration: f64, exposure: &str) -> YieldSummary {
    let level = 2.5 * variance(STIFFNESS).sqrt();
    let further = format!(
        "simulation: {{ duration: {duration}, step: 8e-3, output_step: 1 }}
requirements: {{ below: {{ that: mass.x <= {level}, from: 2 s }} }}
statistics: {{ samples: 2048, quantiles: [50%], {exposure} seed: 3 }}
"
    );
    // Lines are nearer to each other than one over the longest motion: parts of it are independent.
    let text = oscillator("160", 0.0, &further).replace("[0.02, 25]", "[0.05, 5.55]");
    statistics(&text).summary.requirements[0].clone()
}

#[test]
#[ignore = "2 s"]
fn first_passages_match_rices_formula() {
    let short = passage(4.0, "exposure: 6 s,");
    // Not more than it is above at first, and rises on average: ν⁺ = ω/(2π) exp(−L²/(2σ²)). Rises come in groups.
    let rate = STIFFNESS.sqrt() / std::f64::consts::TAU * (-0.5_f64 * 2.5 * 2.5).exp();
    let [above, rises] = [0.0062, 2.0 * rate];
    let [fewest, most] = short.ppm_interval.map(|ppm| 1e-6 * ppm);
    assert!(fewest <= above + rises && most >= 0.5 * (1.0 - f64::exp(-rises)), "{short:?}");
    assert!(short.ppm > 0.0 && short.samples == 2048);
    // Three windows in a row fail as the exposure says.
    let exposure = short.exposure.as_ref().unwrap();
    let long = passage(8.0, "");
    assert!((exposure.time - 6.0).abs() < 1e-12 && long.exposure.is_none());
    assert!(exposure.ppm_interval[0] <= long.ppm_interval[1], "{exposure:?} {long:?}");
    assert!(exposure.ppm_interval[1] >= long.ppm_interval[0], "{exposure:?} {long:?}");
}

#[test]
fn seeds_choose_samples_and_realisations() {
    let seeded = |seed: usize, realisation: usize| {
        let asked = format!(
            "simulation: {{ duration: 0.2, step: 0.01, output_step: 0.1 }}\nstatistics: {{ samples: 1024, quantiles: [50%], seed: {seed} }}\n"
        );
        let text = oscillator("160", 0.0, &asked).replace("lines: 60", &format!("lines: 20, seed: {realisation}"));
        let (_, bounds, summary) = run(&text);
        (bounds.outputs[0].nominal.clone(), *summary.statistics.unwrap())
    };
    let first = seeded(1, 1);
    let again = seeded(1, 1);
    assert_eq!(first.0, again.0);
    assert_eq!(first.1.outputs[0].deviation, again.1.outputs[0].deviation);
    let other = seeded(2, 3);
    assert_ne!(first.0, other.0);
    assert_ne!(first.1.outputs[0].deviation, other.1.outputs[0].deviation);
}

#[test]
fn ramped_excitation_starts_at_zero() {
    let further =
        "simulation: { duration: 1, step: 0.01, output_step: 0.25 }\nstatistics: { samples: 1024, quantiles: [50%] }\n";
    let text = oscillator("160", 0.0, further).replace("lines: 60", "lines: 30, ramp: 0.5 s");
    let found = statistics(&text.replace("x: mass.x", "x: noise"));
    let expected = (NOISE * (25.0 - 0.02)).sqrt();
    // 3 u² − 2 u³ of the whole after 0, a half and all of its 0.5 s.
    for (own, share) in found.outputs[0].deviation.iter().zip([0.0, 0.5, 1.0, 1.0]) {
        assert!((own.value - share * expected).abs() <= 2.0 * own.sampling + 1e-12, "{own:?} {share}");
    }
}
