//! Bounds of throws to a ceiling, which only a part of the box may reach. Truths are parabolas and, in contact, sines.

use mbint::results::{Bounds, Method};

use crate::common::{band, largest, output, read, run_methods};
use crate::through_events::{assert_true, integrated, range};

/// A ball thrown up, which the faster throws of the box take to a stiff ceiling.
const CEILING: &str = "
parameters: { v0: { value: 5, unit: m/s, tolerance: 10% }, K: { value: 1e5, unit: N/m, tolerance: 10% }, H: 1.3 m }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ceiling: { force: { on: ball, value: [0, \"-K*max(ball.y - H, 0)\"] } }
initial: { ball.y: 0, ball.vy: v0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 1, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 5 } }
";

/// Height of the ceiling, m.
const HEIGHT: f64 = 1.3;

/// Height and velocity of the throw under a ceiling: parabolas, and in contact
/// y = H + (u/ω) sin ωτ − (g/ω²)(1 − cos ωτ).
pub fn thrown(height: f64, speed: f64, stiffness: f64, t: f64) -> [f64; 2] {
    let g = 9.81;
    let left = speed * speed - 2.0 * g * height;
    let fly = |t: f64| [speed * t - 0.5 * g * t * t, speed - g * t];
    if left <= 0.0 {
        return fly(t);
    }
    let (omega, at) = (stiffness.sqrt(), left.sqrt());
    let begins = (speed - at) / g;
    let contact = 2.0 / omega * (at * omega / g).atan();
    if t < begins {
        return fly(t);
    }
    if t < begins + contact {
        let (sin, cos) = (omega * (t - begins)).sin_cos();
        let push = g / (omega * omega);
        return [height + at / omega * sin - push * (1.0 - cos), at * cos - push * omega * sin];
    }
    let since = t - begins - contact;
    [height - at * since - 0.5 * g * since * since, -at - g * since]
}

/// Truth over a lattice of speeds, dense on both sides of the one that just grazes, and stiffnesses.
fn over_throws(line: usize, t: f64) -> [f64; 2] {
    let grazes = (2.0 * 9.81 * HEIGHT).sqrt();
    let evenly = (0..=400).map(|place| 4.5 + f64::from(place) / 400.0);
    let beside = (0..200).flat_map(|place| {
        let by = 0.4 * 10.0_f64.powf(-f64::from(place) / 30.0);
        [grazes - by, grazes + by]
    });
    let speeds: Vec<f64> = evenly.chain(beside).collect();
    let points = speeds.iter().flat_map(|&speed| (0..9).map(move |place| (speed, f64::from(place) / 4.0 - 1.0)));
    range(points.map(|(speed, b)| thrown(HEIGHT, speed, 1e5 * (1.0 + 0.1 * b), t)[line]))
}

/// A part of the box meets the ceiling: it is divided where that is just grazed.
#[test]
#[ignore = "2 s"]
fn a_box_is_divided_where_an_event_is_grazed() {
    let (bounds, summary) = run_methods(&read(CEILING), None);
    assert!(integrated(&summary, "chebyshev").0);
    // Neighbours of the lattice leave the ceiling at instants that differ by 0.4 ms.
    assert_true(&bounds, "v", 0.05, 5e-3, |t| over_throws(1, t));
    assert_true(&bounds, "y", 0.02, 5e-4, |t| over_throws(0, t));
    let [event] = &summary.events[..] else { panic!("{:?}", summary.events) };
    assert!(event.met > 0 && event.met < event.samples && event.event.contains("max"), "{event:?}");
    // v0² = 2 g H, whatever the stiffness.
    let [(name, value)] = &event.grazed_at[..] else { panic!("{event:?}") };
    assert!(name == "v0" && (value - (2.0 * 9.81 * HEIGHT).sqrt()).abs() < 1e-3, "{event:?}");
}

/// Asserts that a band is not flagged, and has the truths within its errors.
#[track_caller]
pub fn assert_within(bounds: &Bounds, name: &str, method: Method, slack: f64, truth: impl Fn(f64) -> [f64; 2]) {
    let band = band(output(bounds, name), method);
    assert!(!band.error.unresolved.contains(&true), "{name} is flagged: {:?}", band.error.total);
    for (row, &t) in bounds.times.iter().enumerate() {
        let ([lower, upper], error) = (truth(t), band.error.total[row] + 1e-12);
        let [below, above] = [band.lower[row] - lower, upper - band.upper[row]];
        assert!(below <= error && above <= error, "{name} at {t}: {below:e} and {above:e} beyond, {error:e} stated");
        assert!(below >= -error - slack && above >= -error - slack, "{name} at {t}: {below:e}, {above:e}");
    }
}

/// Asserts that a method bounds throws some of which touch the ceiling.
#[track_caller]
fn assert_throws(request: &str, method: Method) {
    let text = CEILING.replace("chebyshev: { order: 5 }", request);
    let (bounds, _) = run_methods(&read(&text), None);
    assert_within(&bounds, "v", method, 5e-3, |t| over_throws(1, t));
    assert_within(&bounds, "y", method, 5e-4, |t| over_throws(0, t));
}

/// Behind a grazed surface no jet follows.
#[test]
#[ignore = "2 s"]
fn a_divided_box_has_taylor_bounds() {
    assert_throws("taylor: { order: 2 }", Method::Taylor);
}

/// Just below the top of the flight the instant of the hit is known to rounding of the height over a small velocity.
#[test]
fn jets_pass_instants_known_to_rounding() {
    let (height, mass) = (0.4338, 4.53);
    let text = CEILING
        .replace("{ value: 5, unit: m/s, tolerance: 10% }", "{ interval: [2.97273, 2.98727] }")
        .replace("{ value: 1e5, unit: N/m, tolerance: 10% }", "{ interval: [194020, 197980] }")
        .replace("H: 1.3 m", "H: 0.4338 m")
        .replace("mass: 1,", "mass: 4.53,")
        .replace("duration: 1, step: 1e-3, output_step: 0.02", "duration: 0.46, step: 1e-3, output_step: 0.01")
        .replace("chebyshev: { order: 5 }", "taylor: { order: 3 }");
    let (bounds, _) = run_methods(&read(&text), None);
    let of_line = |line: usize, t: f64| {
        let at = |place: i32| f64::from(place) / 60.0 - 1.0;
        let speeds = (0..=120).map(|place| 2.98 + 0.00727 * at(place));
        let stiffness = |place: i32| (196_000.0 + 1980.0 * f64::from(place - 4) / 4.0) / mass;
        range(speeds.flat_map(|speed| (0..=8).map(move |place| thrown(height, speed, stiffness(place), t)[line])))
    };
    assert_within(&bounds, "v", Method::Taylor, 5e-3, |t| of_line(1, t));
    assert_within(&bounds, "y", Method::Taylor, 5e-5, |t| of_line(0, t));
}

/// Differences of a scan's few samples say nothing about the motions between them.
#[test]
fn errors_of_scans_follow_motions_between_events() {
    assert_throws("scan: { points: 5 }", Method::Scan);
}

/// Where the output's slopes are larger than those of errors can be, an end is that of a simulated corner.
#[test]
fn ends_at_corners_have_no_error_of_polynomials() {
    let text = CEILING
        .replace("{ value: 5, unit: m/s, tolerance: 10% }", "{ value: 6, unit: m/s, tolerance: 4% }")
        .replace("{ value: 1e5, unit: N/m, tolerance: 10% }", "1e5 N/m")
        .replace("chebyshev: { order: 5 }", "chebyshev: { order: 2 }");
    let (bounds, _) = run_methods(&read(&text), None);
    let speeds = || (0..=400).map(|place| 6.0 + 0.24 * (f64::from(place) / 200.0 - 1.0));
    let truth = |line: usize, t: f64| range(speeds().map(|speed| thrown(HEIGHT, speed, 1e5, t)[line]));
    assert_within(&bounds, "v", Method::Chebyshev, 5e-3, |t| truth(1, t));
    assert_within(&bounds, "y", Method::Chebyshev, 5e-5, |t| truth(0, t));
    let band = band(output(&bounds, "v"), Method::Chebyshev);
    let behind = bounds.times.iter().position(|&t| t > 0.5).unwrap();
    assert!(largest(band.error.total[behind..].iter().copied()) < 1e-7, "{:?}", band.error.total);
}
