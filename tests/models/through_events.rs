//! Bounds through impacts: motions are cut at their events. Truths are closed forms of flights and oscillations between
//! them, and another integrator.

use std::f64::consts::PI;

use mbint::results::{Bounds, Method, Summary};

use crate::common::dormand_prince::dormand_prince;
use crate::common::{band, largest, output, read, run_methods};

/// A ball that bounces without loss.
pub const ELASTIC: &str = "
parameters: { g: 9.81 m/s^2, K: { value: 1e5, unit: N/m, tolerance: 5% }, h0: { value: 1, unit: m, tolerance: 2% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ground: { force: { on: ball, value: [0, \"K*max(-ball.y, 0)\"] } }
initial: { ball.y: h0, ball.vy: 0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 } }
";

/// A ball whose contact dissipates.
pub const BOUNCE: &str = "
parameters: { h0: { value: 1, unit: m, tolerance: 2% }, d: { value: 0.1, unit: s/m, tolerance: 5% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  floor: { contact: { between: [ground, ball], plane: y, impact: { stiffness: 1e5, exponent: 1, dissipation: d } } }
initial: { ball.y: h0, ball.vy: 0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 2, step: 1e-4, output_step: 0.02 }
bounds: { chebyshev: { order: 3 } }
";

/// Height and velocity of the elastic ball: y = −(u/ω) sin ωτ − (g/ω²)(1 − cos ωτ) in contact.
pub fn elastic(height: f64, stiffness: f64, t: f64) -> [f64; 2] {
    let (g, omega) = (9.81, stiffness.sqrt());
    let speed = (2.0 * g * height).sqrt();
    let fall = speed / g;
    let contact = (PI + 2.0 * (g / (speed * omega)).atan()) / omega;
    if t < fall {
        return [height - 0.5 * g * t * t, -g * t];
    }
    let within = (t - fall) % (contact + 2.0 * fall);
    if within < contact {
        let (sin, cos) = (omega * within).sin_cos();
        return [-speed / omega * sin - g / (omega * omega) * (1.0 - cos), -speed * cos - g / omega * sin];
    }
    let flight = within - contact;
    [speed * flight - 0.5 * g * flight * flight, speed - g * flight]
}

/// Integrator of the summary, and simulations of a method.
pub fn integrated(summary: &Summary, method: &str) -> (bool, usize, usize) {
    let of_method = summary.methods.iter().find(|own| own.method == method).unwrap();
    let between_events = summary.integration.as_ref().is_some_and(|name| name.contains("between events"));
    (between_events, of_method.simulations, of_method.steps)
}

/// Asserts that ranges contain the truths' up to the stated errors, and are wider by at most these and `slack`.
#[track_caller]
pub fn assert_true(bounds: &Bounds, name: &str, stated: f64, slack: f64, truth: impl Fn(f64) -> [f64; 2]) {
    let band = band(output(bounds, name), Method::Chebyshev);
    assert!(!band.error.unresolved.contains(&true), "{name} is flagged");
    assert!(largest(band.error.total.iter().copied()) <= stated, "{name}: {:?}", band.error.total);
    for (row, &t) in bounds.times.iter().enumerate() {
        let ([lower, upper], error) = (truth(t), band.error.total[row] + 1e-12);
        let [below, above] = [band.lower[row] - lower, upper - band.upper[row]];
        assert!(below <= error && above <= error, "{name} at {t}: {below:e} and {above:e} beyond, {error:e} stated");
        assert!(below >= -error - slack && above >= -error - slack, "{name} at {t}: {below:e}, {above:e}");
    }
}

pub fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lower, upper], value| [lower.min(value), upper.max(value)])
}

/// Truth over a lattice of 301 heights and 9 stiffnesses.
pub fn over_box(line: usize, t: f64) -> [f64; 2] {
    let points = (0..301 * 9).map(|place| (f64::from(place % 301) / 150.0 - 1.0, f64::from(place / 301) / 4.0 - 1.0));
    range(points.map(|(a, b)| elastic(1.0 + 0.02 * a, 1e5 * (1.0 + 0.05 * b), t)[line]))
}

/// Widens ranges of height and velocity, row by row, to those of a motion.
fn widen(truths: &mut [[[f64; 2]; 2]], motion: Vec<[f64; 2]>) {
    for (truth, state) in truths.iter_mut().zip(motion) {
        for ([lower, upper], value) in truth.iter_mut().zip(state) {
            (*lower, *upper) = (lower.min(value), upper.max(value));
        }
    }
}

#[test]
fn bounds_of_an_elastic_ball_match_the_closed_form() {
    let (bounds, summary) = run_methods(&read(ELASTIC), None);
    assert!(integrated(&summary, "chebyshev").0);
    assert_eq!(integrated(&summary, "chebyshev").1, 16);
    // Beside a separation the velocity falls by g times the spread of instants between neighbours of the lattice.
    assert_true(&bounds, "v", 1e-3, 2e-3, |t| over_box(1, t));
    assert_true(&bounds, "y", 1e-4, 2e-4, |t| over_box(0, t));
}

#[test]
fn dissipating_contact_matches_another_integrator() {
    let (bounds, summary) = run_methods(&read(BOUNCE), None);
    assert_eq!(integrated(&summary, "chebyshev").1, 16);
    let mut truths = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 2]; bounds.times.len()];
    for index in 0..25 {
        let [a, b] = [f64::from(index % 5) / 2.0 - 1.0, f64::from(index / 5) / 2.0 - 1.0];
        let (height, d) = (1.0 + 0.02 * a, 0.1 * (1.0 + 0.05 * b));
        let rate = |_: f64, [y, v]: [f64; 2]| [v, -9.81 + 1e5 * (-y).max(0.0) * (1.0 - d * v)];
        let motion = dormand_prince(rate, [height, 0.0], 0.02, bounds.times.len(), 1e-14);
        widen(&mut truths, motion);
    }
    let row = |t: f64| (t / 0.02).round() as usize;
    // 25 samples need not be at the ends.
    assert_true(&bounds, "v", 1e-3, f64::INFINITY, |t| truths[row(t)][1]);
    assert_true(&bounds, "y", 1e-4, f64::INFINITY, |t| truths[row(t)][0]);
}

#[test]
fn tolerance_needs_few_simulations() {
    let text = ELASTIC.replace("bounds: { chebyshev: { order: 3 } }", "bounds: { tolerance: 1e-3 }");
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").1 <= 25);
    assert_true(&bounds, "v", 1e-3 * 9.0, 2e-3, |t| over_box(1, t));
}

/// An event is before the end for some samples and behind it for others.
#[test]
fn event_near_the_end_is_followed() {
    let text = ELASTIC.replace("duration: 2", "duration: 0.46").replace("output_step: 0.02", "output_step: 0.01");
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0);
    assert_true(&bounds, "v", 1e-3, 2e-3, |t| over_box(1, t));
}

/// Jets go through the events, too.
#[test]
fn taylor_polynomials_go_through_events() {
    let text = ELASTIC.replace("chebyshev: { order: 3 }", "taylor: { order: 5 }");
    let (bounds, summary) = run_methods(&read(&text), None);
    assert_eq!(integrated(&summary, "taylor").1, 1);
    let band = band(output(&bounds, "v"), Method::Taylor);
    assert!(!band.error.unresolved.contains(&true) && largest(band.error.total.iter().copied()) < 1e-3);
    for (row, &t) in bounds.times.iter().enumerate() {
        let ([lower, upper], error) = (over_box(1, t), band.error.total[row] + 1e-12);
        let [below, above] = [band.lower[row] - lower, upper - band.upper[row]];
        assert!(below <= error && above <= error, "at {t}: {below:e} and {above:e} beyond, {error:e} stated");
        assert!(below >= -error - 2e-3 && above >= -error - 2e-3, "at {t}: {below:e}, {above:e}");
    }
}

/// Polynomials of the second degree have a grid of 3⁸ = 6561 samples.
#[test]
fn scans_of_two_points_take_no_further_samples() {
    let text = ELASTIC
        .replace(
            "parameters: { g: 9.81 m/s^2,",
            "parameters: { g: { value: 9.81, unit: m/s^2, tolerance: 0.1% }, m: { value: 1, unit: kg, tolerance: 1% },
  b: { interval: [0, 1 mm] }, c: { value: 0.01, unit: N*s/m, tolerance: 9% }, f: { value: 0.01, unit: N, tolerance: 9% },
  w: { value: 0.01, unit: m/s, tolerance: 9% },",
        )
        .replace("mass: 1,", "mass: m,")
        .replace("-9.81] } }", "-g] } }\n  push: { force: { on: ball, value: [0, \"f - c*ball.vy\"] } }")
        .replace("max(-ball.y, 0)", "max(b - ball.y, 0)")
        .replace("ball.vy: 0", "ball.vy: w")
        .replace("duration: 2", "duration: 0.8")
        .replace("chebyshev: { order: 3 }", "scan: { points: 2 }");
    let (_, summary) = run_methods(&read(&text), None);
    let (between_events, simulations, _) = integrated(&summary, "scan");
    assert_eq!((between_events, simulations), (true, 256));
}

/// Contacts of 0.26 ms: steps of their length everywhere would be tens of thousands.
#[test]
fn a_single_motion_takes_few_steps() {
    let text = ELASTIC.replace("value: 1e5, unit: N/m, tolerance: 5%", "value: 1.5e8, unit: N/m");
    let text = text.replace("{ value: 1, unit: m, tolerance: 2% }", "1 m").replace("step: 1e-3", "tolerance: 1e-6");
    let (bounds, summary) = run_methods(&read(&text), None);
    let (is_cut, _, steps) = integrated(&summary, "nominal");
    assert!(is_cut && steps < 1000, "{steps}");
    let [y, v] = ["y", "v"].map(|name| &output(&bounds, name).nominal);
    let off = bounds.times.iter().enumerate().map(|(row, &t)| {
        let [height, velocity] = elastic(1.0, 1.5e8, t);
        largest([y[row] - height, v[row] - velocity])
    });
    assert!(largest(off) < 1e-8);
}

/// The test of HHT-I3 is in `scheme_between_events`.
#[test]
fn requested_explicit_scheme_is_used() {
    let text = ELASTIC.replace("step: 1e-3", "tolerance: 1e-6, scheme: explicit");
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0);
    assert_true(&bounds, "v", 1e-2, 1e-2, |t| over_box(1, t));
}

/// A ball on a floor whose losses grow with the speed: it comes to rest, and rests for most of the time.
#[test]
#[ignore = "2 s"]
fn a_ball_that_comes_to_rest_is_followed_to_the_end() {
    let text = BOUNCE.replace("value: 1, unit: m, tolerance: 2%", "value: 10, unit: m, tolerance: 1%");
    let text = text.replace("d: { value: 0.1, unit: s/m, tolerance: 5% }", "d: 0.5 s/m");
    let text = text.replace("duration: 2, step: 1e-4, output_step: 0.02", "duration: 20, step: 1e-3, output_step: 0.1");
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0 && summary.events_followed.is_none());
    let mut truths = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 2]; bounds.times.len()];
    for height in [9.9, 9.95, 10.0, 10.05, 10.1] {
        let rate = |_: f64, [y, v]: [f64; 2]| [v, -9.81 + 1e5 * (-y).max(0.0) * (1.0 - 0.5 * v).max(0.0)];
        let motion = dormand_prince(rate, [height, 0.0], 0.1, bounds.times.len(), 1e-13);
        widen(&mut truths, motion);
    }
    let row = |t: f64| (t / 0.1).round() as usize;
    assert_true(&bounds, "v", 1e-4, f64::INFINITY, |t| truths[row(t)][1]);
    assert_true(&bounds, "y", 1e-5, f64::INFINITY, |t| truths[row(t)][0]);
}

/// A ball that bounces more often than events are followed: bounds are sharp up to the last of them, and the summary
/// has its time.
#[test]
fn bounces_without_end_are_flagged_from_a_time() {
    let text = ELASTIC.replace("K: { value: 1e5, unit: N/m, tolerance: 5% }", "K: 1e5 N/m");
    let text = text.replace("order: 3", "order: 5");
    let text = text.replace("duration: 2, step: 1e-3, output_step: 0.02", "duration: 80, step: 1e-3, output_step: 1");
    let (bounds, summary) = run_methods(&read(&text), None);
    let followed = summary.events_followed.as_ref().unwrap();
    assert!(followed.why.contains("more events"), "{}", followed.why);
    // 64 contacts, in the sample that falls from 0.98 m.
    let (fall, omega) = ((2.0 * 0.98 / 9.81_f64).sqrt(), 1e5_f64.sqrt());
    let contact = (PI + 2.0 * (9.81 / (9.81 * fall * omega)).atan()) / omega;
    assert!((followed.until - (127.0 * fall + 64.0 * contact)).abs() < 1e-6, "{}", followed.until);
    let band = band(output(&bounds, "v"), Method::Chebyshev);
    for (row, &t) in bounds.times.iter().enumerate() {
        assert_eq!(band.error.unresolved[row], t > followed.until, "at {t}: {:?}", band.error.total[row]);
        let heights = (0..=400).map(|index| 1.0 + 0.02 * (f64::from(index) / 200.0 - 1.0));
        let [lower, upper] = range(heights.map(|height| elastic(height, 1e5, t)[1]));
        let error = band.error.total[row] + 1e-9;
        let is_held = band.lower[row] - lower <= error && upper - band.upper[row] <= error;
        assert!(is_held || t > followed.until, "at {t}: {error:e}");
    }
}

/// Four parameters, of which the height matters most: terms are added where most is expected.
#[test]
#[ignore = "2 s"]
fn four_parameters_take_few_simulations() {
    let text = BOUNCE.replace("tolerance: 2%", "tolerance: 5%").replace("mass: 1,", "mass: m,");
    let four = "K: { value: 1e5, unit: N/m, tolerance: 5% }, m: { value: 1, unit: kg, tolerance: 5% }, h0:";
    let text = text.replace("h0: {", &format!("{four} {{")).replace("stiffness: 1e5", "stiffness: K");
    let text = text.replace("chebyshev: { order: 3 }", "tolerance: 1e-4");
    let (bounds, summary) = run_methods(&read(&text), None);
    let (is_cut, simulations, _) = integrated(&summary, "chebyshev");
    assert!(is_cut && simulations <= 100, "{simulations}");
    let mut truths = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 2]; bounds.times.len()];
    // All corners, and the middle.
    for corner in 0..17 {
        let side = |bit: usize| if corner == 16 { 1.0 } else { 0.95 + 0.1 * f64::from(corner >> bit & 1) };
        let (height, d, stiffness) = (side(0), 0.1 * side(1), 1e5 * side(2) / side(3));
        let rate = |_: f64, [y, v]: [f64; 2]| [v, -9.81 + stiffness * (-y).max(0.0) * (1.0 - d * v)];
        let motion = dormand_prince(rate, [height, 0.0], 0.02, bounds.times.len(), 1e-14);
        widen(&mut truths, motion);
    }
    let row = |t: f64| (t / 0.02).round() as usize;
    assert_true(&bounds, "v", 1e-3, f64::INFINITY, |t| truths[row(t)][1]);
    assert_true(&bounds, "y", 1e-3, f64::INFINITY, |t| truths[row(t)][0]);
}
