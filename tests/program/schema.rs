//! The committed JSON Schema is that of the grammar, and the models keep to it.
//!
//! `MBINT_UPDATE_SCHEMA=1 cargo test --test program schema` writes it, and `tests/program/only_semantics.txt`: the bad
//! models whose errors the schema cannot see.

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
fn models_satisfy_the_schema_and_refer_to_it() {
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

/// The schema accepts all that the reader accepts, texts outside of the shipped folder included.
#[test]
fn schema_accepts_all_readable_models() {
    let validator = validator();
    let examples = yaml_files("docs/examples")
        .into_iter()
        .map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap()));
    // Bodies without mass in an assembly, the unit of a number, units in the table of a law.
    let own = [
        "analysis: kinematics
assemblies: { arm: { bodies: { bar: { points: { A: [0, 0], B: [0.3, 0] } } } } }
instances: { one: { of: arm } }
joints: { hinge: { revolute: [ground, one.bar.A] }, drive: { motor: { on: hinge, speed: 1 } } }
outputs: { angle: { formula: one.bar.angle*180/pi, unit: 1 } }
simulation: { duration: 1 }
",
        "tables: { lift: { points: [[0, 0], [90, 0.5], [180, 2]], units: [deg, 1] } }
parameters:
  mass: { value: 2, unit: kg, interval: [1, 3], distribution: { table: [[1 kg, 0], [2000 g, 1.5], [3, 0]] } }
  ratio: { value: 0.5, unit: 1, tolerance: 10% }
bodies: { block: { mass: mass, coordinates: [x] } }
effects: { push: { force: { on: block, value: [lift(t*(1 rad/s))*ratio*(1 N), 0] } } }
outputs: { x: block.x }
simulation: { duration: 1 }
bounds: { chebyshev: { order: 3 } }
",
    ];
    let own = own.iter().enumerate().map(|(index, text)| (format!("own model {index}"), (*text).to_owned()));
    for (name, text) in examples.chain(own) {
        let instance = as_json(&text).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&instance).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(errors.is_empty(), "{name}: {errors:#?}");
        if name.starts_with("own") {
            let read = model::read_str(&name, &text, &[]);
            assert!(!read.diagnostics.has_errors(), "{name}: {}", read.diagnostics.render(false));
        }
    }
}

/// The file as an editor reads it; `None` if it is no YAML that can be JSON.
fn as_json(text: &str) -> Option<serde_json::Value> {
    serde_yaml::from_str(text).ok()
}

/// The reader refuses everything that the schema refuses; the list has the bad models that only the reader refuses.
#[test]
#[ignore = "2 s"]
fn only_semantics_is_beyond_the_schema() {
    let validator = validator();
    let mut list = String::new();
    let mut paths = yaml_files("tests/bad_models");
    paths.sort();
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let Some(instance) = as_json(&text) else { continue };
        let diagnostics = model::read(&path, &[]).diagnostics;
        if !validator.is_valid(&instance) {
            assert!(diagnostics.has_errors(), "{}: only the schema refuses it", path.display());
        } else if diagnostics.has_errors() {
            let name = path.file_stem().unwrap().to_string_lossy();
            let first =
                diagnostics.records().into_iter().find(|record| format!("{:?}", record.severity) == "Error").unwrap();
            list += &format!("{name}: {}\n", first.message.lines().next().unwrap_or_default());
        }
    }
    let path = root().join("tests/program/only_semantics.txt");
    if std::env::var_os("MBINT_UPDATE_SCHEMA").is_some() {
        fs::write(&path, &list).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == list, "write it anew: MBINT_UPDATE_SCHEMA=1 cargo test --test program schema\n{list}");
}

/// Every value of every model is replaced by possible mistakes: where the schema refuses, the reader does.
#[test]
#[ignore = "10 s"]
fn schema_refuses_no_readable_model() {
    let validator = validator();
    let others = ["-1", "0", "0.5", "2", "\"-3 m\"", "text", "[1, 2]", "{}", "-0.05"];
    let mut refused = 0;
    for path in yaml_files("models") {
        let text = fs::read_to_string(&path).unwrap();
        let whole = as_json(&text).unwrap();
        if whole.get("scenes").is_some() || text.len() > 6000 {
            continue;
        }
        // A text that looks like a number is a text for the reader.
        let texts = ["/model", "/description", "/units/0", "/units/1"];
        for pointer in leaves(&whole).into_iter().filter(|leaf| !texts.iter().any(|end| leaf.ends_with(end))) {
            for other in others {
                let mut changed = whole.clone();
                *changed.pointer_mut(&pointer).unwrap() = as_json(other).unwrap();
                if validator.is_valid(&changed) {
                    continue;
                }
                refused += 1;
                let written = serde_yaml::to_string(&changed).unwrap();
                let read = model::read_str(&path.display().to_string(), &written, &[]);
                assert!(read.diagnostics.has_errors(), "{}: {pointer} = {other} is refused", path.display());
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

/// Places of all scalars.
fn leaves(value: &serde_json::Value) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![(String::new(), value)];
    while let Some((pointer, value)) = open.pop() {
        match value {
            serde_json::Value::Object(object) => open.extend(
                object
                    .iter()
                    .map(|(key, value)| (format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1")), value)),
            ),
            serde_json::Value::Array(items) => {
                open.extend(items.iter().enumerate().map(|(index, value)| (format!("{pointer}/{index}"), value)));
            }
            _ => found.push(pointer),
        }
    }
    found
}

#[test]
fn schema_checks_ranges_and_exclusive_keys() {
    let validator = validator();
    let valid = |text: &str| validator.is_valid(&as_json(text).unwrap());
    let bar = "
parameters: { l: { value: 0.2, unit: m, tolerance: 1% } }
bodies: { bar: { mass: 1, inertia: 0.1, points: { A: [l, 0] } } }
joints: { j: { revolute: [ground, bar.A] }, m: { motor: { on: j, speed: 60 rpm } } }
effects: { d: { drag: { on: bar, linear: 2 } } }
outputs: { a: bar.angle }
simulation: { duration: 1, step: 1e-3, alpha: -0.2 }
bounds: { scan: { points: 3 }, chebyshev: { order: 4 } }
";
    assert!(valid(bar));
    for (good, bad) in [
        ("points: 3", "points: 0"),
        ("points: 3", "points: { l: 1 }"),
        ("order: 4", "order: 0"),
        ("order: 4", "order: 100000"),
        ("alpha: -0.2", "alpha: 0.5"),
        ("alpha: -0.2", "alpha: 0"),
        ("alpha: -0.2", "alpha: -0.4"),
        ("duration: 1", "duration: -1"),
        ("duration: 1", "duration: -1 s"),
        ("duration: 1", "duration: 0"),
        ("step: 1e-3", "step: -1 ms"),
        ("step: 1e-3", "step: 1e-3, tolerance: 1e-4"),
        ("speed: 60 rpm", "from: 2"),
        ("speed: 60 rpm", "speed: 60 rpm, position: t"),
        ("speed: 60 rpm", "to: 90 deg"),
        ("mass: 1, ", ""),
        ("inertia: 0.1, ", ""),
        ("mass: 1, ", "mass: -1, "),
        ("mass: 1, ", "mass: -1 kg, "),
        ("tolerance: 1%", "tolerance: -1%"),
        ("tolerance: 1%", "tolerance: 1%, interval: [0, 1]"),
        ("tolerance: 1%", "tolerance: 1%, plus: 1"),
        ("speed: 60 rpm", "to: 1, profile: quintic, duration: -1"),
        ("speed: 60 rpm", "to: 1, profile: quintic, duration: -1 s"),
        ("outputs: { a: bar.angle }", "outputs: {}"),
        ("outputs: { a: bar.angle }", ""),
        ("bodies: {", "bodies: { ground: { mass: 1 },"),
        ("bounds: {", "limits: { impact: { stiffness: 1e6 } }\nbounds: {"),
        ("bodies: {", "model: a/b\nbodies: {"),
    ] {
        let text = bar.replacen(good, bad, 1);
        assert_ne!(text, bar, "{bad}");
        assert!(!valid(&text), "{bad}");
        assert!(model::read_str("x.yaml", &text, &[]).diagnostics.has_errors(), "{bad}");
    }
    for (good, other) in [
        ("tolerance: 1%", "tolerance: +1% -2%"),
        ("{ value: 0.2, unit: m, tolerance: 1% }", "0.2 m ± 1%"),
        ("{ value: 0.2, unit: m, tolerance: 1% }", "[0.1, 0.2]"),
        ("{ value: 0.2, unit: m, tolerance: 1% }", "{ interval: \"[1, 2] mm\" }"),
        ("mass: 1, ", "mass: 5*l, "),
        ("duration: 1", "duration: 2 - 1"),
        ("bar.A", "bar"),
        ("mass: 1, inertia: 0.1", "inertia: 0.1, coordinates: [angle]"),
    ] {
        let text = bar.replacen(good, other, 1);
        assert!(valid(&text), "{other}");
    }
}

#[test]
fn schema_refuses_wrong_keys_and_types() {
    let validator = validator();
    for name in ["unknown-key", "unknown-top-level-key", "unknown-kinds", "wrong-types", "missing-simulation"] {
        let text = fs::read_to_string(root().join(format!("tests/bad_models/{name}.yaml"))).unwrap();
        let instance: serde_json::Value = serde_yaml::from_str(&text).unwrap();
        assert!(!validator.is_valid(&instance), "{name}");
    }
    let with = |simulation: &str| {
        let text = format!(
            "bodies: {{ b: {{ mass: 1, inertia: 1 }} }}\noutputs: {{ x: b.x }}\nbounds: {{ taylor: }}\nsimulation: {simulation}\n"
        );
        validator.is_valid(&serde_yaml::from_str(&text).unwrap())
    };
    assert!(with("{ duration: 2 s, step: 1e-3 }"));
    assert!(!with("{ duration: 2 s, step: }"));
    assert!(!with("{ duration: [2] }"));
}
