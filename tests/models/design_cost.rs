//! Designs by the cost of their tolerances, against Lagrange's multipliers and scans over closed forms.

use mbint::Model;
use mbint::results::{Criterion, DesignStudy};

fn designed(text: &str) -> DesignStudy {
    Model::from_yaml_str("design.yaml", text).unwrap().study().design(Criterion::WorstCase).unwrap()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within, "{found} is not {wanted}");
}

const STACK: &str = "
parameters:
  a: { value: 30 mm, tolerance: 0.1 mm, cost: { reciprocal: 1 } }
  b: { value: 20 mm, tolerance: 0.1 mm, cost: { reciprocal: 4 } }
  c: { value: 10.5 mm, tolerance: 0.1 mm, cost: { reciprocal: 9 } }
outputs: { gap: { formula: a - b - c + 0.1 mm, unit: mm } }
requirements: { fits: { output: gap, min: 0.1 mm, max: 0.7 mm } }
design: { c: 9 to 11 mm }
objective: cost
";

#[test]
fn cost_of_a_stack_matches_lagrange() {
    let found = designed(STACK);
    // In the middle of the limits 0.3 mm are left: multiples of 0.1 mm as √1 : √4 : √9, with the sum 3, cost 36/3.
    let best = found.best().unwrap();
    assert!(best.is_feasible && found.front.len() == 5, "{found:?}");
    assert_near(best.values[0], 9.7e-3, 1e-9);
    assert!(best.worst >= 12.0 - 1e-9, "nothing is cheaper than the optimum: {}", best.worst);
    for own in &found.front {
        // Each margin, a share of 0.7 mm, leaves less to the tolerances.
        let left = 0.3 - 0.7 * own.margin;
        assert_near(own.cost, 36.0 / (left / 0.1), 2e-3 * own.cost);
        for (tolerance, share) in own.tolerances.iter().zip([1.0, 2.0, 3.0]) {
            assert_near(1e3 * tolerance.after.above, left * share / 6.0, 1e-3 * left);
        }
    }
    let largest = 0.3 / 0.7;
    for (own, share) in found.front.iter().zip([0.0, 0.2, 0.4, 0.6, 0.8]) {
        assert_near(own.margin, share * largest, 1e-3);
        assert!(own.margin >= share * largest - 1e-9, "{own:?}");
    }
}

#[test]
fn the_margin_has_the_same_front() {
    let costs = |objective: &str| -> Vec<f64> {
        let found = designed(&STACK.replace("objective: cost", objective).replace("0.1 mm, cost", "0.05 mm, cost"));
        assert!(found.best().unwrap().is_feasible);
        found.front.iter().map(|own| own.cost).collect()
    };
    let (of_margin, of_cost) = (costs("objective: margin"), costs("objective: cost"));
    assert_eq!(of_margin.len(), 5);
    of_margin.iter().zip(&of_cost).for_each(|(a, b)| assert_near(*a, *b, 1e-3 * b));
    // With another tolerance the same cost is that of half of it.
    assert_near(of_cost[0], 6.0, 0.01);
}

#[test]
fn nominal_values_minimise_the_cost_of_tolerances() {
    let found = designed(
        "
parameters:
  a: { value: 0.6 m, tolerance: 10 mm, cost: { reciprocal: 8 } }
  b: { value: 1.7 m, tolerance: 5 mm, cost: { reciprocal: 1 } }
outputs: { area: a*b }
requirements: { area: { output: area, min: 0.99 m^2, max: 1.01 m^2 } }
design: { a: 0.5 to 5 m, b: 0.2 to 2 m }
objective: cost
",
    );
    // The cost is 0.08/tₐ + 0.005/t_b, and b tₐ + a t_b ≤ 0.01 with a b = 1: (√(16/a) + √a)²/2, least for a = 4.
    let best = found.best().unwrap();
    assert!(best.is_feasible, "{best:?}");
    assert_near(best.values[0], 4.0, 0.15);
    assert_near(best.values[0] * best.values[1], 1.0, 1e-3);
    assert!(best.worst >= 8.0 - 1e-3, "nothing is cheaper than the optimum: {}", best.worst);
    assert_near(best.worst, 8.0, 0.08);
    assert!(found.nominal_point.as_ref().is_some_and(|point| point.worst >= best.worst - 1e-3));
}

#[test]
fn lever_is_set_to_its_least_sensitive_angle() {
    let found = designed(
        "
analysis: kinematics
parameters:
  angle: { value: 30 deg, tolerance: 0.2 deg, cost: { reciprocal: 3 } }
  l: { value: 0.2 m, tolerance: 0.2 mm, cost: { reciprocal: 2 } }
bodies: { lever: { mass: 1, points: { A: [0, 0], B: [l, 0] } } }
joints:
  pivot: { revolute: [ground, lever.A] }
  drive: { motor: { on: pivot, position: angle } }
outputs: { height: lever.B.y }
requirements: { height: { output: height, min: 99.5 mm, max: 100.5 mm, at: 0 s } }
design: { angle: 20 to 80 deg, l: 0.1 to 0.3 m }
objective: cost
simulation: { duration: 0.1, output_step: 0.1 }
",
    );
    // The height H = l sin φ takes H cot φ δφ + sin φ δl of half a millimetre: cost (√(3 a) + √(2 b))²/0.5 mm, where a
    // and b are the parts that the model's tolerances take. The second order, δφ² H/2, is below 2 % of that.
    let cost = |degrees: f64| {
        let angle = degrees.to_radians();
        let taken = [0.1 / angle.tan() * 0.2_f64.to_radians(), 0.2e-3 * angle.sin()];
        ((3.0 * taken[0]).sqrt() + (2.0 * taken[1]).sqrt()).powi(2) / 0.5e-3
    };
    let least = (2000..=8000).map(|i| cost(0.01 * f64::from(i))).fold(f64::INFINITY, f64::min);
    let best = found.best().unwrap();
    assert!(best.is_feasible, "{best:?}");
    assert_near(best.worst, least, 0.03 * least);
    assert_near(cost(best.values[0].to_degrees()), least, 0.01 * least);
    assert!(best.worst < 0.9 * cost(30.0), "{} {}", best.worst, cost(30.0));
}

#[test]
fn grades_match_a_search_of_all_combinations() {
    let grades = "grades: { 0.05 mm: 9, 0.1 mm: 4, 0.2 mm: 3, 0.3 mm: 1 }";
    let found = designed(&STACK.replace("cost: { reciprocal: 4 }", &format!("cost: {{ {grades} }}")));
    // The rest of 0.3 mm after a grade is shared as √1 : √9.
    let cost = |(t, cost): (f64, f64)| if t < 0.3 { cost + 16.0 / ((0.3 - t) / 0.1) } else { f64::INFINITY };
    let least = [(0.05, 9.0), (0.1, 4.0), (0.2, 3.0), (0.3, 1.0)].map(cost).into_iter().fold(f64::INFINITY, f64::min);
    let best = found.best().unwrap();
    assert_near(best.worst, least, 2e-3 * least);
    assert_near(best.values[0], 9.7e-3, 1e-6);
}

#[test]
#[ignore = "slow: a minute on two busy cores in a test build"]
fn a_share_of_the_production_costs_less_than_every_case() {
    let text = STACK.replace("tolerance: 0.1 mm,", "tolerance: 0.1 mm, distribution: normal,");
    let model = Model::from_yaml_str("design.yaml", &text).unwrap();
    let found = model.study().design(Criterion::Share(0.9973)).unwrap();
    // σ is a third of the tolerance: three deviations of the gap are 0.3 mm, with t³ ~ c: Σ t² = 0.3².
    let shape = [1.0, 4.0, 9.0].map(f64::cbrt);
    let scale = 3.0 / shape.iter().map(|own| own * own).sum::<f64>().sqrt();
    let least: f64 = [1.0, 4.0, 9.0].iter().zip(shape).map(|(cost, own)| cost / (scale * own)).sum();
    let best = found.best().unwrap();
    assert!(best.is_feasible && best.share.unwrap() >= 0.9973, "{best:?}");
    assert_near(best.worst, least, 0.02 * least);
}

#[test]
fn nearest_point_is_given_if_no_tolerances_suffice() {
    let found = designed(&STACK.replace("9 to 11 mm", "10.2 to 11 mm"));
    let best = found.best().unwrap();
    assert!(!best.is_feasible && found.front.is_empty(), "{best:?}");
    assert_eq!(best.at_limits, ["c"]);
    assert_eq!(found.not_met[0].requirement, "fits");
}
