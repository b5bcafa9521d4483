use super::*;

fn range(k: usize, intervals: usize, f: impl Fn(&[f64]) -> f64) -> Extent {
    extremes(&Lattices::default(), &vec![intervals; k], &[0.0], &|points| points.iter().map(|xi| f(xi)).collect())
        .swap_remove(0)
}

#[test]
fn peak_near_an_edge_is_found() {
    // Between the last two points of the grid.
    let found = range(1, 8, |xi| (xi[0] - 0.93).powi(2) + 0.1 * (xi[0] - 0.93).powi(3));
    assert!(found.range.lower.abs() < 1e-9 && found.gap < 1e-6, "{found:?}");
    assert!((found.range.upper - (1.93_f64.powi(2) - 0.1 * 1.93_f64.powi(3))).abs() < 1e-12);
}

#[test]
fn a_ridge_is_followed_to_its_end() {
    // Along x ≈ y the function hardly changes; its least value is where the ridge leaves the box.
    let f = |xi: &[f64]| 100.0 * (xi[0] - xi[1] + 0.3 * xi[0] * xi[0]).powi(2) + 0.1 * xi[1] + 0.05 * xi[2];
    let least = |y: f64| {
        // The best x for this y, by a dense search.
        (0..=200_000).map(|i| f(&[-1.0 + 1e-5 * f64::from(i), y, -1.0])).fold(f64::INFINITY, f64::min)
    };
    let found = range(3, 6, f);
    let truth = (0..=40).map(|i| least(-1.0 + 0.01 * f64::from(i))).fold(f64::INFINITY, f64::min);
    assert!((found.range.lower - truth).abs() < 1e-3 * found.range.width(), "{found:?}, {truth}");
}

#[test]
fn a_function_that_is_shifted_has_its_extremes_nearby() {
    let wave = |shift: f64| {
        move |points: &[Vec<f64>]| {
            points.iter().map(|xi| (9.0 * xi[0] + shift).sin() + 0.1 * xi[1]).collect::<Vec<f64>>()
        }
    };
    let known: Vec<Extent> = extremes(&Lattices::default(), &[24; 2], &[0.0], &wave(0.0));
    let shifted = extremes_near(&known, &wave(0.4));
    assert!((shifted[0].range.upper - 1.1).abs() < 1e-6 && (shifted[0].range.lower + 1.1).abs() < 1e-6, "{shifted:?}");
    let slope = |shift: f64| move |points: &[Vec<f64>]| points.iter().map(|xi| xi[0] + shift).collect::<Vec<f64>>();
    let shifted = extremes_near(&extremes(&Lattices::default(), &[4], &[0.0], &slope(0.0)), &slope(0.4));
    assert!((shifted[0].range.upper - 1.4).abs() < 1e-12 && (shifted[0].range.lower + 0.6).abs() < 1e-12);
}

#[test]
fn a_range_full_of_turns_has_no_gap() {
    // About forty local extremes of either kind, all alike.
    let found = range(1, 24, |xi| (120.0 * xi[0] + 9.0 * xi[0] * xi[0]).sin());
    assert!((found.range.upper - 1.0).abs() < 1e-9 && (found.range.lower + 1.0).abs() < 1e-9, "{found:?}");
    assert!(found.gap < 1e-4, "{}", found.gap);
}

#[test]
fn range_without_parameters_is_a_value_and_nan_is_unknown() {
    assert_eq!(range(0, 8, |_| 3.0).range, Range { lower: 3.0, upper: 3.0 });
    assert!(range(1, 8, |xi| if xi[0] == 0.0 { f64::NAN } else { 1.0 }).range.lower.is_nan());
}

#[test]
fn the_best_of_many_waves_is_found() {
    // Two waves that beat: only one crest of thirty is the highest.
    let f = |x: f64| (60.0 * x).sin() + (57.0 * x + 0.4).sin() + 0.05 * x;
    let found = range(1, 16, |xi| f(xi[0]));
    let dense = (0..=400_000).map(|i| f(-1.0 + 5e-6 * f64::from(i)));
    let truth = dense.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(v), u.max(v)));
    assert!((found.range.lower - truth.0).abs() < 1e-8 && (found.range.upper - truth.1).abs() < 1e-8, "{found:?}");
    assert!(found.gap < 1e-8);
    let found = range(2, 8, |xi| (9.0 * xi[0]).sin() * (14.0 * xi[1] + xi[0]).cos() + 0.1 * xi[0] * xi[1]);
    let f = |x: f64, y: f64| (9.0 * x).sin() * (14.0 * y + x).cos() + 0.1 * x * y;
    let dense = (0..=1_000_000).map(|i| f(-1.0 + 2e-3 * f64::from(i % 1001), -1.0 + 2e-3 * f64::from(i / 1001)));
    let truth = dense.fold(f64::NEG_INFINITY, f64::max);
    assert!(found.range.upper >= truth && found.range.upper < truth + 1e-4, "{found:?}, {truth}");
}

/// It does not matter which one of equal crests is refined.
#[test]
fn every_crest_is_climbed_to_its_top() {
    for shift in [0.0, 0.013, 0.1, 0.37, 0.71] {
        let f = |x: f64, y: f64| (9.0 * x + 0.3 * x * x + shift).sin() * (7.0 * y + 0.5 * x * y + 2.0 * shift).cos();
        let (found, permuted) = (range(2, 16, |xi| f(xi[0], xi[1])), range(2, 16, |xi| f(xi[1], xi[0])));
        for found in [found, permuted] {
            assert!((found.range.upper - 1.0).abs() < 1e-10 && (found.range.lower + 1.0).abs() < 1e-10, "{found:?}");
        }
    }
}

#[test]
fn search_stops_at_rounding_errors() {
    let seen = std::cell::Cell::new(0);
    // Noise of some units of rounding, and a function that is not known better than to a thousandth of its size.
    let noise = |xi: f64| (1e7 * xi).sin();
    let evaluate = |points: &[Vec<f64>]| {
        seen.set(seen.get() + points.len());
        let first = points.iter().map(|xi| 3.0 + 2e-15 * noise(xi[0]));
        first.chain(points.iter().map(|xi| xi[0] + 1e-3 * noise(xi[0]))).collect()
    };
    let found = extremes(&Lattices::default(), &[16], &[1e-13, 3e-3], &evaluate);
    assert!(seen.get() < 200, "{} points", seen.get());
    assert!((found[1].range.upper - 1.0).abs() < 3e-3 && found[0].range.width() < 1e-14, "{found:?}");
}

#[test]
fn size_sign_and_order_do_not_matter() {
    let f = |x: f64, y: f64| (7.0 * x + y * y).sin() + (5.0 * y - x).cos();
    let known = range(2, 10, |xi| f(xi[0], xi[1]));
    let moved = range(2, 10, |xi| 1e3 + 0.1 * f(xi[0], xi[1]));
    let mirrored = range(2, 10, |xi| -1e9 * f(xi[0], xi[1]));
    let permuted = range(2, 10, |xi| f(xi[1], xi[0]));
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * known.range.width();
    assert!(close(10.0 * (moved.range.upper - 1e3), known.range.upper), "{moved:?} {known:?}");
    assert!(close(-1e-9 * mirrored.range.lower, known.range.upper) && close(permuted.range.upper, known.range.upper));
    assert!(close(-1e-9 * mirrored.range.upper, known.range.lower) && close(permuted.range.lower, known.range.lower));
}
