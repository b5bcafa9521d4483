//! The committed JSON Schema is that of the grammar, and the models keep to it.
//!
//! `MBINT_UPDATE_SCHEMA=1 cargo test --test schema` writes it.

use std::fs;
use std::path::{Path, PathBuf};

use mbint::model;

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
    assert!(committed == current, "write it anew: MBINT_UPDATE_SCHEMA=1 cargo test --test schema");
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

/// `docs/reference/joints.md`, from the joints' own files.
fn page_of_joints() -> String {
    let mut page = "# Joints\n\nMade from the joints' own files: `MBINT_UPDATE_SCHEMA=1 cargo test --test schema` writes it, and \
        `mbint explain --joints` prints the same.\nKeys marked with * are required.\n\n\
        A is the first point of `between`, B the second; r is a position in the ground's frame, e the vector part of the\n\
        rotation of the second point's frame against the first's. The equations of motion are M w = Q − Φ_qᵀ λ.\n\
        The outputs `joint.force` (its magnitude), `joint.force.x`, …, N, and `joint.torque`, `joint.torque.x`, …, N m, are the\n\
        reaction on the second body in the ground's axes, the torque about B; the first body has the opposite at the same place.\n\
        Joints that turn have `angle` (rad), `angular_velocity` and `angular_acceleration` about their axis; joints that slide have\n\
        `displacement` (m), `velocity` and `acceleration` along it: of the second frame against the first.\n"
        .to_owned();
    for joint in mbint::elements::JointKind::docs() {
        let docs = joint.element;
        page += &format!("\n## {}\n\n{}\n\n```text\n{}\n```\n\n", docs.keyword, docs.description, docs.formulas.join("\n"));
        if !docs.keys.is_empty() {
            page += "| key | |\n|---|---|\n";
            for key in &docs.keys {
                let star = if key.required { " *" } else { "" };
                page += &format!("| `{}`{star} | {} |\n", key.name, key.description);
            }
            page.push('\n');
        }
        page += "| constraint | residual | multiplier λ |\n|---|---|---|\n";
        for row in joint.rows {
            let name = if row.name.is_empty() { "the joint's own".to_owned() } else { format!("`{}`", row.name) };
            page += &format!("| {name} | {} | {} |\n", row.unit, row.multiplier.replace('|', "\\|"));
        }
        page += &format!("\nExample: `{}: {}`. Source: {}.\n", docs.keyword, docs.example, docs.source.trim_end_matches('.'));
    }
    page
}

#[test]
fn the_page_of_joints_is_current() {
    let path = root().join("docs/reference/joints.md");
    let current = page_of_joints();
    if std::env::var_os("MBINT_UPDATE_SCHEMA").is_some() {
        fs::write(&path, &current).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == current, "write it anew: MBINT_UPDATE_SCHEMA=1 cargo test --test schema");
}
