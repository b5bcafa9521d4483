//! A number that follows another no faster than at a rate, and within limits: a command on its way through a drive.
//!
//! ```text
//! ẏ = sat_R((c − y)/T),     c = u, or within limits: m + sat_w(u − m)
//! m = (lower + upper)/2,    w = (upper − lower)/2
//! ```
//!
//! sat is that of a servo, T the lag with which y follows slow inputs. Since y follows c, which is within the limits, y
//! does not run up against them. It begins at `initial`.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::Formula;

use super::laws::saturation::saturated;
use super::state::{VALUE_AND_CHANGE, value_and_change};
use super::{ForceElement, Forces, StateVariable, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::values::Number;
use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, SymbolTable};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// A number that follows another within limits.
#[derive(Clone, Debug)]
pub struct RateLimit {
    /// u, may depend on t, positions, velocities and states.
    input: Formula,
    /// R, of parameters; `None` for no limit of the rate.
    rate: Option<Formula>,
    /// T, of parameters, s.
    lag: Formula,
    /// Lower and upper limit, of parameters; `None` for no limits.
    limits: Option<[Formula; 2]>,
    /// y₀, of parameters.
    initial: Formula,
    /// Dimension of y; `None` if unknown.
    dimension: Option<Dimension>,
}

impl ForceElement for RateLimit {
    const SENSORS: &'static [TypedSensor] = &VALUE_AND_CHANGE;

    fn sensors(&self) -> Vec<TypedSensor> {
        value_and_change(self.dimension).to_vec()
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        vec![StateVariable { sensor: self.sensors()[0].0, initial: &self.initial, period: None }]
    }

    fn value_ahead<S: SymbolTable>(reader: &mut Reader<'_, S>, mapping: &Node) -> Option<Option<Dimension>> {
        let mut known = |key: &str| mapping.get(key).and_then(|node| reader.quietly(node));
        let values = ["initial", "input", "upper", "lower"].into_iter().find_map(&mut known);
        Some(values.or_else(|| Some(known("rate")?.times(Dimension::TIME))))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let mut command = forces.value(&self.input)?;
        if let Some([lower, upper]) = &self.limits {
            let (lower, upper) = (forces.value(lower)?, forces.value(upper)?);
            let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
            command = middle + saturated(command - middle, half);
        }
        let mut change = (command - forces.state(0)) / forces.value(&self.lag)?;
        if let Some(rate) = &self.rate {
            change = saturated(change, forces.value(rate)?);
        }
        forces.sensor(self.sensors()[1].0, change);
        forces.state_rate(0, change);
        Ok(())
    }
}

impl Group for RateLimit {
    fn key_names() -> Vec<&'static str> {
        vec!["input", "lag", "rate", "lower", "upper", "initial"]
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        let schema = generator.subschema_for::<Number>();
        let key = |name, doc, unit, required: bool, without: Option<&'static str>| Key {
            name,
            doc,
            unit,
            required,
            default: (!required && without.is_none()).then(|| 0.into()),
            default_in_words: without,
            schema: schema.clone(),
            requirement: None,
            keys: Vec::new(),
        };
        vec![
            key("input", "A formula of t, parameters, positions, velocities and states.", "", true, None),
            key("lag", "Time by which it follows slow inputs late.", "s", true, None),
            key("rate", "How fast it changes at most, in its unit over s.", "", false, Some("no limit")),
            key("lower", "Its smallest value; goes with `upper`.", "", false, Some("none")),
            key("upper", "Its largest value; goes with `lower`.", "", false, Some("none")),
            key("initial", "Its value at the start, a formula of parameters.", "", false, None),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        let input = reader.required(fields, "input").and_then(|node| reader.any_unit(node, Context::Effect));
        let lag = constant(reader, fields, "lag", true);
        let [rate, lower, upper, initial] =
            ["rate", "lower", "upper", "initial"].map(|key| constant(reader, fields, key, false));
        if fields.get("rate").is_none() && fields.get("lower").is_none() && fields.get("upper").is_none() {
            let message = "a rate limit needs `rate`, or `lower` and `upper`";
            reader.error(
                Code::IncompleteElement,
                fields.at.clone(),
                message,
                "without, it would be a `filter`".to_owned(),
            );
            return None;
        }
        for (key, other) in [("lower", "upper"), ("upper", "lower")] {
            if fields.get(key).is_some() && fields.get(other).is_none() {
                reader.error(Code::MisplacedKey, fields.key_span(key), format!("`{key}` goes with `{other}`"), None);
                return None;
            }
        }
        let ((input, of_input), (lag, of_lag)) = (input?, lag??);
        let ([rate, lower, upper], initial) = ([rate?, lower?, upper?], initial?);
        let node = fields.get("lag")?;
        if let Some(found) = of_lag {
            reader.check_fits(&node.span, found, Dimension::TIME);
        }
        reader.require(node, &lag, |value| value > 0.0, "must be positive");
        let unit = |value: &Option<(Formula, Option<Dimension>)>| value.as_ref().and_then(|(_, own)| *own);
        let by_rate = unit(&rate).map(|own| own.times(Dimension::TIME));
        let dimension = of_input.or(unit(&initial)).or(unit(&upper)).or(unit(&lower)).or(by_rate);
        for (key, found) in [("lower", unit(&lower)), ("upper", unit(&upper)), ("initial", unit(&initial))] {
            if let (Some(found), Some(wanted), Some(node)) = (found, dimension, fields.get(key)) {
                reader.check_fits(&node.span, found, wanted);
            }
        }
        if let (Some((rate, found)), Some(node)) = (&rate, fields.get("rate")) {
            if let (Some(found), Some(wanted)) = (found, dimension) {
                reader.check_fits(&node.span, *found, wanted.per(Dimension::TIME));
            }
            reader.require(node, rate, |value| value > 0.0, "must be positive");
        }
        let formula = |value: Option<(Formula, Option<Dimension>)>| value.map(|(formula, _)| formula);
        let limits = formula(lower).zip(formula(upper)).map(|(lower, upper)| [lower, upper]);
        if let Some([lower, upper]) = &limits {
            reader.ordered(fields, "lower", lower, "upper", upper);
        }
        let initial = formula(initial).unwrap_or_else(|| Formula::number(0.0));
        Some(Self { input, rate: formula(rate), lag, limits, initial, dimension })
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend([&self.input, &self.lag, &self.initial]);
        found.extend(self.rate.iter().chain(self.limits.iter().flatten()));
    }
}

/// A number of parameters, in any unit: `None` if it is wrong, `Some(None)` if it is not given.
fn constant<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    fields: &Fields<'_>,
    key: &str,
    required: bool,
) -> Option<Option<(Formula, Option<Dimension>)>> {
    let node = if required { reader.required(fields, key) } else { fields.get(key) };
    match node {
        None => Some(None),
        Some(node) => reader.any_unit(node, Context::Constant).map(Some),
    }
}

impl Element for RateLimit {
    const KEYWORD: &'static str = "rate_limit";
    const WHAT: &'static str = "a rate limit";
    const DESCRIPTION: &'static str = "A number that follows another no faster than at a rate, and within limits.";
    const EQUATIONS: &'static [&'static str] = &["ẏ = sat((c − y)/lag),  |ẏ| ≤ rate,  c = input within lower … upper"];
    const SOURCE: &'static str = "Åström & Murray, Feedback Systems, 2nd ed. (2021), sec. 11.4";
    const EXAMPLE: &'static str = "{ input: 0.5*sin(20*t), rate: 2, lag: 5 ms, lower: -0.4, upper: 0.4 }";
    const SHORT: Option<&'static str> = None;
}

impl JsonSchema for RateLimit {
    fn schema_name() -> Cow<'static, str> {
        "RateLimit".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Self::object(generator)
    }
}
