//! Whether the reported errors are honest: they cover the true ones at 99 % of the output times, and are on average not
//! more than ten times as large. The truths are closed forms, references, and other equations (minimal coordinates)
//! solved by another method (Runge and Kutta's), over dense grids of the parameters.

use mbint::RangeKind;
use mbint::results::{Method, OutputBounds};

use crate::common::runge_kutta::runge_kutta;
use crate::common::{Findings, Subject, band, model, output, read, reference, run_methods};

/// Least and largest of an output at every output time.
type Truth = Vec<(f64, f64)>;

/// Chebyshev bounds of this order, Taylor's of the second, and a scan of 30 points (9 for more than one parameter).
fn all_methods(description: Subject, order: usize) -> Subject {
    let points = if description.uncertain_count() == 1 { 30 } else { 9 };
    description.asking(move |study| study.chebyshev(order).taylor(2).scan(points))
}

const ALL: [Method; 3] = [Method::Chebyshev, Method::Taylor, Method::Scan];

/// Share of rows in which the reported error covers both ends' true ones, and the mean of the reported over the mean of
/// the true.
fn honesty(output: &OutputBounds, method: Method, truth: &Truth) -> (f64, f64) {
    let band = band(output, method);
    let mut covered = 0;
    let (mut reported, mut true_errors) = (0.0, 0.0);
    for (row, &(lower, upper)) in truth.iter().enumerate() {
        let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
        if error > band.error.total[row] {
            println!("row {row}: off by {error:.2e}, reported {:.2e}, [{lower}, {upper}]", band.error.total[row]);
        } else {
            covered += 1;
        }
        reported += band.error.total[row];
        true_errors += error;
    }
    (covered as f64 / truth.len() as f64, reported / true_errors)
}

/// Findings of several settings, and ratios of stated to true errors.
#[derive(Default)]
struct Settings {
    findings: Findings,
    ratios: Vec<f64>,
}

impl Settings {
    /// Asserts that all are covered, and that stated errors are at most ten times as large on average. (One may be:
    /// where both ends are validation samples, which the band contains, it is far better than the surrogate of a low
    /// order is elsewhere.)
    fn are_honest(mut self) {
        let mean = self.ratios.iter().sum::<f64>() / self.ratios.len() as f64;
        println!("{mean:.2} times on average");
        self.findings.check(mean <= 10.0, format_args!("{mean} times on average"));
        self.findings.none();
    }
}

fn check(settings: &mut Settings, name: &str, description: &Subject, methods: &[Method], outputs: &[(&str, Truth)]) {
    for &method in methods {
        // Alone: in one run each band contains the simulations of the others, and is better than its error says.
        let (bounds, _) = run_methods(description, Some(vec![method]));
        for (wanted, truth) in outputs {
            let output = output(&bounds, wanted);
            let (covered, ratio) = honesty(output, method, truth);
            println!("{name}: {wanted}.{}: {:.1} % covered, {ratio:.2} times", method.name(), 100.0 * covered);
            let what = format_args!("{name}: {wanted}.{} is covered at {covered}, {ratio} times", method.name());
            settings.findings.check(covered >= 0.99, what);
            settings.ratios.push(ratio);
        }
    }
}

/// Ranges over samples of curves, from each sample's values at the output times.
fn range_over(curves: impl Iterator<Item = Vec<f64>>, rows: usize) -> Truth {
    let mut truth = vec![(f64::INFINITY, f64::NEG_INFINITY); rows];
    for curve in curves {
        for ((lower, upper), value) in truth.iter_mut().zip(curve) {
            (*lower, *upper) = (lower.min(value), upper.max(value));
        }
    }
    truth
}

/// n points from a to b, both included.
fn points(a: f64, b: f64, n: usize) -> impl Iterator<Item = f64> + Clone {
    (0..n).map(move |i| a + (b - a) * i as f64 / (n - 1) as f64)
}

/// The slider crank of the paper, against its reference's true ranges.
#[test]
fn errors_of_the_slider_crank_are_honest() {
    let rows = reference("slider_crank/bounds_l1_1pct.csv");
    let mut truth = vec![(0.7085, 0.7115)];
    truth.extend(rows.iter().filter(|row| row[0] > 0.0).map(|row| (row[2], row[3])));
    let mut settings = Settings::default();
    for h in [2e-3, 1e-3, 5e-4, 1e-4] {
        for order in [3, 5, 8] {
            let description = all_methods(model("slider_crank_one").observing(&["slider.x"]).step(h), order);
            check(&mut settings, &format!("h {h}, order {order}"), &description, &ALL, &[("slider.x", truth.clone())]);
        }
        // The paper's way.
        let description = model("slider_crank_one").observing(&["slider.x"]).step(h).chebyshev(5, RangeKind::Tight);
        check(
            &mut settings,
            &format!("h {h}, the paper's"),
            &description,
            &[Method::Chebyshev],
            &[("slider.x", truth.clone())],
        );
    }
    settings.are_honest();
}

/// The pendulum: θ'' = −(g/l) sin θ.
#[test]
fn errors_of_the_pendulum_are_honest() {
    let rows = 101;
    let curves: Vec<Vec<[f64; 2]>> = points(0.995, 1.005, 401)
        .map(|l| {
            let start = [std::f64::consts::FRAC_PI_2, 0.0];
            let angles = runge_kutta(|[angle, rate]| [rate, -9.81 / l * angle.sin()], start, 0.05, rows, 100);
            angles.iter().map(|[angle, _]| [-l * angle.sin(), -l * angle.cos()]).collect()
        })
        .collect();
    let truth = |index: usize| range_over(curves.iter().map(|curve| curve.iter().map(|p| p[index]).collect()), rows);
    let mut settings = Settings::default();
    for (h, order) in [(5e-3, 3), (1e-3, 5), (2.5e-4, 7)] {
        let description = all_methods(model("pendulum").duration(5.0).step(h), order);
        let outputs = [("x", truth(0)), ("y", truth(1))];
        check(&mut settings, &format!("pendulum, h {h}, order {order}"), &description, &ALL, &outputs);
    }
    settings.are_honest();
}

/// A damped oscillator with three uncertain parameters, against its closed form.
#[test]
fn errors_of_an_oscillator_are_honest() {
    let description = read(
        "
parameters:
  m: { value: 0.5, unit: kg, tolerance: 2% }
  c: { value: 0.8, unit: N*s/m, tolerance: 10% }
  k: { value: 50, unit: N/m, tolerance: 3% }
bodies: { mass: { mass: m, coordinates: [x] } }
effects:
  mount: { spring_damper: { between: [ground, mass], along: x, stiffness: k, damping: c, free_length: 1 } }
initial: { mass.x: 1.2, mass.vx: 0 }
outputs: { stretch: mass.x - 1, speed: mass.vx }
simulation: { duration: 3, step: 1e-3, output_step: 0.02 }
",
    );
    let rows = 151;
    let mut curves = Vec::new();
    for m in points(0.49, 0.51, 101) {
        for c in points(0.72, 0.88, 5) {
            for k in points(48.5, 51.5, 101) {
                let decay: f64 = c / (2.0 * m);
                let omega = (k / m - decay * decay).sqrt();
                let at = |t: f64| {
                    let (sin, cos) = (omega * t).sin_cos();
                    let fade = 0.2 * (-decay * t).exp();
                    [fade * (cos + decay / omega * sin), -fade * (omega + decay * decay / omega) * sin]
                };
                curves.push((0..rows).map(|row| at(0.02 * row as f64)).collect::<Vec<_>>());
            }
        }
    }
    let truth = |index: usize| range_over(curves.iter().map(|curve| curve.iter().map(|p| p[index]).collect()), rows);
    let mut settings = Settings::default();
    for (h, order) in [(5e-3, 2), (1e-3, 4)] {
        let description = all_methods(description.clone().step(h), order);
        let outputs = [("stretch", truth(0)), ("speed", truth(1))];
        check(&mut settings, &format!("oscillator, h {h}, order {order}"), &description, &ALL, &outputs);
    }
    settings.are_honest();
}

/// The double pendulum in its two angles.
#[test]
fn errors_of_the_double_pendulum_are_honest() {
    let rows = 151;
    let (m1, m2, g) = (1.0, 0.8, 9.81);
    let mut curves = Vec::new();
    for l1 in points(0.4975, 0.5025, 25) {
        for l2 in points(0.398, 0.402, 25) {
            // Uniform bars, angles from the x axis.
            let f = |[a, b, u, w]: [f64; 4]| {
                let (s, c) = (a - b).sin_cos();
                let coupling = 0.5 * m2 * l1 * l2;
                let (m11, m12, m22) = ((m1 / 3.0 + m2) * l1 * l1, coupling * c, m2 * l2 * l2 / 3.0);
                let q1 = -coupling * s * w * w - (0.5 * m1 + m2) * g * l1 * a.cos();
                let q2 = coupling * s * u * u - 0.5 * m2 * g * l2 * b.cos();
                let determinant = m11 * m22 - m12 * m12;
                [u, w, (m22 * q1 - m12 * q2) / determinant, (m11 * q2 - m12 * q1) / determinant]
            };
            let start = [-40.0_f64.to_radians(), -70.0_f64.to_radians(), 0.0, 0.0];
            let solution = runge_kutta(f, start, 0.02, rows, 10);
            let end = |y: &[f64; 4]| [l1 * y[0].cos() + l2 * y[1].cos(), l1 * y[0].sin() + l2 * y[1].sin()];
            curves.push(solution.iter().map(end).collect::<Vec<_>>());
        }
    }
    let truth = |index: usize| range_over(curves.iter().map(|curve| curve.iter().map(|p| p[index]).collect()), rows);
    let mut settings = Settings::default();
    for (h, order) in [(2e-3, 3), (1e-3, 5)] {
        let description = all_methods(model("double_pendulum").step(h), order);
        let outputs = [("x", truth(0)), ("y", truth(1))];
        check(&mut settings, &format!("double pendulum, h {h}, order {order}"), &description, &ALL, &outputs);
    }
    settings.are_honest();
}
