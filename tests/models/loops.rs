//! Loops in joint coordinates: where a loop can branch off, the row of its closure vanishes, and rounding is all that
//! is left of it.

use mbint::Formulation;
use mbint::results::Method;

use crate::common::{Subject, curve, distance, largest, nominal, output, read, richardson, run_methods};
use crate::singular::{one_crank, parallelogram};

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

fn in_joint(text: &str) -> Subject {
    within(read(text), Formulation::Joint)
}

#[test]
fn a_flat_start_runs_in_joint_coordinates_too() {
    let description = in_joint(&parallelogram(2, 0.0, 1.0));
    let explained = description.study().explain().unwrap();
    assert!(explained.redundant_constraints.is_empty() && !explained.singular_at_start.is_empty());
    for h in [1e-3, 2.5e-4, 1e-4] {
        let (bounds, summary) = run_methods(&description.clone().step(h), None);
        assert_eq!(summary.failure, None, "h = {h}");
        let end = *curve(&bounds, "angle").last().unwrap();
        let exact = one_crank(2.0, 0.0, 1.0);
        assert!((end - exact).abs() < 8.0 * h * h + 1e-8, "h = {h}: {end} instead of {exact}");
        assert!(curve(&bounds, "gap").iter().all(|gap| gap.abs() < 1e-11), "h = {h}");
    }
}

/// Flat, folded over: sin 180° is 1e-16, no more and no less than rounding.
#[test]
fn a_start_folded_over_is_singular_but_for_rounding() {
    let text = parallelogram(2, 0.0, 1.0)
        .replace("c0.angle: 0", "c0.angle: 180 deg")
        .replace("c1.angle: 0", "c1.angle: 180 deg")
        .replace("simulation:", "guess: { bar.x: -0.5, bar.y: 0 }\nsimulation:");
    let description = in_joint(&text);
    let explained = description.study().explain().unwrap();
    assert!(explained.redundant_constraints.is_empty() && !explained.singular_at_start.is_empty());
    let (bounds, summary) = run_methods(&description, Some(Vec::new()));
    assert_eq!(summary.failure, None);
    let end = *curve(&bounds, "angle").last().unwrap();
    let exact = one_crank(2.0, std::f64::consts::PI, 1.0);
    assert!((end - exact).abs() < 5e-6, "{end} instead of {exact}");
}

/// Cranks of 1 m that turn over, through both flat positions, several times.
#[test]
fn turns_through_flat_positions_stay_on_their_branch() {
    for cranks in [2, 3] {
        let text = parallelogram(cranks, 1.0, -8.0).replace("bounds:", "# bounds:");
        for h in [1e-3, 2.5e-4, 6.25e-5] {
            let [absolute, joint] = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
                let (bounds, summary) = run_methods(&within(read(&text), formulation).step(h), Some(Vec::new()));
                assert_eq!(summary.failure, None, "h = {h}");
                assert!(curve(&bounds, "gap").iter().all(|gap| gap.abs() < 1e-10), "h = {h}");
                let end = *curve(&bounds, "angle").last().unwrap();
                ((end - one_crank(cranks as f64, 1.0, -8.0)).abs(), summary.singular_configurations.len())
            });
            println!("{cranks} cranks, h = {h}: off by {:.1e} and {:.1e}", absolute.0, joint.0);
            assert!(joint.0 < absolute.0.max(1e-8), "h = {h}: off by {:e}, absolute {:e}", joint.0, absolute.0);
            assert_eq!(joint.1, absolute.1, "h = {h}: singular configurations");
        }
    }
}

/// Every sample of a box is at another distance from the flat position when a step ends next to it.
#[test]
fn all_samples_pass_flat_positions() {
    let text = parallelogram(2, 1.0, -8.0).replace("scan: { points: 5 }", "scan: { points: 201 }");
    let (bounds, summary) = run_methods(&in_joint(&text).step(1e-3), Some(vec![Method::Scan]));
    assert_eq!(summary.failure, None);
    let gap = output(&bounds, "gap").bands[0].clone();
    assert!(largest(gap.lower.iter().chain(&gap.upper).copied()) < 1e-10);
    let energy = output(&bounds, "energy").bands[0].clone();
    let drift = |curve: &[f64]| largest(curve.iter().map(|value| value - curve[0])) / curve[0].abs();
    assert!(drift(&energy.lower) < 2e-5 && drift(&energy.upper) < 2e-5, "{energy:?}");
}

/// A four-bar linkage: base, crank, coupler and rocker.
fn four_bar(lengths: [f64; 4], angles: [f64; 3], rate: f64) -> String {
    let [base, crank, coupler, rocker] = lengths;
    let [a, b, c] = angles;
    format!(
        "parameters: {{ crank: {{ value: {crank}, unit: m, tolerance: 1% }} }}
bodies:
  ground: {{ points: {{ A: [0, 0], D: [{base}, 0] }} }}
  left: {{ mass: 1, inertia: 0.1, points: {{ A: [-crank/2, 0], B: [crank/2, 0] }} }}
  top: {{ mass: 1, inertia: 0.1, points: {{ B: [-{coupler}/2, 0], C: [{coupler}/2, 0] }} }}
  right: {{ mass: 1, inertia: 0.1, points: {{ D: [-{rocker}/2, 0], C: [{rocker}/2, 0] }} }}
joints:
  A: {{ revolute: [ground.A, left.A] }}
  B: {{ revolute: [left.B, top.B] }}
  C: {{ revolute: [top.C, right.C] }}
  D: {{ revolute: [ground.D, right.D] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ left.angle: {a}, left.angular_velocity: {rate} }}
guess: {{ top.angle: {b}, right.angle: {c} }}
outputs: {{ left: left.angle, top: top.angle, right: right.angle, energy: energy, force: C.force.x }}
simulation: {{ duration: 1.5, step: 1e-3, output_step: 0.01 }}
bounds: {{ scan: {{ points: 21 }}, chebyshev: {{ order: 4 }} }}
"
    )
}

/// Asserts that the formulations agree at the end of Richardson's extrapolation, to `allowed` of the largest value.
#[track_caller]
fn assert_formulations_agree(text: &str, names: &[&str], h: f64, allowed: f64) {
    let limits = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
        let runs = [h, 0.5 * h].map(|h| nominal(&within(read(text), formulation).step(h)));
        names.iter().map(|name| richardson(curve(&runs[0], name), curve(&runs[1], name))).collect::<Vec<_>>()
    });
    for ((name, absolute), joint) in names.iter().zip(&limits[0]).zip(&limits[1]) {
        let (apart, size) = (distance(absolute, joint), largest(absolute.iter().copied()).max(1e-3));
        println!("{name}: {:.1e} of {size:.1e}", apart);
        assert!(apart < allowed * size, "{name}: {apart:e} of {size:e}");
    }
}

#[test]
fn formulations_agree_near_change_points() {
    // A kite: crank and base, coupler and rocker alike. It is flat where the crank points along the base.
    assert_formulations_agree(
        &four_bar([1.0, 1.0, 0.7, 0.7], [1.2, -0.6, 2.2], 2.0),
        &["left", "top", "right", "energy"],
        5e-4,
        1e-4,
    );
    // Parallelograms but for one per cent: the crank turns over, or the linkage swings back before it is flat.
    for crank in [0.99, 1.01] {
        let text = four_bar([1.0, crank, 1.0, 1.0], [1.2, 0.0, 1.2], 1.0);
        assert_formulations_agree(&text, &["left", "top", "right", "energy"], 2.5e-4, 1e-3);
    }
}

/// A box of lengths with the parallelogram in it: on its two sides linkages move differently. Joint coordinates bound
/// the same motions as absolute ones, and report it where they cannot.
#[test]
fn bounds_across_a_change_point_match_absolute_coordinates() {
    let text = four_bar([1.0, 1.0, 1.0, 1.0], [1.2, 0.0, 1.2], 1.0);
    let [absolute, joint] = [Formulation::Absolute, Formulation::Joint]
        .map(|formulation| run_methods(&within(read(&text), formulation).step(2.5e-4).duration(0.4), None));
    assert_eq!((absolute.1.failure, joint.1.failure), (None, None));
    for name in ["left", "right"] {
        let [a, b] = [&absolute.0, &joint.0].map(|bounds| {
            output(bounds, name).bands.iter().map(|band| [band.lower.clone(), band.upper.clone()]).collect::<Vec<_>>()
        });
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!(distance(a, b) < 1e-4, "{name}: {:e}", distance(a, b));
        }
    }
}

/// If the model leaves the formulation open, loops are closed in the branch that absolute coordinates find, also
/// without guesses.
#[test]
fn auto_closes_loops_in_the_branch_of_absolute_coordinates() {
    for (lengths, angle) in [([0.4, 0.1, 0.35, 0.3], 0.5), ([0.4, 0.1, 0.35, 0.3], -2.0), ([1.0, 0.8, 0.9, 0.7], 2.0)] {
        let with_guess = four_bar(lengths, [angle, 0.3, 1.5], 1.0);
        let without: String =
            with_guess.lines().filter(|line| !line.starts_with("guess")).map(|l| format!("{l}\n")).collect();
        for text in [with_guess, without] {
            let [absolute, auto] = [Formulation::Absolute, Formulation::Auto]
                .map(|formulation| nominal(&within(read(&text), formulation).duration(0.01)));
            for name in ["left", "top", "right"] {
                let [a, b] = [&absolute, &auto].map(|bounds| curve(bounds, name)[0]);
                assert!((a - b).abs() < 1e-9, "{name}: {a} and {b}");
            }
        }
    }
    let chosen = read(&four_bar([0.4, 0.1, 0.35, 0.3], [0.5, 0.3, 1.5], 1.0)).study().explain().unwrap();
    assert!(chosen.formulation.starts_with("joint coordinates"), "{}", chosen.formulation);
}

/// Two loops that share a rocker, one of them with a slider, and a gear between cranks.
#[test]
fn formulations_agree_on_loops_with_shared_links() {
    let text = "
bodies:
  ground: { points: { A: [0, 0], D: [1, 0], E: [1.8, 0.1] } }
  crank: { mass: 1, inertia: 0.02, points: { A: [0, 0], B: [0.3, 0] } }
  rod: { mass: 1, inertia: 0.08, points: { B: [-0.45, 0], C: [0.45, 0] } }
  rocker: { mass: 1, inertia: 0.06, points: { D: [0, 0], C: [0.6, 0], F: [0.4, 0.1] } }
  link: { mass: 0.5, inertia: 0.03, points: { F: [-0.5, 0], G: [0.5, 0] } }
  slider: { mass: 2, inertia: 0.05 }
  wheel: { mass: 1, inertia: 0.05 }
joints:
  A: { revolute: [ground.A, crank.A] }
  B: { revolute: [crank.B, rod.B] }
  C: { revolute: [rod.C, rocker.C] }
  D: { revolute: [ground.D, rocker.D] }
  F: { revolute: [rocker.F, link.F] }
  G: { revolute: [link.G, slider] }
  rail: { prismatic: { between: [ground.E, slider], axis: [1, 0.1] } }
  W: { revolute: [ground.E, wheel] }
  mesh: { equation: wheel.angle + 2*crank.angle = 1.0 }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { crank.angle: 1.0, crank.angular_velocity: 6 }
guess: { rod.angle: 0.2, rocker.angle: 1.7, link.angle: -0.4, slider.x: 2.0 }
outputs: { crank: crank.angle, slider: slider.x, wheel: wheel.angle, force: C.force.x, energy: energy }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
bounds: { }
";
    assert_formulations_agree(text, &["crank", "slider", "wheel", "energy"], 5e-4, 1e-4);
    assert_formulations_agree(text, &["force"], 2.5e-4, 1e-3);
}

#[test]
fn options_of_runs_do_not_matter_to_loops() {
    // The same bits for any number of threads, through flat positions.
    let description = in_joint(&parallelogram(2, 1.0, -8.0)).duration(0.5);
    let [one, two] = [1, 2]
        .map(|threads| description.study().methods(&[Method::Scan]).threads(threads).run().unwrap().bounds().clone());
    assert_eq!(format!("{:?}", output(&one, "angle").bands), format!("{:?}", output(&two, "angle").bands));
}
