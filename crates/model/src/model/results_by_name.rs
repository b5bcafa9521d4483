//! Formulas of numbers that are known by their names when a sample is over: reduced outputs, and results
//! that an analysis adds to the outputs.

use std::ops::Range;

use symdiff::Formula;

use super::description::{Analysis, Description};
use crate::grammar::Symbol;
use crate::grammar::dimension::{self, KnownDimension};
use crate::grammar::quantity::Dimension;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Node;

/// The smallest eigenvalue of an equilibrium.
const STABILITY: &str = "stability";

/// The largest growth of any mode.
const GROWTH: &str = "growth";

/// A formula that was read, with its dimension where that is known.
pub(super) struct DimensionedFormula {
    pub formula: Formula,
    pub dimension: Option<Dimension>,
}

/// Names in a formula of numbers.
pub(super) struct Numbers {
    /// The dimension of a number, where that is known; `None` of other results.
    pub dimension: fn(&Description, &str) -> Option<Option<Dimension>>,
    /// Said of other names.
    pub refusal: &'static str,
    /// Suggested correction.
    pub help: &'static str,
}

/// Reduced outputs.
pub(super) const REDUCED: Numbers = Numbers {
    dimension: |model, name| model.reduced.iter().find(|own| own.name == name).map(|own| own.dimension),
    refusal: "neither a reduced output nor a parameter",
    help: "a reduced output is compared with one number per motion: make the other one a reduced output too",
};

/// Outputs, and results that an analysis adds to them.
pub(super) const RESULTS: Numbers = Numbers {
    dimension: |model, name| of_output(model, name).or_else(|| of_analysis(model, name)),
    refusal: "neither an output, nor a result of the analysis, nor a parameter",
    help: "modes have `mode1.frequency`, `mode1.damping`, …, `growth` with states, and `NAME.amplitude` of a response; what else is \
           compared with them is an output or a parameter",
};

fn of_output(model: &Description, name: &str) -> Option<Option<Dimension>> {
    model.outputs.iter().find(|own| own.name == name).map(|own| own.dimension)
}

/// The dimension of a result, where that is known; `None` of a name that is no result of the analysis.
fn of_analysis(model: &Description, name: &str) -> Option<Option<Dimension>> {
    let rate = Dimension::FREQUENCY;
    match model.analysis {
        Analysis::Statics => (name == STABILITY).then(|| Some(rate.times(rate))),
        Analysis::Modes(_) if name.trim_end_matches('_') == GROWTH => Some(Some(rate)),
        Analysis::Modes(_) => {
            let (owner, quantity) = name.split_once('.')?;
            let is_random = model.trajectories.iter().any(|own| own.random().is_some());
            if let Some(dimension) = of_output(model, owner).filter(|_| is_random) {
                return match quantity {
                    "rms" => Some(dimension),
                    "crossings" => Some(Some(rate)),
                    _ => None,
                };
            }
            if model.modes.responses.iter().any(|response| response.name == owner) {
                return match quantity {
                    "amplitude" => Some(None),
                    "phase" => Some(Some(Dimension::ANGLE)),
                    _ => None,
                };
            }
            let number: usize = owner.strip_prefix("mode")?.parse().ok()?;
            // Reduced outputs are read before the section that says how many modes there are.
            let is_asked = number >= 1 && (model.modes.number == 0 || number <= model.modes.number);
            let dimension = match quantity {
                "frequency" | "growth" => Some(rate),
                "damping" => Some(Dimension::NUMBER),
                "time_constant" => Some(Dimension::TIME),
                _ if quantity.starts_with("shape.") => None,
                _ => return None,
            };
            is_asked.then_some(dimension)
        }
        Analysis::Motion | Analysis::Kinematics | Analysis::BlackBox | Analysis::Dimensions => None,
    }
}

/// Whether formulas of an analysis name its results, and outputs by their names, instead of the motion.
pub(super) fn are_named<'t>(model: &Description, mut names: impl Iterator<Item = &'t str>) -> bool {
    match model.analysis {
        Analysis::Modes(_) => true,
        Analysis::Statics => names.any(|name| name == STABILITY && of_output(model, name).is_none()),
        Analysis::Motion | Analysis::Kinematics | Analysis::BlackBox | Analysis::Dimensions => false,
    }
}

/// The unit in which people see a margin of results, if it is not that of their dimension.
pub(super) fn unit<'t>(mut names: impl Iterator<Item = &'t str>) -> Option<&'static str> {
    names.any(|name| name.starts_with("mode") && name.ends_with(".frequency")).then_some("Hz")
}

/// The formula at each frequency of the response that it names; itself where it names none.
pub(super) fn at_frequencies(model: &Description, formula: &Formula) -> Vec<Formula> {
    let names_of = |response: &str, name: &str| name.split_once('.').is_some_and(|(owner, _)| owner == response);
    let is_named = |response: &&super::description::ResponseRequest| {
        formula.names().any(|(name, _)| of_output(model, name).is_none() && names_of(&response.name, name))
    };
    let named = model.modes.responses.iter().find(is_named);
    let Some(response) = named else { return vec![formula.clone()] };
    let at = |index: usize| {
        formula.with_names(|name| {
            let (_, quantity) = name.split_once('.').filter(|_| names_of(&response.name, name))?;
            Some(Formula::name(&format!("response.{}.{index}.{quantity}", response.name)))
        })
    };
    (0..response.frequencies.len()).map(at).collect()
}

/// The formula of numbers and parameters in a part of a scalar.
pub(super) fn part(
    reader: &mut Reader,
    node: &Node,
    range: Range<usize>,
    numbers: &Numbers,
) -> Option<DimensionedFormula> {
    let scalar = reader.scalar(node, "a formula")?;
    let formula: Formula = reader.parse(node, scalar, range.clone())?;
    if formula.names().any(|(name, _)| reader.is_unread_output(name)) {
        return None;
    }
    let mut unknown = None;
    for (name, span) in formula.names() {
        if (numbers.dimension)(&reader.model, name).is_some() {
            continue;
        }
        match reader.symbol(name) {
            Some(Symbol::Parameter(index)) => {
                if let Some(used) = reader.used.get_mut(index) {
                    *used = true;
                }
            }
            _ => unknown = Some((clip(name), range.start + span.start..range.start + span.end)),
        }
    }
    if let Some((name, span)) = unknown {
        let message = format!("`{name}` is {}", numbers.refusal);
        reader.error(Code::UnknownName, scalar.place(&node.span, span), message, numbers.help.to_owned());
        return None;
    }
    let mut mismatches = Vec::new();
    let kind = |name: &str| match (numbers.dimension)(&reader.model, name) {
        Some(dimension) => dimension.map_or(KnownDimension::Any, KnownDimension::motion),
        None => match reader.symbol(name) {
            Some(Symbol::Parameter(index)) => reader.kinds.get(index).copied().unwrap_or(KnownDimension::Any),
            _ => KnownDimension::Any,
        },
    };
    let dimension = dimension::analyse(&formula, kind, |_| [None; 2], &mut mismatches).dimension();
    for mismatch in mismatches {
        let part = range.start + mismatch.span.start..range.start + mismatch.span.end;
        reader.error(Code::WrongDimension, scalar.place(&node.span, part), mismatch.message, None);
    }
    Some(DimensionedFormula { formula, dimension })
}
