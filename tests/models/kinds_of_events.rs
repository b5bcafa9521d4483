//! Events that are no impacts, and such as coincide: slack cables, conditions on the time, stops upon stops. Truths are
//! closed forms.

use std::f64::consts::PI;

use mbint::results::Method;

use crate::common::{band, output, read, run_methods};
use crate::through_events::{ELASTIC, assert_true, elastic, integrated, over_box, range};

#[test]
fn a_cable_slackens() {
    let text = "
parameters: { u: { value: 2, unit: m/s, tolerance: 5% }, k: { value: 4e3, unit: N/m, tolerance: 5% } }
bodies: { m: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rope: { cable: { between: [ground, m], free_length: 1 m, stiffness: k, transition: 1e-6 m } }
initial: { m.y: -0.5, m.vy: u }
outputs: { y: m.y }
simulation: { duration: 1.2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 4 } }
";
    let (bounds, summary) = run_methods(&read(text), None);
    assert!(integrated(&summary, "chebyshev").0);
    let truth = |t: f64| {
        let points =
            (0..301 * 9).map(|place| (f64::from(place % 301) / 150.0 - 1.0, f64::from(place / 301) / 4.0 - 1.0));
        let of = |(a, b): (f64, f64)| {
            let (u, stiffness) = (2.0 * (1.0 + 0.05 * a), 4e3 * (1.0 + 0.05 * b));
            elastic(0.5 + u * u / (2.0 * 9.81), stiffness, t - u / 9.81)[0] - 1.0
        };
        range(points.map(of))
    };
    assert_true(&bounds, "y", 1e-6, 5e-5, truth);
}

/// A torque that changes its sign at an uncertain time: ω = (2T − (t − T))/I behind it.
#[test]
fn a_condition_on_the_time_is_an_event() {
    let text = "
parameters: { T: { value: 0.5, unit: s, tolerance: 10% } }
bodies: { rod: { mass: 1, inertia: 0.1, points: { A: [-0.5, 0] } } }
joints: { hinge: { revolute: [ground, rod.A] } }
effects: { torque: { torque: { on: rod, value: \"if(t < T, 2, -1)\" } } }
outputs: { speed: rod.angular_velocity }
simulation: { duration: 1, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 4 } }
";
    let (bounds, summary) = run_methods(&read(text), None);
    assert!(integrated(&summary, "chebyshev").0);
    let speed = |t: f64, switch: f64| (2.0 * t.min(switch) - (t - switch).max(0.0)) / 0.35;
    // Largest where it switches just then.
    let truth = |t: f64| range([0.45, 0.55, t.clamp(0.45, 0.55)].into_iter().map(|switch| speed(t, switch)));
    assert_true(&bounds, "speed", 1e-8, 1e-10, truth);
}

/// A mass between two stops that coincide, and one that begins within them: x = 1 + x₀ cos ωτ + v/ω sin ωτ.
#[test]
fn stops_may_coincide_and_overlap_at_the_start() {
    let text = |start: f64| {
        format!(
            "
parameters: {{ v0: {{ value: 2, unit: m/s, tolerance: 5% }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
effects:
  f: {{ force: {{ on: m, value: [\"-1e4*max(m.x - 1, 0)\", 0] }} }}
  g: {{ force: {{ on: m, value: [\"-2e4*max(m.x - 1, 0)\", 0] }} }}
initial: {{ m.x: {start}, m.vx: v0 }}
outputs: {{ v: m.vx }}
simulation: {{ duration: 0.8, step: 1e-3, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 4 }} }}
"
        )
    };
    let omega = 3e4_f64.sqrt();
    let velocity = |start: f64, speed: f64, t: f64| {
        if start > 1.0 {
            // Until it leaves the stops, at the phase of the amplitude's sine.
            let phase = ((start - 1.0) * omega / speed).atan();
            let (leaves, amplitude) = ((PI - phase) / omega, speed.hypot((start - 1.0) * omega));
            return if t < leaves { amplitude * (phase + omega * t).cos() } else { -amplitude };
        }
        let hits = (1.0 - start) / speed;
        let phase = omega * (t - hits);
        if phase < 0.0 { speed } else { speed * phase.min(PI).cos() }
    };
    for start in [0.0, 1.01] {
        let (bounds, summary) = run_methods(&read(&text(start)), None);
        assert!(integrated(&summary, "chebyshev").0);
        let truth = |t: f64| {
            range((0..=4000).map(|place| velocity(start, 2.0 * (1.0 + 0.05 * (f64::from(place) / 2000.0 - 1.0)), t)))
        };
        assert_true(&bounds, "v", 1e-4, 1e-2, truth);
    }
}

/// Two stops at one position are one of the summed stiffness: their events coincide in all samples.
#[test]
fn coinciding_stops_act_as_one() {
    let one = ELASTIC.replace("  ground:", "  unused: { force: { on: ball, value: [0, 0] } }\n  ground:");
    let two = ELASTIC
        .replace("  ground:", "  again: { force: { on: ball, value: [0, \"K/4*max(-ball.y, 0)\"] } }\n  ground:");
    let two = two.replace("\"K*max(-ball.y, 0)\"", "\"3*K/4*max(-2*ball.y, 0)/2\"");
    let [(one, _), (two, summary)] = [one, two].map(|text| run_methods(&read(&text), None));
    assert!(integrated(&summary, "chebyshev").0);
    for name in ["y", "v"] {
        let [one, two] = [&one, &two].map(|bounds| band(output(bounds, name), Method::Chebyshev));
        assert!(!two.error.unresolved.contains(&true), "{name} is flagged");
        let ends = one.lower.iter().zip(&two.lower).chain(one.upper.iter().zip(&two.upper));
        for (row, (a, b)) in ends.enumerate() {
            let error = one.error.total[row % one.lower.len()] + two.error.total[row % one.lower.len()];
            assert!((a - b).abs() <= error + 1e-12, "{name}: {a} {b}, {error:e} stated");
        }
    }
}

/// A floor of two conditions that are met at once, and are no multiples of each other: which of them the cubics through
/// the ends of a step find first differs from sample to sample.
#[test]
fn simultaneous_conditions_are_one_event() {
    let two = "\"if((ball.y + 1)^3 < 1, -K*ball.y/2, 0) + K/2*max(-ball.y, 0)\"";
    let (bounds, summary) = run_methods(&read(&ELASTIC.replace("\"K*max(-ball.y, 0)\"", two)), None);
    assert!(integrated(&summary, "chebyshev").0);
    assert_true(&bounds, "v", 1e-3, 2e-3, |t| over_box(1, t));
    assert_true(&bounds, "y", 1e-4, 2e-4, |t| over_box(0, t));
}
