//! The committed JSON Schema is that of the grammar, and the models keep to it.
//!
//! `MBINT_UPDATE_SCHEMA=1 cargo test --test program schema` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use mbint::inner::model;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn yaml_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "yaml")).collect()
}

fn validator() -> jsonschema::Validator {
    jsonschema::validator_for(&serde_json::from_str(&model::schema()).unwrap()).unwrap()
}

#[test]
fn the_committed_schema_is_current() {
    let path = root().join("schemas/mbint.schema.json");
    let current = model::schema();
    if std::env::var_os("MBINT_UPDATE_SCHEMA").is_some() {
        fs::write(&path, &current).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap();
    assert!(committed == current, "write it anew: MBINT_UPDATE_SCHEMA=1 cargo test --test program schema");
}

#[test]
fn the_models_keep_to_the_schema_and_name_it() {
    let validator = validator();
    let paths = yaml_files("models");
    assert!(!paths.is_empty());
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let first = text.lines().next().unwrap();
        assert_eq!(first, "# yaml-language-server: $schema=../schemas/mbint.schema.json", "{}", path.display());
        let instance: serde_json::Value = serde_yaml::from_str(&text).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&instance).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
        assert!(model::load(&path, &[]).is_ok(), "{}", path.display());
    }
}

#[test]
fn the_schema_knows_wrong_keys_and_types() {
    let validator = validator();
    for name in ["unknown-key", "unknown-top-level-key", "unknown-kinds", "wrong-types", "missing-simulation"] {
        let text = fs::read_to_string(root().join(format!("tests/bad_models/{name}.yaml"))).unwrap();
        let instance: serde_json::Value = serde_yaml::from_str(&text).unwrap();
        assert!(!validator.is_valid(&instance), "{name}");
    }
    let with = |simulation: &str| {
        let text = format!("bodies: {{}}\noutputs: {{}}\nbounds: {{ taylor: }}\nsimulation: {simulation}\n");
        validator.is_valid(&serde_yaml::from_str(&text).unwrap())
    };
    assert!(with("{ duration: 2 s, step: 1e-3 }"));
    assert!(!with("{ duration: 2 s, step: }"));
    assert!(!with("{ duration: [2] }"));
}
