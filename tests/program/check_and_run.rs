//! `mbint check` accepts the models that `mbint run` begins to simulate, and refuses the others with the same words:
//! every model, every example of the documents, and every model with an error.

use std::fs;
use std::path::{Path, PathBuf};

use mbint::inner::study::{self, Options};
use mbint::inner::{model, model::Description};

use crate::place::Place;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let is_model = |path: &PathBuf| {
        path.extension().is_some_and(|extension| ["yaml", "urdf", "xml"].iter().any(|known| extension == *known))
    };
    let mut files: Vec<PathBuf> = entries.filter(is_model).collect();
    files.sort();
    files
}

/// Goes up to the first step and no further.
fn begins(description: &Description) -> Result<(), String> {
    let options = Options { interrupted: &|| true, costly: false, ..Options::default() };
    study::run(description, options).map(drop).map_err(|error| error.to_string())
}

#[test]
fn both_refuse_the_same_models_with_the_same_words() {
    let place = Place::new();
    let mut refused = 0;
    for path in files("tests/bad_models") {
        let path = path.display();
        let [check, run] = ["check", "run -q --no-report"].map(|command| {
            let done = place.command(&format!("{command} {path}")).output().unwrap();
            (done.status.code(), String::from_utf8(done.stderr).unwrap())
        });
        if check.0 == Some(2) {
            assert_eq!(check, run, "{path}");
            refused += 1;
        } else {
            assert_eq!((check.0, run.0 == Some(2)), (Some(0), false), "{path}: {} {}", check.1, run.1);
        }
        assert!(!run.1.contains("internal error"), "{path}: {}", run.1);
    }
    assert!(refused > 150, "{refused}");
}

#[test]
fn both_accept_the_same_models() {
    for path in files("models").into_iter().chain(files("docs/examples")) {
        let shown = path.display();
        let description = model::load(&path, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let (ready, begun) = (study::ready(&description).map(drop), begins(&description));
        assert!(ready.is_ok() && begun.is_ok(), "{shown}: {ready:?} {begun:?}");
    }
}
