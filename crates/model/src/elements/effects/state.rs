//! A state: a number that changes as a formula says, in addition to the mechanism's coordinates.
//!
//! ```text
//! ẏ = f(t, q, v, y)        in the unit of y over s;      y = y₀ at the start
//! ```
//!
//! y is the velocity of a coordinate of its own, with mass 1 and the force f, so that schemes, jets and enclosures take
//! it as they take every velocity (decision 0082). Nothing depends on that coordinate itself.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::Formula;

use super::{ForceElement, Forces, StateVariable, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::values::Number;
use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;

/// A number with its rate of change.
#[derive(Clone, Debug)]
pub struct State {
    /// f, may depend on t, positions, velocities and states.
    pub rate: Formula,
    /// y₀, of parameters.
    pub initial: Formula,
    /// Dimension of y; `None` if unknown.
    pub dimension: Option<Dimension>,
}

/// A number that follows an equation, and its rate, of a dimension that is not known.
pub(super) const VALUE_AND_CHANGE: [TypedSensor; 2] =
    [(Sensor::VALUE.of_unknown_unit(), Dimension::NUMBER), (Sensor::CHANGE.of_unknown_unit(), Dimension::NUMBER)];

/// The same, of a dimension that may be known.
pub(super) fn value_and_change(dimension: Option<Dimension>) -> [TypedSensor; 2] {
    dimension.map_or(VALUE_AND_CHANGE, |known| [(Sensor::VALUE, known), (Sensor::CHANGE, known.per(Dimension::TIME))])
}

impl ForceElement for State {
    const SENSORS: &'static [TypedSensor] = &VALUE_AND_CHANGE;

    fn sensors(&self) -> Vec<TypedSensor> {
        value_and_change(self.dimension).to_vec()
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        vec![StateVariable { sensor: self.sensors()[0].0, initial: &self.initial, period: None }]
    }

    fn value_ahead<S: SymbolTable>(reader: &mut Reader<'_, S>, mapping: &Node) -> Option<Option<Dimension>> {
        let initial = mapping.get("initial").and_then(|node| reader.quietly(node));
        let mut rate = || Some(reader.quietly(mapping.get("rate")?)?.times(Dimension::TIME));
        Some(initial.or_else(&mut rate))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let rate = forces.value(&self.rate)?;
        forces.sensor(self.sensors()[1].0, rate);
        forces.state_rate(0, rate);
        Ok(())
    }
}

impl Group for State {
    fn key_names() -> Vec<&'static str> {
        vec!["rate", "initial"]
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        let schema = generator.subschema_for::<Number>();
        let key = |name, doc, required: bool| Key {
            name,
            doc,
            unit: "",
            required,
            default: (!required).then(|| 0.into()),
            default_in_words: None,
            schema: schema.clone(),
            requirement: None,
            keys: Vec::new(),
        };
        vec![
            key(
                "rate",
                "How fast it changes: a formula of t, parameters, positions, velocities and states, in its unit over s.",
                true,
            ),
            key("initial", "Its value at the start, a formula of parameters; its unit is that of the state.", false),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        let rate = reader.required(fields, "rate").and_then(|node| reader.any_unit(node, Context::Effect));
        let initial = match fields.get("initial") {
            Some(node) => reader.any_unit(node, Context::Constant),
            None => Some((Formula::number(0.0), None)),
        };
        let ((rate, change), (initial, own)) = (rate?, initial?);
        if let (Some(change), Some(own)) = (change, own) {
            let node = fields.get("rate")?;
            reader.check_fits(&node.span, change, own.per(Dimension::TIME));
        }
        let dimension = own.or_else(|| change.map(|change| change.times(Dimension::TIME)));
        Some(Self { rate, initial, dimension })
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend([&self.rate, &self.initial]);
    }
}

impl Element for State {
    const KEYWORD: &'static str = "state";
    const WHAT: &'static str = "a state";
    const DESCRIPTION: &'static str = "A number with its rate of change: an integral, a current, a filter's value.";
    const EQUATIONS: &'static [&'static str] = &["ẏ = rate"];
    const SOURCE: &'static str = "Brüls & Arnold, J. Comput. Nonlinear Dynam. 3 (2008) 041007";
    const EXAMPLE: &'static str = "{ rate: arm.angle - 0.1*sin(2*t), initial: 0.2 rad*s }";
    const SHORT: Option<&'static str> = None;
}

impl JsonSchema for State {
    fn schema_name() -> Cow<'static, str> {
        "State".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Self::object(generator)
    }
}
