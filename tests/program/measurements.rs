//! Cases that tests note for the verification report: the limits that stand in them are asserted.

use crate::measured::Case;

#[test]
fn figures_beyond_their_limits_are_reported() {
    let within =
        Case::new("none", "a").at_most("error, m", 1e-7, 1e-6).at_least("order", 1.95, 1.9).order("order", 2.09, 2.0);
    assert_eq!(within.figure("step, s", f64::NAN).share("missed", 3, 4, Some(0.1)).write(), "");
    let beyond =
        Case::new("none", "a").at_most("error, m", f64::NAN, 1.0).at_least("order", 1.8, 1.9).order("rate", 1.85, 2.0);
    let expected = "\"a\": error, m: NaN is not at most 1e0\n\"a\": order: 1.8e0 is not at least 1.9e0\n\"a\": rate: 1.850, not 2\n";
    assert_eq!(beyond.write(), expected);
}

#[test]
#[should_panic = "\"a\": error, m: 2e0 is not at most 1e0"]
fn a_case_that_is_noted_is_asserted() {
    Case::new("none", "a").at_most("error, m", 2.0, 1.0).note();
}
