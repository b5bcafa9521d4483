//! Numbers with tolerances, written in one piece, as the fields of a parameter's long form.

use crate::grammar::quantity::Dimension;
use crate::grammar::report::Report;
use crate::grammar::tolerance::{self, Deviation, Toleranced};
use crate::grammar::unit::{Unit, number_and_unit};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Value};

/// The fields `value`, `tolerance`, `interval`, `plus` and `minus` that a number in one piece stands for. What cannot
/// be read is the `value`, of which it is reported.
pub fn fields(node: &Node) -> Vec<Entry> {
    let Ok(Toleranced { value, deviation }) = tolerance::read(node) else { return vec![field("value", node.clone())] };
    let mut fields: Vec<Entry> = value.into_iter().map(|value| field("value", value)).collect();
    match deviation {
        None => {}
        Some(Deviation::Either(either)) => fields.push(field("tolerance", either)),
        Some(Deviation::Sides { plus, minus }) => fields.extend([field("plus", plus), field("minus", minus)]),
        Some(Deviation::Between(between)) => fields.push(field("interval", between)),
        Some(Deviation::Class(class)) => fields.push(field("tolerance", class)),
    }
    fields
}

/// The fields of a parameter, in whichever form it is written.
pub fn fields_of_parameter(node: &Node) -> Vec<Entry> {
    match &node.value {
        Value::Mapping(entries) => {
            let of_entry = |entry: &Entry| match entry.key.as_str() {
                "value" if entry.value.scalar().is_some() => fields(&entry.value),
                _ => vec![entry.clone()],
            };
            entries.iter().flat_map(of_entry).collect()
        }
        _ => fields(node),
    }
}

/// The dimension of a number that is written with its unit; nothing of a formula.
pub fn dimension(node: &Node) -> Option<Dimension> {
    let fields = fields_of_parameter(node);
    let text =
        |key: &str| fields.iter().find(|field| field.key == key)?.value.scalar().map(|scalar| scalar.text.as_str());
    if let Some(unit) = text("unit") {
        return Unit::parse(unit).ok().map(|unit| unit.dimension);
    }
    let (_, unit, _) = number_and_unit(text("value")?)?;
    Unit::parse(unit).ok().map(|unit| unit.dimension)
}

/// Whether the unit of a number given instead of a parameter's own fits that one's; reports one that does not.
pub fn fits(report: &mut Report, given: &Node, own: &Node) -> bool {
    match (dimension(given), dimension(own)) {
        (Some(given_as), Some(wanted)) => report.check_fits(&given.span, given_as, wanted),
        _ => true,
    }
}

/// Warns of a bare number, given instead of a parameter's own, that looks as if it were in the unit of that one: `31`
/// instead of `30 mm` is 31 m.
pub fn suspect_unit(report: &mut Report, given: &Node, own: &Node) {
    let [given_fields, own_fields] = [given, own].map(fields_of_parameter);
    if [&given_fields, &own_fields].into_iter().flatten().any(|field| field.key == "unit") {
        return;
    }
    let Some((node, bare)) = first_number(&given_fields).and_then(|node| {
        let number: f64 = node.scalar()?.text.trim().parse().ok()?;
        Some((node, number))
    }) else {
        return;
    };
    let own_text = first_number(&own_fields).and_then(Node::scalar).map_or("", |scalar| scalar.text.trim());
    let Some((written, unit_text, _)) = number_and_unit(own_text) else { return };
    let Some(unit) = Unit::parse(unit_text).ok().filter(|unit| !unit.is_si()) else { return };
    let factor_from = |number: f64| {
        let ratio = (bare / number).abs();
        ratio.max(ratio.recip())
    };
    if factor_from(written) < factor_from(unit.to_si(written)) {
        let si = unit.dimension.unit();
        let message = format!("a bare number is in SI units, where the model has `{}`", clip(own_text));
        let help = if si.is_empty() {
            format!("write `{bare} {unit_text}`")
        } else {
            format!("write `{bare} {unit_text}`, or `{bare} {si}` where that is meant")
        };
        report.diagnostics.push(Diagnostic::warning(Code::UnitLeftOut, node.span.clone(), message).help(help));
    }
}

/// The value of a parameter, or the least.
fn first_number(fields: &[Entry]) -> Option<&Node> {
    let of = |key: &str| fields.iter().find(|field| field.key == key).map(|field| &field.value);
    of("value").or_else(|| match &of("interval")?.value {
        Value::Sequence(ends) => ends.first(),
        _ => None,
    })
}

/// A field of a parameter.
pub fn field(key: &str, value: Node) -> Entry {
    Entry { key: key.to_owned(), key_span: value.span.clone(), value }
}
