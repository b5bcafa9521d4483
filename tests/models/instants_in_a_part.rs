//! Instants of events that only a part of the box has, against closed forms.

use std::f64::consts::PI;

use mbint::results::ReducedSummary;

use crate::common::{read, run_methods};

/// The reduced output `t` of a model.
fn instant(text: &str) -> ReducedSummary {
    let summary = run_methods(&read(text), None).1;
    summary.reduced.into_iter().find(|own| own.name == "t").unwrap()
}

/// Some samples have it, its bounds are these within the stated error, and that is at most `error`.
#[track_caller]
fn check(found: &ReducedSummary, [lower, upper]: [f64; 2], error: f64) {
    let band = &found.bands[0];
    let off = (band.lower - lower).abs().max((band.upper - upper).abs());
    println!("[{lower}, {upper}] off by {off:.1e}, stated {:.1e}", band.error);
    assert!(!band.unresolved && band.error <= error && off <= band.error + 1e-12, "{band:?}, not [{lower}, {upper}]");
    let occurs = found.occurs.as_ref().unwrap();
    assert!(0 < occurs.samples && occurs.samples < occurs.of, "{occurs:?}");
}

/// The share of the box in which it occurs is this.
#[track_caller]
fn check_share(found: &ReducedSummary, share: f64) {
    let [least, most] = found.occurs.as_ref().unwrap().share.unwrap();
    assert!(least <= share && share <= most && most - least < 5e-3, "{least} to {most}, not {share}");
}

const G: f64 = 9.81;

/// A ball that is thrown at `speed` ± `tolerance`, under a ceiling at 1.3 m.
fn throw(speed: f64, tolerance: f64, event: &str) -> ReducedSummary {
    instant(&format!(
        "
parameters: {{ v0: {{ value: {speed}, unit: m/s, tolerance: {tolerance} }}, H: 1.3 m }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  ceiling: {{ force: {{ on: ball, value: [0, \"-1e5*(1 N/m)*max(ball.y - H, 0)\"] }} }}
initial: {{ ball.y: 0, ball.vy: v0 }}
outputs: {{ y: ball.y, t: {event} }}
simulation: {{ duration: 0.9, step: 1e-3, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
    ))
}

/// It rises to y at (v − √(v² − 2 g y))/g.
#[test]
fn a_ceiling_is_reached_at_some_speeds() {
    let rises = |speed: f64, y: f64| (speed - (speed * speed - 2.0 * G * y).max(0.0).sqrt()) / G;
    let least = |y: f64| (2.0 * G * y).sqrt();
    for (speed, tolerance) in [(5.0, 0.5), (5.02, 0.1), (5.1, 0.2)] {
        let found = throw(speed, tolerance, "{ when: ball.y > H }");
        check(&found, [rises(speed + tolerance, 1.3), rises(least(1.3), 1.3)], 1e-4);
        check_share(&found, 0.5 + (speed - least(1.3)) / (2.0 * tolerance));
    }
    // No event of the motion: fast balls pass it before the ceiling.
    check(&throw(5.0, 0.5, "{ when: ball.y > 1.2 m }"), [rises(5.5, 1.2), rises(least(1.2), 1.2)], 1e-4);
}

/// A mass on a spring, thrown from rest at v, passes 0.2 m at asin(0.2 ω/v)/ω on its way out, and at (π − …)/ω on its
/// way back, if v/ω reaches as far. Nothing switches there.
#[test]
fn a_hump_reaches_a_threshold_in_a_part_of_the_box() {
    let passed = |event: &str| {
        instant(&format!(
            "
parameters: {{ v: 2 m/s ± 10%, k: 100 N/m ± 5% }}
bodies: {{ ball: {{ mass: 1 kg, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, ball], along: x, stiffness: k, free_length: 0 }} }} }}
initial: {{ ball.x: 0, ball.vx: v }}
outputs: {{ x: ball.x, t: {{ {event}: ball.x > 0.2 m }} }}
simulation: {{ duration: 0.45, step: 5e-4, output_step: 0.05 }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
        ))
    };
    let [soft, stiff] = [95.0_f64, 105.0].map(f64::sqrt);
    let reached = |omega: f64| (0.2 * omega / 2.2).asin();
    // Grazed at a quarter of the period.
    let first = passed("when");
    check(&first, [reached(soft) / soft, PI / 2.0 / soft], 1e-4);
    // v > 0.2 ω: over k the mean of √k is ⅔ (105^1.5 − 95^1.5)/10.
    let mean = 2.0 / 3.0 * (stiff.powi(3) - soft.powi(3)) / 10.0;
    check_share(&first, (2.2 - 0.2 * mean) / 0.4);
    check(&passed("last_when"), [PI / 2.0 / stiff, (PI - reached(soft)) / soft], 1e-4);
}

/// A bolt that a spring of free length a moves to a (1 − cos ω t): it is caught at d where 2 a > d.
#[test]
fn a_latch_catches_in_a_part_of_the_box() {
    let found = instant(
        "
parameters: { a: 10 mm ± 5%, k: 400 N/m ± 5%, d: 20 mm }
bodies: { bolt: { mass: 0.1 kg, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, bolt], along: x, stiffness: k, free_length: a } }
  catch: { force: { on: bolt, value: [\"-1e5*(1 N/m)*max(bolt.x - d, 0)\", 0] } }
initial: { bolt.x: 0, bolt.vx: 0 }
outputs: { x: bolt.x, t: { when: bolt.x > d } }
simulation: { duration: 0.09, step: 1e-4, output_step: 0.002 }
bounds: { chebyshev: { order: 3 } }
",
    );
    let [soft, stiff] = [380.0_f64, 420.0].map(|k| (k / 0.1).sqrt());
    check(&found, [(1.0_f64 - 2.0 / 1.05).acos() / stiff, PI / soft], 5e-4);
}

/// A ball that all samples drop on the floor: √(2 h/g), to rounding at the ends that samples have.
#[test]
fn a_dropped_ball_hits_the_floor_at_its_instant() {
    let found = instant(
        "
parameters: { h: 1 m ± 10% }
bodies: { ball: { mass: 1 kg, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  floor: { force: { on: ball, value: [0, \"1e5*(1 N/m)*max(-ball.y, 0)\"] } }
initial: { ball.y: h, ball.vy: 0 }
outputs: { y: ball.y, t: { when: ball.y < 0 m } }
simulation: { duration: 0.9, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 5 } }
",
    );
    let band = &found.bands[0];
    let truth = [0.9, 1.1].map(|h: f64| (2.0 * h / G).sqrt());
    let off = (band.lower - truth[0]).abs().max((band.upper - truth[1]).abs());
    assert!(!band.unresolved && found.occurs.is_none() && band.error < 1e-8 && off <= band.error, "{band:?}");
    for (case, truth) in found.worst.unwrap().iter().zip(truth) {
        assert!((case.value - truth).abs() < 1e-13, "{case:?}, not {truth}");
    }
}

/// A condition that holds from the start in one part of the box, and never in another, has no bounds: the instant has a
/// kink.
#[test]
fn an_instant_with_a_kink_stays_flagged() {
    let found = throw(5.0, 0.5, "{ when: ball.y < 0.5 m, from: 0.82 s }");
    assert!(found.bands[0].unresolved, "{:?}", found.bands);
}
