//! A run is a function of its model: the same bytes whatever the number of threads, and each time.

use mbint::inner::export::bounds_csv;
use mbint::inner::model::Description;
use mbint::inner::study::{self, Options};

use crate::common::{Vary, load, model, model_files};

fn bytes(description: &Description, threads: usize) -> (Vec<u8>, String) {
    let options = Options { threads: Some(threads), ..Options::default() };
    let (bounds, summary) = study::run(description, options).unwrap();
    (bounds_csv(&bounds).unwrap(), serde_json::to_string_pretty(&summary.without_seconds()).unwrap())
}

#[test]
#[ignore = "20 s: every model, on different numbers of threads"]
fn results_do_not_depend_on_the_number_of_threads() {
    for path in model_files() {
        let description = load(&path).at_most(0.5);
        let one = bytes(&description, 1);
        for threads in [2, 7] {
            assert!(bytes(&description, threads) == one, "{} with {threads} threads", path.display());
        }
    }
}

#[test]
#[ignore = "10 s: every method three times"]
fn results_with_a_tolerance_do_not_depend_on_the_number_of_threads() {
    let description = model("slider_crank").duration(0.5).tolerance(1e-6);
    let one = bytes(&description, 1);
    for threads in [2, 7] {
        assert!(bytes(&description, threads) == one, "with {threads} threads");
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let description = model("car_axis").duration(0.5);
    assert!(bytes(&description, 2) == bytes(&description, 2));
}
