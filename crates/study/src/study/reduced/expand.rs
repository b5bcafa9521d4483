//! Arguments of reduced outputs and requirements, as outputs of the model that are not shown.

use std::borrow::Cow;

use symdiff::Formula;
use symdiff::formula::Term;

use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::unit::Unit;
use crate::model::{Description, Output};
use crate::results::{Bounds, ContributionSummary, ErrorSummary, Summary};

/// The model with these outputs behind its own; the model itself if it reduces and requires nothing.
pub fn expanded(description: &Description) -> Cow<'_, Description> {
    if description.reduced.is_empty() && description.requirements.is_empty() {
        return Cow::Borrowed(description);
    }
    let mut expanded = description.clone();
    let outputs = &mut expanded.outputs;
    for reduced in &mut expanded.reduced {
        let of_results = reduced.of_results;
        reduced.outputs =
            reduced.sources.iter().map(|source| output_of(outputs, &reduced.name, source, of_results)).collect();
    }
    for own in expanded.requirements.iter_mut().filter(|own| own.times.is_some()) {
        let of = |slack| output_of(outputs, &own.name, slack, own.of_results);
        own.outputs = own.slacks.iter().map(of).collect();
    }
    Cow::Owned(expanded)
}

/// Index of the output with a formula; of a new one if none has it.
fn output_of(outputs: &mut Vec<Output>, name: &str, formula: &Formula, of_results: bool) -> usize {
    let terms = |formula: &Formula| formula.terms().iter().map(|(term, _)| term.clone()).collect::<Vec<Term>>();
    let own = terms(formula);
    let is_same = |output: &Output| output.of_results == of_results && terms(&output.formula) == own;
    outputs.iter().position(is_same).unwrap_or_else(|| {
        let (name, formula) = (name.to_owned(), formula.clone());
        outputs.push(Output { name, formula, unit: String::new(), dimension: None, of_results });
        outputs.len() - 1
    })
}

/// Results for the model's own outputs, and for those that its analysis adds, out of those of the expanded model.
pub fn shown(
    description: &Description,
    expanded: &Description,
    mut bounds: Bounds,
    mut summary: Summary,
) -> (Bounds, Summary) {
    let hidden = description.outputs.len()..expanded.outputs.len();
    if !hidden.is_empty() {
        bounds.outputs.drain(hidden.clone());
        bounds.witnesses.retain(|own| own.output < hidden.start);
        bounds.derivatives.retain(|own| own.output < hidden.start);
        bounds.functions.retain(|own| own.output.is_none_or(|output| output < hidden.start));
        let shown: Vec<&str> = bounds.outputs.iter().map(|output| output.name.as_str()).collect();
        summary.excitations.retain(|own| shown.contains(&own.output.as_str()));
        if !bounds.contributions.is_empty() {
            bounds.contributions.drain(hidden.clone());
        }
        if let Some(analysis) = summary.analysis.as_mut().filter(|analysis| !analysis.values.is_empty()) {
            analysis.values.drain(hidden);
        }
        summary.errors = ErrorSummary::of(&bounds);
        summary.contributions = ContributionSummary::of(&bounds);
    }
    for output in &mut bounds.outputs {
        output.display = description.display.get(&output.name).cloned();
    }
    for error in &mut summary.errors {
        error.display = description.display.get(&error.output).cloned();
    }
    for value in summary.analysis.iter_mut().flat_map(|analysis| &mut analysis.values) {
        value.display = description.display.get(&value.output).cloned();
    }
    for own in summary.statistics.iter_mut().flat_map(|statistics| &mut statistics.summary.outputs) {
        own.display = description.display.get(&own.output).cloned();
    }
    for point in &mut bounds.responses {
        point.amplitude.display = of_amplitude(description, &point.name, &point.amplitude.unit);
    }
    (bounds, summary)
}

/// The declared unit of a response's output over the load's unit.
fn of_amplitude(description: &Description, name: &str, unit: &str) -> Option<DisplayUnit> {
    let response = description.modes.responses.iter().find(|response| response.name == name)?;
    let output = description.outputs.iter().find(|output| output.name == response.output)?;
    let si = if output.unit.is_empty() { "1" } else { &output.unit };
    let over = unit.strip_prefix(si)?;
    let text = format!("{}{over}", description.display.get(&response.output)?.text);
    let unit = Unit::parse(&text).ok()?;
    Some(DisplayUnit::new(&text, unit))
}
