//! `distribution`: the law of an uncertain parameter.

use super::ParameterDraft;
use super::interval;
use crate::grammar::dimension::KnownDimension;
use crate::keys;
use crate::model::description::Law;
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::numerics::statistics::Distribution;
use crate::syntax::codes::Code;
use crate::syntax::suggest;
use crate::syntax::yaml::{Node, Value};

const NAMES: [&str; 7] = ["uniform", "normal", "truncated_normal", "lognormal", "triangular", "beta", "table"];

/// Where a law is to lie: nominal value and interval.
#[derive(Clone, Copy)]
pub struct LawInterval {
    pub nominal: f64,
    pub lower: f64,
    pub upper: f64,
    /// Nominal value and interval of the file, which its laws refer to; `None` if they are not replaced.
    pub written: Option<[f64; 3]>,
}

impl LawInterval {
    /// Position of a value of the file's law; its distance from the nominal value scales with the tolerance for a
    /// `scaled` law.
    fn moved(self, value: f64, scaled: bool) -> f64 {
        let Some([nominal, lower, upper]) = self.written else { return value };
        let (now, before) = match value < nominal {
            true => (self.nominal - self.lower, nominal - lower),
            false => (self.upper - self.nominal, upper - nominal),
        };
        let scale = if scaled && before > 0.0 { now / before } else { 1.0 };
        self.nominal + scale * (value - nominal)
    }

    /// The ends of the file's interval.
    fn ends(self) -> [f64; 2] {
        self.written.map_or([self.lower, self.upper], |[_, lower, upper]| [lower, upper])
    }
}

/// A law by its name, over an interval.
pub fn named(name: &str, LawInterval { nominal, lower, upper, .. }: LawInterval) -> Option<Law> {
    let (mean, sigma) = (0.5 * lower + 0.5 * upper, (upper - lower) / (2.0 * TUNING.sigmas));
    let (distribution, by_tolerance) = match name {
        "uniform" => (Distribution::Uniform { lower, upper }, false),
        "normal" => (Distribution::Normal { mean, sigma }, true),
        "truncated_normal" => (Distribution::TruncatedNormal { mean, sigma, lower, upper }, true),
        "triangular" => (Distribution::Triangular { lower, mode: nominal, upper }, false),
        _ => return None,
    };
    Some(Law { distribution, by_tolerance })
}

/// Reads a law over an interval; `kind` is the parameter's dimension.
pub fn read(
    reader: &mut Reader,
    draft: &ParameterDraft,
    node: &Node,
    place: LawInterval,
    kind: &mut KnownDimension,
) -> Option<Law> {
    if let Some(scalar) = node.scalar() {
        let law = named(&scalar.text, place);
        if law.is_none() {
            let (message, help) = match scalar.text.as_str() {
                "beta" => ("`beta` needs its exponents", "e.g. `{ beta: { alpha: 2, beta: 5 } }`".to_owned()),
                "lognormal" => {
                    ("`lognormal` needs its standard deviation", "e.g. `{ lognormal: { sigma: 0.1 } }`".to_owned())
                }
                "table" => ("`table` needs its points", "e.g. `{ table: [[0.1, 0], [0.2, 1], [0.3, 0]] }`".to_owned()),
                _ => ("this is no distribution", format!("the distributions are {}", suggest::list(&NAMES))),
            };
            reader.error(Code::BadDistribution, node.span.clone(), message, help);
        }
        return law;
    }
    let entry = reader.only::<keys::LawKinds>(node, node.span.clone())?;
    let LawInterval { nominal, lower, upper, .. } = place;
    let by_name = named(&entry.key, place);
    let distribution = match (entry.key.as_str(), by_name.as_ref().map(|law| &law.distribution)) {
        ("normal" | "truncated_normal", Some(default)) => {
            let fields = reader.fields::<keys::NormalLaw>(&entry.value, entry.key_span.clone())?;
            let mut number = |key: &str, default: f64| match fields.get(key) {
                None => Some(default),
                Some(node) => interval::bare_number(reader, draft, node, kind),
            };
            let (mean, third) = (number("mean", 0.5 * lower + 0.5 * upper)?, (upper - lower) / (2.0 * TUNING.sigmas));
            let sigma = number("sigma", third)?;
            if sigma <= 0.0 {
                let place = fields.get("sigma").map_or(node.span.clone(), |node| node.span.clone());
                reader.error(Code::BadDistribution, place, "a standard deviation is positive", None);
                return None;
            }
            let by_tolerance = fields.get("sigma").is_none();
            let mean = if fields.get("mean").is_some() { place.moved(mean, by_tolerance) } else { mean };
            let distribution = match default {
                Distribution::Normal { .. } => Distribution::Normal { mean, sigma },
                _ => Distribution::TruncatedNormal { mean, sigma, lower, upper },
            };
            return Some(Law { distribution, by_tolerance });
        }
        ("triangular", _) => {
            let fields = reader.fields::<keys::TriangularLaw>(&entry.value, entry.key_span.clone())?;
            let mode = match fields.get("mode") {
                None => nominal,
                Some(node) => {
                    let written = interval::bare_number(reader, draft, node, kind)?;
                    let mode = place.moved(written, true);
                    let [first, last] = place.ends();
                    if !(first..=last).contains(&written) {
                        reader.error(
                            Code::BadDistribution,
                            node.span.clone(),
                            "the mode lies outside of the interval",
                            None,
                        );
                        return None;
                    }
                    mode
                }
            };
            Distribution::Triangular { lower, mode, upper }
        }
        ("beta", _) => {
            let fields = reader.fields::<keys::BetaLaw>(&entry.value, entry.key_span.clone())?;
            let mut exponent = |key: &str| {
                let node = reader.required(&fields, key)?;
                positive(reader, node)
            };
            let (alpha, beta) = (exponent("alpha"), exponent("beta"));
            Distribution::Beta { alpha: alpha?, beta: beta?, lower, upper }
        }
        ("lognormal", _) => {
            let fields = reader.fields::<keys::LognormalLaw>(&entry.value, entry.key_span.clone())?;
            let sigma = reader.required(&fields, "sigma").and_then(|node| positive(reader, node));
            let (median, at) = match fields.get("median") {
                None => (nominal, entry.key_span.clone()),
                Some(node) => {
                    // Its logarithm deviates: it goes with the nominal value by a factor.
                    let factor = place.written.map_or(1.0, |[before, ..]| nominal / before);
                    (factor * interval::bare_number(reader, draft, node, kind)?, node.span.clone())
                }
            };
            if median <= 0.0 || lower <= 0.0 {
                let help = format!("the median is {median}, and the interval begins at {lower}");
                reader.error(Code::BadDistribution, at, "a lognormal law is one of positive values", help);
                return None;
            }
            Distribution::Lognormal { median, sigma: sigma?, lower: 0.0, upper: f64::INFINITY }
        }
        ("table", _) => Distribution::Table(table(reader, draft, &entry.value, place, kind)?),
        _ => {
            reader.fields::<keys::NoNumbers>(&entry.value, entry.key_span.clone())?;
            Distribution::Uniform { lower, upper }
        }
    };
    Some(Law { distribution, by_tolerance: false })
}

/// A positive number without a unit.
pub fn positive(reader: &mut Reader, node: &Node) -> Option<f64> {
    let scalar = reader.scalar(node, "a positive number")?;
    let number = scalar.text.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
    if number.is_none() {
        reader.error(
            Code::BadDistribution,
            node.span.clone(),
            format!("`{}` is not a positive number", suggest::clip(&scalar.text)),
            None,
        );
    }
    number
}

/// Points of a density, ascending, within the interval.
fn table(
    reader: &mut Reader,
    draft: &ParameterDraft,
    node: &Node,
    place: LawInterval,
    kind: &mut KnownDimension,
) -> Option<Vec<(f64, f64)>> {
    let Value::Sequence(items) = &node.value else {
        let help = "e.g. `[[0.1, 0], [0.2, 1], [0.3, 0]]`".to_owned();
        reader.error(Code::BadDistribution, node.span.clone(), "a table is a list of pairs of value and density", help);
        return None;
    };
    let [lower, upper] = place.ends();
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(items.len());
    for item in items {
        let [x, density] = reader.two(item, "a value and its density")?;
        let x_value = interval::bare_number(reader, draft, x, kind)?;
        let scalar = reader.scalar(density, "a density")?;
        let value = scalar.text.parse::<f64>().ok().filter(|value| *value >= 0.0 && value.is_finite());
        let Some(value) = value else {
            reader.error(
                Code::BadDistribution,
                density.span.clone(),
                "a density is a number that is not negative",
                None,
            );
            return None;
        };
        let slack = 1e-9 * (upper - lower);
        if !(lower - slack..=upper + slack).contains(&x_value) {
            reader.error(Code::BadDistribution, x.span.clone(), "this value lies outside of the interval", None);
            return None;
        }
        let x_value = place.moved(x_value.clamp(lower, upper), true);
        if points.last().is_some_and(|last| last.0 >= x_value) {
            reader.error(
                Code::BadDistribution,
                x.span.clone(),
                "values ascend, but this one does not come after the one before",
                None,
            );
            return None;
        }
        points.push((x_value.clamp(place.lower, place.upper), value));
    }
    if points.len() < 2 || points.iter().all(|point| point.1 == 0.0) {
        reader.error(
            Code::BadDistribution,
            node.span.clone(),
            "a table has two points at least, and a density somewhere",
            None,
        );
        return None;
    }
    Some(points)
}
