//! A run is a function of its model: the same bytes whatever the number of threads, and each time.

use crate::common::{Subject, load, model, model_files};

/// Bounds with all parts of their errors, to the last bit, and the record of the run.
fn bytes(description: &Subject, threads: usize) -> (String, String) {
    let result = description.study().threads(threads).run().unwrap();
    let summary = result.summary().clone().without_seconds();
    (format!("{:?}", result.bounds()), serde_json::to_string_pretty(&summary).unwrap())
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
fn results_to_a_tolerance_do_not_depend_on_threads() {
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
