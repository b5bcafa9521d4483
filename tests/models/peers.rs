//! Test models of other programs, written in this project's words: cases and reference values are the rows of
//! `tests/peers/*.csv`, models stand in the folders next to them.
//!
//! Exudyn's values are those of `tests/peers/in_exudyn.py`, which makes the mechanisms of its mini examples in Exudyn;
//! Chrono's are the closed forms that its unit tests state, by `tests/peers/closed_forms.py`.

use std::path::Path;

use crate::common::measured::Case;
use crate::common::{curve, largest, load, nominal};

/// Runs all cases of a table, fails with every deviation, and returns their number.
fn collection(peer: &str, program: &str) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers");
    let mut table = csv::Reader::from_path(folder.join(format!("{peer}.csv"))).unwrap();
    let mut broken = String::new();
    let mut count = 0;
    for row in table.records() {
        let row = row.unwrap();
        let [case, model, set, outputs, reference, tolerance, source, reason] =
            std::array::from_fn(|column| &row[column]);
        let given = set.split(';').filter_map(|one| one.split_once('='));
        let model = load(&folder.join(peer).join(format!("{model}.yaml")));
        let bounds = nominal(&given.fold(model, |found, (name, value)| found.with(name, value)));
        let expected: Vec<f64> = reference.split(';').map(|number| number.parse().unwrap()).collect();
        // Accelerations of a start stand in the first row, motions in the last one.
        let row = if reason.contains("at the start") { 0 } else { bounds.times.len() - 1 };
        let found: Vec<f64> = outputs.split(';').map(|name| curve(&bounds, name)[row]).collect();
        assert_eq!(found.len(), expected.len(), "{case}");
        let apart = largest(found.iter().zip(&expected).map(|(found, expected)| found - expected));
        broken += &Case::new("collections", &format!("{program}, {case}"))
            .source(&format!("{source}; {reason}"))
            .at_most("largest difference, as a share", apart / largest(expected), tolerance.parse().unwrap())
            .write();
        count += 1;
    }
    assert!(broken.is_empty(), "\n{broken}");
    count
}

#[test]
#[ignore = "4 s"]
fn mini_examples_of_exudyn_have_its_values() {
    assert_eq!(collection("exudyn", "Exudyn"), 20);
}

#[test]
fn unit_tests_of_chrono_have_their_closed_forms() {
    assert_eq!(collection("chrono", "Chrono"), 44);
}
