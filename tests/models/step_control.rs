//! Steps of HHT-I3 from a tolerance.
//!
//! The local position error is of third order, δ ∼ h³, and is kept at each step's share of the tolerance, tol · h/T:
//! h ∼ tol^(1/2), and the error at the end, ∼ h², is proportional to the tolerance:
//! a decade for a decade, within a factor of 3.

use crate::common::{distance, model, nominal, run_methods};

#[test]
fn the_error_falls_with_the_tolerance() {
    for (name, output) in [("slider_crank_one", "slider.x"), ("double_pendulum", "lower.end.x")] {
        let description = model(name).duration(1.0).observing(&[output]).rows_every(0.02);
        let exact = nominal(&description.clone().step(2e-5));
        let tolerances = [1e-4, 1e-5, 1e-6];
        let errors = tolerances.map(|tolerance| {
            let bounds = nominal(&description.clone().by_hht().tolerance(tolerance));
            distance(&bounds.outputs[0].nominal, &exact.outputs[0].nominal)
        });
        println!("{name}: {errors:?}");
        for (errors, tolerances) in errors.windows(2).zip(tolerances.windows(2)) {
            let exponent = (errors[0] / errors[1]).log10() / (tolerances[0] / tolerances[1]).log10();
            assert!((exponent - 1.0).abs() < 3.0_f64.log10(), "{name}: error ~ tol^{exponent}: {errors:?}");
        }
    }
}

#[test]
fn number_of_steps_grows_with_the_root_of_the_tolerance() {
    let description = model("slider_crank_one").duration(1.0);
    let steps = [1e-4, 1e-6].map(|tolerance| {
        let (_, summary) = run_methods(&description.clone().by_hht().tolerance(tolerance), Some(Vec::new()));
        summary.methods[0].steps
    });
    println!("{steps:?}");
    // h ∼ tol^(1/2): a tenth, less the steps that rows every 0.01 s cut off.
    let ratio = steps[1] as f64 / steps[0] as f64;
    assert!((6.0..11.0).contains(&ratio), "{steps:?}");
}

#[test]
fn all_samples_share_the_steps() {
    // Rows of the samples are at the same times as the nominal one's: bounds at zero width are its course.
    let description = model("slider_crank_one").duration(0.5).tolerance(1e-7);
    let (bounds, _) = run_methods(&description, None);
    for output in &bounds.outputs {
        for band in &output.bands {
            for (row, nominal) in output.nominal.iter().enumerate() {
                assert!(band.lower[row] <= nominal + 1e-9 && *nominal <= band.upper[row] + 1e-9, "{}", output.name);
            }
        }
    }
}
