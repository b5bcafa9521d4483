//! An input delayed by a time, approximated by a rational law.
//!
//! ```text
//! e^(−s T) ≈ N(−s T)/D(s T),    N(x) = Σ cₖ xᵏ, k ≤ n − 1,    D(x) = Σ dₖ xᵏ, k ≤ n
//! cₖ = (2n−1−k)! (n−1)! / ((2n−1)! k! (n−1−k)!),    dₖ = (2n−1−k)! n! / ((2n−1)! k! (n−k)!)
//! ```
//!
//! Padé's approximation with a numerator of one degree less than the denominator: its Taylor series is that of the
//! delay up to (s T)²ⁿ⁻¹, and the output follows from states alone, so that the delayed formula may depend on the
//! output. It begins at rest, settled at a constant input. (Golub & Van Loan, *Matrix Computations* (2013), sec. 9.3.)

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::{Binary, Formula};

use super::{Filter, ForceElement, Forces, StateVariable, TypedSensor};
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::values::Number;
use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, SymbolTable};
use crate::multibody::BuildError;

/// A number as it was some time ago.
#[derive(Clone, Debug)]
pub struct Delay {
    /// u, may depend on t, positions, velocities and states.
    input: Formula,
    /// T, of parameters, s.
    time: Formula,
    /// u₀, of parameters.
    initial: Option<Formula>,
    /// The rational law.
    law: Filter,
}

impl ForceElement for Delay {
    const SENSORS: &'static [TypedSensor] = Filter::SENSORS;

    fn sensors(&self) -> Vec<TypedSensor> {
        self.law.sensors()
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        self.law.states()
    }

    fn value_ahead<S: SymbolTable>(reader: &mut Reader<'_, S>, mapping: &Node) -> Option<Option<Dimension>> {
        Some(["initial", "input"].into_iter().find_map(|key| mapping.get(key).and_then(|node| reader.quietly(node))))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        self.law.apply(forces)
    }
}

/// Coefficients of N(−x) and D(x), the highest power first.
fn pade(order: usize) -> [Vec<f64>; 2] {
    // dₖ₊₁/dₖ = (n − k)/((k + 1)(2n − 1 − k)), and for cₖ with n − 1 in place of n above.
    let coefficients = |degree: usize, sign: f64| {
        let mut all = vec![1.0];
        for k in 0..degree {
            let ratio = (degree - k) as f64 / ((k + 1) * (2 * order - 1 - k)) as f64;
            all.push(sign * ratio * all[k]);
        }
        all.reverse();
        all
    };
    [coefficients(order - 1, -1.0), coefficients(order, 1.0)]
}

/// Coefficients of s for those of s T.
fn by_time(coefficients: &[f64], time: &Formula) -> Vec<Formula> {
    let mut power = Formula::number(1.0);
    let mut found = Vec::with_capacity(coefficients.len());
    for &coefficient in coefficients.iter().rev() {
        found.push(power.combined(Binary::Mul, &Formula::number(coefficient)));
        power = power.combined(Binary::Mul, time);
    }
    found.reverse();
    found
}

impl Group for Delay {
    fn key_names() -> Vec<&'static str> {
        vec!["input", "time", "order", "initial"]
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        let mut key = |name, doc, unit, required: bool| Key {
            name,
            doc,
            unit,
            required,
            default: match name {
                "order" => Some(TUNING.order_of_delay.into()),
                _ => (!required).then(|| 0.into()),
            },
            default_in_words: None,
            schema: match name {
                "order" => {
                    schemars::json_schema!({ "type": "integer", "minimum": 1, "maximum": TUNING.most_order_of_delay })
                }
                _ => generator.subschema_for::<Number>(),
            },
            requirement: None,
            keys: Vec::new(),
        };
        vec![
            key("input", "A formula of t, parameters, positions, velocities and states.", "", true),
            key("time", "How long ago, a formula of parameters.", "s", true),
            key("order", "Number of states: 2 order − 1 terms of the delay's series are met.", "", false),
            key("initial", "The constant input that it has settled at when the motion starts.", "", false),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        let input = reader.required(fields, "input").and_then(|node| reader.any_unit(node, Context::Effect));
        let time = reader.required(fields, "time").and_then(|node| reader.any_unit(node, Context::Constant));
        let order = match fields.get("order") {
            None => Some(TUNING.order_of_delay),
            Some(node) => reader.count(node, 1, TUNING.most_order_of_delay),
        };
        let initial = match fields.get("initial") {
            None => None,
            Some(node) => Some(reader.any_unit(node, Context::Constant)?),
        };
        let ((input, of_input), (time, of_time), order) = (input?, time?, order?);
        let node = fields.get("time")?;
        if let Some(found) = of_time {
            reader.check_fits(&node.span, found, Dimension::TIME);
        }
        reader.require(node, &time, |value| value > 0.0, "must be positive");
        let of_initial = initial.as_ref().and_then(|(_, own)| *own);
        if let (Some(found), Some(wanted), Some(node)) = (of_initial, of_input, fields.get("initial")) {
            reader.check_fits(&node.span, found, wanted);
        }
        let initial = initial.map(|(initial, _)| initial);
        let [numerator, denominator] = pade(order).map(|coefficients| by_time(&coefficients, &time));
        let law = Filter::of(input.clone(), [numerator, denominator], initial.clone(), of_input.or(of_initial));
        Some(Self { input, time, initial, law })
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend([&self.input, &self.time]);
        found.extend(&self.initial);
    }
}

impl Element for Delay {
    const KEYWORD: &'static str = "delay";
    const WHAT: &'static str = "a delay";
    const DESCRIPTION: &'static str = "A number as it was some time ago, by Padé's approximation.";
    const EQUATIONS: &'static [&'static str] = &["D(s T) y = N(−s T) u ≈ D(s T) e^(−s T) u,  s = d/dt"];
    const SOURCE: &'static str = "Golub & Van Loan, Matrix Computations, 4th ed. (2013), sec. 9.3";
    const EXAMPLE: &'static str = "{ input: arm.angle, time: 20 ms, initial: 0.3 rad }";
    const SHORT: Option<&'static str> = None;
}

impl JsonSchema for Delay {
    fn schema_name() -> Cow<'static, str> {
        "Delay".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Self::object(generator)
    }
}
