//! Designs against optima by hand and against grids over closed forms.

use mbint::Model;
use mbint::results::{Criterion, DesignKind, DesignStudy};

fn designed(text: &str) -> DesignStudy {
    by(text, Criterion::WorstCase)
}

fn by(text: &str, criterion: Criterion) -> DesignStudy {
    Model::from_yaml_str("design.yaml", text).unwrap().study().design(criterion).unwrap()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within, "{found} is not {wanted}");
}

#[test]
fn a_minimax_of_parabolas() {
    let found = designed(
        "parameters: { a: 1 m ± 0.2 m, b: 0.5 m ± 0.1 m }
outputs: { e: \"(a - 2 m)^2 + (a - b)*b\" }
design: { a: 0 to 3 m }
objective: { least: e }
",
    );
    // Convex in a, and rising in b up to a/2: the worst cases are a ± 0.2 with b = 0.6, and equal at a = 1.7.
    let best = found.best().unwrap();
    assert_near(best.values[0], 1.7, 2e-4);
    assert_near(best.worst, 0.79, 2e-4);
    assert_near(best.nominal, 0.09 + 0.6, 2e-4);
    // Without tolerances: 2 (a − 2) + b = 0.
    let nominal = found.nominal_point.as_ref().unwrap();
    assert_near(nominal.values[0], 1.75, 2e-3);
    assert_near(nominal.worst, 0.8125, 2e-3);
    assert_eq!(nominal.kind, DesignKind::Nominal);
    let model = found.model_point.as_ref().unwrap();
    assert_near(model.worst, 1.6, model.error);
    assert!(best.is_feasible && best.requirements.is_empty() && found.optima.len() == 1, "{found:?}");
}

#[test]
fn requirements_hold_about_the_optimum() {
    let found = designed(
        "parameters: { a: 1 m ± 20%, b: 0.5 m, c: { value: 2*b, tolerance: 0.01 m } }
outputs: { e: a + b, f: c*a }
requirements: { big: { output: f, min: 1 m^2 } }
design: { a: 500 mm to 3 m, b: 0.2 to 3 m }
objective: { least: e }
",
    );
    // 1.2 a + b is least where (2 b − 0.01) 0.8 a = 1: a² = 0.625/1.2.
    let a = (0.625_f64 / 1.2).sqrt();
    let b = 0.625 / a + 0.005;
    let best = found.best().unwrap();
    assert!(best.is_feasible, "{best:?}");
    assert_near(best.values[0], a, 2e-3);
    assert_near(best.values[1], b, 3e-3);
    assert!(best.worst >= 1.2 * a + b - 1e-9, "nothing is better than the optimum: {}", best.worst);
    assert_near(best.worst, 1.2 * a + b, 3e-4);
    // The optimum without tolerances, a = b = √½, misses it.
    let nominal = found.nominal_point.unwrap();
    assert!(!nominal.is_feasible);
    assert_near(nominal.values[0], 0.5_f64.sqrt(), 2e-3);
}

#[test]
fn percentages_stay_percentages() {
    let found = designed(
        "parameters: { a: 2 ± 10% }
outputs: { e: a + 1/a }
design: { a: 0.5 to 4 }
objective: { least: e }
",
    );
    // e(0.9 a) = e(1.1 a).
    let best = found.best().unwrap();
    assert_near(best.values[0], ((1.0 / 0.9 - 1.0 / 1.1) / 0.2_f64).sqrt(), 2e-3);
    assert_near(best.deviations[0][0], 0.1 * best.values[0], 1e-12);
}

#[test]
fn several_optima_are_listed_best_first() {
    let found = designed(
        "parameters: { a: 0.5 ± 0.1 }
outputs: { e: (a^2 - 1)^2 + 0.2*a }
design: { a: -2 to 2 }
objective: { least: e }
",
    );
    let worst = |a: f64| {
        let e = |a: f64| (a * a - 1.0).powi(2) + 0.2 * a;
        (0..=200).map(|i| e(a - 0.1 + 0.001 * f64::from(i))).fold(f64::MIN, f64::max)
    };
    let least = |from: i32, to: i32| {
        (from..=to).map(|i| 1e-3 * f64::from(i)).min_by(|a, b| worst(*a).total_cmp(&worst(*b))).unwrap()
    };
    let (left, right) = (least(-2000, 0), least(0, 2000));
    let values: Vec<f64> = found.optima.iter().map(|own| own.values[0]).collect();
    assert_eq!(values.len(), 2, "{values:?}");
    assert_near(values[0], left, 2e-3);
    assert_near(values[1], right, 2e-3);
    assert_near(found.optima[0].worst, worst(left), 1e-3);
    assert_near(found.optima[1].worst, worst(right), 1e-3);
}

#[test]
#[ignore = "2 s"]
fn an_output_over_time_against_a_grid() {
    let found = designed(
        "analysis: kinematics
parameters: { r: 0.08 m ± 1 mm, l: 0.4 m ± 2 mm }
bodies:
  crank: { points: { A: [0, 0], B: [r, 0] } }
  rod: { points: { B: [0, 0], C: [l, 0] } }
  slider: { coordinates: [x] }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin: { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
  drive: { motor: { on: pivot, position: 6.283185307179586*t } }
outputs: { error: \"slider.x - 0.3 m - 0.1 m*cos(6.283185307179586*t)\" }
design: { r: 0.06 to 0.12 m, l: 0.25 to 0.45 m }
objective: { least: abs(error) }
simulation: { duration: 1, output_step: 0.05 }
bounds: { chebyshev: { order: 4 } }
",
    );
    let error = |r: f64, l: f64| {
        let at = |row: i32| {
            let angle = std::f64::consts::TAU * 0.05 * f64::from(row);
            let slider = r * angle.cos() + (l * l - (r * angle.sin()).powi(2)).sqrt();
            (slider - 0.3 - 0.1 * angle.cos()).abs()
        };
        (0..=20).map(at).fold(0.0, f64::max)
    };
    // Convex enough in both: the corners are worst.
    let worst = |r: f64, l: f64| {
        let corners = [(r - 1e-3, l - 2e-3), (r - 1e-3, l + 2e-3), (r + 1e-3, l - 2e-3), (r + 1e-3, l + 2e-3)];
        corners.into_iter().map(|(r, l)| error(r, l)).fold(0.0, f64::max)
    };
    let mut least = f64::INFINITY;
    for i in 0..=120 {
        for j in 0..=400 {
            least = f64::min(least, worst(0.06 + 5e-4 * f64::from(i), 0.25 + 5e-4 * f64::from(j)));
        }
    }
    let best = found.best().unwrap();
    assert_near(best.worst, worst(best.values[0], best.values[1]), 1e-5);
    assert!(best.worst <= least + 2e-5, "{} is not {least}", best.worst);
}

#[test]
fn a_share_of_the_production_by_normal_laws() {
    let text = "parameters: { a: { value: 1.5 m, tolerance: 0.3 m, distribution: normal } }
outputs: { size: a }
requirements: { big: { output: size, min: 1 m } }
design: { a: 0.5 to 3 m }
objective: { least: size }
";
    let best = by(text, Criterion::Share(0.99)).best().cloned().unwrap();
    // σ = 0.1 m, and Φ(2.3263) = 0.99.
    let quantile = 0.232_63;
    assert_near(best.values[0], 1.0 + quantile, 3e-3);
    assert_near(best.worst, best.values[0] + quantile, 2e-3);
    assert!(best.is_feasible && best.share.unwrap() >= 0.99, "{best:?}");
    // In every case it is larger by the whole tolerance.
    let worst = designed(text).best().cloned().unwrap();
    assert_near(worst.values[0], 1.3, 1e-3);
    assert_near(worst.worst, 1.6, 1e-3);
}

#[test]
fn nearest_point_is_given_if_none_is_feasible() {
    let found = designed(
        "parameters: { a: 1 m ± 0.1 m, b: 1 m ± 0.1 m }
outputs: { f: a*b, e: a + b }
requirements: { big: { output: f, min: 10 m^2 } }
design: { a: 0.5 to 3 m, b: 0.5 to 2 m }
objective: { least: e }
",
    );
    let best = found.best().unwrap();
    assert!(!best.is_feasible && best.at_limits == ["a", "b"], "{best:?}");
    assert_eq!(best.values, [3.0, 2.0]);
    assert_near(found.not_met[0].margin, 2.9 * 1.9 - 10.0, 1e-9);
}

#[test]
fn margins_are_balanced_and_their_cost_is_stated() {
    let found = designed(
        "parameters:
  a: { value: 3 m, tolerance: 0.2 m, cost: { reciprocal: 4 } }
  b: { value: 1 m, tolerance: 0.1 m, cost: { reciprocal: 1 } }
outputs: { x: a + b }
requirements: { low: { output: x, min: 2 m }, high: { output: x, max: 4 m } }
design: { a: 0 to 4 m }
objective: margin
",
    );
    // (a + b − 0.3 − 2)/2 = (4 − a − b − 0.3)/4.
    let best = found.best().unwrap();
    let a = (4.0 - 0.3) / 3.0 + (2.3 * 2.0) / 3.0 - 1.0;
    assert_near(best.values[0], a, 1e-3);
    assert_near(best.worst, (a + 1.0 - 2.3) / 2.0, 1e-3);
    let allocation = found.allocation.unwrap();
    let [before, after] = allocation.costs();
    assert!(after.unwrap() < before.unwrap() && allocation.trade.len() > 2, "{allocation:?}");
}

/// Worst cases of shipped models are at least a fifth better than at the optimum without tolerances, by studies.
fn gains(name: &str) {
    let path = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    let found = Model::from_file(path).unwrap().study().design(Criterion::WorstCase).unwrap();
    let (best, nominal) = (found.best().unwrap(), found.nominal_point.as_ref().unwrap());
    assert!(best.is_feasible, "{best:?}");
    let error = best.error + nominal.error;
    assert!(best.worst - nominal.worst - error >= 0.2 * nominal.worst.abs(), "{found:?}");
    assert!(best.nominal < nominal.nominal, "the other is better without tolerances");
}

#[test]
#[ignore = "2 s"]
fn design_improves_the_toe_of_a_double_wishbone() {
    gains("double_wishbone");
}

#[test]
#[ignore = "slow: 40 s on two busy cores"]
fn design_improves_the_dose_of_a_ventilator() {
    gains("four_bar_ventilator");
}
