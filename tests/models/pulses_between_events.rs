//! Short pulses of a force in time, and short bumps in space, in motions that are cut at events: steps between events
//! resolve them, although samples meet them at other times of their segments.

use mbint::results::Method;

use crate::common::{band, output, ran, study_of};

/// A ball that falls onto a floor, and is pushed upwards by a bell-shaped force, N, of an impulse of J = Aw√π.
fn pushed(push: &str) -> String {
    format!(
        "
parameters: {{ h0: {{ interval: [0.99, 1.01] }} }}
bodies: {{ b: {{ mass: 1, coordinates: [y] }} }}
effects: {{ f: {{ force: {{ on: b, value: [0, \"-9.81 - 1e5*min(b.y, 0) + {push}\"] }} }} }}
initial: {{ b.y: h0, b.vy: 0 }}
outputs: {{ v: b.vy }}
simulation: {{ duration: 0.8, step: 5e-4, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 4 }}, scan: {{ points: 5 }} }}
"
    )
}

const ROOT_OF_PI: f64 = 1.772_453_850_905_516;

/// Ends, errors and flags of a method's rows of the velocity, with how motions are integrated.
fn bounds_of(push: &str, method: Method) -> (Vec<([f64; 2], f64)>, bool, bool) {
    let (bounds, summary) = ran(study_of(&pushed(push)));
    let own = band(output(&bounds, "v"), method);
    let rows = (0..own.lower.len()).map(|row| ([own.lower[row], own.upper[row]], own.error.total[row])).collect();
    (
        rows,
        summary.integration.is_some_and(|name| name.contains("between events")),
        !own.error.unresolved.contains(&true),
    )
}

/// The velocity before the floor is met is −g t, and J/m more behind the pulse, whether motions are cut or the pulse is
/// too short for that.
#[test]
fn a_pulse_before_an_event_is_not_passed_over() {
    for (force, width, is_cut) in [(2000.0, 5e-4, true), (2e4, 1e-5, true), (2e6, 1e-7, false)] {
        let push = format!("{force:e}*exp(-((t - 0.312)/{width:e})^2)");
        for method in [Method::Chebyshev, Method::Scan] {
            let (rows, was_cut, _) = bounds_of(&push, method);
            assert_eq!(was_cut, is_cut, "{push}");
            for (row, (ends, error)) in rows.into_iter().enumerate().take(23) {
                let time = 0.02 * row as f64;
                let truth = if time > 0.312 { force * width * ROOT_OF_PI } else { 0.0 } - 9.81 * time;
                let off = ends.into_iter().map(|end| (end - truth).abs()).fold(0.0, f64::max);
                assert!(off <= error + 1e-12, "{push}, {method:?}, {time} s: {off:e}, stated {error:e}");
            }
        }
    }
}

/// A pulse in the flight between two contacts, whose segment begins 5 ms earlier in some samples than in others, moves
/// both ends of the velocity by J/m.
#[test]
fn a_pulse_between_events_is_not_passed_over() {
    let (without, _, _) = bounds_of("0", Method::Chebyshev);
    let (with, is_cut, is_known) = bounds_of("500*exp(-((t - 0.611)/5e-4)^2)", Method::Chebyshev);
    assert!(is_cut && is_known);
    for (row, (own, others)) in with.into_iter().zip(without).enumerate() {
        let impulse = if row > 30 { 500.0 * 5e-4 * ROOT_OF_PI } else { 0.0 };
        for (end, other) in own.0.into_iter().zip(others.0) {
            let off = (end - other - impulse).abs();
            assert!(off <= own.1 + others.1 + 1e-12, "row {row}: {off:e}, stated {:e}", own.1 + others.1);
        }
    }
}

/// A mass that is pushed for 60 µs, at a time that is known to 0.3 ms: the push is over before it begins in other
/// samples. Its impulse is 4 F D/3, whenever it acts.
#[test]
fn a_pulse_at_an_uncertain_time_is_resolved() {
    let text = "
parameters: { T0: { interval: [0.1098, 0.1101] }, D: 3e-5 }
bodies: { b: { mass: 1, coordinates: [x] } }
effects: { f: { force: { on: b, value: [\"139000*max(0, 1 - ((t - T0)/D)^2)\", 0] } } }
initial: { b.x: 0, b.vx: 0 }
outputs: { x: b.x }
simulation: { duration: 0.23, step: 5e-4, output_step: 0.01 }
bounds: { chebyshev: { order: 4 }, scan: { points: 5 } }
";
    let (bounds, summary) = ran(study_of(text));
    assert!(summary.integration.is_some_and(|name| name.contains("between events")));
    let speed = 139_000.0 * 3e-5 * 4.0 / 3.0;
    for method in [Method::Chebyshev, Method::Scan] {
        let own = band(output(&bounds, "x"), method);
        assert!(!own.error.unresolved.contains(&true));
        for (row, &time) in bounds.times.iter().enumerate().filter(|(_, time)| (**time - 0.11).abs() > 1e-3) {
            for (end, begin) in [(own.lower[row], 0.1101), (own.upper[row], 0.1098)] {
                let off = (end - speed * (time - begin).max(0.0)).abs();
                assert!(off <= own.error.total[row] + 1e-12, "{method:?}, {time} s: {off:e}");
                assert!(own.error.total[row] < 1e-9, "{method:?}, {time} s: {:e}", own.error.total[row]);
            }
        }
    }
}

/// A falling ball passes over a bump of a force in space, N, whose work is a √π s. Its energy says what its speed is
/// before it meets the floor.
#[test]
fn a_bump_before_an_event_is_not_passed_over() {
    for width in [2e-3, 2e-4] {
        let text = format!(
            "
parameters: {{ m: {{ interval: [0.98, 1.02] }}, h0: {{ interval: [0.99, 1.01] }} }}
bodies: {{ b: {{ mass: m, coordinates: [y] }} }}
effects:
  f: {{ force: {{ on: b, value: [0, \"-m*9.81 - 1e5*min(b.y, 0) + {}*exp(-((b.y - 0.5)/{width})^2)\"] }} }}
initial: {{ b.y: h0, b.vy: 0 }}
outputs: {{ gained: \"m*(b.vy^2/2 + 9.81*(b.y - h0))\" }}
simulation: {{ duration: 0.7, step: 5e-4, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 4 }}, scan: {{ points: 5 }} }}
",
            1.0 / width
        );
        let (bounds, summary) = ran(study_of(&text));
        assert!(summary.integration.is_some_and(|name| name.contains("between events")));
        for method in [Method::Chebyshev, Method::Scan] {
            let own = band(output(&bounds, "gained"), method);
            let is_beside = |time: f64| time < 0.31 || (0.33..0.43).contains(&time);
            for (row, &time) in bounds.times.iter().enumerate().filter(|(_, time)| is_beside(**time)) {
                let truth = if time > 0.32 { -ROOT_OF_PI } else { 0.0 };
                let off = (own.lower[row] - truth).abs().max((own.upper[row] - truth).abs());
                assert!(off <= own.error.total[row] + 1e-12, "{width}, {method:?}, {time} s: {off:e}");
                assert!(own.error.total[row] < 1e-5, "{width}, {method:?}, {time} s: {:e}", own.error.total[row]);
            }
        }
    }
}
