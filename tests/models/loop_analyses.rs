//! Loops in joint coordinates beyond plain motions: redundant constraints, equilibria, small vibrations, the explicit
//! method, enclosures.

use mbint::results::{Bounds, Method};
use mbint::{Formulation, SchemeChoice, Study};

use crate::common::{
    Subject, band, curve, distance, largest, model, nominal, output, read, richardson, run, run_methods,
};
use crate::statics::{close, value};

const FORMULATIONS: [Formulation; 2] = [Formulation::Absolute, Formulation::Joint];

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

/// A four-bar linkage that hangs on a spring.
fn four_bar(analysis: &str, bounds: &str) -> Subject {
    read(&format!(
        "
analysis: {analysis}
parameters: {{ crank: {{ value: 0.1, unit: m, tolerance: 1% }}, k: {{ value: 2, unit: N*m/rad, tolerance: 2% }} }}
bodies:
  ground: {{ points: {{ A: [0, 0], D: [0.4, 0] }} }}
  left: {{ mass: 1, inertia: 0.01, points: {{ A: [-crank/2, 0], B: [crank/2, 0] }} }}
  top: {{ mass: 1, inertia: 0.03, points: {{ B: [-0.175, 0], C: [0.175, 0] }} }}
  right: {{ mass: 1, inertia: 0.02, points: {{ D: [-0.15, 0], C: [0.15, 0] }} }}
joints:
  A: {{ revolute: [ground.A, left.A] }}
  B: {{ revolute: [left.B, top.B] }}
  C: {{ revolute: [top.C, right.C] }}
  D: {{ revolute: [ground.D, right.D] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  spring: {{ torsional_spring_damper: {{ on: A, stiffness: k, damping: 0.01, free_angle: 1 }} }}
guess: {{ left.angle: 0.6, top.angle: 0.4, right.angle: 1.5 }}
outputs: {{ left: left.angle, top: top.angle, right: right.angle }}
bounds: {{ {bounds} }}
"
    ))
}

/// Both formulations' nominal values and bands of every output.
#[track_caller]
fn agree(bounds: [&Bounds; 2], methods: &[Method], allowed: f64) {
    let [absolute, joint] = bounds;
    assert!(!absolute.outputs.is_empty());
    for wanted in &absolute.outputs {
        let found = output(joint, &wanted.name);
        let size = largest(wanted.nominal.iter().copied()).max(1e-6);
        let apart = distance(&wanted.nominal, &found.nominal) / size;
        assert!(apart < allowed, "{}: {apart:e}", wanted.name);
        for &method in methods {
            let (a, b) = (band(wanted, method), band(found, method));
            let apart = distance(&a.lower, &b.lower).max(distance(&a.upper, &b.upper)) / size;
            assert!(apart < allowed, "{} by {method:?}: {apart:e}", wanted.name);
        }
    }
}

/// Bricard's mechanism: five closure equations are independent, the sixth is not.
#[test]
fn formulations_agree_on_a_redundant_loop() {
    let description = model("bricard").duration(1.0).rows_every(0.1);
    for formulation in FORMULATIONS {
        let explained = within(description.clone(), formulation).study().explain().unwrap();
        assert_eq!((explained.redundant_constraints.len(), explained.degrees_of_freedom), (1, 1));
    }
    let ends = FORMULATIONS.map(|formulation| {
        let runs = [2e-3, 1e-3].map(|h| nominal(&within(description.clone(), formulation).step(h)));
        ["x", "y", "z"].map(|name| richardson(curve(&runs[0], name), curve(&runs[1], name)))
    });
    for (absolute, joint) in ends[0].iter().zip(&ends[1]) {
        let apart = distance(absolute, joint);
        assert!(apart < 1e-5, "{apart:e} m");
    }
}

#[test]
fn formulations_agree_on_equilibria_of_loops() {
    let bounds =
        FORMULATIONS.map(|formulation| run(&within(four_bar("statics", "chebyshev: { order: 4 }"), formulation)));
    agree([&bounds[0], &bounds[1]], &[Method::Chebyshev], 1e-9);
}

#[test]
fn formulations_agree_on_vibrations_of_loops() {
    let text = "chebyshev: { order: 4 }";
    let bounds =
        FORMULATIONS.map(|formulation| run(&within(four_bar("modes\ninitial: equilibrium", text), formulation)));
    let [absolute, joint] = [0, 1].map(|index: usize| value(&bounds[index], "mode1.frequency"));
    assert!(absolute > 0.1);
    close(joint, absolute, 1e-9);
    let [a, b] = [0, 1].map(|index: usize| {
        let band = band(output(&bounds[index], "mode1.frequency"), Method::Chebyshev);
        [band.lower[0], band.upper[0]]
    });
    close(b[0], a[0], 1e-6);
    close(b[1], a[1], 1e-6);
}

/// The explicit method closes loops by projections in both; HHT-I3 with short steps is where both end.
#[test]
fn formulations_agree_on_explicit_motions_of_loops() {
    for name in ["slider_crank", "spatial_four_bar", "excavator"] {
        let description = model(name).at_most(0.5).rows_every(0.05);
        let bounds = FORMULATIONS.map(|formulation| {
            let description = within(description.clone(), formulation).tolerance(1e-7).scheme(SchemeChoice::Explicit);
            let (bounds, summary) = run_methods(&description, Some(Vec::new()));
            assert_eq!(summary.integration.as_deref(), Some("Dormand–Prince 8(5,3), explicit"));
            bounds
        });
        agree([&bounds[0], &bounds[1]], &[], 1e-5);
    }
}

/// Certified bounds in joint coordinates hold every sample: those of the scheme the samples of its steps, those of the
/// motion the ones of the explicit method under a tight tolerance.
#[test]
fn enclosures_of_loops_contain_every_sample() {
    let loops = within(model("slider_crank_one").duration(0.1).rows_every(0.01).scan(21), Formulation::Joint);
    let explained = loops.study().explain().unwrap();
    assert!(explained.formulation.contains("; loops are cut at "), "{}", explained.formulation);
    let explicit = loops.clone().tolerance(1e-11).scheme(SchemeChoice::Explicit);
    for description in [loops.asking(Study::certified_scheme), explicit.asking(Study::certified)] {
        let (bounds, _) = run_methods(&description, Some(vec![Method::Scan, Method::Certified]));
        assert_held(&bounds);
    }
}

/// Asserts that certified bounds contain the scan, and are hardly wider.
fn assert_held(bounds: &Bounds) {
    for output in &bounds.outputs {
        let (scan, certified) = (band(output, Method::Scan), band(output, Method::Certified));
        let slack = 1e-9 * largest(output.nominal.iter().copied());
        for row in 0..bounds.times.len() {
            let (lower, upper) = (certified.lower[row], certified.upper[row]);
            assert!(
                lower <= scan.lower[row] + slack && upper >= scan.upper[row] - slack,
                "{} in row {row}",
                output.name
            );
            let width = scan.upper[row] - scan.lower[row];
            assert!(
                upper - lower < 1.1 * width + slack,
                "{} in row {row}: {:e} of {width:e}",
                output.name,
                upper - lower
            );
        }
    }
}
