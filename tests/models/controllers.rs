//! Controllers of shipped models against control theory.

use mbint::results::Method;

use crate::common::{band, curve, largest, model, nominal, output, run};

/// Masses that the controller knows: e = (e₀ + (ė₀ + 10 e₀) t) exp(−10 t) about a path, whatever the arm does.
#[test]
#[ignore = "2 s"]
fn errors_of_a_known_arm_decay_as_double_lags() {
    let bounds = nominal(&model("computed_torque").tolerance(1e-9));
    for (name, start) in [("shoulder_error", -6.0_f64), ("elbow_error", 2.0)] {
        let start = start.to_radians();
        for (&t, found) in bounds.times.iter().zip(curve(&bounds, name)) {
            let wanted = start * (1.0 + 10.0 * t) * (-10.0 * t).exp();
            assert!((found - wanted).abs() < 1e-7, "{name} at {t}: {found}, not {wanted}");
        }
    }
}

/// At rest kp M(q₂) e equals the part of the weight that the controller does not know; for each pair of masses a fixed
/// point.
fn at_rest(upper: f64, fore: f64) -> [f64; 2] {
    let (a, b, g, kp) = (0.5, 0.4, 9.81, 100.0);
    let ends = [40_f64.to_radians(), 20_f64.to_radians()];
    let [m0, m1, m2] = [4.0 * a * a / 3.0 + 2.5 * (a * a + b * b / 3.0), 2.5 * a * b / 2.0, 2.5 * b * b / 3.0];
    let mut error = [0.0; 2];
    for _ in 0..60 {
        let [first, second] = [ends[0] - error[0], ends[1] - error[1]];
        let of_fore = g * (fore - 2.5) * b / 2.0 * (first + second).cos();
        let load = [g * ((upper - 4.0) / 2.0 + fore - 2.5) * a * first.cos() + of_fore, of_fore];
        let [top, side] = [m0 + 2.0 * m1 * second.cos(), m2 + m1 * second.cos()];
        let determinant = kp * (top * m2 - side * side);
        error = [(m2 * load[0] - side * load[1]) / determinant, (top * load[1] - side * load[0]) / determinant];
    }
    error
}

#[test]
fn unknown_masses_leave_the_error_of_their_weight() {
    let bounds = run(&model("computed_torque"));
    let mut wanted = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for i in 0..=40 {
        for j in 0..=40 {
            let error = at_rest(3.6 + 0.02 * f64::from(i), 2.0 + 0.025 * f64::from(j));
            for (ends, error) in wanted.iter_mut().zip(error) {
                *ends = [ends[0].min(error), ends[1].max(error)];
            }
        }
    }
    let end = bounds.times.len() - 1;
    for (name, [lower, upper]) in ["shoulder_error", "elbow_error"].into_iter().zip(wanted) {
        assert!(upper - lower > 5e-3);
        for method in [Method::Chebyshev, Method::Taylor] {
            let band = band(output(&bounds, name), method);
            let (found, allowed) = ([band.lower[end], band.upper[end]], band.error.total[end] + 1e-6);
            let off = largest([found[0] - lower, found[1] - upper]);
            assert!(off < allowed && allowed < 5e-5, "{name}: {found:?}, not {lower} to {upper}");
        }
    }
}
