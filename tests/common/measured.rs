//! Measurements for the verification report, which `cargo xtask verification` writes.
//!
//! With `MBINT_MEASURED=FILE` every case is a line of JSON at the end of FILE, else nothing is written. A figure is
//! written with its limits: the test asserts them, and the report compares with them.

use std::io::Write as _;

use serde_json::{Map, Value, json};

/// A case of a claim: a mechanism, a family, a target; with its figures.
pub struct Case {
    line: Map<String, Value>,
    figures: Vec<Value>,
    broken: Vec<String>,
}

impl Case {
    /// A case of a claim of `crates/xtask/src/verification/claims.rs`.
    pub fn new(claim: &str, case: &str) -> Self {
        let line = [("claim", claim), ("case", case)].map(|(key, text)| (key.to_owned(), json!(text)));
        Self { line: line.into_iter().collect(), figures: Vec::new(), broken: Vec::new() }
    }

    /// Source of the expected values.
    pub fn source(mut self, source: &str) -> Self {
        self.line.insert("source".to_owned(), json!(source));
        self
    }

    /// A figure without a limit.
    pub fn figure(mut self, name: &str, value: f64) -> Self {
        self.figures.push(json!({ "name": name, "value": value }));
        self
    }

    /// A figure in words.
    pub fn text(mut self, name: &str, text: &str) -> Self {
        self.figures.push(json!({ "name": name, "text": text }));
        self
    }

    /// A figure that is no less than a limit.
    pub fn at_least(mut self, name: &str, value: f64, low: f64) -> Self {
        self.figures.push(json!({ "name": name, "value": value, "low": low }));
        self.holds(value >= low, format!("{name}: {value:e} is not at least {low:e}"))
    }

    /// A figure that is no more than a limit.
    pub fn at_most(mut self, name: &str, value: f64, high: f64) -> Self {
        self.figures.push(json!({ "name": name, "value": value, "high": high }));
        self.holds(value <= high, format!("{name}: {value:e} is not at most {high:e}"))
    }

    /// An observed order, which is that of theory to within 0.1.
    pub fn order(mut self, name: &str, order: f64, theory: f64) -> Self {
        self.figures.push(json!({ "name": name, "value": order, "low": theory - 0.1, "high": theory + 0.1 }));
        self.holds((order - theory).abs() <= 0.1, format!("{name}: {order:.3}, not {theory}"))
    }

    /// `count` of `of` independent trials, to which the report adds a confidence interval. A limit of the share is for
    /// the report to compare with that interval.
    pub fn share(mut self, name: &str, count: usize, of: usize, high: Option<f64>) -> Self {
        self.figures.push(json!({ "name": name, "count": count, "of": of, "high": high }));
        self
    }

    /// The case is known not to be covered by the claim.
    pub fn excepted(mut self, why: &str) -> Self {
        self.line.insert("exception".to_owned(), json!(why));
        self
    }

    fn holds(mut self, holds: bool, otherwise: String) -> Self {
        self.broken.extend((!holds).then_some(otherwise));
        self
    }

    /// Writes the case; returns its figures that are beyond their limits.
    #[must_use]
    pub fn write(mut self) -> String {
        self.line.insert("figures".to_owned(), Value::Array(self.figures));
        let line = format!("{}\n", Value::Object(self.line.clone()));
        if let Some(path) = std::env::var_os("MBINT_MEASURED") {
            // One call: tests of other threads and programs write at the same time.
            let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
            file.and_then(|mut file| file.write_all(line.as_bytes())).expect("MBINT_MEASURED can be written");
        }
        let broken = self.broken.iter().map(|figure| format!("{}: {figure}\n", self.line["case"]));
        broken.collect()
    }

    /// Writes the case; fails where a figure is beyond its limits.
    #[track_caller]
    pub fn note(self) {
        let broken = self.write();
        assert!(broken.is_empty(), "\n{broken}");
    }
}
