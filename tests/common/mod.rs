//! What the tests share: reading, running, and looking at curves.

pub mod adams;
pub mod closed_forms;
pub mod dormand_prince;
pub mod finite_elements;
pub mod measured;
pub mod power;
pub mod random;
pub mod registry;
pub mod restitution;
pub mod runge_kutta;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mbint::inner::methods::{Chebyshev, Expand, Scan};
use mbint::inner::model::{self, Description, Output, ParameterValue, SchemeChoice, Stepping};
use mbint::inner::numerics::RangeKind;
use mbint::inner::study::{self, Options};
use mbint::results::{Band, Bounds, Method, OutputBounds, Summary};
use mbint::{Model, Study};

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
pub fn model(name: &str) -> Description {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name).with_extension("yaml");
    load(&path)
}

#[track_caller]
pub fn load(path: &Path) -> Description {
    model::load(path, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// What `mbint run` runs of a file: its scenes or, where it has none, the model itself.
#[track_caller]
pub fn load_all(path: &Path) -> Vec<Description> {
    let reading = model::read(path, &[]);
    let report = reading.diagnostics.clone();
    let chosen = reading.chosen(&[]).unwrap();
    assert!(!chosen.is_empty(), "{report}");
    chosen.into_iter().map(|(_, description)| description).collect()
}

/// A model from text.
#[track_caller]
pub fn read(text: &str) -> Description {
    model::load_str("test", text, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// A model from text, as users of the library have it.
#[track_caller]
pub fn model_of(text: &str) -> Model {
    Model::from_yaml_str("test", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A study of a model from text, as users of the library ask for one.
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

/// Runs what the model asks for; nothing may fail.
#[track_caller]
pub fn run(description: &Description) -> Bounds {
    run_methods(description, None).0
}

/// Runs the nominal sample only.
#[track_caller]
pub fn nominal(description: &Description) -> Bounds {
    run_methods(description, Some(Vec::new())).0
}

#[track_caller]
pub fn run_methods(description: &Description, methods: Option<Vec<Method>>) -> (Bounds, Summary) {
    let options = Options { methods, threads: Some(2), ..Options::default() };
    let (bounds, summary) =
        study::run(description, options).unwrap_or_else(|error| panic!("{}: {error}", description.name));
    assert_eq!(summary.failure, None, "{}", description.name);
    (bounds, summary)
}

/// Changes to a description, for tests that vary one thing.
pub trait Vary {
    fn step(self, h: f64) -> Self;
    fn duration(self, duration: f64) -> Self;
    /// Its own duration, but at most this.
    fn at_most(self, duration: f64) -> Self;
    /// A row of output after every this many seconds.
    fn rows_every(self, output_step: f64) -> Self;
    fn tolerance(self, tolerance: f64) -> Self;
    /// Integrated by HHT-I3, whatever would be cheaper.
    fn by_hht(self) -> Self;
    /// These outputs instead of the model's.
    fn observing(self, formulas: &[&str]) -> Self;
    /// An uncertain parameter's interval, relative to its nominal value.
    fn uncertain(self, parameter: &str, relative: f64) -> Self;
    /// Chebyshev bounds of the expanded outputs only, of this order in every parameter.
    fn chebyshev(self, order: usize, range: RangeKind) -> Self;
    /// A scan only.
    fn scan(self, points: usize) -> Self;
}

impl Vary for Description {
    fn step(mut self, h: f64) -> Self {
        self.simulation.stepping = Stepping::Fixed(h);
        self
    }

    fn duration(mut self, duration: f64) -> Self {
        self.simulation.duration = duration;
        self
    }

    fn at_most(mut self, duration: f64) -> Self {
        self.simulation.duration = self.simulation.duration.min(duration);
        self
    }

    fn rows_every(mut self, output_step: f64) -> Self {
        self.simulation.output_step = output_step;
        self
    }

    fn tolerance(mut self, tolerance: f64) -> Self {
        self.simulation.stepping = Stepping::Tolerance(tolerance);
        self
    }

    fn by_hht(mut self) -> Self {
        self.simulation.scheme = SchemeChoice::Hht;
        self
    }

    fn observing(mut self, formulas: &[&str]) -> Self {
        let output = |formula: &&str| Output {
            name: (*formula).to_owned(),
            formula: symdiff::Formula::parse(formula).unwrap(),
            unit: String::new(),
            dimension: None,
            of_results: false,
        };
        self.outputs = formulas.iter().map(output).collect();
        self
    }

    fn uncertain(mut self, parameter: &str, relative: f64) -> Self {
        let found = self.parameters.iter_mut().find(|known| known.name == parameter).unwrap();
        let ParameterValue::Interval { nominal, .. } = found.value else { panic!("{parameter} is deterministic") };
        let half = relative * nominal.abs();
        found.value = ParameterValue::Interval { nominal, lower: nominal - half, upper: nominal + half };
        self
    }

    fn chebyshev(mut self, order: usize, range: RangeKind) -> Self {
        let order = Chebyshev::of_order(order, uncertain_count(&self));
        let request = Chebyshev { expand: Expand::Output, range, ..order };
        self.bounds = mbint::inner::methods::BoundsRequest { chebyshev: Some(request), ..Default::default() };
        self
    }

    fn scan(mut self, points: usize) -> Self {
        let request = Scan::of_points(points, uncertain_count(&self));
        self.bounds = mbint::inner::methods::BoundsRequest { scan: Some(request), ..Default::default() };
        self
    }
}

pub fn uncertain_count(description: &Description) -> usize {
    let uncertain = |parameter: &&model::Parameter| matches!(parameter.value, ParameterValue::Interval { .. });
    description.parameters.iter().filter(uncertain).count()
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

/// Largest absolute value; NaN where there is one.
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
