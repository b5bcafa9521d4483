//! Certified bounds of the scheme's motion: they hold every sample of the ordinary integration, are hardly wider than
//! their range, and say where they end.
//!
//! The ordinary integration ends Newton's iteration at 1e-11 of a position; its samples are therefore allowed to lie
//! outside by `NEWTON` times the size of the output, and no more.

use mbint::Study;
use mbint::results::{Bounds, Method};

use crate::common::Subject;
use crate::common::*;

/// Error of an ordinary sample: Newton's tolerance, gathered over the steps.
const NEWTON: f64 = 1e-9;

/// The same, whose certified bounds are of the scheme.
fn of_scheme(description: Subject) -> Subject {
    description.asking(Study::certified_scheme)
}

fn certify(description: Subject) -> (Bounds, Option<String>) {
    let (bounds, summary) = of_scheme(description).finished(Some(vec![Method::Scan, Method::Certified]));
    (bounds, summary.failure)
}

/// Asserts that every row contains the scan; returns, for each output, the largest overestimation of the width relative
/// to the scan's, over rows from `from` seconds on.
#[track_caller]
fn overestimation(bounds: &Bounds, from: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for output in &bounds.outputs {
        let (scan, certified) = (band(output, Method::Scan), band(output, Method::Certified));
        let size = largest(output.nominal.iter().copied());
        let mut worst = 0.0_f64;
        for row in 0..bounds.times.len() {
            let (lower, upper) = (certified.lower[row], certified.upper[row]);
            let slack = NEWTON * size;
            let held = lower <= scan.lower[row] + slack && upper >= scan.upper[row] - slack;
            assert!(held, "{} at {} s: [{lower}, {upper}]", output.name, bounds.times[row]);
            if bounds.times[row] >= from {
                let (width, true_width) = (upper - lower, scan.upper[row] - scan.lower[row]);
                worst = worst.max((width - true_width) / true_width);
            }
        }
        found.push(worst);
    }
    found
}

#[test]
fn bounds_contain_every_sample_of_the_pendulum() {
    let (bounds, failure) = certify(model("pendulum").duration(3.0).scan(101).observing(&["bob.x", "bob.y"]));
    assert_eq!(failure, None);
    // Measured 4.6e-5 and 6.9e-6.
    for (found, name) in overestimation(&bounds, 0.2).into_iter().zip(["x", "y"]) {
        assert!(found < 2e-4, "{name}: {found:e}");
    }
}

/// Accelerations and reactions of a row solve equations of their own.
#[test]
fn bounds_contain_every_sample_of_a_reaction() {
    let (bounds, failure) = certify(model("pendulum").duration(1.0).scan(51).observing(&["bob.ax", "bob.ay"]));
    assert_eq!(failure, None);
    for (found, name) in overestimation(&bounds, 0.2).into_iter().zip(["bob.ax", "bob.ay"]) {
        assert!(found < 1e-2, "{name}: {found:e}");
    }
}

#[test]
#[ignore = "20 s: enclosures of a whole motion"]
fn bounds_contain_every_sample_of_the_slider_crank() {
    let (bounds, failure) = certify(model("slider_crank_one").duration(0.4).scan(101));
    assert_eq!(failure, None);
    // Measured 4.8e-6 and 2.5e-6.
    for (found, output) in overestimation(&bounds, 0.05).into_iter().zip(&bounds.outputs) {
        assert!(found < 2e-5, "{}: {found:e}", output.name);
    }
}

#[test]
#[ignore = "10 s: enclosures over two parameters"]
fn two_parameters() {
    let (bounds, failure) = certify(model("slider_crank").duration(0.1).scan(31));
    assert_eq!(failure, None);
    for found in overestimation(&bounds, 0.05) {
        // Measured 3.8e-5.
        assert!(found < 2e-4, "{found:e}");
    }
}

#[test]
#[ignore = "20 s: enclosures of a whole motion"]
fn interval_of_zero_width_gives_the_nominal_motion() {
    let description = model("slider_crank_one").uncertain("l1", 0.0).duration(0.5).scan(2);
    let (bounds, failure) = certify(description);
    assert_eq!(failure, None);
    for output in &bounds.outputs {
        let certified = band(output, Method::Certified);
        let (below, above) = (distance(&certified.lower, &output.nominal), distance(&certified.upper, &output.nominal));
        // Rounding errors of 500 steps, each as large and as adverse as it may be, integrated twice: measured 2e-9.
        assert!(below < 1e-8 && above < 1e-8, "{}: {below:e} {above:e}", output.name);
        for (lower, upper) in certified.lower.iter().zip(&certified.upper) {
            assert!(lower <= upper);
        }
    }
}

#[test]
#[ignore = "10 s: a box is halved again and again"]
fn lost_rows_are_unknown_and_reported() {
    // A box in which cranks turn over and others do not: no polynomial follows.
    let (bounds, failure) =
        certify(model("pendulum").uncertain("length", 0.3).step(2e-3).duration(4.0).rows_every(0.5).scan(11));
    let failure = failure.expect("4 s are too long for ±30 %");
    assert!(failure.contains("certified bounds are unknown from there on") && failure.contains(" s "), "{failure}");
    let x = output(&bounds, "x");
    let certified = band(x, Method::Certified);
    assert_eq!(certified.lower.len(), bounds.times.len());
    assert!(certified.lower[0] <= -1.3 && certified.upper[0] >= -0.7);
    assert!(certified.lower.last().unwrap().is_nan() && certified.upper.last().unwrap().is_nan());
    // The scan continues.
    assert!(band(x, Method::Scan).lower.iter().all(|value| value.is_finite()));
}

#[test]
fn unsupported_models_are_refused() {
    let refused = |description: &Subject| {
        of_scheme(description.clone()).asking(|study| study.methods(&[Method::Certified]).threads(1)).refused()
    };
    let many = read(
        "model: many\nparameters: { a: { value: 1, tolerance: 1% }, b: { value: 1, tolerance: 1% }, c: { value: 1, tolerance: 1% } }\n\
         bodies: { bob: { mass: a*b*c, coordinates: [x] } }\noutputs: { x: bob.x }\nsimulation: { duration: 1, step: 0.1 }\n",
    );
    assert_eq!(refused(&many), "certified bounds are for at most two uncertain parameters, not 3");
    let controlled = model("pendulum").tolerance(1e-6);
    let message = refused(&controlled);
    assert!(
        message.starts_with("certified bounds of the scheme enclose HHT-I3 itself with a fixed `step`"),
        "{message}"
    );
}

/// Friction proportional to its reaction is enclosed, and so is a stop of any exponent as long as the whole box is away
/// from it.
#[test]
fn friction_and_stops_that_are_not_reached_are_enclosed() {
    let text = |effect: &str| {
        read(&format!(
            "
parameters: {{ l: {{ value: 0.3, unit: m, tolerance: 1% }} }}
bodies: {{ rod: {{ mass: 1, inertia: 0.02, points: {{ pin: [-l, 0] }} }} }}
joints: {{ hinge: {{ revolute: [ground, rod.pin] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  extra: {effect}
initial: {{ rod.angle: -0.3, rod.angular_velocity: 1 }}
outputs: {{ angle: rod.angle }}
simulation: {{ duration: 0.02, step: 1e-3 }}
"
        ))
    };
    let friction = "{ joint_friction: { on: hinge, coefficient: 0.2, radius: 0.01, transition_velocity: 0.5 } }";
    let stops = ["", ", exponent: 1.3"]
        .map(|exponent| format!("{{ stop: {{ on: hinge, upper: 1, impact: {{ stiffness: 1e4{exponent} }} }} }}"));
    for effect in [friction, &stops[0], &stops[1]] {
        let (bounds, failure) = certify(text(effect).scan(11));
        assert_eq!(failure, None);
        let [scan, certified] = [Method::Scan, Method::Certified].map(|method| band(&bounds.outputs[0], method));
        for row in 0..bounds.times.len() {
            assert!(certified.lower[row] <= scan.lower[row] && scan.upper[row] <= certified.upper[row], "row {row}");
        }
    }
}

/// A mechanism that a motor moves has no degree of freedom: its frame has no slow directions, and its start nothing to
/// solve for where positions are given.
#[test]
fn a_mechanism_without_degrees_of_freedom_is_certified() {
    let crank = read(
        "
parameters: { r: { value: 0.12, unit: m, tolerance: 1% }, L: { value: 0.41, unit: m } }
bodies:
  crank: { mass: 0.7, inertia: 1e-3, coordinates: [angle], points: { pin: [r, 0] } }
  rod: { mass: 0.3, inertia: 4e-3, points: { a: [-L/2, 0], b: [L/2, 0] } }
  piston: { mass: 0.5, coordinates: [x] }
joints:
  pin: { revolute: [crank.pin, rod.a] }
  wrist: { revolute: [rod.b, piston] }
  drive: { equation: crank.angle = 40*t }
outputs: { x: piston.x, push: wrist.force }
simulation: { duration: 0.02, step: 5e-4 }
",
    );
    let direct = read(
        "
parameters: { r: { value: 0.3, unit: m, tolerance: 1% } }
bodies: { arm: { mass: 2, inertia: 0.05, points: { pin: [-r, 0] } } }
joints: { hinge: { revolute: [ground, arm.pin] }, drive: { motor: { on: hinge, position: 3*t } } }
outputs: { x: arm.x, push: hinge.force }
simulation: { duration: 0.02, step: 5e-4 }
",
    );
    for description in [crank, direct] {
        let (bounds, failure) = certify(description.scan(21));
        assert_eq!(failure, None);
        for output in &bounds.outputs {
            let certified = band(output, Method::Certified);
            assert!(certified.lower.iter().chain(&certified.upper).all(|value| value.is_finite()), "{}", output.name);
        }
        let x = output(&bounds, "x");
        let (scan, certified) = (band(x, Method::Scan), band(x, Method::Certified));
        for row in 0..bounds.times.len() {
            assert!(certified.lower[row] <= scan.lower[row] + NEWTON, "row {row}");
            assert!(certified.upper[row] >= scan.upper[row] - NEWTON, "row {row}");
        }
    }
}

/// The shipped models that motors move. Certified bands hold the samples, and where a band ends the run says why.
#[test]
#[ignore = "20 s: enclosures of four motions"]
fn shipped_models_without_degrees_of_freedom_are_certified() {
    for name in ["four_bar", "universal_joint", "spatial_four_bar", "quick_return"] {
        let (bounds, failure) = certify(model(name).duration(0.1).scan(3));
        let rows = bounds.times.len();
        let mut all = 0;
        for output in &bounds.outputs {
            let (scan, certified) = (band(output, Method::Scan), band(output, Method::Certified));
            let size = largest(output.nominal.iter().copied());
            let known = certified.lower.iter().take_while(|value| value.is_finite()).count();
            let says_why =
                failure.as_ref().is_some_and(|why| why.contains("certified bounds are unknown from there on"));
            // The size of a force that passes zero has no finite derivative there: its enclosure is unknown, and marked
            // so.
            let is_marked = (known..rows).all(|row| certified.error.unresolved[row]);
            assert!(says_why || is_marked, "{name}: {} from row {known} of {rows}: {failure:?}", output.name);
            all += usize::from(known == rows);
            for row in 0..known {
                let held = certified.lower[row] <= scan.lower[row] + NEWTON * size
                    && certified.upper[row] >= scan.upper[row] - NEWTON * size;
                assert!(held, "{name}: {} in row {row}", output.name);
            }
        }
        assert!(2 * all > bounds.outputs.len(), "{name}: {all} of {} outputs to the end", bounds.outputs.len());
    }
}
