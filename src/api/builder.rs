//! A model built in Rust: the sections of a model file, entry by entry.

use super::value::quote;
use super::{Error, Model, Value};

/// Sections in the order in which they are written.
const SECTIONS: [&str; 7] = ["parameters", "bodies", "joints", "effects", "initial", "guess", "outputs"];

/// A model in the making. Keys and values are those of a model file, so that every kind of joint, effect and bounds can
/// be used, and [`build`](Self::build) makes the same checks, with the same messages, as reading a file.
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    name: String,
    /// Entries of each section.
    sections: [Vec<(String, Value)>; SECTIONS.len()],
    /// Keys with one value: `simulation`, `bounds`, ….
    keys: Vec<(String, Value)>,
}

impl ModelBuilder {
    /// A model without entries.
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), sections: Default::default(), keys: Vec::new() }
    }

    fn entry(mut self, section: usize, name: &str, value: impl Into<Value>) -> Self {
        self.sections[section].push((name.to_owned(), value.into()));
        self
    }

    /// A number with a name: `0.5`, `"0.5 m"`, `"2*l1"`, or `fields! { value: 0.5, unit: "m", tolerance: "2%" }`.
    #[must_use]
    pub fn parameter(self, name: &str, value: impl Into<Value>) -> Self {
        self.entry(0, name, value)
    }

    /// A body: `fields! { mass: "m1", inertia: "m1*l1^2/12", points: fields! { A: ["-l1/2", "0"] } }`.
    #[must_use]
    pub fn body(self, name: &str, body: impl Into<Value>) -> Self {
        self.entry(1, name, body)
    }

    /// A joint: `fields! { revolute: ["ground", "crank.A"] }`.
    #[must_use]
    pub fn joint(self, name: &str, joint: impl Into<Value>) -> Self {
        self.entry(2, name, joint)
    }

    /// An effect: `fields! { torque: fields! { on: "crank", value: "tau" } }`.
    #[must_use]
    pub fn effect(self, name: &str, effect: impl Into<Value>) -> Self {
        self.entry(3, name, effect)
    }

    /// A coordinate or velocity that is prescribed at the start, such as `crank.angle`.
    #[must_use]
    pub fn initial(self, name: &str, value: impl Into<Value>) -> Self {
        self.entry(4, name, value)
    }

    /// A coordinate or velocity at which the search for a consistent start begins.
    #[must_use]
    pub fn guess(self, name: &str, value: impl Into<Value>) -> Self {
        self.entry(5, name, value)
    }

    /// An output: a formula such as `"slider.x"`.
    #[must_use]
    pub fn output(self, name: &str, formula: impl Into<Value>) -> Self {
        self.entry(6, name, formula)
    }

    /// Settings of the time steps: `fields! { duration: 2, step: 1e-3 }`.
    #[must_use]
    pub fn simulation(self, simulation: impl Into<Value>) -> Self {
        self.key("simulation", simulation)
    }

    /// Any other key of a model file: `bounds`, `space`, `tables`, `scenes`, ….
    #[must_use]
    pub fn key(mut self, key: &str, value: impl Into<Value>) -> Self {
        self.keys.push((key.to_owned(), value.into()));
        self
    }

    /// The model as the text of a file.
    pub fn to_yaml(&self) -> String {
        let mut text = String::from("model: ");
        quote(&self.name, &mut text);
        text.push('\n');
        for (section, entries) in SECTIONS.iter().zip(&self.sections).filter(|(_, entries)| !entries.is_empty()) {
            text.push_str(section);
            text.push_str(":\n");
            for (name, value) in entries {
                text.push_str("  ");
                quote(name, &mut text);
                text.push_str(": ");
                value.write(&mut text);
                text.push('\n');
            }
        }
        for (key, value) in &self.keys {
            quote(key, &mut text);
            text.push_str(": ");
            value.write(&mut text);
            text.push('\n');
        }
        text
    }

    /// Checks the model.
    ///
    /// # Errors
    /// [`Error::Model`]: everything that is wrong, with locations in the text of [`to_yaml`](Self::to_yaml).
    pub fn build(&self) -> Result<Model, Error> {
        Model::from_yaml_str(&self.name, &self.to_yaml())
    }
}
