//! Outputs that name other outputs: those above them.

use symdiff::Formula;

use super::description::Output;
use super::names::Reader;
use crate::grammar::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Entry;

/// The formula of one of all outputs, with the formulas of outputs above substituted for their names. A name of the
/// model is unchanged. Reports an output that stands further down, and a formula that gets too long.
pub(super) fn with_outputs(reader: &mut Reader, entry: &Entry, all: &[Entry], formula: Formula) -> Option<Formula> {
    let index = |name: &str| all.iter().position(|entry| entry.key == name);
    let own = index(&entry.key);
    let mut named: Vec<(&str, &Formula)> = Vec::new();
    for (name, span) in formula.names().filter(|(name, _)| reader.symbol(name).is_none()) {
        if let Some(known) = above(reader, name) {
            named.push((name, &known.formula));
        } else if let Some(other) = index(name) {
            // Errors of one above are reported there.
            if Some(other) >= own {
                let message = match Some(other) == own {
                    true => format!("the output `{}` names itself", clip(name)),
                    false => format!("`{}` is an output that stands further down", clip(name)),
                };
                let node = &entry.value;
                let index = node.scalar().map_or_else(|| node.span.clone(), |text| text.place(&node.span, span));
                reader.error(Code::Circle, index, message, "an output may name those above it".to_owned());
            }
            return None;
        }
    }
    if named.iter().map(|(_, formula)| formula.terms().len()).sum::<usize>() > TUNING.formula_terms {
        let message = format!(
            "with the outputs that it names, the formula has more than {most} operations",
            most = TUNING.formula_terms
        );
        reader.error(Code::TooLarge, entry.value.span.clone(), message, None);
        return None;
    }
    Some(
        formula
            .with_names(|name| named.iter().find(|(known, _)| *known == name).map(|(_, formula)| (*formula).clone())),
    )
}

fn above<'r>(reader: &'r Reader, name: &str) -> Option<&'r Output> {
    reader.model.outputs.iter().find(|output| output.name == name)
}
