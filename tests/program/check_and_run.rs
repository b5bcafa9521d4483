//! `mbint check` accepts the models that `mbint run` begins to simulate, and refuses the others with the same words:
//! every model, every example of the documents, and every model with an error.

use std::fs;
use std::path::{Path, PathBuf};

use mbint::{Error, Model};

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
fn begins(model: &Model) -> Result<(), Error> {
    model.study().interrupted(&|| true).run().map(drop)
}

#[test]
#[ignore = "5 s"]
fn check_and_run_refuse_the_same_models_equally() {
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
#[ignore = "5 s"]
fn check_and_run_accept_the_same_models() {
    for path in files("models").into_iter().chain(files("docs/examples")) {
        let shown = path.display();
        let model = Model::from_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let (ready, begun) = (model.check(), begins(&model));
        assert!(ready.is_ok() && begun.is_ok(), "{shown}: {ready:?} {begun:?}");
    }
}

/// Nothing that moves, nothing that is uncertain, one row, no output: through every analysis, by every command that
/// simulates. Each ends as documented, with a result or with a message, and with no error of the program.
#[test]
fn empty_models_pass_every_stage() {
    let place = Place::new();
    let bodies = [
        "bodies: { b: { mass: m, inertia: 1 } }\njoints: { w: { fixed: [ground, b] } }\n",
        "bodies: { b: { mass: m, coordinates: [x] } }\neffects: { s: { spring_damper: { between: [ground, b], along: x, \
         stiffness: 10, damping: 1, free_length: 0 } } }\n",
        "bodies: { b: { mass: m, inertia: 1 } }\njoints: { h: { revolute: [ground, b] }, d: { motor: { on: h, position: 0*t } } }\n",
    ];
    let outputs = [
        "outputs: {}\n",
        "outputs: { c: m }\n",
        "outputs: { z: 0*m, peak: { max: z } }\nrequirements: { r: z <= 1 }\n",
    ];
    let asked = [
        "bounds: { chebyshev: { order: 1 }, taylor: { order: 1 }, scan: { points: 2 } }\n",
        "bounds: { tolerance: 1e-2 }\n",
        "statistics: { quantiles: [0.5] }\nbounds: { chebyshev: { order: 1 } }\n",
    ];
    let times = [
        "simulation: { duration: 1e-2, step: 1e-2 }\n",
        "simulation: { duration: 1e-2, tolerance: 1e-4, output_step: 1e-2 }\n",
    ];
    for (number, analysis) in ["motion", "kinematics", "statics", "modes"].into_iter().enumerate() {
        for (bodies, outputs) in bodies.iter().flat_map(|bodies| outputs.iter().map(move |outputs| (bodies, outputs))) {
            for (asked, parameter) in asked.iter().flat_map(|asked| [(asked, "1 kg ± 1%"), (asked, "1 kg")]) {
                let mut text = format!("model: x\nparameters: {{ m: {parameter} }}\n{bodies}{outputs}{asked}");
                text += match analysis {
                    "motion" => times[number % 2],
                    "kinematics" => times[0],
                    _ => "",
                };
                if analysis != "motion" {
                    text += &format!("analysis: {analysis}\n");
                }
                if analysis == "modes" {
                    text += "modes: { number: 1 }\n";
                }
                fs::write(place.path().join("x.yaml"), &text).unwrap();
                ends_as_documented(&place, &text);
            }
        }
    }
}

#[track_caller]
fn ends_as_documented(place: &Place, text: &str) {
    let [check, run] = ["check x.yaml", "run -q --no-report x.yaml -o out"].map(|command| {
        let done = place.command(command).output().unwrap();
        let told = String::from_utf8(done.stderr).unwrap();
        assert!(!told.contains("internal error") && !told.contains("panicked"), "{command}\n{text}\n{told}");
        assert!(matches!(done.status.code(), Some(0 | 2 | 3 | 4)), "{command}: {:?}\n{text}\n{told}", done.status);
        done.status.code() == Some(2)
    });
    assert_eq!(check, run, "refused by one of them\n{text}");
}
