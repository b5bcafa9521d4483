//! `docs/reference/instructions.md`: instructions of every shipped model, which a change that costs nothing leaves as
//! they are. They do not depend on the machine. A step that costs more than in the last row of the performance record
//! is reported.

use std::fmt::Write;
use std::path::Path;

use mbint::Model;

use super::{docs, expect_page};

const INTRODUCTION: &str = "# Instructions of the shipped models

Instructions of a step of each model in `models/`, as `mbint explain` counts them, with all conditional effects active;
of a model with scenes, those of each scene. A step takes those of *step*, of *factor* and *first correction* where the
Newton matrix is factored, else of *correct*, and of *advance*; *sample* is run once a sample, *step size* once a step
size, and *observe* once a row of output. They do not depend on the machine. A test compares them: a change of this page
is a change of cost, and of bits.

| model | coordinates | Newton matrix | sample | step size | step | factor | first correction | correct | advance | observe |
| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |
";

/// Stages of a step with one factorisation, as the performance record has them.
const OF_A_STEP: [&str; 4] = ["step", "factor", "first correction", "advance"];

/// Models of the folder, and robots that are models by themselves.
fn shipped() -> Vec<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let is_model = |extension: &str| ["yaml", "urdf", "xml"].contains(&extension);
    files.retain(|file| file.extension().is_some_and(|extension| is_model(&extension.to_string_lossy())));
    files.sort();
    files
}

/// Largest ratio of a step's instructions to those of the last row of `docs/performance/record.csv`.
const MOST: f64 = 1.02;

/// Models whose step costs more than in the last row of the record allows, with both counts. Models that the row has
/// not are new.
fn regressions(record: &str, steps: &[(String, usize)]) -> Vec<String> {
    let mut table = csv::Reader::from_reader(record.as_bytes());
    let columns = table.headers().unwrap().clone();
    let last = table.records().last().expect("the record has a row").unwrap();
    let recorded = |model: &str| {
        let column = format!("instructions {}", model.replace(',', ""));
        last.get(columns.iter().position(|own| own == column)?)?.parse::<f64>().ok()
    };
    let worse = steps.iter().filter_map(|(model, count)| {
        let recorded = recorded(model)?;
        (*count as f64 > MOST * recorded)
            .then(|| format!("{model}: {count} instructions a step, {recorded} in the record"))
    });
    worse.collect()
}

#[test]
fn regressions_are_found() {
    let record = "version,instructions a.yaml,instructions b.yaml x\n0.1.0,10,\n0.2.0,100,200\n";
    let of = |a, b| {
        regressions(record, &[("a.yaml".to_owned(), a), ("b.yaml, x".to_owned(), b), ("new.yaml".to_owned(), 9)])
    };
    assert_eq!(of(102, 204), Vec::<String>::new());
    assert_eq!(of(103, 200), ["a.yaml: 103 instructions a step, 100 in the record"]);
    assert_eq!(of(50, 205), ["b.yaml, x: 205 instructions a step, 200 in the record"]);
}

#[test]
fn instructions_of_shipped_models_match_the_page() {
    let mut page = INTRODUCTION.to_owned();
    let mut steps = Vec::new();
    for file in shipped() {
        let name = file.file_name().unwrap().to_string_lossy();
        let model = Model::from_file(&file).unwrap_or_else(|error| panic!("{error}"));
        let scenes: Vec<String> = model.scenes().map(str::to_owned).collect();
        let scenes: Vec<Option<String>> =
            if scenes.is_empty() { vec![None] } else { scenes.into_iter().map(Some).collect() };
        for scene in scenes {
            let model = scene.iter().fold(model.clone(), |model, scene| model.scene(scene).unwrap());
            let explanation = model.study().explain().unwrap_or_else(|error| panic!("{name}: {error}"));
            let called = scene.map_or_else(|| name.to_string(), |scene| format!("{name}, {scene}"));
            let (coordinates, matrix) = (explanation.coordinates.len(), explanation.newton.size);
            write!(page, "| {called} | {coordinates} | {matrix} |").unwrap();
            let mut step = 0;
            for (stage, _, count) in explanation.instructions.stages() {
                write!(page, " {count} |").unwrap();
                step += if OF_A_STEP.contains(&stage) { count } else { 0 };
            }
            page.push('\n');
            steps.push((called, step));
        }
    }
    expect_page(&docs().join("reference/instructions.md"), &page);
    let worse = regressions(&std::fs::read_to_string(docs().join("performance/record.csv")).unwrap(), &steps);
    assert!(
        worse.is_empty(),
        "steps cost over 2 % more than in the last row of docs/performance/record.csv. Where that is the price of something, the commit says so, and \
         `cargo xtask bench` writes the row again:\n{}",
        worse.join("\n")
    );
}
