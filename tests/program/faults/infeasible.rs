//! Boxes in part of which the mechanism cannot be assembled, or locks.

use mbint::results::{Band, Bounds, Method, Summary};
use mbint::{Error, Model, Study, StudyResult};

fn read(text: &str) -> Model {
    Model::from_yaml_str("test", text).unwrap_or_else(|error| panic!("{error}"))
}

fn finished(study: Study, skip_infeasible: bool) -> Result<StudyResult, Error> {
    let study = study.threads(2).allow_costly();
    if skip_infeasible { study.skip_infeasible().run() } else { study.run() }
}

fn run(model: &Model, skip_infeasible: bool) -> Result<(Bounds, Summary), String> {
    let done = finished(model.study(), skip_infeasible).map_err(|error| error.to_string())?;
    Ok((done.bounds().clone(), done.summary().clone()))
}

fn band(bounds: &Bounds, method: Method) -> &Band {
    bounds.outputs[0].bands.iter().find(|band| band.method == method).unwrap()
}

/// A crank of 0.1 m, upright, whose end is √(0.3² + 0.1²) m from the rocker's pivot: coupler and rocker together are at
/// least as long. Further parameters do not matter.
fn four_bar(coupler: &str, further: &str) -> Model {
    read(&format!(
        "
parameters: {{ l: {{ {coupler} }}, further: {{ {further} }} }}
bodies:
  ground: {{ points: {{ right: [0.3, 0] }} }}
  crank: {{ mass: 1, inertia: 0.01 + further, points: {{ B: [0.1, 0] }} }}
  coupler: {{ mass: 1, inertia: 0.01, points: {{ C: [l, 0] }} }}
  rocker: {{ mass: 1, inertia: 0.01, points: {{ C: [0.2, 0] }} }}
joints:
  A: {{ revolute: [ground, crank] }}
  B: {{ revolute: [crank.B, coupler] }}
  C: {{ revolute: [coupler.C, rocker.C] }}
  D: {{ revolute: [ground.right, rocker] }}
initial: {{ crank.angle: 90 deg }}
guess: {{ coupler.angle: 20 deg, rocker.angle: 110 deg }}
outputs: {{ rocker: rocker.angle }}
simulation: {{ duration: 0.02, step: 1e-3, output_step: 0.01 }}
bounds: {{ chebyshev: {{ order: 6 }}, scan: {{ points: 25 }} }}
"
    ))
}

/// A coupler that fits at its nominal length, and not at its longest.
const WIDE: &str = "value: 0.25, plus: 0.3, minus: 0.01";

const FURTHER: &str = "value: 0.001, tolerance: 50%";

/// Longest coupler that reaches, m.
fn longest() -> f64 {
    0.1_f64.hypot(0.3) + 0.2
}

#[test]
fn a_coupler_that_is_too_long_is_reported() {
    // With the crank upright its end is √(0.3² + 0.1²) = 0.3162 m from D, so the coupler has at most 0.5162 m.
    let message = run(&four_bar("value: 0.71", FURTHER), false).unwrap_err();
    println!("{message}");
    assert!(message.contains("cannot be closed"), "{message}");
    // The coupler spans from the crank to the rocker; one of the loop's joints cannot be closed, by its part of 190 mm.
    let joint = ["`A`", "`B`", "`C`", "`D`"].iter().any(|joint| message.contains(joint));
    assert!(joint, "{message}");
    let residual = message.split(" mm remain in").next().and_then(|rest| rest.rsplit(' ').next()).unwrap();
    let residual = 1e-3 * residual.parse::<f64>().unwrap();
    assert!(residual > 0.01 && residual < 0.71 - 0.5162 + 1e-3, "{message}");
    assert!(message.ends_with("; check lengths, initial positions and joint kinds"), "{message}");
}

/// Found by fuzzing: the start values of a beam are rows behind the constraints', and had no names.
#[test]
fn lengths_beyond_all_numbers_are_reported() {
    let text = std::fs::read_to_string("models/slider_crank_flexible.yaml").unwrap();
    let far = text.replace("B: [l/2, 0]", "B: [1e308/2, 0]");
    assert_ne!(far, text);
    let message = run(&read(&far), false).unwrap_err();
    println!("{message}");
    assert!(message.contains("singular") && message.contains("start of rod.end.x"), "{message}");
}

#[test]
fn infeasible_sample_is_reported_with_its_parameters() {
    // The nominal coupler fits; the longest of the interval does not.
    let message = run(&four_bar(WIDE, FURTHER), false).unwrap_err();
    println!("{message}");
    assert!(message.contains("cannot be closed with l = 0.5"), "{message}");
    assert!(message.contains(" mm remain in `"), "{message}");
}

#[test]
fn infeasible_part_is_reported_with_its_limits_and_share() {
    let description = four_bar(WIDE, FURTHER);
    let message = run(&description, false).unwrap_err();
    println!("{message}");
    let number = |before: &str| -> f64 {
        let text = message.split(before).nth(1).unwrap();
        text.split([' ', ',']).next().unwrap().parse().unwrap()
    };
    let share = number("so it is with ") / number(" of ");
    let true_share = (0.55 - longest()) / 0.31;
    assert!((share - true_share).abs() < 0.02, "{share} instead of {true_share}");
    assert!((number("with l from ") - longest()).abs() < 2e-3, "{message}");
    assert!(!message.contains("with further") && !message.contains("towards further"), "{message}");
    assert!(message.contains("--skip-infeasible"), "{message}");
}

#[test]
fn feasible_part_is_bounded_with_its_share() {
    let description = four_bar(WIDE, FURTHER);
    let result = finished(description.study(), true).unwrap();
    let (bounds, summary) = (result.bounds(), result.summary());
    assert_eq!(summary.failure, None);
    let true_share = (longest() - 0.24) / 0.31;
    let covered = bounds.covered[0];
    assert!(covered <= true_share && covered > true_share - 0.03, "{covered} of {true_share}");
    assert!(bounds.covered.iter().all(|&share| share == covered), "what is lost is lost at the start");
    let reached = summary.pieces.iter().map(|piece| piece.upper[0]).fold(0.0, f64::max);
    assert!(reached < longest() && reached > longest() - 0.01, "{reached} of {}", longest());
    let folder = tempfile::tempdir().unwrap();
    result.write(folder.path()).unwrap();
    let table = std::fs::read_to_string(folder.path().join("bounds.csv")).unwrap();
    assert!(table.lines().next().unwrap().ends_with(",unresolved,covered"));
    assert!(table.lines().skip(1).all(|row| row.ends_with(&format!(",{covered}"))), "{table}");

    // The rocker's angle closes the triangle of coupler, rocker and the line from the crank's end: the law of cosines.
    // It falls with l, so that its range is known.
    let angle = |l: f64| {
        let base = 0.1_f64.hypot(0.3);
        let cosine = (base * base + 0.2 * 0.2 - l * l) / (2.0 * base * 0.2);
        0.1_f64.atan2(-0.3) - cosine.acos()
    };
    let expected = [angle(reached), angle(0.24)];
    for method in [Method::Chebyshev, Method::Scan] {
        let band = band(bounds, method);
        let error = band.error.total[0];
        println!("{}: {} to {} ± {error}, {expected:?}", method.name(), band.lower[0], band.upper[0]);
        assert!(
            (band.lower[0] - expected[0]).abs() <= error + 1e-9 && (band.upper[0] - expected[1]).abs() <= error + 1e-9
        );
        assert!(!band.error.unresolved[0] && error < 0.05);
    }
}

#[test]
fn feasible_box_has_unchanged_bounds() {
    let description = four_bar("value: 0.25, tolerance: 2%", FURTHER);
    let (plain, skipping) = (run(&description, false).unwrap(), run(&description, true).unwrap());
    assert_eq!(plain.0.outputs, skipping.0.outputs);
    assert_eq!(plain.0.contributions, skipping.0.contributions);
    assert_eq!(skipping.0.covered, [1.0; 3]);
    assert_eq!(skipping.1.pieces.len(), 1);
}

#[test]
fn fully_infeasible_box_is_always_an_error() {
    let text = "value: 0.6, tolerance: 1%";
    for skip in [false, true] {
        let message = run(&four_bar(text, FURTHER), skip).unwrap_err();
        assert!(message.contains("cannot be closed"), "{message}");
    }
}

/// A rocker between 0.135 and 0.155 m: at 0.14 m Grashof's condition 0.1 + 0.3 ≤ 0.26 + r is met, below the motor
/// cannot turn the crank all round.
fn grashof() -> Model {
    read(
        "
parameters: { r: { value: 0.145, tolerance: 0.01 } }
bodies:
  ground: { points: { right: [0.3, 0] } }
  crank: { mass: 1, inertia: 0.001, points: { B: [0.1, 0] } }
  coupler: { mass: 1, inertia: 0.005, points: { C: [0.26, 0] } }
  rocker: { mass: 1, inertia: 0.002, points: { C: [r, 0] } }
joints:
  A: { revolute: [ground, crank] }
  B: { revolute: [crank.B, coupler] }
  C: { revolute: [coupler.C, rocker.C] }
  D: { revolute: [ground.right, rocker] }
  motor: { equation: crank.angle = pi/2 + 2*pi*t }
guess: { coupler.angle: 30 deg, rocker.angle: 110 deg }
outputs: { rocker: rocker.angle }
simulation: { duration: 0.6, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 5 }, scan: { points: 21 } }
",
    )
}

/// The crank cannot pass where its end is 0.26 + r from the rocker's pivot.
#[test]
fn locking_in_a_part_of_the_box_ends_only_its_methods() {
    let (bounds, summary) = run(&grashof(), false).unwrap();
    let failure = summary.failure.unwrap();
    assert!(failure.contains("(r = 0.13") && failure.contains("locks at t = "), "{failure}");
    assert_eq!(bounds.times.len(), 13, "the nominal motion and the scan go on");
    let nominal = &bounds.outputs[0].nominal;
    assert!(nominal.iter().all(|angle| angle.is_finite()));
    let (chebyshev, scan) = (band(&bounds, Method::Chebyshev), band(&bounds, Method::Scan));
    let lost = chebyshev.lower.iter().position(|lower| lower.is_nan()).unwrap();
    // At r = 0.135: 0.1² + 0.3² − 2·0.03 cos φ = 0.395², and φ is a quarter turn at the start.
    let turned = ((0.1_f64.powi(2) + 0.3_f64.powi(2) - 0.395_f64.powi(2)) / 0.06).acos();
    let locked = (turned - std::f64::consts::FRAC_PI_2) / std::f64::consts::TAU;
    assert!(bounds.times[lost] >= locked && bounds.times[lost - 1] < locked, "{} of {locked}", bounds.times[lost]);
    for (row, &angle) in nominal.iter().enumerate() {
        assert!(scan.lower[row] <= angle && angle <= scan.upper[row]);
        assert_eq!(scan.error.unresolved[row], row >= lost);
        assert_eq!(chebyshev.error.unresolved[row], row >= lost);
    }
}

#[test]
fn locked_part_of_the_box_is_omitted_from_then_on() {
    let (bounds, summary) = run(&grashof(), true).unwrap();
    assert_eq!(summary.failure, None);
    println!("{:?}", bounds.covered);
    assert_eq!((bounds.covered[0], bounds.times.len()), (1.0, 13));
    assert!(bounds.covered.windows(2).all(|pair| pair[0] >= pair[1]));
    // Three quarters of the interval are above Grashof's limit.
    let last = *bounds.covered.last().unwrap();
    assert!(last <= 0.75 && last > 0.7, "{last}");
}

/// One sample of a few runs into a square root of a negative number: the others have the same values as without it.
#[test]
fn diverging_sample_leaves_the_others_unchanged() {
    let model = |interval: &str| {
        read(&format!(
            "
parameters: {{ k: {{ value: 10, interval: {interval} }}, reach: 0.8, p: {{ value: 1, unit: N }} }}
bodies: {{ cart: {{ mass: 1, coordinates: [x] }} }}
effects:
  push: {{ force: {{ on: cart, value: [p*sqrt(1 - cart.x/reach), 0] }} }}
  spring: {{ force: {{ on: cart, value: [-k*cart.x, 0] }} }}
initial: {{ cart.x: 0, cart.vx: 0 }}
outputs: {{ x: cart.x }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.1 }}
bounds: {{ scan: {{ points: 12 }} }}
"
        ))
    };
    let (bounds, summary) = run(&model("[1, 12]"), false).unwrap();
    let failure = summary.failure.unwrap();
    assert!(failure.contains("k = 1)") && failure.contains("did not converge at t = 1."), "{failure}");
    // The same samples without the first.
    let result = finished(model("[2, 12]").study().scan(11), false).unwrap();
    let alone = result.bounds();
    let last = bounds.times.len() - 1;
    assert_eq!(bounds.times, alone.times);
    let (with, without) = (band(&bounds, Method::Scan), band(alone, Method::Scan));
    // Points of another interval are the same but for rounding; its validation samples, which the band holds too, are
    // not.
    let off = (with.lower[last] - without.lower[last]).abs().max((with.upper[last] - without.upper[last]).abs());
    assert!(off <= without.error.total[last], "{off:e}, {:e}", without.error.total[last]);
    assert!(with.error.unresolved[last] && with.error.total[last].is_nan());
    assert_eq!(bounds.outputs[0].nominal, alone.outputs[0].nominal);
}

/// The same with steps from a tolerance: a corner for which no step is small enough does not end the others' schedule.
#[test]
fn locked_sample_no_longer_controls_the_schedule() {
    let result = finished(grashof().study().step_tolerance(1e-5), false).unwrap();
    let bounds = result.bounds();
    assert!(result.failure().unwrap().contains("r = 0.13"), "the sample is named");
    assert_eq!(bounds.times.len(), 13);
    assert!(bounds.outputs[0].nominal.iter().all(|angle| angle.is_finite()));
}
