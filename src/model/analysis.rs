//! `analysis:`, `initial: equilibrium`, and what cannot be asked then.

use super::description::{Analysis, Description, Stepping};
use crate::grammar::Symbol;
use crate::grammar::reader::Fields;
use crate::model::names::Reader;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node};

const ANALYSES: [(&str, Analysis); 3] =
    [("motion", Analysis::Motion), ("statics", Analysis::Statics), ("kinematics", Analysis::Kinematics)];

/// The word for a start at rest where forces are in equilibrium.
const EQUILIBRIUM: &str = "equilibrium";

/// Reads what is done with the model, and whether it starts at an equilibrium.
pub fn read(reader: &mut Reader, fields: &Fields) {
    let words = ANALYSES.map(|(word, _)| (word, word));
    if let Some(word) = fields.get("analysis").and_then(|node| reader.choice(node, &words)) {
        let found = ANALYSES.into_iter().find(|(known, _)| *known == word);
        reader.model.analysis = found.map(|(_, analysis)| analysis).unwrap_or_default();
    }
    let analysis = reader.model.analysis.clone();
    let initial = fields.get("initial").filter(|node| !node.is_null());
    let word = initial.and_then(Node::scalar);
    reader.model.starts_at_equilibrium = analysis == Analysis::Statics || word.is_some();
    let Some(node) = initial else { return };
    match (word, &analysis) {
        (Some(word), Analysis::Kinematics) if word.text == EQUILIBRIUM => {
            let help = "leave `initial` out: motors say where it is".to_owned();
            reader.error(node.span.clone(), "there are no forces in kinematics, and no equilibrium of them", help);
        }
        (Some(word), _) if word.text != EQUILIBRIUM => {
            let message = format!("`initial` has values by name, or is `{EQUILIBRIUM}`, but is `{}`", clip(&word.text));
            reader.error(node.span.clone(), message, format!("write `initial: {EQUILIBRIUM}`"));
        }
        (None, Analysis::Statics) => {
            let help = "`guess` says near where to look for the equilibrium".to_owned();
            reader.error(fields.key_span("initial"), "in statics no position is given: forces decide it", help);
        }
        (None, Analysis::Kinematics) => {
            let help = "`guess` says which of several positions is meant".to_owned();
            reader.error(fields.key_span("initial"), "in kinematics no position is given: motors decide it", help);
        }
        _ => {}
    }
}

/// The values by name of `initial`, where it has some.
pub fn values_of_start<'n>(fields: &Fields<'n>) -> Option<&'n Node> {
    fields.get("initial").filter(|node| node.scalar().is_none_or(|scalar| scalar.is_null()))
}

/// Whether `simulation` has to say how long.
pub fn needs_time(model: &Description) -> bool {
    matches!(model.analysis, Analysis::Motion | Analysis::Kinematics)
}

/// Without steps, rows are all that there is of the time; statics has one.
pub fn fit_time(model: &mut Description) {
    let simulation = &mut model.simulation;
    match model.analysis {
        Analysis::Motion => return,
        Analysis::Kinematics => {}
        Analysis::Statics | Analysis::Modes => (simulation.duration, simulation.output_step) = (0.0, 1.0),
    }
    simulation.stepping = Stepping::Fixed(simulation.output_step);
}

/// Reports outputs that kinematics cannot have: it knows no forces, and bodies may have no masses.
pub fn check_outputs(reader: &mut Reader, entries: &[Entry]) {
    if reader.model.analysis != Analysis::Kinematics {
        return;
    }
    for entry in entries {
        let Some(scalar) = entry.value.scalar() else { continue };
        let Ok(formula) = symdiff::Formula::parse(&scalar.text) else { continue };
        for (name, span) in formula.names() {
            let what = match reader.symbol(name) {
                Some(Symbol::Reaction { .. }) => "a reaction",
                Some(Symbol::Energy(_)) => "an energy",
                Some(Symbol::Sensor { measure, .. }) if !measure.is_motion() => "a force",
                _ => continue,
            };
            let message = format!("`{}` is {what}, and kinematics knows no forces", clip(name));
            let help = "with `analysis: motion`, and masses, it can be asked for".to_owned();
            reader.error(scalar.place(&entry.value.span, span), message, help);
        }
    }
}
