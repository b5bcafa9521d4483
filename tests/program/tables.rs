//! Tables of sweeps, allocations and statistics as they were last reviewed: `snapshots/tables/`, in four digits,
//! without errors.
//!
//! `INSTA_UPDATE=always cargo test --test program tables` takes changes over.

use std::fs;
use std::path::Path;

use super::place::Place;

/// Smaller values are rounding.
const ROUNDING: f64 = 1e-9;

/// A table in four digits, without columns of errors, which search by samples.
fn rounded(table: &str) -> String {
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let kept: Vec<usize> = (0..header.len()).filter(|&column| !header[column].ends_with(".error")).collect();
    let number = |text: &str| match text.parse::<f64>() {
        Ok(value) if value.abs() < ROUNDING => "0".to_owned(),
        Ok(value) => format!("{value:.3e}"),
        Err(_) => text.to_owned(),
    };
    let mut rows = vec![kept.iter().map(|&column| header[column].to_owned()).collect::<Vec<_>>()];
    rows.extend(lines.map(|row| kept.iter().map(|&column| number(row[column])).collect()));
    rows.iter().map(|row| row.join(",") + "\n").collect()
}

/// The example of the guide to statistics.
const STATISTICS: &str = include_str!("../../docs/examples/statistics.yaml");

#[track_caller]
fn assert_table(name: &str, arguments: &str, status: i32, file: &str) {
    let place = Place::new();
    fs::write(place.path().join("stack.yaml"), STATISTICS).unwrap();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples").display().to_string();
    place.run(&format!("{} --quiet --output out", arguments.replace("EXAMPLES", &model)), status);
    let table = fs::read_to_string(place.path().join("out").join(file)).unwrap();
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots/tables");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_description(format!("mbint {arguments}: {file}"));
    settings.bind(|| insta::assert_snapshot!(name, rounded(&table)));
}

#[test]
fn the_page_shows_the_example() {
    assert!(include_str!("../../docs/guides/statistics.md").contains(STATISTICS));
}

#[test]
fn sweep_matches_the_snapshot() {
    assert_table("sweep_one", "sweep EXAMPLES/tolerance_stack.yaml --set ring=7.95..8.05:3mm", 4, "sweep.csv");
}

#[test]
fn sweep_of_two_parameters_matches_the_snapshot() {
    assert_table(
        "sweep_two",
        "sweep EXAMPLES/tolerance_stack.yaml --set ring=7.95..8.05:3mm --set spacer=39.9..40.1:2mm",
        4,
        "sweep.csv",
    );
}

#[test]
fn allocation_matches_the_snapshot() {
    assert_table("allocation", "allocate EXAMPLES/tolerance_stack.yaml", 0, "allocation.csv");
}

#[test]
fn statistics_match_the_snapshot() {
    assert_table("statistics", "run stack.yaml", 0, "statistics.csv");
}
