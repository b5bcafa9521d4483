//! Chains of dimensions with the nominal values of their links.

use symdiff::Formula;

use crate::assemble::NumberFormulas;
use crate::model::{Description, ParameterValue};
use crate::results::{Bounds, ChainSummary, LinkSummary, OutputBounds};

/// All chains of a model, in the row in which the closing output's bounds are widest.
pub(super) fn chains(description: &Description, bounds: &Bounds) -> Vec<ChainSummary> {
    let names: Vec<&str> = description.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let formulas: Vec<Formula> = names.iter().filter_map(|name| Formula::parse(name).ok()).collect();
    let nominal: Vec<f64> = description
        .parameters
        .iter()
        .filter_map(|parameter| match parameter.value {
            ParameterValue::Interval { nominal, .. } => Some(nominal),
            ParameterValue::Formula(_) => None,
        })
        .collect();
    let values = NumberFormulas::of(&description.parameters, &[], &formulas).values(&nominal, &[]);
    let of_output = |name: &str| bounds.outputs.iter().find(|output| output.name == name);
    let chain = |chain: &crate::model::Chain| {
        let closing = of_output(&chain.output)?;
        let row = widest(closing);
        let value = |name: &str| match names.iter().position(|known| *known == name) {
            Some(parameter) => values.get(parameter).copied(),
            None => of_output(name)?.nominal.get(row).copied(),
        };
        let link = |link: &crate::model::ChainLink| LinkSummary {
            name: link.name.clone(),
            from: link.from.clone(),
            to: link.to.clone(),
            is_forward: link.is_forward,
            nominal: value(&link.name).unwrap_or(f64::NAN),
        };
        Some(ChainSummary {
            output: chain.output.clone(),
            nominal: *closing.nominal.get(row)?,
            links: chain.links.iter().map(link).collect(),
        })
    };
    description.chains.iter().filter_map(chain).collect()
}

/// The row in which an output's first band is widest.
fn widest(output: &OutputBounds) -> usize {
    let Some(band) = output.bands.first() else { return 0 };
    let width = |row: &usize| band.upper[*row] - band.lower[*row];
    let known = (0..band.lower.len()).filter(|row| width(row).is_finite());
    known.max_by(|a, b| width(a).total_cmp(&width(b)).then(b.cmp(a))).unwrap_or(0)
}
