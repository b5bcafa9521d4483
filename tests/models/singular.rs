//! Redundant constraints and singular starts: parallelograms.

use mbint::results::Method;

use crate::common::runge_kutta::runge_kutta;
use crate::common::{band, curve, output, read, run_methods};

/// Cranks at whole distances, a bar along all their ends; every angle and its rate as given.
pub fn parallelogram(cranks: usize, angle: f64, rate: f64) -> String {
    let names = |f: &dyn Fn(usize) -> String| (0..cranks).map(f).collect::<Vec<_>>().join("\n  ");
    let middle = (cranks - 1) as f64 / 2.0;
    format!(
        "model: parallelogram
parameters: {{ w: {{ value: 1, unit: kg, tolerance: 5% }} }}
bodies:
  ground: {{ points: {{ {} }} }}
  {}
  bar: {{ mass: 1, inertia: 0.5, points: {{ {} }} }}
joints:
  {}
  {}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ {}, bar.angle: 0, bar.angular_velocity: 0 }}
outputs: {{ angle: c0.angle, energy: energy, last: up{}.force.x, gap: c{}.B.x - bar.P{}.x }}
simulation: {{ duration: 2, step: 2.5e-4, output_step: 0.01 }}
bounds: {{ chebyshev: {{ order: 3 }}, taylor: {{ order: 2 }}, scan: {{ points: 5 }} }}
",
        (0..cranks).map(|i| format!("O{i}: [{i}, 0]")).collect::<Vec<_>>().join(", "),
        names(&|i| format!("c{i}: {{ mass: w, inertia: 0.1, points: {{ A: [-0.5, 0], B: [0.5, 0] }} }}")),
        (0..cranks).map(|i| format!("P{i}: [{}, 0]", i as f64 - middle)).collect::<Vec<_>>().join(", "),
        names(&|i| format!("down{i}: {{ revolute: [ground.O{i}, c{i}.A] }}")),
        names(&|i| format!("up{i}: {{ revolute: [c{i}.B, bar.P{i}] }}")),
        (0..cranks)
            .map(|i| format!("c{i}.angle: {angle}, c{i}.angular_velocity: {rate}"))
            .collect::<Vec<_>>()
            .join(", "),
        cranks - 1,
        cranks - 1,
        cranks - 1,
    )
}

/// The one crank that three parallel ones on a bar that only shifts amount to: θ̈ = −m_g g cos θ / I, by fourth-order
/// Runge–Kutta with small steps.
pub fn one_crank(cranks: f64, angle: f64, rate: f64) -> f64 {
    let (mass, inertia) = (0.5 * cranks + 1.0, cranks * (0.1 + 0.25) + 1.0);
    let slope = |[angle, rate]: [f64; 2]| [rate, -mass * 9.81 * angle.cos() / inertia];
    runge_kutta(slope, [angle, rate], 2.0, 2, 20_000)[1][0]
}

#[test]
fn redundant_constraint_is_named_and_leaves_the_motion() {
    let description = read(&parallelogram(3, 0.5, 0.0));
    let (bounds, summary) = run_methods(&description, None);
    assert_eq!((summary.degrees_of_freedom, summary.redundant_constraints.as_slice()), (1, &["up2.y".to_owned()][..]));
    // 5.2e-5 at h = 1e-3, so by order 2 a sixteenth of it here.
    let end = *curve(&bounds, "angle").last().unwrap();
    let exact = one_crank(3.0, 0.5, 0.0);
    assert!((end - exact).abs() < 5e-6, "{end} instead of {exact}");
    assert!(curve(&bounds, "gap").iter().all(|gap| gap.abs() < 1e-11));
    // A reaction that equilibrium does not determine must not wander: after three flat positions, in which it is
    // infinite, all methods still agree on it. (Second order against third: 1e-4 of a newton.)
    let last = output(&bounds, "last");
    let (chebyshev, taylor) = (band(last, Method::Chebyshev), band(last, Method::Taylor));
    let apart = (chebyshev.upper.last().unwrap() - taylor.upper.last().unwrap()).abs();
    assert!(apart < 5e-4, "{apart}");
}

#[test]
fn a_flat_parallelogram_is_a_singular_start_and_runs() {
    let description = read(&parallelogram(2, 0.0, 1.0));
    let explained = description.study().explain().unwrap();
    assert_eq!(explained.degrees_of_freedom, 1);
    assert!(explained.redundant_constraints.is_empty() && !explained.singular_at_start.is_empty());
    let (bounds, summary) = description.finished(None);
    assert_eq!(summary.failure, None);
    let end = *curve(&bounds, "angle").last().unwrap();
    let exact = one_crank(2.0, 0.0, 1.0);
    assert!((end - exact).abs() < 5e-6, "{end} instead of {exact}");
    let energy = curve(&bounds, "energy");
    assert!(energy.iter().all(|value| (value - energy[0]).abs() < 2e-4));
}
