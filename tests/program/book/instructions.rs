//! `docs/reference/instructions.md`: instructions of every shipped model, which a change that costs nothing leaves as
//! they are. They do not depend on the machine.

use std::fmt::Write;
use std::path::Path;

use mbint::inner::{model, study};

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

/// Models of the folder, and robots that are models by themselves.
fn shipped() -> Vec<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let is_model = |extension: &str| ["yaml", "urdf", "xml"].contains(&extension);
    files.retain(|file| file.extension().is_some_and(|extension| is_model(&extension.to_string_lossy())));
    files.sort();
    files
}

#[test]
fn the_instructions_of_shipped_models_are_those_of_the_page() {
    let mut page = INTRODUCTION.to_owned();
    for file in shipped() {
        let name = file.file_name().unwrap().to_string_lossy();
        let reading = model::read(&file, &[]);
        let models = reading.chosen(&[]).unwrap();
        assert!(!models.is_empty(), "{name} cannot be read");
        for (scene, description) in models {
            let explanation = study::explain(&description).unwrap_or_else(|error| panic!("{name}: {error}"));
            let called = scene.map_or_else(|| name.to_string(), |scene| format!("{name}, {scene}"));
            let (coordinates, matrix) = (explanation.coordinates.len(), explanation.newton.size);
            write!(page, "| {called} | {coordinates} | {matrix} |").unwrap();
            for (_, _, count) in explanation.instructions.stages() {
                write!(page, " {count} |").unwrap();
            }
            page.push('\n');
        }
    }
    expect_page(&docs().join("reference/instructions.md"), &page);
}
