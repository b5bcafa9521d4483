//! A number that is computed every T seconds and constant in between: a measured or commanded value of a digital
//! controller.
//!
//! ```text
//! y(t) = u(t_k) for t_k ≤ t < t_{k+1},     t_k = k T,     k = 0, 1, 2, …
//! ```
//!
//! u is taken just before t_k: where it refers to y itself, or to other sampled numbers, these have their values from
//! before t_k. So y is the memory of a difference equation, y_{k+1} = f(y_k, …), which begins at `initial`. Steps of
//! the integration end at the instants t_k. (Åström & Wittenmark, *Computer-Controlled Systems*, 3rd ed. (1997), ch. 2)

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::Formula;

use super::{ForceElement, Forces, StateVariable, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::values::Number;
use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;

/// A number that is computed at instants.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// u, may depend on t, positions, velocities and states.
    input: Formula,
    /// T, s.
    period: f64,
    /// y before the start, of parameters.
    initial: Formula,
    /// Dimension of y; `None` if unknown.
    dimension: Option<Dimension>,
}

impl ForceElement for Sampled {
    const SENSORS: &'static [TypedSensor] = &[(Sensor::VALUE.of_unknown_unit(), Dimension::NUMBER)];

    fn sensors(&self) -> Vec<TypedSensor> {
        vec![self.dimension.map_or(Self::SENSORS[0], |known| (Sensor::VALUE, known))]
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        vec![StateVariable { sensor: self.sensors()[0].0, initial: &self.initial, period: Some(self.period) }]
    }

    fn value_ahead<S: SymbolTable>(reader: &mut Reader<'_, S>, mapping: &Node) -> Option<Option<Dimension>> {
        Some(["initial", "input"].into_iter().find_map(|key| mapping.get(key).and_then(|node| reader.quietly(node))))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let input = forces.value(&self.input)?;
        forces.hold(0, input);
        Ok(())
    }
}

impl Group for Sampled {
    fn key_names() -> Vec<&'static str> {
        vec!["input", "period", "initial"]
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        let schema = generator.subschema_for::<Number>();
        let key = |name, doc, unit, required: bool| Key {
            name,
            doc,
            unit,
            required,
            default: (!required).then(|| 0.into()),
            default_in_words: None,
            schema: schema.clone(),
            requirement: None,
            keys: Vec::new(),
        };
        vec![
            key(
                "input",
                "A formula of t, parameters, positions, velocities and states, its own name among them.",
                "",
                true,
            ),
            key("period", "Time from one instant to the next, the same for all samples.", "s", true),
            key(
                "initial",
                "Its value before the start, a formula of parameters, where `input` refers to it.",
                "",
                false,
            ),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        let input = reader.required(fields, "input").and_then(|node| reader.any_unit(node, Context::Effect));
        let period = reader.required(fields, "period").and_then(|node| {
            let period = reader.number(node, Dimension::TIME)?;
            reader.require(node, &Formula::number(period), |value| value > 0.0, "must be positive");
            Some(period).filter(|period| *period > 0.0)
        });
        let initial = match fields.get("initial") {
            Some(node) => reader.any_unit(node, Context::Constant),
            None => Some((Formula::number(0.0), None)),
        };
        let ((input, of_input), period, (initial, of_initial)) = (input?, period?, initial?);
        if let (Some(found), Some(wanted), Some(node)) = (of_initial, of_input, fields.get("initial")) {
            reader.check_fits(&node.span, found, wanted);
        }
        Some(Self { input, period, initial, dimension: of_input.or(of_initial) })
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend([&self.input, &self.initial]);
    }
}

impl Element for Sampled {
    const KEYWORD: &'static str = "sampled";
    const WHAT: &'static str = "a sampled number";
    const DESCRIPTION: &'static str =
        "A number that is computed at instants and constant in between, as by a digital controller.";
    const EQUATIONS: &'static [&'static str] = &["y = input(k period) for k period ≤ t < (k + 1) period"];
    const SOURCE: &'static str = "Åström & Wittenmark, Computer-Controlled Systems, 3rd ed. (1997), ch. 2";
    const EXAMPLE: &'static str = "{ input: arm.angle - 0.1*sin(2*t), period: 20 ms }";
    const SHORT: Option<&'static str> = None;
}

impl JsonSchema for Sampled {
    fn schema_name() -> Cow<'static, str> {
        "Sampled".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Self::object(generator)
    }
}
