//! `cost`: cost of an uncertain parameter's tolerance, for `mbint allocate`.

use super::law::positive;
use super::{ParameterDraft, interval};
use crate::grammar::dimension::KnownDimension;
use crate::grammar::quantity::Dimension;
use crate::keys;
use crate::model::description::{Cost, Grade};
use crate::model::names::Reader;
use crate::numerics::iso286;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Reads a cost of a parameter with this nominal value.
pub fn read(
    reader: &mut Reader,
    draft: &ParameterDraft,
    node: &Node,
    nominal: f64,
    kind: &mut KnownDimension,
) -> Option<Cost> {
    if let Some(scalar) = node.scalar() {
        if scalar.text == "fixed" {
            return Some(Cost::Fixed);
        }
        let message = format!("`{}` is no cost", clip(&scalar.text));
        let help = "write `fixed`, `{ reciprocal: 2 }` or `{ grades: { IT7: 5, IT9: 2 } }`".to_owned();
        reader.error(Code::BadCost, node.span.clone(), message, help);
        return None;
    }
    let fields = reader.fields::<keys::CostKinds>(node, node.span.clone())?;
    let grades = match (fields.get("reciprocal"), fields.get("grades")) {
        (Some(node), None) => return positive(reader, node).map(Cost::Reciprocal),
        (None, Some(grades)) => grades,
        _ => {
            reader.error(Code::BadCost, node.span.clone(), "a cost is `reciprocal`, or has `grades`", None);
            return None;
        }
    };
    let size = match fields.get("size") {
        Some(node) => interval::bare_number(reader, draft, node, kind)?,
        None => nominal,
    };
    let mut known: Vec<Grade> = Vec::new();
    for entry in reader.entries(grades, "grades") {
        let tolerance = tolerance(reader, draft, entry, size, kind);
        let cost = positive(reader, &entry.value);
        known.push(Grade { name: entry.key.clone(), tolerance: tolerance?, cost: cost? });
    }
    if known.is_empty() {
        reader.error(Code::BadCost, grades.span.clone(), "there is no grade", None);
        return None;
    }
    known.sort_by(|a, b| a.tolerance.total_cmp(&b.tolerance));
    Some(Cost::Grades(known))
}

/// Half the width of a grade's tolerance zone: of ISO 286, or as it is written.
fn tolerance(
    reader: &mut Reader,
    draft: &ParameterDraft,
    entry: &Entry,
    size: f64,
    kind: &mut KnownDimension,
) -> Option<f64> {
    let Some(grade) = entry.key.strip_prefix("IT") else {
        let scalar = Scalar::plain(&entry.key, None);
        let node = Node { span: entry.key_span.clone(), value: Value::Scalar(scalar) };
        let found = interval::bare_number(reader, draft, &node, kind)?;
        if found <= 0.0 {
            reader.error(Code::BadCost, entry.key_span.clone(), "the tolerance of a grade is positive", None);
            return None;
        }
        return Some(found);
    };
    if kind.dimension().is_some_and(|dimension| dimension != Dimension::LENGTH) {
        reader.error(
            Code::BadCost,
            entry.key_span.clone(),
            "ISO 286 is about lengths, but the parameter is no length",
            None,
        );
        return None;
    }
    let width = grade.parse::<u8>().ok().and_then(|grade| iso286::tolerance(grade, size.abs()));
    if width.is_none() {
        let message = format!("`{}` of a size of {} mm is not in ISO 286-1's table", clip(&entry.key), 1e3 * size);
        let help =
            "grades are IT5 to IT12, sizes above 0 up to 3150 mm; give a `size`, or tolerances such as `0.02 mm`";
        reader.error(Code::BadCost, entry.key_span.clone(), message, help.to_owned());
    }
    width.map(|width| 0.5 * width)
}
