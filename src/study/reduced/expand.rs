//! What reduced outputs and requirements are of, as outputs of the model that are not shown.

use std::borrow::Cow;

use symdiff::Formula;
use symdiff::formula::Term;

use crate::model::{Description, Output, Requirement};
use crate::results::{Bounds, ContributionSummary, ErrorSummary, Summary};

/// The model with these outputs behind its own; the model itself where it reduces and requires nothing.
pub fn expanded(description: &Description) -> Cow<'_, Description> {
    if description.reduced.is_empty() && description.requirements.is_empty() {
        return Cow::Borrowed(description);
    }
    let mut expanded = description.clone();
    let outputs = &mut expanded.outputs;
    for reduced in &mut expanded.reduced {
        reduced.places = reduced.sources.iter().map(|source| place(outputs, &reduced.name, source)).collect();
    }
    for Requirement { name, slacks, places, .. } in expanded.requirements.iter_mut().filter(|own| own.times.is_some()) {
        *places = slacks.iter().map(|slack| place(outputs, name, slack)).collect();
    }
    Cow::Owned(expanded)
}

/// The output with a formula; a new one where none has it.
fn place(outputs: &mut Vec<Output>, name: &str, formula: &Formula) -> usize {
    let terms = |formula: &Formula| formula.terms().iter().map(|(term, _)| term.clone()).collect::<Vec<Term>>();
    let own = terms(formula);
    outputs.iter().position(|output| terms(&output.formula) == own).unwrap_or_else(|| {
        outputs.push(Output { name: name.to_owned(), formula: formula.clone(), unit: String::new(), dimension: None });
        outputs.len() - 1
    })
}

/// Results with the model's own outputs, and what its analysis adds: without those behind its own, of all those of the expanded model.
pub fn shown(
    description: &Description,
    expanded: &Description,
    (mut bounds, mut summary): (Bounds, Summary),
) -> (Bounds, Summary) {
    let hidden = description.outputs.len()..expanded.outputs.len();
    if !hidden.is_empty() {
        bounds.outputs.drain(hidden.clone());
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
    (bounds, summary)
}
