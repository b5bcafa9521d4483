//! Limits of excitations: `± 5 N`, `20 N ± 10%`, `[lower, upper]`.

use symdiff::{Binary, Formula, Unary};

use crate::grammar::quantity::Dimension;
use crate::grammar::tolerance::{self, Deviation};
use crate::grammar::unit::number_and_unit;
use crate::grammar::{Context, Symbol};
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::yaml::Node;

/// An example of limits.
const EXAMPLE: &str = "e.g. `± 5 N`, `20 N ± 10%`, or `[lower, upper]`";

/// Middle and half distance of limits.
pub struct Limits {
    pub middle: Formula,
    pub reach: Formula,
}

/// A formula of t and parameters of the excitation's dimension, or that says it.
fn any_of(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let (formula, own) = reader.any_unit(node, Context::Time)?;
    if let (Some(own), Some(known)) = (own, *dimension) {
        reader.check_fits(&node.span, own, known).then_some(())?;
    }
    *dimension = dimension.or(own);
    Some(formula)
}

/// Reads limits. A value alone has no distance, where it `may_be_one`.
pub fn limits(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>, may_be_one: bool) -> Option<Limits> {
    let read = match tolerance::read(node) {
        Ok(read) => read,
        Err(error) => {
            reader.diagnostics.push(*error);
            return None;
        }
    };
    Some(match (read.value, read.deviation) {
        (value, Some(Deviation::Either(deviation))) => around(reader, value.as_ref(), &deviation, dimension)?,
        (None, Some(Deviation::Between(pair))) => {
            let [lower, upper] = reader.two(&pair, "a list of the lower and the upper limit")?;
            let lower = any_of(reader, lower, dimension);
            let upper = any_of(reader, upper, dimension);
            let (lower, upper) = (lower?, upper?);
            let half = Formula::number(0.5);
            Limits {
                middle: lower.combined(Binary::Add, &upper).combined(Binary::Mul, &half),
                reach: upper.combined(Binary::Sub, &lower).combined(Binary::Mul, &half),
            }
        }
        (Some(value), None) if may_be_one => {
            Limits { middle: any_of(reader, &value, dimension)?, reach: Formula::number(0.0) }
        }
        _ => {
            reader.error(Code::BadExcitation, node.span.clone(), "limits belong here", EXAMPLE.to_owned());
            return None;
        }
    })
}

/// `20 N ± 10%`, `± 5 N`.
fn around(
    reader: &mut Reader,
    value: Option<&Node>,
    deviation: &Node,
    dimension: &mut Option<Dimension>,
) -> Option<Limits> {
    let middle = match value {
        Some(value) => any_of(reader, value, dimension)?,
        None => Formula::number(0.0),
    };
    let percent = deviation.scalar().and_then(|scalar| number_and_unit(&scalar.text));
    let reach = match (percent.filter(|(_, unit, _)| *unit == "%"), value) {
        (Some((percent, ..)), Some(_)) => {
            middle.clone().applied(Unary::Abs).combined(Binary::Mul, &Formula::number(percent / 100.0))
        }
        _ => any_of(reader, deviation, dimension)?,
    };
    Some(Limits { middle, reach })
}

/// Whether a formula changes in time.
pub fn is_of_time(reader: &Reader, formula: &Formula) -> bool {
    formula.names().any(|(name, _)| matches!(reader.symbol(name), Some(Symbol::Time | Symbol::Trajectory { .. })))
}
