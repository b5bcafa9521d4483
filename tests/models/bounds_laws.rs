//! Laws that bounds obey whatever the mechanism.

use mbint::RangeKind;
use mbint::results::{Bounds, Method};

use crate::common::{
    Findings, Subject, band, distance, largest, load, model, model_files, output, read, run, with_reversed_parameters,
};

/// Share of the times at which a method's band leaves another's by more than the errors of both.
fn outside(output: &mbint::results::OutputBounds, inner: Method, outer: Method) -> f64 {
    let (inner, outer) = (band(output, inner), band(output, outer));
    let rows = inner.lower.len();
    let leaves = |row: &usize| {
        let error = outer.error.total[*row] + inner.error.total[*row];
        let below = outer.lower[*row] - inner.lower[*row];
        let above = inner.upper[*row] - outer.upper[*row];
        !(below <= error && above <= error)
    };
    (0..rows).filter(leaves).count() as f64 / rows as f64
}

#[test]
#[ignore = "20 s: a scan of every model"]
fn scans_lie_within_chebyshev_bounds() {
    // Values of a scan do occur, but for the time steps' error.
    let mut findings = Findings::default();
    for path in model_files() {
        let description = load(&path);
        if description.study().description().bounds.scan.is_none() {
            continue;
        }
        let bounds = run(&description);
        let name = path.file_stem().unwrap().to_string_lossy();
        for output in &bounds.outputs {
            let share = outside(output, Method::Scan, Method::Chebyshev);
            println!("{name}: {} {share:.2e}", output.name);
            findings.check(share < 0.01, format_args!("{name}: {} leaves its bounds at {share:e}", output.name));
        }
    }
    findings.none();
}

/// A hundred times narrower intervals.
fn narrowed(description: Subject) -> Subject {
    scaled(description, 0.01)
}

/// The intervals times a factor, about their middles.
fn scaled(description: Subject, factor: f64) -> Subject {
    let uncertain: Vec<(String, f64)> = description
        .model
        .uncertain()
        .map(|(name, [lower, upper])| (name.to_owned(), (upper - lower) / (upper + lower)))
        .collect();
    uncertain.iter().fold(description, |found, (name, relative)| found.uncertain(name, factor * relative.abs()))
}

#[test]
fn taylor_and_chebyshev_agree_on_narrow_intervals() {
    // With intervals of 1e-4 the terms that either method omits are below rounding and Newton's tolerance (1e-11 of a
    // position; up to 1e-7 of an acceleration or reaction, which is h⁻² times the position's).
    let mut findings = Findings::default();
    for name in ["slider_crank", "double_pendulum", "four_bar", "quick_return", "scotch_yoke", "car_axis"] {
        let description = narrowed(model(name)).chebyshev(4, RangeKind::Tight).taylor(4);
        for output in &run(&description).outputs {
            let (chebyshev, taylor) = (band(output, Method::Chebyshev), band(output, Method::Taylor));
            let difference = distance(&chebyshev.lower, &taylor.lower).max(distance(&chebyshev.upper, &taylor.upper));
            let width = largest(chebyshev.upper.iter().zip(&chebyshev.lower).map(|(upper, lower)| upper - lower));
            println!("{name}: {} differ by {difference:.2e}, width {width:.2e}", output.name);
            findings.check(
                difference < 1e-3 * width,
                format_args!("{name}: {} differ by {difference:e} at a width of {width:e}", output.name),
            );
        }
    }
    findings.none();
}

#[test]
#[ignore = "10 s: every model"]
fn intervals_of_no_width_give_the_nominal_motion() {
    for name in ["slider_crank", "car_axis"] {
        let description = scaled(model(name), 0.0);
        for output in &run(&description.duration(1.0)).outputs {
            for band in &output.bands {
                let (below, above) = (distance(&band.lower, &output.nominal), distance(&band.upper, &output.nominal));
                let allowed = match band.method {
                    // Sums over nodes: rounding.
                    Method::Chebyshev => 1e-12,
                    // A sweep more than Newton's iteration: its tolerance of 1e-11, in every step anew.
                    Method::Taylor => 1e-10,
                    Method::Scan => 0.0,
                    Method::Certified => unreachable!("no model asks for it"),
                };
                assert!(below <= allowed && above <= allowed, "{name}: {:?} {below:e} {above:e}", band.method);
            }
        }
    }
}

fn assert_same(a: &Bounds, b: &Bounds, tolerance: f64) {
    for a in &a.outputs {
        let b = output(b, &a.name);
        for (a, b) in a.bands.iter().zip(&b.bands) {
            let difference = distance(&a.lower, &b.lower).max(distance(&a.upper, &b.upper));
            assert!(difference < tolerance, "{:?} differs by {difference:e}", a.method);
        }
    }
}

#[test]
fn the_order_of_parameters_does_not_matter() {
    // Sums over nodes run in another order: rounding.
    let description = model("slider_crank").duration(1.0);
    let turned = with_reversed_parameters(include_str!("../../models/slider_crank.yaml")).duration(1.0);
    assert_same(&run(&description), &run(&turned), 1e-12);
}

#[test]
fn bounds_of_a_linear_response_are_exact() {
    // y = y₀ + v₀ t − ½ g t² is linear in v₀ and g: the extremes are at the corners, whatever the method and range.
    let text = "
parameters:
  v0: { value: 4, unit: m/s, tolerance: 0.5 }
  g: { value: 9.81, unit: m/s^2, plus: 0.02, minus: 0.05 }
bodies: { ball: { mass: 0.3, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { ball.y: 2, ball.vy: v0 }
outputs: { y: ball.y }
simulation: { duration: 2, step: 0.01, output_step: 0.1 }
bounds: { chebyshev: { order: 3, range: RANGE }, taylor: { order: 2, range: RANGE }, scan: { points: 2 } }
";
    for range in ["tight", "interval"] {
        let bounds = run(&read(&text.replace("RANGE", range)));
        for band in &bounds.outputs[0].bands {
            for (row, &t) in bounds.times.iter().enumerate() {
                let y = |v0: f64, g: f64| 2.0 + v0 * t - 0.5 * g * t * t;
                let (lower, upper) = (y(3.5, 9.83), y(4.5, 9.76));
                let errors = [band.lower[row] - lower, band.upper[row] - upper];
                assert!(largest(errors) < 1e-12, "{range} {:?} at {t} s: {errors:?}", band.method);
            }
        }
    }
}

#[test]
fn tight_bounds_lie_within_interval_bounds() {
    for name in ["slider_crank", "double_pendulum"] {
        let [tight, interval] =
            [RangeKind::Tight, RangeKind::Interval].map(|range| run(&model(name).chebyshev(5, range)));
        for (tight, interval) in tight.outputs.iter().zip(&interval.outputs) {
            let (tight, interval) = (band(tight, Method::Chebyshev), band(interval, Method::Chebyshev));
            for row in 0..tight.lower.len() {
                assert!(interval.lower[row] <= tight.lower[row] && tight.upper[row] <= interval.upper[row]);
            }
        }
    }
}

#[test]
fn wider_intervals_give_wider_bounds() {
    let widths = [0.002, 0.005, 0.01].map(|relative| {
        let description = model("slider_crank_one").uncertain("l1", relative).chebyshev(10, RangeKind::Tight);
        run(&description.duration(1.0))
    });
    for pair in widths.windows(2) {
        let (narrow, wide) = (&pair[0].outputs[0].bands[0], &pair[1].outputs[0].bands[0]);
        for row in 0..narrow.lower.len() {
            // Order 10 resolves x3 over 1 s to 1e-9.
            assert!(wide.lower[row] <= narrow.lower[row] + 1e-9 && narrow.upper[row] <= wide.upper[row] + 1e-9);
        }
    }
}
