//! Models that were written for an older version of the language are accepted as they are; those of a version are never
//! changed.

use std::fs;
use std::path::Path;

use super::place::Place;

#[test]
fn models_of_older_versions_are_accepted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/old_models/1.0");
    let place = Place::new();
    let mut models: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    models.sort();
    assert!(models.len() >= 6);
    for model in models {
        fs::copy(&model, place.path().join("model.yaml")).unwrap();
        let (_, errors) = place.run("check model.yaml", 0);
        assert_eq!(errors, "", "{}", model.display());
        // Bounds of scenes and methods would take long; all of the language is read and compiled.
        place.run("explain model.yaml", 0);
    }
}

#[test]
fn model_of_an_older_version_keeps_its_bounds() {
    let place = Place::new();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/old_models/1.0/slider_crank.yaml");
    fs::copy(model, place.path().join("model.yaml")).unwrap();
    place.run("run model.yaml --method chebyshev -o out -q", 0);
    let table = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let columns: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let (lower, upper) = (column("x3.chebyshev.lower"), column("x3.chebyshev.upper"));
    let width = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        cells[upper].parse::<f64>().unwrap() - cells[lower].parse::<f64>().unwrap()
    };
    let widest = table.lines().skip(1).map(width).fold(0.0, f64::max);
    assert!((widest - 0.251).abs() < 1e-3, "{widest}");
}

/// The number in the schema grows with the language.
#[test]
fn the_schema_has_a_version() {
    let place = Place::new();
    let (schema, _) = place.run("schema", 0);
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    assert_eq!(schema["$comment"], "version 1.0");
    let (version, _) = place.run("--version --verbose", 0);
    let told = |line: &str| version.lines().any(|own| own.starts_with(line));
    assert!(
        told(concat!("mbint ", env!("CARGO_PKG_VERSION"))) && told("schema: 1.0") && told("instructions: "),
        "{version}"
    );
    assert_eq!(place.run("--verbose -V", 0).0, version);
}
