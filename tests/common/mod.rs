//! Shared by the tests: reading, running, and comparing curves.

pub mod adams;
pub mod closed_forms;
pub mod dop853;
pub mod dormand_prince;
pub mod finite_elements;
pub mod measured;
pub mod power;
pub mod random;
pub mod registry;
pub mod restitution;
pub mod runge_kutta;
mod subject;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mbint::results::{Band, Bounds, Method, OutputBounds, Summary};
use mbint::{Model, Study};

pub use subject::Subject;

/// The files of `models/`, in alphabetical order.
pub fn model_files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
        .collect();
    paths.sort();
    assert!(!paths.is_empty(), "models/ holds no models");
    paths
}

/// The model of this name in `models/`.
#[track_caller]
pub fn model(name: &str) -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name).with_extension("yaml");
    load(&path)
}

#[track_caller]
pub fn load(path: &Path) -> Subject {
    Model::from_file(path).unwrap_or_else(|error| panic!("{error}")).into()
}

/// Subjects of `mbint run` on a file: its scenes or, if it has none, the model itself.
#[track_caller]
pub fn load_all(path: &Path) -> Vec<Subject> {
    let whole = load(path);
    let scene = |name: &str| whole.model.clone().scene(name).unwrap_or_else(|error| panic!("{error}")).into();
    let scenes: Vec<Subject> = whole.model.scenes().map(scene).collect();
    if scenes.is_empty() { vec![whole] } else { scenes }
}

/// A model from text.
#[track_caller]
pub fn read(text: &str) -> Subject {
    model_of(text).into()
}

/// A model from text whose parameters stand in the opposite order, each on a line.
#[track_caller]
pub fn with_reversed_parameters(text: &str) -> Subject {
    let (before, section) = text.split_once("\nparameters:\n").unwrap();
    let end = section.split_inclusive('\n').take_while(|line| line.starts_with(' ')).map(str::len).sum();
    let (own, after) = section.split_at(end);
    let lines: Vec<&str> = own.lines().rev().collect();
    assert!(lines.len() > 1, "{own}");
    read(&format!("{before}\nparameters:\n{}\n{after}", lines.join("\n")))
}

/// A model from text, as users of the library have it.
#[track_caller]
pub fn model_of(text: &str) -> Model {
    Model::from_yaml_str("test", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A study of a model from text, as users of the library make one.
#[track_caller]
pub fn study_of(text: &str) -> Study<'static> {
    model_of(text).study().allow_costly()
}

/// Bounds and summary of a study that can be run, whether or not it reaches the end.
#[track_caller]
pub fn ran(study: Study<'_>) -> (Bounds, Summary) {
    let result = study.threads(2).run().unwrap_or_else(|error| panic!("{error}"));
    (result.bounds().clone(), result.summary().clone())
}

/// Why a study of a model from text cannot be run.
#[track_caller]
pub fn refused(text: &str) -> String {
    study_of(text).run().expect_err("it cannot be run").to_string()
}

/// Runs all requested methods; none may fail.
#[track_caller]
pub fn run(subject: &Subject) -> Bounds {
    run_methods(subject, None).0
}

/// Runs the nominal sample only.
#[track_caller]
pub fn nominal(subject: &Subject) -> Bounds {
    run_methods(subject, Some(Vec::new())).0
}

/// Runs these methods, or the requested ones; nothing may fail.
#[track_caller]
pub fn run_methods(subject: &Subject, methods: Option<Vec<Method>>) -> (Bounds, Summary) {
    let (bounds, summary) = subject.finished(methods);
    assert_eq!(summary.failure, None, "{}", subject.name());
    (bounds, summary)
}

/// An output by its name.
#[track_caller]
pub fn output<'b>(bounds: &'b Bounds, name: &str) -> &'b OutputBounds {
    bounds.outputs.iter().find(|output| output.name == name).unwrap_or_else(|| panic!("no output {name}"))
}

/// An output's nominal course.
#[track_caller]
pub fn curve<'b>(bounds: &'b Bounds, name: &str) -> &'b [f64] {
    &output(bounds, name).nominal
}

/// A method's band of an output.
#[track_caller]
pub fn band(output: &OutputBounds, method: Method) -> &Band {
    output.bands.iter().find(|band| band.method == method).unwrap()
}

/// Largest absolute value; NaN if any value is NaN.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger =
        |largest: f64, value: f64| if largest.is_nan() || value.abs() <= largest { largest } else { value.abs() };
    values.into_iter().fold(0.0, larger)
}

/// Largest difference of two curves.
#[track_caller]
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    largest(a.iter().zip(b).map(|(a, b)| a - b))
}

/// Largest difference of a curve from a function of time.
pub fn distance_from(times: &[f64], curve: &[f64], exact: impl Fn(f64) -> f64) -> f64 {
    largest(times.iter().zip(curve).map(|(&t, value)| value - exact(t)))
}

/// The step that ends at a time.
pub fn row(bounds: &Bounds, time: f64) -> usize {
    let row = bounds.times.iter().position(|&t| (t - time).abs() < 1e-9);
    row.unwrap_or_else(|| panic!("no row at {time} s"))
}

/// Observed order of convergence from the errors at h and h/2.
pub fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// Extrapolates two curves of a second-order scheme, at h and h/2, to h = 0.
pub fn richardson(coarse: &[f64], fine: &[f64]) -> Vec<f64> {
    coarse.iter().zip(fine).map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0).collect()
}

/// Asserts on all cases at once, so that one failing run shows every number.
#[derive(Default)]
pub struct Findings(String);

impl Findings {
    pub fn check(&mut self, fine: bool, what: std::fmt::Arguments) {
        if !fine {
            writeln!(self.0, "{what}").unwrap();
        }
    }

    /// A case of the verification report.
    pub fn note(&mut self, case: measured::Case) {
        self.0 += &case.write();
    }

    #[track_caller]
    pub fn none(self) {
        assert!(self.0.is_empty(), "\n{}", self.0);
    }
}

/// Rows of a committed file of reference results; `tests/reference/README.md` says how each was made.
#[track_caller]
pub fn reference(file: &str) -> Vec<Vec<f64>> {
    rows(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(file))
}

/// The folder of results and robots that other projects published; tests that need it are ignored unless asked for.
pub fn third_party() -> PathBuf {
    std::env::var_os("MBINT_REFERENCE").expect("MBINT_REFERENCE names the folder of third-party results").into()
}

/// Rows of numbers below a line of names; `#` begins a comment.
#[track_caller]
pub fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let rows: Vec<_> =
        lines.map(|line| line.split([',', '\t']).map(|field| field.parse().unwrap()).collect()).collect();
    assert!(!rows.is_empty(), "{} has no rows", path.display());
    rows
}
