//! Linkages that are made for the curve that a point draws: the points are where circles meet, one after another.

use std::f64::consts::TAU;

use mbint::results::Method;

use crate::common::measured::Case;
use crate::common::{band, curve, distance_from, largest, model, nominal, output, run};

/// Newton's tolerance (1e-11 of the model's size) times the slopes of the closed forms.
const CLOSED: f64 = 1e-10;

pub(super) type Point = [f64; 2];

/// Intersection of two circles, to the left of the way from the first centre to the second.
pub(super) fn left_of(first: Point, radius: f64, second: Point, other: f64) -> Point {
    let (x, y) = (second[0] - first[0], second[1] - first[1]);
    let distance = x.hypot(y);
    let along = (radius * radius - other * other + distance * distance) / (2.0 * distance);
    let across = (radius * radius - along * along).sqrt();
    [first[0] + (along * x - across * y) / distance, first[1] + (along * y + across * x) / distance]
}

/// The pen of `peaucellier.yaml`: the crank's end, inverted in a circle.
fn pen(crank: f64, arm: f64, t: f64) -> Point {
    let (base, side) = (0.09, 0.08);
    let angle = 0.8 * (TAU * t).sin();
    let (x, y) = (base + crank * angle.cos(), crank * angle.sin());
    let factor = (arm * arm - side * side) / (x * x + y * y);
    [factor * x, factor * y]
}

#[test]
fn peaucelliers_pen_draws_a_straight_line() {
    let bounds = nominal(&model("peaucellier"));
    let line = (0.2 * 0.2 - 0.08 * 0.08) / (2.0 * 0.09);
    let off = distance_from(&bounds.times, curve(&bounds, "pen_x"), |_| line);
    Case::new("textbook", "Peaucellier's straight line")
        .source("inversion in a circle")
        .at_most("largest error", off, CLOSED)
        .note();
    assert!(distance_from(&bounds.times, curve(&bounds, "pen_y"), |t| pen(0.09, 0.2, t)[1]) < CLOSED);
}

#[test]
fn bounds_of_peaucelliers_line_match_inversion() {
    let bounds = run(&model("peaucellier").scan(3));
    for (name, index) in [("pen_x", 0), ("pen_y", 1)] {
        let output = output(&bounds, name);
        let band = band(output, Method::Scan);
        for (row, &t) in bounds.times.iter().enumerate() {
            let values: Vec<f64> = [-1e-4, 0.0, 1e-4]
                .iter()
                .flat_map(|c| [-1e-4, 0.0, 1e-4].map(|a| pen(0.09 + c, 0.2 + a, t)[index]))
                .collect();
            let lower = values.iter().copied().fold(f64::INFINITY, f64::min);
            let upper = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
            assert!(error < CLOSED, "{name} at {t} s: [{lower}, {upper}] is off by {error:e}");
        }
    }
}

/// The toe of `jansen.yaml` by Jansen's letters, in m.
fn toe(t: f64) -> Point {
    let [a, b, c, d, e, f, g, h, i, j, k, l, m] =
        [38.0, 41.5, 39.3, 40.1, 55.8, 39.4, 36.7, 65.7, 49.0, 50.0, 61.9, 7.8, 15.0].map(|length| length * 1e-3);
    let bearing = [-a, -l];
    let pin = [m * (TAU * t).cos(), m * (TAU * t).sin()];
    let top = left_of(bearing, b, pin, j);
    let ankle = left_of(pin, k, bearing, c);
    let side = left_of(bearing, d, top, e);
    let knee = left_of(ankle, g, side, f);
    left_of(ankle, i, knee, h)
}

#[test]
fn jansens_toe_matches_intersections_of_circles() {
    let bounds = nominal(&model("jansen"));
    for (name, index) in [("toe_x", 0), ("toe_y", 1)] {
        let error = distance_from(&bounds.times, curve(&bounds, name), |t| toe(t)[index]);
        assert!(error < CLOSED, "{name} is off by {error:e} m");
    }
}

#[test]
fn jansens_sole_is_flat() {
    // While the foot is down, over half of the step's length, it rises by less than 5 % of that length.
    let steps: Vec<Point> = (0..1000).map(|place| toe(f64::from(place) * 1e-3)).collect();
    let lowest = steps.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let down = steps.iter().filter(|point| point[1] < lowest + 4e-3).map(|point| point[0]);
    let (left, right) = down.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, r), x| (l.min(x), r.max(x)));
    let bounds = nominal(&model("jansen"));
    let computed = curve(&bounds, "toe_y").iter().copied().fold(f64::INFINITY, f64::min);
    assert!(right - left > 0.04, "the sole is {} m long", right - left);
    // Rows are 20 ms apart, and the sole is flat: its lowest point is between two of them.
    assert!(largest([computed - lowest]) < 1e-4, "{computed} {lowest}");
}
