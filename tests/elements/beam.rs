//! Beams against the textbook: deflections, the elastica, and natural frequencies.

use mbint::results::Bounds;

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{Subject, curve, nominal, order, read};

/// A cantilever of N elements along x, of length 1, EI = 1, mass and rotational inertia lumped at its nodes; `load`
/// acts at its tip.
fn cantilever(elements: usize, mass: f64, tip_mass: f64, damping: f64, load: &str, run: &str) -> Subject {
    let h = 1.0 / elements as f64;
    let (mut bodies, mut beams, mut start) = (String::new(), String::new(), String::new());
    for node in 1..=elements {
        let share = if node == elements { 0.5 } else { 1.0 };
        let lump = share * mass * h + if node == elements { tip_mass } else { 0.0 };
        let inertia = 1e-6 * mass.max(tip_mass) * h * h;
        bodies += &format!("  n{node}: {{ mass: {lump:e}, inertia: {inertia:e} }}\n");
        let before = if node == 1 { "ground".to_owned() } else { format!("n{}", node - 1) };
        beams += &format!(
            "  b{node}: {{ beam: {{ between: [{before}, n{node}], length: {h:e}, axial_stiffness: 1e4, bending_stiffness: 1, damping: {damping} }} }}\n"
        );
        let x = node as f64 * h;
        start += &format!("n{node}.x: {x:e}, n{node}.y: 0, n{node}.angle: 0, ");
    }
    read(&format!(
        "
bodies:
{bodies}effects:
{beams}  load: {load}
initial: {{ {start} }}
outputs: {{ x: n{elements}.x, y: n{elements}.y, angle: n{elements}.angle, moment: b{elements}.torque, energy: energy }}
simulation: {{ {run} }}
"
    ))
}

fn last(bounds: &Bounds, name: &str) -> f64 {
    *curve(bounds, name).last().unwrap()
}

/// y = P L³/3 EI and slope P L²/2 EI for a small load, of one element already.
#[test]
fn deflection_of_a_cantilever_matches_the_textbook() {
    for elements in [1, 3] {
        let load = format!("{{ force: {{ on: n{elements}, value: [0, -1e-3] }} }}");
        let description = cantilever(elements, 0.01, 1.0, 0.5, &load, "duration: 20, step: 0.01, output_step: 1");
        let bounds = nominal(&description);
        let (y, angle) = (last(&bounds, "y"), last(&bounds, "angle"));
        assert!((y + 1e-3 / 3.0).abs() < 1e-9, "{elements}: {y:e}");
        assert!((angle + 0.5e-3).abs() < 1e-9, "{elements}: {angle:e}");
    }
}

/// The elastica under P L²/EI = 1: Bisshopp & Drucker, Q. Appl. Math. 3 (1945) 272: tip at 0.9436 L, 0.3017 L down.
#[test]
fn a_cantilever_bends_far_like_the_elastica() {
    let down = [2, 4, 8].map(|elements| {
        let load = format!("{{ force: {{ on: n{elements}, value: [0, -1] }} }}");
        let description = cantilever(elements, 0.01, 1.0, 0.5, &load, "duration: 20, step: 0.01, output_step: 1");
        let bounds = nominal(&description);
        [-last(&bounds, "y"), last(&bounds, "x")]
    });
    println!("{down:?}");
    assert!((down[2][0] - 0.3017).abs() < 4e-4 && (down[2][1] - 0.9436).abs() < 4e-4, "{down:?}");
    let order = order((down[0][0] - down[1][0]).abs(), (down[1][0] - down[2][0]).abs());
    assert!(order > 1.5, "{order}");
}

/// Periods between passages of zero downwards.
fn period(bounds: &Bounds) -> f64 {
    let y = curve(bounds, "y");
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let crossings: Vec<f64> = (1..y.len())
        .filter(|&i| y[i - 1] > mean && y[i] <= mean)
        .map(|i| {
            let part = (y[i - 1] - mean) / (y[i - 1] - y[i]);
            bounds.times[i - 1] + part * (bounds.times[i] - bounds.times[i - 1])
        })
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

/// ω = √(3 EI/(m L³)) with a mass at its tip, and 3.516 √(EI/(ρA L⁴)) with its own mass, to which lumps converge with
/// order two.
#[test]
fn a_cantilever_has_its_natural_frequency() {
    let load = |elements: usize| format!("{{ force: {{ on: n{elements}, value: [0, -1e-3] }} }}");
    let description = cantilever(1, 0.0, 1.0, 0.0, &load(1), "duration: 18.137, step: 2e-3, output_step: 2e-3");
    let found = std::f64::consts::TAU / period(&nominal(&description));
    assert!((found - 3.0_f64.sqrt()).abs() < 1e-4, "{found}");
    let errors = [3, 6].map(|elements| {
        let description =
            cantilever(elements, 1.0, 0.0, 0.002, &load(elements), "duration: 17.87, step: 2e-3, output_step: 2e-3");
        (std::f64::consts::TAU / period(&nominal(&description)) / 3.516015 - 1.0).abs()
    });
    println!("{errors:?}");
    let order = order(errors[0], errors[1]);
    assert!((order - 2.0).abs() < 0.2, "{order}: {errors:?}");
}

/// Bent from the start on, its axis askew.
#[test]
fn stored_energy_equals_work_done() {
    assert_balance(
        &pair(
            "",
            "  e: { beam: { between: [a.P, b.P], axis: [0.2, 1], length: 1.6, axial_stiffness: 50, bending_stiffness: 3 } }",
            APART,
        ),
        "0",
    );
}
