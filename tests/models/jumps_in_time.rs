//! Forces that jump at times which are the same for all samples: all of them share steps that end there, by the
//! explicit method. Truths are closed forms.

use mbint::results::{Method, OutputBounds};

use crate::common::{band, curve, output, ran, study_of};

const STIFFNESS: f64 = 27.2;
const BEGIN: f64 = 0.671_235;
const END: f64 = 0.671_685;

/// An oscillator under a force that acts for 0.45 ms, a tenth of the model's step.
fn pushed(simulation: &str) -> String {
    format!(
        "
parameters: {{ m: {{ interval: [6.77, 6.89] }}, f: {{ interval: [281, 283] }} }}
bodies: {{ b: {{ mass: m, coordinates: [x] }} }}
effects:
  s: {{ force: {{ on: b, value: [\"-{STIFFNESS}*b.x + if(t < {BEGIN}, 0, if(t < {END}, f, 0))\", 0] }} }}
initial: {{ b.x: 0.047, b.vx: 0 }}
outputs: {{ v: b.vx, a: b.ax }}
simulation: {{ duration: 1.14, output_step: 0.03, {simulation} }}
bounds: {{ chebyshev: {{ order: 6 }}, taylor: {{ order: 4 }}, scan: {{ points: 9 }} }}
"
    )
}

/// Velocity of a sample at a time, s.
fn velocity(m: f64, f: f64, t: f64) -> f64 {
    let omega = (STIFFNESS / m).sqrt();
    let step = |s: f64| if t > s { f / (m * omega) * (omega * (t - s)).sin() } else { 0.0 };
    -0.047 * omega * (omega * t).sin() + step(BEGIN) - step(END)
}

/// Largest distance by which the truth at 9 × 9 points of the box goes beyond an output's band and its error.
fn beyond(own: &OutputBounds, method: Method, times: &[f64]) -> f64 {
    let band = band(own, method);
    let at = |low: f64, high: f64, index: usize| low + (high - low) * index as f64 / 8.0;
    let samples: Vec<(f64, f64)> =
        (0..81).map(|index| (at(6.77, 6.89, index / 9), at(281.0, 283.0, index % 9))).collect();
    let of_row = |(row, &time): (usize, &f64)| {
        let values = || samples.iter().map(|&(m, f)| velocity(m, f, time));
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        (band.lower[row] - least).max(most - band.upper[row]) - band.error.total[row]
    };
    times.iter().enumerate().map(of_row).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn steps_end_at_jumps_of_functions_of_the_time() {
    for simulation in ["step: 0.005", "tolerance: 1e-6"] {
        let (bounds, summary) = ran(study_of(&pushed(simulation)));
        assert!(summary.integration.is_some_and(|name| name.contains("explicit")), "{simulation}");
        let own = output(&bounds, "v");
        for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
            let time = band(own, method).error.time;
            assert!(time < 1e-11, "{simulation}, {method:?}: {time:e}");
            assert!(!band(own, method).error.unresolved.contains(&true));
            let beyond = beyond(own, method, &bounds.times);
            assert!(beyond < 1e-13, "{simulation}, {method:?}: {beyond:e}");
        }
        for (&time, &value) in bounds.times.iter().zip(curve(&bounds, "v")) {
            let truth = velocity(6.83, 282.0, time);
            assert!((value - truth).abs() < 1e-12, "{simulation}, {time} s: {value}, not {truth}");
        }
    }
}

/// A row at the time of a jump shows what follows.
#[test]
fn rows_at_jumps_are_behind_them() {
    let text = "
parameters: { m: { interval: [0.99, 1.01] } }
bodies: { b: { mass: m, coordinates: [x] } }
effects: { f: { force: { on: b, value: [\"if(t < 0.3, 1, 2)\", 0] } } }
initial: { b.x: 0, b.vx: 0 }
outputs: { a: b.ax, v: b.vx }
simulation: { duration: 1, step: 0.05, output_step: 0.1 }
bounds: { chebyshev: { order: 3 } }
";
    let (bounds, _) = ran(study_of(text));
    for (row, &time) in bounds.times.iter().enumerate() {
        let acceleration = if row < 3 { 1.0 } else { 2.0 };
        let velocity = time + (time - 0.3).max(0.0);
        assert!((curve(&bounds, "a")[row] - acceleration).abs() < 1e-12, "{time} s");
        assert!((curve(&bounds, "v")[row] - velocity).abs() < 1e-12, "{time} s");
    }
}

/// Only 128 events are followed: a force that jumps more often is known up to there, or with an error that holds.
#[test]
fn rows_behind_the_last_event_that_is_followed_are_not_those_before() {
    for frequency in [205.0, 300.0] {
        let text = format!(
            "
parameters: {{ m: {{ interval: [0.98, 1.02] }} }}
bodies: {{ b: {{ mass: m, coordinates: [x] }} }}
effects: {{ f: {{ force: {{ on: b, value: [\"1 + sign(sin({frequency}*t + 0.3))\", 0] }} }} }}
initial: {{ b.x: 0, b.vx: 0 }}
outputs: {{ v: b.vx }}
simulation: {{ duration: 2, step: 0.002, output_step: 0.1 }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
        );
        let (bounds, _) = ran(study_of(&text));
        let own = band(output(&bounds, "v"), Method::Chebyshev);
        let (period, begin) = (2.0 * std::f64::consts::PI / frequency, 0.3 / frequency);
        let since_zero = |time: f64| (time / period).floor() * period + 2.0 * (time % period).min(0.5 * period);
        for (row, &time) in bounds.times.iter().enumerate().filter(|(row, _)| !own.error.unresolved[*row]) {
            let impulse = since_zero(begin + time) - since_zero(begin);
            let off = (own.lower[row] - impulse / 1.02).abs().max((own.upper[row] - impulse / 0.98).abs());
            assert!(off <= own.error.total[row] + 1e-12, "{frequency}, {time} s: {off:e}");
        }
    }
}
