//! Small mechanisms whose motion has a closed form.
//!
//! Where the acceleration is constant the scheme is exact: it integrates quadratics. Elsewhere the error is of second
//! order, so that runs at h and h/2, extrapolated to h = 0, must meet the closed form far more closely than either.

use crate::common::measured::Case;
use crate::common::{curve, largest, model, nominal, order, reference, richardson, row};

/// Times at which a curve passes zero: cubic Hermite interpolation with its slopes, Newton's method.
fn zeros(times: &[f64], values: &[f64], slopes: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    for row in 1..times.len() {
        let (a, b) = (values[row - 1], values[row]);
        if a * b >= 0.0 {
            continue;
        }
        let h = times[row] - times[row - 1];
        let (da, db) = (h * slopes[row - 1], h * slopes[row]);
        let (square, cube) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
        let mut s = a / (a - b);
        for _ in 0..20 {
            s -= (a + s * (da + s * (square + s * cube))) / (da + s * (2.0 * square + 3.0 * s * cube));
        }
        found.push(times[row - 1] + s * h);
    }
    found
}

#[test]
fn the_pendulum_has_its_period() {
    // From the horizontal: T = 4 K(sin 45°) √(L/g), 17 digits by the arithmetic-geometric mean.
    const PERIOD: f64 = 2.3678419475762374;
    let period = |h: f64| {
        let bounds = nominal(&model("pendulum").observing(&["bob.x", "bob.vx"]).step(h).rows_every(0.01));
        let zeros = zeros(&bounds.times, curve(&bounds, "bob.x"), curve(&bounds, "bob.vx"));
        // Zeros at T/4 + n T/2: the last but one that passes in the same direction as the first.
        let count = (zeros.len() - 1) / 2;
        (zeros[2 * count] - zeros[0]) / count as f64
    };
    let periods = [1e-3, 5e-4].map(period);
    let errors = periods.map(|period| (period - PERIOD).abs());
    let extrapolated = ((4.0 * periods[1] - periods[0]) / 3.0 - PERIOD).abs();
    println!("errors {errors:?}, extrapolated {extrapolated:.3e}");
    let order = order(errors[0], errors[1]);
    // The interpolation between rows 0.01 s apart has errors of about 1e-8 (h⁴/384 · x⁗, x⁗ ≈ 1e3 at the bottom).
    let case = Case::new("textbook", "pendulum, period, h extrapolated").source("4 K(sin 45°) √(L/g)");
    case.order("order", order, 2.0).at_most("largest error", extrapolated, 1e-7).note();
}

/// Jacobi's elliptic functions, 40 digits.
#[test]
fn pendulum_motion_matches_elliptic_functions() {
    let rows = reference("iftomm/pendulum.csv");
    let description = model("pendulum").observing(&["bob.x", "bob.y", "rod.force + 3*9.81*bob.y"]).rows_every(0.01);
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let error = |x: &[f64], y: &[f64]| {
        largest(rows.iter().flat_map(|line| {
            let row = row(&runs[0], line[0]);
            [x[row] - line[1], y[row] - line[2]]
        }))
    };
    let errors = runs.each_ref().map(|run| error(curve(run, "bob.x"), curve(run, "bob.y")));
    let limits = ["bob.x", "bob.y"].map(|name| richardson(curve(&runs[0], name), curve(&runs[1], name)));
    let left = error(&limits[0], &limits[1]);
    println!("errors {errors:?}, extrapolated {left:.3e}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    // Without its h² term the error is of third order.
    assert!(left < 1e-2 * errors[1], "{left:e}");
    // The rod's tension is 3 m g |y|/L: energy and the centripetal acceleration.
    // (From 0.1 s on: at first it is zero, where its magnitude has a kink.)
    let tensions = runs.each_ref().map(|run| largest(run.outputs[2].nominal[10..].iter().copied()));
    println!("tension {tensions:?}");
    assert!((order(tensions[0], tensions[1]) - 2.0).abs() < 0.1, "{tensions:?}");
}
