//! A model under test, and the questions of a test about it.

use std::sync::Arc;

use mbint::results::{Bounds, Summary};
use mbint::{Formulation, Method, Model, RangeKind, SchemeChoice, Study};

type Ask = Arc<dyn Fn(Study<'static>) -> Study<'static> + Send + Sync>;

/// A model with a test's changes of its study, for tests that vary one thing.
#[derive(Clone)]
pub struct Subject {
    pub model: Model,
    asked: Vec<Ask>,
    /// Names of its outputs, if a test chose them by their formulas.
    formulas: Vec<String>,
}

impl From<Model> for Subject {
    fn from(model: Model) -> Self {
        Self { model, asked: Vec::new(), formulas: Vec::new() }
    }
}

impl Subject {
    pub fn name(&self) -> &str {
        self.model.name()
    }

    /// Adds a setting of its study, after all others.
    pub fn asking(mut self, ask: impl Fn(Study<'static>) -> Study<'static> + Send + Sync + 'static) -> Self {
        self.asked.push(Arc::new(ask));
        self
    }

    pub fn step(self, h: f64) -> Self {
        self.asking(move |study| study.step(h))
    }

    pub fn duration(self, duration: f64) -> Self {
        self.asking(move |study| study.duration(duration))
    }

    /// Its own duration, but at most this.
    pub fn at_most(self, duration: f64) -> Self {
        let duration = self.model.duration().min(duration);
        if duration > 0.0 { self.duration(duration) } else { self }
    }

    /// A row of output after every this many seconds.
    pub fn rows_every(self, output_step: f64) -> Self {
        self.asking(move |study| study.output_step(output_step))
    }

    /// Steps of any length, within a tolerance.
    pub fn tolerance(self, tolerance: f64) -> Self {
        self.asking(move |study| study.step_tolerance(tolerance))
    }

    pub fn formulation(self, formulation: Formulation) -> Self {
        self.asking(move |study| study.formulation(formulation))
    }

    pub fn scheme(self, scheme: SchemeChoice) -> Self {
        self.asking(move |study| study.scheme(scheme))
    }

    pub fn extrapolation(self, levels: usize) -> Self {
        self.asking(move |study| study.extrapolation(levels))
    }

    /// Integrates by HHT-I3, even if another scheme is cheaper.
    pub fn by_hht(self) -> Self {
        self.scheme(SchemeChoice::Hht)
    }

    /// These outputs instead of the model's, named by their formulas.
    #[track_caller]
    pub fn observing(mut self, formulas: &[&str]) -> Self {
        let plain = |formula: &str| {
            let mut letters = formula.chars();
            letters.next().is_some_and(|first| first.is_ascii_alphabetic())
                && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        let name = |(index, formula): (usize, &&str)| match plain(formula) {
            true => (*formula).to_owned(),
            false => format!("observed_{index}"),
        };
        let names: Vec<String> = formulas.iter().enumerate().map(name).collect();
        let outputs: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(formulas.iter().copied()).collect();
        self.model = self.model.observing(&outputs).unwrap_or_else(|error| panic!("{error}"));
        self.formulas = formulas.iter().map(|&formula| formula.to_owned()).collect();
        self
    }

    /// Another value of a parameter, as after `--set`.
    #[track_caller]
    pub fn with(mut self, parameter: &str, value: impl std::fmt::Display) -> Self {
        self.model = self.model.with(parameter, value).unwrap_or_else(|error| panic!("{error}"));
        self
    }

    /// An uncertain parameter's interval, relative to its nominal value.
    #[track_caller]
    pub fn uncertain(self, parameter: &str, relative: f64) -> Self {
        self.with(parameter, format!("± {}%", 100.0 * relative))
    }

    /// Adds Chebyshev bounds of the expanded outputs, of this order in every parameter.
    pub fn chebyshev(self, order: usize, range: RangeKind) -> Self {
        self.asking(move |study| study.chebyshev(order).range(range))
    }

    /// Adds Taylor bounds of this order.
    pub fn taylor(self, order: usize) -> Self {
        self.asking(move |study| study.taylor(order))
    }

    /// Adds a scan.
    pub fn scan(self, points: usize) -> Self {
        self.asking(move |study| study.scan(points))
    }

    /// Number of its uncertain parameters.
    pub fn uncertain_count(&self) -> usize {
        self.model.uncertain().count()
    }

    /// The requested study.
    pub fn study(&self) -> Study<'static> {
        self.asked.iter().fold(self.model.study().allow_costly(), |study, ask| ask(study))
    }

    /// Bounds and summary of a study of it, whether or not it reaches the end.
    #[track_caller]
    pub fn ran(&self, study: Study<'_>) -> (Bounds, Summary) {
        let (mut bounds, mut summary) = super::ran(study);
        for (output, formula) in bounds.outputs.iter_mut().zip(&self.formulas) {
            let own = std::mem::replace(&mut output.name, formula.clone());
            let named = summary.undetermined_outputs.iter_mut().filter(|name| **name == own);
            named.for_each(|name| name.clone_from(formula));
        }
        (bounds, summary)
    }

    /// Bounds and summary, on some threads, whether or not it reaches the end.
    #[track_caller]
    pub fn finished(&self, methods: Option<Vec<Method>>) -> (Bounds, Summary) {
        let study = self.study();
        self.ran(match methods {
            Some(methods) => study.methods(&methods),
            None => study,
        })
    }

    /// Why it cannot be run.
    #[track_caller]
    pub fn refused(&self) -> String {
        self.study().run().expect_err("it cannot be run").to_string()
    }

    /// Why it cannot be built or assembled.
    #[track_caller]
    pub fn unbuilt(&self) -> String {
        self.model.check().expect_err("it cannot be built").to_string()
    }
}
