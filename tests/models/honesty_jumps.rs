//! Whether bounds are honest where an output's own formula jumps: `mod`, `atan2` and `floor` of an angle that turns.
//! The truths are closed forms.

use std::f64::consts::{PI, TAU};

use mbint::results::Method;

use super::honesty_search::assert_honest;
use crate::common::{band, output, read, run};

/// A disc that turns freely from an uncertain angle at an uncertain speed.
const DISC: &str = "\
model: disc
parameters: { w: { interval: [2.6, 2.9], unit: rad/s }, from: { interval: [0.05, 0.15], unit: rad } }
bodies: { d: { inertia: 1, coordinates: [angle] } }
initial: { d.angle: from, d.angular_velocity: w }
outputs:
  rest: \"mod(d.angle, 2*pi)\"
  direction: \"atan2(sin(d.angle), cos(d.angle))\"
  count: \"floor(d.angle/1 rad)\"
  scaled: \"(2 + sin(t/1 s))*mod(d.angle, 2*pi)\"
simulation: { duration: 6, step: 0.02, output_step: 0.06 }
bounds: { chebyshev: { order: 4 } }
";

/// Range of x − n·period, with the whole number n that brings x above `least`, over x from `from` to `to`.
fn sawtooth((from, to): (f64, f64), period: f64, least: f64) -> (f64, f64) {
    let turns = |x: f64| ((x - least) / period).floor();
    if turns(from) == turns(to) {
        (from - turns(from) * period, to - turns(to) * period)
    } else {
        (least, least + period)
    }
}

#[test]
fn ends_at_jumps_are_found() {
    let bounds = run(&read(DISC));
    let angle = |t: f64| (0.05 + 2.6 * t, 0.15 + 2.9 * t);
    let rest = |t: f64| sawtooth(angle(t), TAU, 0.0);
    let scaled = |t: f64| ((2.0 + t.sin()) * rest(t).0, (2.0 + t.sin()) * rest(t).1);
    let count = |t: f64| (angle(t).0.floor(), angle(t).1.floor());
    let counted = [
        assert_honest(&bounds, "rest", Method::Chebyshev, rest),
        assert_honest(&bounds, "direction", Method::Chebyshev, |t| sawtooth(angle(t), TAU, -PI)),
        assert_honest(&bounds, "scaled", Method::Chebyshev, scaled),
    ];
    assert_eq!(counted, [bounds.times.len(); 3], "nothing of these is flagged");
    // An angle that is a whole number at an end of the box is on either side of a jump.
    assert!(assert_honest(&bounds, "count", Method::Chebyshev, count) > 0);
    // The brink itself, not a point next to it.
    let rest = band(output(&bounds, "rest"), Method::Chebyshev);
    let full: Vec<usize> = (0..bounds.times.len()).filter(|&row| rest.upper[row] - rest.lower[row] > 6.0).collect();
    assert!(full.len() > 10);
    assert!(full.iter().all(|&row| rest.lower[row].abs() < 1e-12 && (rest.upper[row] - TAU).abs() < 1e-12));
}
