//! Every file of `models/` is one that a user can run.

use mbint::results::{Bounds, Method, Summary};

use crate::common::{Subject, load, model_files};

#[test]
fn every_model_is_read_without_diagnostics() {
    for path in model_files() {
        let description = load(&path);
        let warnings = description.model.warnings();
        assert!(warnings.records().is_empty(), "{warnings}");
        let name = description.name();
        assert_eq!(path.file_stem().unwrap().to_string_lossy(), name, "a model has the name of its file");
    }
}

/// Parameters beyond which one method is enough.
const MANY: usize = 20;

/// Asserts that all requested results exist: every row of every method of every output, with ordered bounds.
pub fn assert_complete(description: &Subject, bounds: &Bounds, summary: &Summary) {
    // Bricard's loop moves because one of its constraints is implied by the others.
    let redundant = usize::from(description.name() == "bricard");
    let found = &summary.redundant_constraints;
    assert_eq!(found.len(), redundant, "{}: {found:?}", description.name());
    assert!(!summary.parameters.is_empty(), "{} has no uncertain parameter", description.name());
    let study = description.study();
    let model = study.description();
    let rows = (model.simulation.duration / model.simulation.output_step).round() as usize + 1;
    assert_eq!(bounds.times.len(), rows, "{}", description.name());
    assert_eq!(bounds.outputs.len(), model.outputs.len());
    let asked = &model.bounds;
    let all = [
        (Method::Chebyshev, asked.chebyshev.is_some()),
        (Method::Taylor, asked.taylor.is_some()),
        (Method::Scan, asked.scan.is_some()),
    ];
    let asked: Vec<Method> = all.into_iter().filter_map(|(method, asked)| asked.then_some(method)).collect();
    // With many parameters neither a scan nor jets are possible: samples are compared in a test of the model's own.
    let is_compared = asked.len() > 1 || (summary.parameters.len() > MANY && asked == [Method::Chebyshev]);
    assert!(is_compared, "{}: one method is compared with nothing", description.name());
    for output in &bounds.outputs {
        let what = format!("{}: {}", description.name(), output.name);
        let methods: Vec<Method> = output.bands.iter().map(|band| band.method).collect();
        assert_eq!(methods, asked, "{what}");
        for band in &output.bands {
            for row in 0..rows {
                // NaN is in no order.
                assert!(band.lower[row] <= band.upper[row], "{what}: {:?} in row {row}", band.method);
            }
        }
    }
}

#[test]
fn every_model_names_its_schema() {
    for path in model_files() {
        let text = std::fs::read_to_string(&path).unwrap();
        let first = text.lines().next().unwrap_or_default();
        let named = first == "# yaml-language-server: $schema=../schemas/mbint.schema.json";
        assert!(named, "{} begins with `{first}`", path.display());
    }
}
