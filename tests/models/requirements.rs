//! Requirements against closed forms: their verdicts, margins and nearest failures.

use mbint::results::Verdict;

use crate::common::{Subject, load, read, run_methods};
use crate::reduced::{PENDULUM, check, requirement, summary};

/// With parameters set as after `--set`.
#[track_caller]
fn set(description: Subject, settings: &[impl AsRef<str>]) -> Subject {
    settings.iter().fold(description, |found, setting| {
        let (name, value) = setting.as_ref().split_once('=').unwrap();
        found.with(name, value)
    })
}

/// Verdicts are those of the closed forms, and failures can be shown.
#[test]
fn verdicts_follow_from_bounds_and_samples() {
    let description = read(PENDULUM);
    let summary = summary(&description);
    let verdict = |name: &str| requirement(&summary, name).verdict;
    // stroke from 0.1613 to 0.2271 m; back at most 2 · 0.2642 s; the ratio up to 0.2271/0.2641 m/s.
    assert_eq!((verdict("wide"), verdict("in_time")), (Verdict::Holds, Verdict::Holds));
    assert_eq!((verdict("narrow"), verdict("ratio")), (Verdict::Violated, Verdict::Violated));
    let narrow = requirement(&summary, "narrow");
    let nearest = narrow.nearest.as_ref().unwrap();
    assert!(nearest.corner && (nearest.margin - (0.2 - 2.0 * 0.412 * 16_f64.to_radians().sin())).abs() < 1e-7);
    assert!((narrow.percent.unwrap() - 100.0 * narrow.margin / 0.2).abs() < 1e-9);
    let shown = run_methods(&set(read(PENDULUM), &nearest.settings), None).1;
    let shown = requirement(&shown, "narrow");
    assert_eq!(shown.verdict, Verdict::Violated);
    assert!((shown.margin - nearest.margin).abs() < 1e-9);
}

/// Thrown up at 3 m/s under 9 m/s² it rises to 0.5 m, which meets a limit of 0.5 m in spite of rounding.
#[test]
fn limit_reached_exactly_is_not_violated() {
    let text = "
bodies: { ball: { mass: 1, coordinates: [y] } }
effects: { weight: { force: { on: ball, value: [0, -9] } } }
initial: { ball.y: 0, ball.vy: 3 }
outputs: { y: ball.y, top: { max: y } }
requirements: { low: y <= 0.5 m, top: top <= 0.5 m, lower: y <= 0.4999999 m }
simulation: { duration: 0.6, step: 10 ms, output_step: 10 ms }
";
    let summary = summary(&read(text));
    assert_ne!(requirement(&summary, "low").verdict, Verdict::Violated);
    assert_ne!(requirement(&summary, "top").verdict, Verdict::Violated);
    assert_eq!(requirement(&summary, "lower").verdict, Verdict::Violated);
}

/// A study refines itself until its requirement is decided: order 1 does not know the curvature.
#[test]
fn an_undecided_requirement_raises_the_order() {
    let text = PENDULUM.replace("simulation:", "bounds: { chebyshev: { order: 1 } }\nsimulation:");
    let text = text.replace("wide: stroke >= 0.15 m", "wide: stroke >= 0.16132 m");
    let summary = summary(&read(&text));
    // 2 · 0.388 m · sin 12° = 0.161339… m
    let wide = requirement(&summary, "wide");
    assert_eq!(wide.verdict, Verdict::Holds, "{wide:?}");
    assert!(summary.methods.iter().any(|method| method.method.contains("earlier")), "{:?}", summary.methods);
}

/// A slider that drifts either way is farthest from the middle at one end of the time or the other: its margin has a
/// kink where it stands still, and its bounds in the rows have none.
#[test]
fn margin_with_a_jumping_instant_is_decided_by_rows() {
    let model = "
parameters: { a: 0 m ± 0.1 m, v: 0 m/s ± 1 m/s, b: 0 m ± 0.03 m }
bodies: { slider: { mass: 1, coordinates: [x] } }
initial: { slider.x: a + b, slider.vx: v }
outputs: { x: slider.x }
requirements: { stays: abs(x) <= 1.2 m }
simulation: { duration: 1, step: 0.01, output_step: 0.05 }
bounds: { tolerance: 1e-4 }
";
    let found = summary(&read(model));
    let stays = requirement(&found, "stays");
    assert_eq!(stays.verdict, Verdict::Holds, "{stays:?}");
    assert!((stays.margin - 0.07).abs() <= stays.error && stays.error < 1e-3, "{stays:?}");
    let found = summary(&read(&model.replace("1.2 m", "1.1 m")));
    assert_eq!(requirement(&found, "stays").verdict, Verdict::Violated);
}

/// The tutorial's drawing: half a degree is missed with its tolerances, and met with the two that matter most
/// tightened.
#[test]
fn the_tutorials_four_bar_is_decided() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/four_bar_drawing.yaml");
    let run = |settings: &[&str]| summary(&set(load(&path), settings));
    let drawn = run(&[]);
    assert_eq!(drawn.requirements[0].verdict, Verdict::Violated);
    let two: Vec<&str> = drawn.reduced[0].contributions[..2].iter().map(|own| own.parameter.as_str()).collect();
    assert_eq!(two, ["b", "d"]);
    let tightened = run(&["b=260 mm ± 0.5 mm", "d=300 mm ± 0.3 mm"]);
    assert_eq!(tightened.requirements[0].verdict, Verdict::Holds);
}

#[test]
fn uncertain_limit_in_no_equation_counts() {
    // x = k, at most twice = 1.4 m ± 0.1 m: at worst 1.2 m against 1.3 m (2 · 0.65 m).
    let text = "
parameters:
  k: { value: 1, tolerance: 0.2 }
  room: { value: 0.7, unit: m, tolerance: 0.05 }
  twice: 2*room
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: k*(1 m), block.vx: 0 }
outputs: { x: block.x, most: { max: x } }
requirements: { far: most <= twice }
simulation: { duration: 0.1, step: 0.01, output_step: 0.01 }
bounds: { taylor: { order: 2 } }
";
    // Taylor bounds are of the rows; a reduced output has bounds of other methods.
    let summary = summary(&read(text));
    let far = &summary.requirements[0];
    assert_eq!(far.verdict, Verdict::Holds, "{far:?}");
    assert!((far.margin - 0.1).abs() < 1e-9 + far.error && far.error < 1e-9, "{far:?}");
    let nearest = far.nearest.as_ref().unwrap();
    assert!((nearest.margin - 0.1).abs() < 1e-9 && nearest.settings.len() == 2, "{nearest:?}");
}

/// The page's slider crank: the stroke is 2 r, |ẍ| at the dead centre r ω² (1 + r/l), and x = r cos φ + √(l² − r² sin²
/// φ).
#[test]
fn slider_crank_of_the_guide_matches_closed_forms() {
    let example = include_str!("../../docs/examples/requirements.yaml");
    let page = include_str!("../../docs/guides/requirements.md");
    assert!(page.contains(example), "the page shows the example");
    let found = summary(&read(example));
    let simulations: usize = found.methods.iter().map(|method| method.simulations).sum();
    assert_eq!(simulations, 191, "the page says so");
    let ends = |of: &dyn Fn(f64, f64, f64) -> f64| {
        let corners = [0.099, 0.101].into_iter().flat_map(|r| [0.2985, 0.3015].map(|l| (r, l)));
        let values = corners.flat_map(|(r, l)| [2.85, 3.15].map(|m| of(r, l, m)));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    };
    check(&found, "stroke", ends(&|r, _, _| 2.0 * r), 1e-9);
    check(&found, "hardest", ends(&|r, l, m| m * r * 100.0 * (1.0 + r / l)), 1e-3);
    // x² − 2 x r cos φ + r² = l²
    check(&found, "down", ends(&|r, l, _| ((0.0625 + r * r - l * l) / (0.5 * r)).acos() / 10.0), 1e-8);
    for (name, verdict) in [
        ("clears", Verdict::Holds),
        ("far", Verdict::Holds),
        ("gentle", Verdict::Holds),
        ("light", Verdict::Violated),
        ("timely", Verdict::Holds),
    ] {
        assert_eq!(requirement(&found, name).verdict, verdict, "{name}");
    }
}

/// A conserved output does not move, and no error is small compared with a band without width: its limits are decided
/// by margin and error, in the first round.
#[test]
fn requirements_on_conserved_outputs_are_decided_at_once() {
    let text = "
parameters: { m: 1.3 kg ± 5%, v: 2 m/s ± 3% }
bodies: { a: { mass: m, coordinates: [x] }, b: { mass: 0.7, coordinates: [x] } }
effects:
  s: { spring_damper: { between: [a, b], along: x, stiffness: 300, free_length: 0.5 } }
initial: { a.x: 0, a.vx: v, b.x: 0.5, b.vx: 0 }
outputs: { drift: m*a.vx + 0.7*b.vx - m*v, last: { final: drift } }
requirements:
  kept: abs(drift) <= 1e-3 N*s
  at_the_end: abs(last) <= 1e-3 N*s
  too_strict: drift >= 1e-3 N*s
simulation: { duration: 1, step: 1e-3 }
bounds: { chebyshev: { order: 3 } }
";
    let summary = summary(&read(text));
    for name in ["kept", "at_the_end"] {
        let own = requirement(&summary, name);
        assert_eq!(own.verdict, Verdict::Holds, "{own:?}");
        // Momentum is conserved exactly, but for rounding.
        assert!((own.margin - 1e-3).abs() <= own.error + 1e-9, "{own:?}");
    }
    assert_eq!(requirement(&summary, "too_strict").verdict, Verdict::Violated);
    assert!(!summary.methods.iter().any(|method| method.method.contains("earlier")), "{:?}", summary.methods);
}
