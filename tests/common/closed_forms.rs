//! Assertions that an output has a closed form.

use mbint::results::Bounds;

use super::{Subject, curve, distance_from, nominal, order, richardson};

/// Rounding over a thousand steps, with numbers of size 1 to 100.
const ROUNDING: f64 = 1e-10;

/// Error of reactions by rounding of positions (1e-16 m), which is divided by βh² = 3e-5 s² and multiplied by masses;
/// its traces in the algorithmic accelerations fade slowly.
const ROUNDING_OF_FORCES: f64 = 1e-8;

/// Asserts that an output has this closed form: exactly up to rounding.
#[track_caller]
pub fn assert_exact(bounds: &Bounds, name: &str, exact: impl Fn(f64) -> f64) {
    let error = distance_from(&bounds.times, curve(bounds, name), exact);
    assert!(error < ROUNDING, "{name} is off by {error:e}");
}

/// The same for reactions.
#[track_caller]
pub fn assert_exact_force(bounds: &Bounds, name: &str, exact: impl Fn(f64) -> f64) {
    let error = distance_from(&bounds.times, curve(bounds, name), exact);
    assert!(error < ROUNDING_OF_FORCES, "{name} is off by {error:e}");
}

/// Asserts second order, and that the extrapolation at step h has errors below `limit`.
#[track_caller]
pub fn assert_converges(description: &Subject, h: f64, name: &str, limit: f64, exact: impl Fn(f64) -> f64) {
    let [coarse, fine] = [h, 0.5 * h].map(|h| nominal(&description.clone().step(h)));
    let errors = [&coarse, &fine].map(|run| distance_from(&run.times, curve(run, name), &exact));
    let extrapolated = richardson(curve(&coarse, name), curve(&fine, name));
    let left = distance_from(&fine.times, &extrapolated, &exact);
    let order = order(errors[0], errors[1]);
    println!("{name}: errors {errors:?}, order {order:.3}, extrapolated {left:.3e}");
    assert!((order - 2.0).abs() < 0.1, "{name} converges with order {order}: {errors:?}");
    assert!(left < limit, "{name}: {left:e} is left after extrapolation");
}
