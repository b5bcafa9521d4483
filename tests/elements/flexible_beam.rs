//! Beams with mass against the textbook: deflections, the elastica, uncertain stiffness, the size of the equations.

use std::f64::consts::PI;

use mbint::results::{Bounds, Method};

use crate::common::runge_kutta::runge_kutta;
use crate::common::{Subject, band, curve, largest, nominal, order, output, read, run};

/// A beam of length 1 with EI = 1 that is clamped at its start.
fn cantilever(elements: usize, mass: f64, axial: f64, damping: f64, load: &str, run: &str) -> Subject {
    read(&format!(
        "
bodies:
  rod:
    beam:
      {{ length: 1, mass_per_length: {mass}, axial_stiffness: {axial:e}, bending_stiffness: 1, damping: {damping}, elements: {elements} }}
joints: {{ clamp: {{ fixed: [ground, rod.start] }} }}
effects: {{ load: {load} }}
outputs:
  x: rod.end.x
  y: rod.end.y
  angle: rod.end.angle
  root: clamp.torque
  moment: rod.element1.start_torque
  end: rod.element{elements}.torque
  strain: potential_energy
simulation: {{ {run} }}
"
    ))
}

/// Cantilever at rest under a load.
fn rest(elements: usize, axial: f64, load: &str) -> Bounds {
    nominal(&cantilever(elements, 0.01, axial, 0.5, load, "duration: 20, step: 0.01, output_step: 1"))
}

fn last(bounds: &Bounds, name: &str) -> f64 {
    *curve(bounds, name).last().unwrap()
}

/// P L³/3EI and P L²/2EI; q L⁴/8EI and q L³/6EI: of one element already.
#[test]
fn deflection_of_a_cantilever_matches_the_textbook() {
    for elements in [1, 2, 5] {
        let bounds = rest(elements, 1e4, "{ force: { on: rod.end, value: [0, -1e-3] } }");
        let (y, angle) = (last(&bounds, "y"), last(&bounds, "angle"));
        assert!((y + 1e-3 / 3.0).abs() < 1e-9 && (angle + 0.5e-3).abs() < 1e-9, "{elements}: {y:e} {angle:e}");
        assert!((last(&bounds, "moment") + 1e-3).abs() < 1e-8 && last(&bounds, "end").abs() < 1e-8);
        let q = 1e-3;
        let bounds = rest(elements, 1e4, "{ gravity: { acceleration: [0, -0.1] } }");
        let (y, angle) = (last(&bounds, "y"), last(&bounds, "angle"));
        assert!((y + q / 8.0).abs() < 1e-9 && (angle + q / 6.0).abs() < 1e-9, "{elements}: {y:e} {angle:e}");
        // The clamp carries all of it; elements know their moments but for q L²/12 each.
        assert!((last(&bounds, "root").abs() - 0.5 * q).abs() < 1e-8, "{:e}", last(&bounds, "root"));
        let missing = q / (12.0 * (elements * elements) as f64);
        assert!((last(&bounds, "moment") + 0.5 * q - missing).abs() < 1e-8, "{:e}", last(&bounds, "moment"));
    }
}

/// P L³/3EI + P L/GA, and P L²/2EI: of one element already.
#[test]
fn deflection_by_shear_matches_the_textbook() {
    for elements in [1, 3] {
        let bounds = nominal(&read(&format!(
            "
analysis: statics
bodies:
  rod:
    beam: {{ length: 1, mass_per_length: 1, axial_stiffness: 1e4, bending_stiffness: 1, shear_stiffness: 20, elements: {elements} }}
joints: {{ clamp: {{ fixed: [ground, rod.start] }} }}
effects: {{ load: {{ force: {{ on: rod.end, value: [0, -1e-4] }} }} }}
outputs: {{ y: rod.end.y, angle: rod.end.angle }}
"
        )));
        let wanted = -1e-4 * (1.0 / 3.0 + 1.0 / 20.0);
        let (y, angle) = (last(&bounds, "y"), last(&bounds, "angle"));
        assert!((y / wanted - 1.0).abs() < 1e-6 && (angle + 0.5e-4).abs() < 1e-10, "{elements}: {y:e} {angle:e}");
    }
}

/// x, y and angle of the tip of the elastica under P L²/EI, stretched by ε = N/EA: θ'' = P (1 + ε) cos θ, θ(0) = 0,
/// θ'(1) = 0 by shooting.
fn elastica(load: f64, axial: f64) -> [f64; 3] {
    let along = |slope: f64| {
        let law = |[_, _, angle, bend]: [f64; 4]| {
            let long = 1.0 - load * angle.sin() / axial;
            [long * angle.cos(), long * angle.sin(), bend, load * long * angle.cos()]
        };
        *runge_kutta(law, [0.0, 0.0, 0.0, slope], 1.0, 2, 2000).last().unwrap()
    };
    let (mut low, mut high) = (-2.0 * load, 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if along(middle)[3] > 0.0 { high = middle } else { low = middle }
    }
    let [x, y, angle, _] = along(low);
    [x, y, angle]
}

#[test]
fn a_cantilever_bends_far_like_the_elastica() {
    // Bisshopp & Drucker, Q. Appl. Math. 3 (1945) 272.
    let [x, y, _] = elastica(1.0, f64::INFINITY);
    assert!((x - 0.9436).abs() < 1e-4 && (y + 0.3017).abs() < 1e-4, "{x} {y}");
    for load in [1.0, 3.0, 10.0] {
        let exact = elastica(load, 1e5);
        let errors: Vec<f64> = [1, 2, 4, 8, 16]
            .into_iter()
            .map(|elements| {
                let load = format!("{{ force: {{ on: rod.end, value: [0, \"-{load}*min(t/8, 1)\"] }} }}");
                let bounds = rest(elements, 1e5, &load);
                let found = ["x", "y", "angle"].map(|name| last(&bounds, name));
                largest(found.iter().zip(exact).map(|(found, exact)| found - exact))
            })
            .collect();
        let orders: Vec<f64> = errors.windows(2).map(|pair| order(pair[0], pair[1])).collect();
        println!("P L²/EI = {load}: off by {errors:?}, orders {orders:.2?}");
        assert!((orders[3] - 4.0).abs() < 0.2 && errors[3] < 4e-5, "{errors:?}");
    }
}

/// A moment alone bends it to an arc: π EI/L to half a circle.
#[test]
fn a_moment_bends_a_cantilever_to_a_circle() {
    let mut errors = Vec::new();
    for elements in [2, 4, 8] {
        let bounds = rest(elements, 1e5, &format!("{{ torque: {{ on: rod.end, value: \"{PI}*min(t/8, 1)\" }} }}"));
        let off = [last(&bounds, "x"), last(&bounds, "y") - 2.0 / PI, last(&bounds, "angle") - PI];
        println!("{elements} elements: x, y, angle off by {off:?}");
        // Each element has half of its angle at both ends, whatever its chord.
        assert!(off[0].abs() < 1e-10 && off[2].abs() < 1e-10, "{off:?}");
        errors.push(off[1].abs());
    }
    assert!(order(errors[1], errors[2]) > 3.8 && errors[2] < 1e-5, "{errors:?}");
}

/// The stiffness uncertain: the tip of a cantilever that swings in its first mode.
#[test]
fn stiffness_and_mass_may_be_uncertain() {
    let description = read(
        "
parameters: { EI: { value: 1, unit: N*m^2, tolerance: 5% }, mu: { value: 1, unit: kg/m, tolerance: 5% } }
bodies: { rod: { beam: { length: 1, mass_per_length: mu, axial_stiffness: 1e4, bending_stiffness: EI, elements: 2, damping: 1e-3 } } }
joints: { clamp: { fixed: [ground, rod.start] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
outputs: { y: rod.end.y, angle: rod.end.angle, root: clamp.torque }
simulation: { duration: 2, step: 2e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 6 }, scan: { points: 15 } }
",
    );
    let bounds = run(&description);
    for name in ["y", "angle", "root"] {
        let output = output(&bounds, name);
        let (chebyshev, scan) = (band(output, Method::Chebyshev), band(output, Method::Scan));
        let widest = largest(scan.upper.iter().zip(&scan.lower).map(|(upper, lower)| upper - lower));
        let beyond = (0..bounds.times.len()).map(|row| {
            let error = chebyshev.error.total[row];
            (chebyshev.lower[row] - error - scan.lower[row]).max(scan.upper[row] - chebyshev.upper[row] - error)
        });
        let beyond = beyond.fold(0.0, f64::max);
        let error = largest(chebyshev.error.total.iter().copied());
        println!("{name}: widest {widest:.3e}, error {error:.1e}, scan beyond by {beyond:.1e}");
        assert!(beyond == 0.0 && error < 0.01 * widest, "{name}: {beyond:e}, {error:e} of {widest:e}");
    }
}

/// Elements cost the same each.
#[test]
fn instructions_grow_with_the_elements() {
    let weight = "{ gravity: { acceleration: [0, -9.81] } }";
    let instructions = [8, 16, 32].map(|elements| {
        let description = cantilever(elements, 1.0, 1e4, 0.0, weight, "duration: 1");
        let simulator = mbint::inner::study::prepare(description.study().description()).unwrap();
        simulator.program.factor().len() + simulator.program.correct().len()
    });
    println!("{instructions:?}");
    let [small, middle, large] = instructions;
    assert!(large - middle < 2 * (middle - small) + 100, "{instructions:?}");
}

/// Joint coordinates are refused for bodies that bend.
#[test]
fn a_beam_has_absolute_coordinates() {
    let run = "duration: 1, formulation: joint";
    let description = cantilever(1, 1.0, 1e4, 0.0, "{ gravity: { acceleration: [0, -9.81] } }", run);
    let failure = description.unbuilt();
    assert!(failure.contains("beam `rod` bends"), "{failure}");
}
