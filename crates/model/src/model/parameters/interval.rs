//! How far a parameter may deviate: `tolerance`, `interval`, `plus` and `minus`.

use symdiff::formula::Term;

use super::{ParameterDraft, Spec};
use crate::grammar::dimension::KnownDimension;
use crate::grammar::fits::ToleranceClass;
use crate::grammar::formulas::{Written, evaluate};
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::unit::number_and_unit;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest;
use crate::syntax::yaml::Node;

/// Nominal, lower and upper value.
pub fn bounds(
    reader: &mut Reader,
    draft: &ParameterDraft,
    nominal: Option<f64>,
    kind: &mut KnownDimension,
) -> Option<[f64; 3]> {
    let Spec { value, tolerance, interval, plus, minus, class, .. } = &draft.spec;
    if draft.spec.contradictory {
        return None;
    }
    if let Some(node) = interval {
        let [first, second] = reader.two(node, "a list of the smallest and the largest value")?;
        let lower = bare_number(reader, draft, first, kind);
        let upper = bare_number(reader, draft, second, kind);
        let (lower, upper) = (lower?, upper?);
        if lower > upper {
            let help = format!("the smaller one stands first: `[{}, {}]`", text(second), text(first));
            reader.error(Code::ReversedRange, node.span.clone(), "the interval is reversed", help);
            return None;
        }
        let nominal = match (value, nominal) {
            (None, _) => lower + (upper - lower) / 2.0,
            (Some(_), nominal) => nominal?,
        };
        if !(lower..=upper).contains(&nominal) {
            let place = value.as_ref().map_or_else(|| node.span.clone(), |value| value.span.clone());
            let diagnostic = Diagnostic::error(Code::BadTolerance, place, "the value lies outside its interval");
            reader.diagnostics.push(diagnostic.also(node.span.clone(), "the interval"));
            return None;
        }
        return Some([nominal, lower, upper]);
    }
    // Without a value there is nothing to deviate from; that was reported.
    value.as_ref()?;
    if let Some(node) = class {
        return by_class(reader, node, nominal, kind);
    }
    let (above, below) = deviations(reader, draft, nominal, kind)?;
    let nominal = nominal?;
    let (lower, upper) = (nominal - below, nominal + above);
    if !(lower.is_finite() && upper.is_finite() && (upper - lower).is_finite()) {
        let written = [tolerance, plus, minus].into_iter().flatten().next();
        let place = written.map_or_else(|| 0..0, |node| node.span.clone());
        reader.error(Code::NotANumber, place, "the parameter's limits are no finite numbers", None);
        return None;
    }
    Some([nominal, lower, upper])
}

/// The middle of the limits that a tolerance class gives a size, and the limits.
fn by_class(reader: &mut Reader, node: &Node, size: Option<f64>, kind: &KnownDimension) -> Option<[f64; 3]> {
    let size = size?;
    if kind.dimension() != Some(Dimension::LENGTH) {
        let help = "e.g. `12 mm H7`".to_owned();
        reader.error(
            Code::BadClass,
            node.span.clone(),
            "a tolerance class belongs to a length, but this value is no length",
            help,
        );
        return None;
    }
    // Without the rounding error of 12 mm in metres.
    let millimetres = (size * 1e9).round() / 1e6;
    let found = ToleranceClass::parse(&node.scalar()?.text)?.and_then(|class| class.deviations(millimetres));
    match found {
        Ok(deviations) => {
            let [lower, upper] = deviations.map(|deviation| (1e6 * millimetres + 1e3 * deviation) / 1e9);
            Some([lower + (upper - lower) / 2.0, lower, upper])
        }
        Err(error) => {
            reader.error(Code::BadClass, node.span.clone(), error.to_string(), None);
            None
        }
    }
}

/// How far the value may deviate upwards and downwards.
pub fn deviations(
    reader: &mut Reader,
    draft: &ParameterDraft,
    nominal: Option<f64>,
    kind: &mut KnownDimension,
) -> Option<(f64, f64)> {
    let Spec { tolerance, plus, minus, class, .. } = &draft.spec;
    if let Some(node) = class {
        let help = "give the deviations themselves, e.g. `tolerance: 0.01 mm`".to_owned();
        reader.error(
            Code::BadClass,
            node.span.clone(),
            "a tolerance class needs a size that no uncertain parameter changes",
            help,
        );
        return None;
    }
    let (above, below) = match tolerance {
        Some(node) => {
            let either = deviation(reader, draft, Some(node), nominal, kind);
            (either, either)
        }
        None => {
            let above = deviation(reader, draft, plus.as_ref(), nominal, kind);
            (above, deviation(reader, draft, minus.as_ref(), nominal, kind))
        }
    };
    above.zip(below)
}

/// How far a value may deviate: `1%` of it, or a quantity.
fn deviation(
    reader: &mut Reader,
    draft: &ParameterDraft,
    node: Option<&Node>,
    nominal: Option<f64>,
    kind: &mut KnownDimension,
) -> Option<f64> {
    let Some(node) = node else { return Some(0.0) };
    let percent = node.scalar().and_then(|scalar| number_and_unit(&scalar.text)).filter(|(_, unit, _)| *unit == "%");
    let deviation = match percent {
        Some((percent, ..)) => {
            // The sign of the percentage, not of the value, says whether it is negative.
            percent / 100.0 * nominal?.abs()
        }
        None => bare_number(reader, draft, node, kind)?,
    };
    let negative = percent.map_or(deviation, |(percent, ..)| percent) < 0.0;
    if negative {
        reader.error(Code::BadTolerance, node.span.clone(), "a tolerance cannot be negative", None);
        return None;
    }
    Some(deviation)
}

/// A number in the parameter's unit, or with its own.
pub fn bare_number(reader: &mut Reader, draft: &ParameterDraft, node: &Node, kind: &mut KnownDimension) -> Option<f64> {
    match reader.written(node)? {
        Written::Quantity { value, unit } => {
            match kind.dimension() {
                Some(dimension) => {
                    reader.check_fits(&node.span, unit.dimension, dimension).then_some(())?;
                }
                None => *kind = KnownDimension::parameter(unit.dimension),
            }
            Some(unit.to_si(value))
        }
        Written::Formula(formula) => {
            if !reader.check_names(node, &formula, 0, Context::Constant) {
                return None;
            }
            if formula.names().next().is_some() {
                reader.error(
                    Code::BadTolerance,
                    node.span.clone(),
                    "the limits of a parameter are numbers, not formulas",
                    None,
                );
                return None;
            }
            let own_unit = matches!(draft.value, Some(Written::Quantity { .. })) && draft.unit.is_none();
            let bare = formula.terms().iter().all(|(term, _)| !matches!(term, Term::Quantity(..)));
            if own_unit && bare {
                let unit =
                    draft.spec.value.as_ref().and_then(Node::scalar).and_then(|scalar| number_and_unit(&scalar.text));
                let help = format!("e.g. `{} {}`", text(node), unit.map_or("m", |(_, unit, _)| unit));
                reader.error(Code::MissingUnit, node.span.clone(), "this number has no unit, but the value has", help);
                return None;
            }
            let dimension = reader.kind(node, &formula, 0).dimension();
            if let (Some(found), Some(wanted)) = (dimension, kind.dimension()) {
                reader.check_fits(&node.span, found, wanted).then_some(())?;
            }
            // With units in it, the formula gives SI.
            let in_si = dimension.is_some();
            let number = evaluate(&formula, |_| None).filter(|number| number.is_finite());
            if number.is_none() {
                reader.error(
                    Code::NotANumber,
                    node.span.clone(),
                    format!("`{}` is not a finite number", text(node)),
                    None,
                );
            }
            match draft.unit {
                Some(unit) if !in_si => number.map(|number| unit.to_si(number)),
                _ => number,
            }
        }
    }
}

fn text(node: &Node) -> String {
    suggest::clip(node.scalar().map_or("", |scalar| scalar.text.trim()))
}
