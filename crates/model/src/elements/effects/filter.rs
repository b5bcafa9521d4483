//! A filter by its numerator and denominator: a linear law from an input to an output, with states of its own.
//!
//! ```text
//! (aₙ sⁿ + … + a₁ s + a₀) y = (bₙ sⁿ + … + b₁ s + b₀) u          s = d/dt
//!
//! y = x₁ + (bₙ/aₙ) u,     ẋₖ = xₖ₊₁ + (bₙ₋ₖ u − aₙ₋ₖ y)/aₙ,     xₙ₊₁ = 0
//! ```
//!
//! In this form (the observable one; Kailath, *Linear Systems* (1980), sec. 2.1) no rate of the input is needed, and y
//! itself is the first state where the numerator is shorter than the denominator. It begins at rest, settled at a
//! constant input u₀: xₖ₊₁ = (aₙ₋ₖ b₀/a₀ − bₙ₋ₖ) u₀/aₙ.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::{Binary, Formula};

use super::{ForceElement, Forces, StateVariable, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::values::Number;
use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;
use crate::syntax::yaml::Value;

/// The states behind the output.
const STAGES: [Sensor; 8] = [
    Sensor::of_motion("stage_1"),
    Sensor::of_motion("stage_2"),
    Sensor::of_motion("stage_3"),
    Sensor::of_motion("stage_4"),
    Sensor::of_motion("stage_5"),
    Sensor::of_motion("stage_6"),
    Sensor::of_motion("stage_7"),
    Sensor::of_motion("stage_8"),
];

/// The output before it is read, so that no filter depends on itself at once.
const OUTPUT: Sensor = Sensor::of_force("value").of_unknown_unit();

/// A linear law from an input to an output.
#[derive(Clone, Debug)]
pub struct Filter {
    /// u, may depend on t, positions, velocities and states.
    input: Formula,
    /// bₘ … b₀, of parameters, m ≤ n.
    numerator: Vec<Formula>,
    /// aₙ … a₀, of parameters.
    denominator: Vec<Formula>,
    /// u₀, of parameters; `None` for 0.
    initial: Option<Formula>,
    /// x₁ … xₙ at the start, of parameters.
    start: Vec<Formula>,
    /// Dimension of y; `None` if unknown.
    dimension: Option<Dimension>,
}

impl ForceElement for Filter {
    const SENSORS: &'static [TypedSensor] =
        &[(OUTPUT, Dimension::NUMBER), (Sensor::CHANGE.of_unknown_unit(), Dimension::NUMBER)];

    fn sensors(&self) -> Vec<TypedSensor> {
        let known = |sensor: Sensor| if self.dimension.is_some() { sensor } else { sensor.of_unknown_unit() };
        let dimension = self.dimension.unwrap_or(Dimension::NUMBER);
        let mut sensors = vec![(known(Sensor::VALUE), dimension)];
        if self.lags() {
            sensors.push((known(Sensor::CHANGE), dimension.per(Dimension::TIME)));
        }
        sensors
    }

    fn states(&self) -> Vec<StateVariable<'_>> {
        let [first, ..] = STAGES;
        let first = if self.lags() { self.sensors()[0].0 } else { first };
        let sensors = [first].into_iter().chain(STAGES.into_iter().skip(1));
        sensors.zip(&self.start).map(|(sensor, initial)| StateVariable { sensor, initial, period: None }).collect()
    }

    fn value_ahead<S: SymbolTable>(reader: &mut Reader<'_, S>, mapping: &Node) -> Option<Option<Dimension>> {
        let [numerator, denominator] = ["numerator", "denominator"].map(|key| list(mapping.get(key)));
        if numerator.len() >= denominator.len() {
            return None;
        }
        let [numerator, denominator] = [numerator, denominator].map(|nodes| {
            let known = nodes.iter().map(|node| reader.quietly(node)).collect::<Vec<_>>();
            of_list(&known, nodes.iter().all(is_literal))
        });
        let input = mapping.get("input").and_then(|node| reader.quietly(node));
        Some(of_output(input, numerator, denominator))
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let input = forces.value(&self.input)?;
        let zero = forces.graph().number(0.0);
        let order = self.start.len();
        let mut numerator = vec![zero; order + 1 - self.numerator.len()];
        for coefficient in &self.numerator {
            numerator.push(forces.value(coefficient)?);
        }
        let mut denominator = Vec::with_capacity(order + 1);
        for coefficient in &self.denominator {
            denominator.push(forces.value(coefficient)?);
        }
        let leading = denominator[0];
        let output = if self.lags() {
            forces.state(0)
        } else {
            let output = forces.state(0) + numerator[0] / leading * input;
            forces.sensor(self.sensors()[0].0, output);
            output
        };
        for index in 0..order {
            let next = if index + 1 < order { forces.state(index + 1) } else { zero };
            let change = next + (numerator[index + 1] * input - denominator[index + 1] * output) / leading;
            forces.state_rate(index, change);
            if index == 0 && self.lags() {
                forces.sensor(self.sensors()[1].0, change);
            }
        }
        Ok(())
    }
}

impl Filter {
    /// Filter with the coefficients of input and output, the highest power of s first, settled at an input.
    pub(super) fn of(
        input: Formula,
        [numerator, denominator]: [Vec<Formula>; 2],
        initial: Option<Formula>,
        dimension: Option<Dimension>,
    ) -> Self {
        let start = settled(initial.as_ref(), &numerator, &denominator);
        Self { input, numerator, denominator, initial, start, dimension }
    }

    /// Whether the output is a state, and not the input's at once.
    fn lags(&self) -> bool {
        self.numerator.len() < self.denominator.len()
    }
}

/// The items of a list that stands behind a key.
fn list(node: Option<&Node>) -> &[Node] {
    match node.map(|node| &node.value) {
        Some(Value::Sequence(items)) => items,
        _ => &[],
    }
}

/// Whether a coefficient is written as a bare number.
fn is_literal(node: &Node) -> bool {
    node.scalar().is_some_and(|scalar| scalar.text.trim().parse::<f64>().is_ok())
}

/// The dimension of the last of a list's coefficients, as the first says that has a known one; of bare numbers that of
/// a number.
fn of_list(known: &[Option<Dimension>], are_literal: bool) -> Option<Dimension> {
    let powers = (0..known.len()).rev();
    let last = |(dimension, power): (&Option<Dimension>, usize)| {
        dimension.map(|dimension| (0..power).fold(dimension, |dimension, _| dimension.per(Dimension::TIME)))
    };
    known.iter().zip(powers).find_map(last).or_else(|| are_literal.then_some(Dimension::NUMBER))
}

/// The dimension of y, from those of u, b₀ and a₀.
fn of_output(
    input: Option<Dimension>,
    numerator: Option<Dimension>,
    denominator: Option<Dimension>,
) -> Option<Dimension> {
    Some(input?.times(numerator?).per(denominator?))
}

/// x₁ … xₙ of a filter that has settled at an input.
fn settled(input: Option<&Formula>, numerator: &[Formula], denominator: &[Formula]) -> Vec<Formula> {
    let zero = Formula::number(0.0);
    let (Some(input), Some(constant), [leading, rest @ ..]) = (input, numerator.last(), denominator) else {
        return vec![zero; denominator.len() - 1];
    };
    let gain = rest.last().map_or(zero, |last| constant.combined(Binary::Div, last));
    let shorter = denominator.len() - numerator.len();
    let state = |(place, coefficient): (usize, &Formula)| {
        let of_output = coefficient.combined(Binary::Mul, &gain);
        let change = match place.checked_sub(shorter) {
            Some(place) => of_output.combined(Binary::Sub, &numerator[place]),
            None => of_output,
        };
        change.combined(Binary::Mul, input).combined(Binary::Div, leading)
    };
    denominator[..rest.len()].iter().enumerate().map(state).collect()
}

impl Group for Filter {
    fn key_names() -> Vec<&'static str> {
        vec!["input", "numerator", "denominator", "initial"]
    }

    fn keys(generator: &mut SchemaGenerator) -> Vec<Key> {
        let mut key = |name, doc, required: bool, is_list: bool| Key {
            name,
            doc,
            unit: "",
            required,
            default: (!required).then(|| 0.into()),
            default_in_words: None,
            schema: match is_list {
                true => generator.subschema_for::<Vec<Number>>(),
                false => generator.subschema_for::<Number>(),
            },
            requirement: None,
            keys: Vec::new(),
        };
        vec![
            key("input", "A formula of t, parameters, positions, velocities and states.", true, false),
            key("numerator", "Coefficients of the input and its rates, the highest first.", true, true),
            key("denominator", "Coefficients of the output and its rates, the highest first.", true, true),
            key("initial", "The constant input that it has settled at when the motion starts.", false, false),
        ]
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        let input = reader.required(fields, "input").and_then(|node| reader.any_unit(node, Context::Effect));
        let [numerator, denominator] = ["numerator", "denominator"].map(|key| Coefficients::read(reader, fields, key));
        let (numerator, denominator) = (numerator?, denominator?);
        check_order(reader, fields, [numerator.formulas.len(), denominator.formulas.len()])?;
        let nodes = list(fields.get("denominator"));
        reader.require(&nodes[0], &denominator.formulas[0], |value| value != 0.0, "must not be zero");
        let (input, dimension) = input?;
        let initial = match fields.get("initial") {
            None => None,
            Some(node) => {
                let (initial, own) = reader.any_unit(node, Context::Constant)?;
                if let (Some(own), Some(wanted)) = (own, dimension) {
                    reader.check_fits(&node.span, own, wanted);
                }
                let last = nodes.len() - 1;
                let settles = "must not be zero where the filter has settled at an input";
                reader.require(&nodes[last], &denominator.formulas[last], |value| value != 0.0, settles);
                Some(initial)
            }
        };
        let dimension = of_output(dimension, numerator.dimension, denominator.dimension);
        let (numerator, denominator) = (numerator.formulas, denominator.formulas);
        Some(Self::of(input, [numerator, denominator], initial, dimension))
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.push(&self.input);
        found.extend(self.numerator.iter().chain(&self.denominator).chain(&self.initial));
    }
}

/// A list of coefficients, the highest power of s first.
struct Coefficients {
    formulas: Vec<Formula>,
    /// Dimension of the last; `None` if unknown.
    dimension: Option<Dimension>,
}

impl Coefficients {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, key: &str) -> Option<Self> {
        let node = reader.required(fields, key)?;
        let nodes = list(Some(node));
        if nodes.is_empty() {
            let help = "the highest power of s comes first, e.g. `[0.01 s^2, 0.14 s, 1]`".to_owned();
            reader.error(Code::BadFilter, node.span.clone(), format!("`{key}` is a list of coefficients"), help);
            return None;
        }
        let read: Vec<_> = nodes.iter().map(|node| reader.any_unit(node, Context::Constant)).collect();
        let (formulas, known): (Vec<_>, Vec<_>) = read.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let dimension = of_list(&known, nodes.iter().all(is_literal));
        for (index, (node, own)) in nodes.iter().zip(known).enumerate() {
            if let (Some(own), Some(last)) = (own, dimension) {
                let power = nodes.len() - 1 - index;
                let wanted = (0..power).fold(last, |dimension, _| dimension.times(Dimension::TIME));
                reader.check_fits(&node.span, own, wanted);
            }
        }
        Some(Self { formulas, dimension })
    }
}

/// Reports a numerator that is too long, a denominator without a state, and one with too many.
fn check_order<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    fields: &Fields<'_>,
    [above, below]: [usize; 2],
) -> Option<()> {
    let (key, message, help) = if below < 2 {
        (
            "denominator",
            "a denominator has two coefficients or more".to_owned(),
            "a factor belongs in formulas, it needs no filter",
        )
    } else if below > STAGES.len() + 1 {
        let help = "put several filters in a row: the input of one is the output of another";
        ("denominator", format!("a denominator has {} coefficients or fewer, not {below}", STAGES.len() + 1), help)
    } else if above > below {
        let message = format!("the numerator has {above} coefficients, more than the denominator, which has {below}");
        ("numerator", message, "such a filter would need rates of its input: let the denominator be as long")
    } else {
        return Some(());
    };
    reader.error(
        Code::BadFilter,
        fields.get(key).map_or_else(|| fields.at.clone(), |node| node.span.clone()),
        message,
        help.to_owned(),
    );
    None
}

impl Element for Filter {
    const KEYWORD: &'static str = "filter";
    const WHAT: &'static str = "a filter";
    const DESCRIPTION: &'static str = "A linear law from an input to an output, by numerator and denominator.";
    const EQUATIONS: &'static [&'static str] = &["(aₙ sⁿ + … + a₀) y = (bₙ sⁿ + … + b₀) u,  s = d/dt"];
    const SOURCE: &'static str = "Kailath, Linear Systems (1980), sec. 2.1";
    const EXAMPLE: &'static str =
        "{ input: arm.angle, numerator: [1], denominator: [0.01 s^2, 0.14 s, 1], initial: 0.3 rad }";
    const SHORT: Option<&'static str> = None;
}

impl JsonSchema for Filter {
    fn schema_name() -> Cow<'static, str> {
        "Filter".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Self::object(generator)
    }
}
