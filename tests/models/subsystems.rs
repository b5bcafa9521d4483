//! Subsystems are models of their own: they have the results of models run apart, whatever becomes of the others.

use mbint::Study;
use mbint::results::{Bounds, Method, MethodSummary, Summary};

use crate::common::{Subject, read};
use crate::pruning::{Sections, csv, difference, pendulum, run};

#[test]
fn subsystems_match_separate_models() {
    let (a, b) = (pendulum("a", 0.0, ", tolerance: 2%"), pendulum("b", 0.3, ", tolerance: 1%"));
    let c = pendulum("c", 0.1, "");
    let both = a.with(&b).with(&c).model();
    let (together, summary) = run(&both);
    assert_eq!(summary.subsystems.len(), 3);
    for (subsystem, one) in summary.subsystems.iter().zip([a, b, c]) {
        let (apart, of_one) = run(&one.model());
        let without_seconds = |methods: &[MethodSummary]| {
            let without = |method: &MethodSummary| MethodSummary { seconds: None, ..method.clone() };
            methods.iter().map(without).collect::<Vec<_>>()
        };
        assert_eq!(without_seconds(&subsystem.methods), without_seconds(&of_one.methods));
        for output in &apart.outputs {
            let found = together.outputs.iter().find(|known| known.name == output.name).unwrap();
            assert_eq!(found, output, "{}", output.name);
        }
    }
    // 5 nodes of one parameter twice, and not 25; and the certain one not at all.
    let simulations = |name: &str| summary.methods.iter().find(|method| method.method == name).unwrap().simulations;
    assert_eq!((simulations("nominal"), simulations("chebyshev"), simulations("scan")), (3, 10, 10));
    // Its own, and two with shorter steps for its error.
    let certain = &summary.subsystems[2];
    assert_eq!(certain.parameters, Vec::<String>::new());
    let simulations: Vec<(&str, usize)> =
        certain.methods.iter().map(|method| (method.method.as_str(), method.simulations)).collect();
    assert_eq!(simulations, [("nominal", 1), ("validation", 2), ("chebyshev", 0), ("taylor", 0), ("scan", 0)]);
    for output in together.outputs.iter().filter(|output| output.name.ends_with("_c")) {
        for band in &output.bands {
            assert_eq!(band.lower, output.nominal);
            assert_eq!(band.upper, output.nominal);
            assert!(band.error.total.iter().all(|error| *error >= 0.0), "{:?}", band.error);
        }
    }
}

/// An output that is no different, and makes the subsystems one.
#[test]
fn subsystems_simulated_together_have_the_same_bounds() {
    let (a, b) = (pendulum("a", 0.0, ", tolerance: 2%"), pendulum("b", 0.3, ", tolerance: 1%"));
    let mut apart = a.with(&b);
    // (The tight range of a polynomial has a margin, which more parameters make wider.)
    apart.bounds = "{ chebyshev: { order: 4 }, scan: { points: 5 }, taylor: { order: 2, range: interval } }".to_owned();
    let mut joined = apart.clone();
    joined.outputs += "  mixed: a.B.x - b.B.x\n";
    let ((apart, of_apart), (joined, of_joined)) = (run(&apart.model()), run(&joined.model()));
    assert_eq!((of_apart.subsystems.len(), of_joined.subsystems.len()), (2, 0));
    let simulations =
        |summary: &Summary| summary.methods.iter().find(|method| method.method == "chebyshev").unwrap().simulations;
    assert_eq!((simulations(&of_apart), simulations(&of_joined)), (10, 25));
    for (apart, joined) in apart.outputs.iter().zip(&joined.outputs) {
        assert_eq!(apart.name, joined.name);
        for (one, other) in apart.bands.iter().zip(&joined.bands) {
            let width = one.upper.iter().zip(&one.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max);
            // Validation samples of two parameters are others than those of one, and bands hold them.
            let errors = one.error.total.iter().zip(&other.error.total).map(|(one, other)| 0.2 * (one + other));
            let errors: Vec<f64> = errors.collect();
            let ends = [(&one.lower, &other.lower), (&one.upper, &other.upper)];
            for (row, (x, y)) in ends.into_iter().flat_map(|(x, y)| x.iter().zip(y).enumerate()) {
                let allowed = errors[row] + 1e-9 * width;
                assert!((x - y).abs() <= allowed, "{} {:?}: {x} {y}, {allowed}", apart.name, one.method);
            }
        }
    }
    for ((of_apart, of_joined), output) in apart.contributions.iter().zip(&joined.contributions).zip(&apart.outputs) {
        let band = output.bands.iter().find(|band| band.method == Method::Chebyshev).unwrap();
        let width = |row: usize| band.upper[row] - band.lower[row];
        let widest = (0..apart.times.len()).map(width).fold(0.0, f64::max);
        for (one, other) in of_apart.iter().zip(of_joined) {
            assert_eq!(one.parameter, other.parameter);
            // A band without width has no shares.
            for row in (0..apart.times.len()).filter(|&row| width(row) > 1e-3 * widest) {
                let (x, y) = (one.total[row], other.total[row]);
                assert!((x - y).abs() < 1e-6, "{} {row}: {x} {y}", output.name);
                let (x, y) = (one.width_without[row], other.width_without[row]);
                assert!((x - y).abs() < 1e-6 * widest, "{} {row}: {x} {y}", output.name);
            }
        }
    }
}

/// A body that is welded to the ground neither moves nor connects others.
#[test]
fn a_base_that_is_welded_to_the_ground_is_the_ground() {
    let text = |outputs: &str| {
        read(&format!(
            "
model: base
parameters: {{ l: {{ value: 0.5, unit: m, tolerance: 2% }}, m_base: {{ value: 5, unit: kg, tolerance: 10% }} }}
bodies:
  base: {{ mass: m_base, inertia: 1, points: {{ O: [0, 0], A: [0.2, 0.1], B: [0.7, 0.1] }} }}
  left: {{ mass: 1, inertia: 0.1, points: {{ P: [-l, 0] }} }}
  right: {{ mass: 1, inertia: 0.1, points: {{ P: [-0.4, 0] }} }}
joints:
  foot: {{ fixed: [ground, base.O] }}
  a: {{ revolute: [base.A, left.P] }}
  b: {{ revolute: [base.B, right.P] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ left.angle: 0.1, right.angle: -0.2 }}
outputs: {outputs}
simulation: {{ duration: 0.3, step: 1e-3 }}
bounds: {{ scan: {{ points: 3 }} }}
"
        ))
    };
    let (apart, summary) = run(&text("{ x: left.x, y: right.y }"));
    let bodies: Vec<Vec<String>> = summary.subsystems.iter().map(|subsystem| subsystem.bodies.clone()).collect();
    assert_eq!(bodies, [["base", "left"], ["base", "right"]]);
    assert_eq!(summary.subsystems[0].parameters, ["l"]);
    assert!(summary.subsystems[1].parameters.is_empty());
    // The reaction at the foot is that of all.
    let (whole, summary) = run(&text("{ x: left.x, y: right.y, foot: foot.force }"));
    assert!(summary.subsystems.is_empty() && summary.not_simulated.is_empty());
    assert_eq!(summary.parameters.len(), 2);
    for (name, off) in difference(&apart, &Bounds { outputs: whole.outputs[..2].to_vec(), ..whole.clone() }) {
        assert!(off < 1e-9, "{name} is off by {off} of its size");
    }
}

/// A crank that is driven until coupler and rocker are stretched, where the motion ends.
fn locking(outputs: &str) -> Sections {
    Sections {
        parameters: "  omega: { value: 1, unit: rad/s, tolerance: 1% }\n".to_owned(),
        ground: ", D: [0.4, 0]".to_owned(),
        bodies: "  crank: { mass: 1, inertia: 0.01, points: { B: [0.3, 0] } }
  coupler: { mass: 1, inertia: 0.01, points: { B: [0, 0], C: [0.25, 0] } }
  rocker: { mass: 1, inertia: 0.01, points: { C: [0.2, 0] } }
"
        .to_owned(),
        joints: "  A: { revolute: [ground, crank] }
  B: { revolute: [crank.B, coupler.B] }
  C: { revolute: [coupler.C, rocker.C] }
  D: { revolute: [ground.D, rocker] }
  motor: { equation: crank.angle = 0.5 + omega*t }
"
        .to_owned(),
        outputs: outputs.to_owned(),
        simulation: "{ duration: 1.5, step: 1e-2, output_step: 0.05 }".to_owned(),
        bounds: "{ scan: { points: 3 } }".to_owned(),
        ..Sections::default()
    }
}

#[test]
fn stopped_subsystem_leaves_the_others_unchanged() {
    let free = pendulum("a", 0.0, ", tolerance: 2%");
    let run = |model: &Subject| model.finished(None);
    let mut both = locking("  rocker: rocker.angle\n").with(&free);
    both.initial += "  crank.angle: 0.5\n";
    let (bounds, summary) = run(&both.model());
    let failure = summary.failure.unwrap();
    assert!(failure.contains("locks at t = 0."), "{failure}");
    assert_eq!((summary.subsystems.len(), bounds.times.len()), (2, 31));
    let mut alone = free.clone();
    (alone.simulation, alone.bounds) = (both.simulation.clone(), both.bounds.clone());
    let (apart, _) = run(&alone.model());
    assert_eq!(bounds.outputs[1..], apart.outputs[..]);
    let stopped = &bounds.outputs[0];
    assert!(stopped.nominal[10].is_finite() && stopped.nominal[30].is_nan());
    assert!(stopped.bands[0].lower[30].is_nan() && stopped.bands[0].error.unresolved[30]);

    // A part that no output needs may lock.
    let mut unasked = locking("").with(&free);
    unasked.initial += "  crank.angle: 0.5\n";
    let (bounds, summary) = run(&unasked.model());
    assert_eq!(summary.failure, None);
    assert_eq!(bounds.outputs, apart.outputs);
    assert_eq!(csv(&bounds), csv(&apart));
}

/// The part of a box in which there is a motion is one for all outputs.
#[test]
fn omitted_parts_of_the_box_join_all_subsystems() {
    let mut slider = Sections {
        parameters: "  rod: { unit: m, interval: [0.35, 0.6] }\n".to_owned(),
        ground: ", H: [0, 0.4]".to_owned(),
        bodies: "  slider: { mass: 1, coordinates: [x] }\n".to_owned(),
        joints: "  link: { distance: { between: [ground.H, slider], length: rod } }\n".to_owned(),
        outputs: "  slid: slider.x\n".to_owned(),
        simulation: "{ duration: 0.02, step: 1e-3 }".to_owned(),
        bounds: "{ scan: { points: 6 } }".to_owned(),
        ..Sections::default()
    };
    slider.add(&pendulum("a", 0.0, ", tolerance: 2%"));
    let model = slider.model();
    let refused = model.refused();
    assert!(refused.contains("cannot be closed") && refused.contains("rod"), "{refused}");
    let (bounds, summary) = model.asking(Study::skip_infeasible).finished(None);
    assert!(summary.subsystems.is_empty() && !summary.pieces.is_empty());
    assert!(summary.pieces.iter().all(|piece| piece.lower.len() == 2), "{:?}", summary.pieces);
    // 0.05 m of the 0.25 m are too short.
    assert!((0.6..0.85).contains(&bounds.covered[0]), "{:?}", bounds.covered);
}
