//! The bounds of every file of `models/`, as they were last reviewed: `snapshots/`. They are the records of
//! `mbint snapshot`; insta is the reviewer.
//!
//! `cargo insta review` (or `INSTA_UPDATE=always cargo test --test models snapshots -- --include-ignored`) takes
//! changes over. In CI a model without a snapshot fails.

use crate::common::{load_all, model_files};
use crate::run_all::assert_complete;

/// Models whose runs take seconds.
const LONG: [&str; 4] = ["door", "half_car", "rough_road", "slider_crank_clearance"];

#[test]
fn bounds_match_the_snapshots() {
    compare(&|file| !LONG.contains(&file));
}

#[test]
#[ignore = "20 s"]
fn bounds_of_long_runs_match_the_snapshots() {
    compare(&|file| LONG.contains(&file));
}

fn compare(is_wanted: &dyn Fn(&str) -> bool) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for path in model_files() {
        let file = path.file_stem().unwrap().to_string_lossy().into_owned();
        if !is_wanted(&file) {
            continue;
        }
        for description in load_all(&path) {
            // A scene's is called `door.windy`.
            let name = description.name().replace('/', ".");
            settings.set_description(format!(
                "models/{file}.yaml{}",
                description.name().replacen(&file, "", 1).replace('/', ", scene ")
            ));
            let result = description.study().threads(2).run().unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(result.failure(), None, "{name}");
            assert_complete(&description, result.bounds(), result.summary());
            settings.bind(|| insta::assert_snapshot!(name, result.snapshot()));
        }
    }
}

#[test]
fn snapshots_belong_to_models() {
    let models: Vec<String> = model_files()
        .iter()
        .flat_map(|path| load_all(path))
        .map(|description| description.name().replace('/', "."))
        .collect();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots");
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().file_name().to_string_lossy().into_owned();
        let Some(name) = file.strip_suffix(".snap") else { continue };
        assert!(models.iter().any(|model| model == name), "snapshots/{file} belongs to no model");
    }
}
