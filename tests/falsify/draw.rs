//! A draw: a model as a file would have it, and the true ranges of its outputs.

use std::fmt::Write;
use std::sync::Arc;

/// A number of the model; uncertain where `half` is positive.
#[derive(Clone)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    /// Half the width of its interval.
    pub half: f64,
    /// Largest half width, relative to the value; 0 if it must be certain.
    pub most: f64,
    /// Whether the model still makes sense if the parameter is 0.
    pub removable: bool,
}

impl Parameter {
    pub fn interval(&self) -> [f64; 2] {
        [self.value - self.half, self.value + self.half]
    }
}

/// Values of every channel at some times, from values of the parameters.
pub type Curves = Arc<dyn Fn(&[f64], &[f64]) -> Vec<Vec<f64>> + Send + Sync>;

/// Derives from the model's parameters fewer ones, independent and with exact intervals, on which a motion depends.
pub type Hidden = Arc<dyn Fn(&[Parameter]) -> Vec<Parameter> + Send + Sync>;

/// A mechanism that does not interact with the others of its model, with parameters of its own.
#[derive(Clone)]
pub struct Term {
    pub parameters: Vec<Parameter>,
    /// Lines of the sections of the file.
    pub bodies: Vec<String>,
    pub joints: Vec<String>,
    pub effects: Vec<String>,
    pub initial: Vec<String>,
    pub guess: Vec<String>,
    /// Formulas of the observed quantities.
    pub channels: Vec<String>,
    /// Curves of the channels over the model's parameters, or over those that are `hidden` behind them.
    pub curves: Curves,
    pub hidden: Option<Hidden>,
    /// Whether `curves` integrate, so that a single value costs as much as all.
    pub integrated: bool,
    /// Size of the coordinates, m or rad: rounding is relative to it.
    pub size: f64,
    pub spatial: bool,
}

impl Term {
    /// Parameters of its curves.
    pub fn seen(&self) -> Vec<Parameter> {
        self.hidden.as_ref().map_or_else(|| self.parameters.clone(), |hidden| hidden(&self.parameters))
    }

    /// Number of uncertain parameters of the model.
    fn uncertain(&self) -> usize {
        self.parameters.iter().filter(|parameter| parameter.half > 0.0).count()
    }
}

/// Combination of channels of different terms into an output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Combine {
    Sum,
    Max,
    Min,
    Product,
}

/// A function of the combined channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrap {
    Nothing,
    Abs,
    Square,
    /// The larger of the value and a constant.
    Above(f64),
    Below(f64),
    /// Sine of this multiple of the value.
    Sine(f64),
    /// Distance of the value from a constant.
    Distance(f64),
}

#[derive(Clone, Debug)]
pub struct Output {
    /// Term and channel.
    pub inputs: Vec<(usize, usize)>,
    pub combine: Combine,
    pub wrap: Wrap,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Number of steps from one row to the next.
    Steps(usize),
    Tolerance(f64),
}

#[derive(Clone, Copy, Debug)]
pub struct Time {
    /// s between rows.
    pub row: f64,
    pub rows: usize,
    pub stepping: Stepping,
}

impl Time {
    /// Output times, as mbint has them.
    pub fn duration(&self) -> f64 {
        crate::random::digits(self.row * self.rows as f64, 12)
    }
}

/// Requested bounds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bounds {
    pub chebyshev: Option<usize>,
    pub expand_output: bool,
    pub taylor: Option<usize>,
    pub scan: Option<usize>,
    pub tolerance: Option<f64>,
}

#[derive(Clone)]
pub struct Draw {
    pub family: &'static str,
    pub analysis: &'static str,
    pub terms: Vec<Term>,
    pub outputs: Vec<Output>,
    pub time: Time,
    pub bounds: Bounds,
}

impl Output {
    fn formula(&self, terms: &[Term]) -> String {
        let inputs: Vec<&str> = self.inputs.iter().map(|&(term, channel)| &*terms[term].channels[channel]).collect();
        let nested = |function: &str| {
            let (first, rest) = inputs.split_first().expect("an output has an input");
            rest.iter().fold((*first).to_owned(), |all, next| format!("{function}({all}, {next})"))
        };
        let inside = match self.combine {
            Combine::Sum => inputs.join(" + "),
            Combine::Product => inputs.iter().map(|input| format!("({input})")).collect::<Vec<_>>().join("*"),
            Combine::Max => nested("max"),
            Combine::Min => nested("min"),
        };
        match self.wrap {
            Wrap::Nothing => inside,
            Wrap::Abs => format!("abs({inside})"),
            Wrap::Square => format!("({inside})^2"),
            Wrap::Above(c) => format!("max({inside}, {c:?})"),
            Wrap::Below(c) => format!("min({inside}, {c:?})"),
            Wrap::Sine(b) => format!("sin({b:?}*({inside}))"),
            Wrap::Distance(c) => format!("abs({inside} - ({c:?}))"),
        }
    }
}

impl Draw {
    pub fn uncertain_count(&self) -> usize {
        self.terms.iter().map(Term::uncertain).sum()
    }

    pub fn yaml(&self) -> String {
        let (name, analysis) = (self.family.replace([' ', '-'], "_"), self.analysis);
        let analysis = if analysis == "motion" { String::new() } else { format!("analysis: {analysis}\n") };
        let mut text = format!("model: {name}\n{analysis}parameters:\n");
        for parameter in self.terms.iter().flat_map(|term| &term.parameters) {
            let Parameter { name, value, half, .. } = parameter;
            let [lower, upper] = parameter.interval();
            let value =
                if *half > 0.0 { format!("{{ interval: [{lower:?}, {upper:?}] }}") } else { format!("{value:?}") };
            writeln!(text, "  {name}: {value}").unwrap();
        }
        if self.terms.iter().any(|term| term.spatial) {
            text.insert_str(text.find("parameters").unwrap(), "space: spatial\n");
        }
        let mut section = |name: &str, lines: &dyn Fn(&Term) -> &Vec<String>| {
            if self.terms.iter().any(|term| !lines(term).is_empty()) {
                writeln!(text, "{name}:").unwrap();
            }
            for line in self.terms.iter().flat_map(lines) {
                writeln!(text, "  {line}").unwrap();
            }
        };
        section("bodies", &|term| &term.bodies);
        section("joints", &|term| &term.joints);
        section("effects", &|term| &term.effects);
        section("initial", &|term| &term.initial);
        section("guess", &|term| &term.guess);
        text += "outputs:\n";
        for (index, output) in self.outputs.iter().enumerate() {
            writeln!(text, "  o{index}: \"{}\"", output.formula(&self.terms)).unwrap();
        }
        let stepping = match self.time.stepping {
            Stepping::Steps(steps) => format!("step: {:?}", self.time.row / steps as f64),
            Stepping::Tolerance(tolerance) => format!("tolerance: {tolerance:?}"),
        };
        let (row, duration) = (self.time.row, self.time.duration());
        writeln!(text, "simulation: {{ duration: {duration:?}, {stepping}, output_step: {row:?} }}").unwrap();
        writeln!(text, "bounds: {{ {} }}", self.bounds.yaml()).unwrap();
        text
    }
}

impl Bounds {
    fn yaml(&self) -> String {
        let expand = if self.expand_output { ", expand: output" } else { "" };
        let methods = [
            self.chebyshev.map(|order| format!("chebyshev: {{ order: {order}{expand} }}")),
            self.tolerance.map(|_| "chebyshev: {}".to_owned()),
            self.taylor.map(|order| format!("taylor: {{ order: {order} }}")),
            self.scan.map(|points| format!("scan: {{ points: {points} }}")),
            self.tolerance.map(|tolerance| format!("tolerance: {tolerance:?}, budget: {{ solves: 1000 }}")),
        ];
        methods.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}
