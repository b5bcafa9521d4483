//! `analysis:`, `initial: equilibrium`, and the requests that they exclude.

use super::description::{
    Analysis, Description, Formulation, Joint, LinearisedAt, ModesRequest, ResponseRequest, Stepping,
};
use super::stack;
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::{Context, Symbol};
use crate::keys;
use crate::model::names::Reader;
use crate::model::states::is_sampled;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

const ANALYSES: [(&str, Analysis); 5] = [
    ("motion", Analysis::Motion),
    ("statics", Analysis::Statics),
    ("kinematics", Analysis::Kinematics),
    ("modes", Analysis::Modes(LinearisedAt::Start)),
    ("dimensions", Analysis::Dimensions),
];

const PLACES: [(&str, LinearisedAt); 3] =
    [("start", LinearisedAt::Start), ("equilibrium", LinearisedAt::Equilibrium), ("motion", LinearisedAt::Motion)];

/// The word for a start at rest where forces are in equilibrium.
const EQUILIBRIUM: &str = "equilibrium";

/// Reads the analysis, and whether it starts at an equilibrium.
pub fn read(reader: &mut Reader, fields: &Fields) {
    if let Some(analysis) = fields.get("analysis").and_then(|node| reader.choice(node, &ANALYSES)) {
        reader.model.analysis = analysis;
    }
    stack::read(reader, fields);
    let at = section_of_modes(reader, fields).and_then(|fields| fields.get("at"));
    if let (Some(node), Analysis::Modes(place)) = (at, &mut reader.model.analysis.clone()) {
        *place = reader.choice(node, &PLACES).unwrap_or_default();
        reader.model.analysis = Analysis::Modes(*place);
    }
    let analysis = reader.model.analysis;
    let at_equilibrium = matches!(analysis, Analysis::Statics | Analysis::Modes(LinearisedAt::Equilibrium));
    let initial = fields.get("initial").filter(|node| !node.is_null());
    let word = initial.and_then(Node::scalar);
    reader.model.mechanism_mut().starts_at_equilibrium = at_equilibrium || word.is_some();
    let Some(node) = initial else { return };
    match (word, &analysis) {
        (Some(word), Analysis::Kinematics) if word.text == EQUILIBRIUM => {
            let help = "leave `initial` out: motors say where it is".to_owned();
            reader.error(
                Code::WrongAnalysis,
                node.span.clone(),
                "there are no forces in kinematics, and no equilibrium of them",
                help,
            );
        }
        (Some(word), _) if word.text != EQUILIBRIUM => {
            let message = format!("`initial` has values by name, or is `{EQUILIBRIUM}`, but is `{}`", clip(&word.text));
            reader.error(Code::WrongAnalysis, node.span.clone(), message, format!("write `initial: {EQUILIBRIUM}`"));
        }
        (None, _) if at_equilibrium => {
            let help = "`guess` says near where to look for the equilibrium".to_owned();
            reader.error(
                Code::WrongAnalysis,
                fields.key_span("initial"),
                "at an equilibrium no position is given: forces decide it",
                help,
            );
        }
        (None, Analysis::Kinematics) => {
            let help = "`guess` says which of several positions is meant".to_owned();
            reader.error(
                Code::WrongAnalysis,
                fields.key_span("initial"),
                "in kinematics no position is given: motors decide it",
                help,
            );
        }
        _ => {}
    }
}

/// The keys of `modes`; reports the section if it is misplaced.
fn section_of_modes<'n>(reader: &mut Reader, fields: &Fields<'n>) -> Option<Fields<'n>> {
    let node = fields.get("modes")?;
    if !matches!(reader.model.analysis, Analysis::Modes(_)) {
        let help = "write `analysis: modes`, or leave it out".to_owned();
        reader.error(Code::WrongAnalysis, fields.key_span("modes"), "`modes` belongs to `analysis: modes`", help);
        return None;
    }
    reader.fields::<keys::Modes>(node, fields.key_span("modes"))
}

/// Reads the questions about small vibrations, when outputs are known.
pub fn read_modes(reader: &mut Reader, fields: &Fields) {
    if !matches!(reader.model.analysis, Analysis::Modes(_)) {
        return;
    }
    let mut request = ModesRequest { number: TUNING.modes, responses: Vec::new() };
    // Errors of the section itself have been reported.
    let node = fields.get("modes");
    let known = node.and_then(|node| match &node.value {
        Value::Mapping(entries) => Some(entries),
        _ => None,
    });
    let find = |key: &str| known.into_iter().flatten().find(|entry| entry.key == key);
    if let Some(entry) = find("number") {
        request.number = reader.count(&entry.value, 1, 1000).unwrap_or(TUNING.modes);
    }
    if let Some(entry) = find("responses") {
        let entries = reader.entries(&entry.value, "responses");
        request.responses = entries.iter().filter_map(|entry| response(reader, entry)).collect();
    }
    reader.model.modes = request;
}

fn response(reader: &mut Reader, entry: &Entry) -> Option<ResponseRequest> {
    reader.name(entry, "a response");
    let fields = reader.fields::<keys::Response>(&entry.value, entry.key_span.clone())?;
    let [load, output, from, to] = ["load", "output", "from", "to"].map(|key| reader.required(&fields, key));
    let load = load.and_then(|node| {
        let (name, dimension) = known_output(reader, node)?;
        if !matches!(dimension, Some(Dimension::LENGTH | Dimension::ANGLE)) {
            let message = format!("a load acts along a length or an angle, and `{}` is neither", clip(&name));
            reader.error(
                Code::WrongAnalysis,
                node.span.clone(),
                message,
                "name an output such as `tip: rod.B.y`".to_owned(),
            );
            return None;
        }
        Some(name)
    });
    let output = output.and_then(|node| known_output(reader, node));
    let [from, to] = [from, to].map(|node| {
        let node = node?;
        let value = reader.number(node, Dimension::FREQUENCY)?;
        if value <= 0.0 {
            reader.error(
                Code::OutOfRange,
                node.span.clone(),
                format!("a frequency is positive, but this is {value} Hz"),
                None,
            );
        }
        Some(value).filter(|value| *value > 0.0)
    });
    let points = match fields.get("points") {
        Some(node) => reader.count(node, 2, TUNING.most_frequencies)?,
        None => TUNING.frequencies,
    };
    let (from, to) = (from?, to?);
    if from >= to {
        let message = format!("frequencies from {from} Hz to {to} Hz are none");
        reader.error(Code::ReversedRange, fields.key_span("to"), message, "`to` is larger than `from`".to_owned());
        return None;
    }
    let factor = symdiff::math::exp(std::f64::consts::LN_2 * symdiff::math::log2(to / from) / (points - 1) as f64);
    let mut frequencies: Vec<f64> = std::iter::successors(Some(from), |f| Some(f * factor)).take(points).collect();
    frequencies[points - 1] = to;
    Some(ResponseRequest { name: entry.key.clone(), load: load?, output: output?.0, frequencies })
}

/// An output that is named, with its dimension.
fn known_output(reader: &mut Reader, node: &Node) -> Option<(String, Option<Dimension>)> {
    let name = reader.scalar(node, "the name of an output")?.text.clone();
    reader.mentions_node(Some(NameKind::Output), node);
    let found = reader.model.outputs.iter().find(|output| output.name == name);
    if let Some(output) = found {
        return Some((name, output.dimension));
    }
    if reader.is_unread_output(&name) {
        return None;
    }
    let help = suggest::help(&name, "outputs", reader.model.outputs.iter().map(|output| output.name.as_str()));
    reader.error(Code::UnknownName, node.span.clone(), format!("unknown output `{}`", clip(&name)), help);
    None
}

/// The values by name of `initial`, if it has some.
pub fn values_of_start<'n>(fields: &Fields<'n>) -> Option<&'n Node> {
    fields.get("initial").filter(|node| node.scalar().is_none_or(|scalar| scalar.is_null()))
}

/// Whether `simulation` has to say how long.
pub fn needs_time(model: &Description) -> bool {
    use LinearisedAt::{Equilibrium, Start};
    !matches!(
        model.analysis,
        Analysis::Statics | Analysis::Modes(Start | Equilibrium) | Analysis::BlackBox | Analysis::Dimensions
    )
}

/// Without steps, rows are all that there is of the time; statics has one.
pub fn fit_time(model: &mut Description) {
    let simulation = &mut model.simulation;
    // Away from an equilibrium a stiffness depends on the coordinates.
    if matches!(model.analysis, Analysis::Modes(_)) && simulation.formulation == Formulation::Auto {
        simulation.formulation = Formulation::Absolute;
    }
    match model.analysis {
        Analysis::Motion | Analysis::Modes(LinearisedAt::Motion) => return,
        Analysis::Kinematics | Analysis::BlackBox => {}
        Analysis::Statics | Analysis::Modes(_) | Analysis::Dimensions => {
            (simulation.duration, simulation.output_step) = (0.0, 1e-3)
        }
    }
    simulation.stepping = Stepping::Fixed(simulation.output_step);
}

/// Reports joints that belong to a motion alone.
pub fn check_joints(reader: &mut Reader, entries: &[Entry]) {
    if reader.model.analysis == Analysis::Motion && !reader.model.starts_at_equilibrium {
        return;
    }
    let is_nonholonomic = |name: &str| {
        let mut joints = reader.model.joints.iter();
        joints.any(|joint| joint.name == name && (joint.kind.is_nonholonomic() || follows_motion(reader, joint)))
    };
    if let Some(entry) = entries.iter().find(|entry| is_nonholonomic(&entry.key)) {
        let message = format!("`{}` constrains velocities, which say nothing of where it is at rest", clip(&entry.key));
        let help = "ask for `analysis: motion`, from a start that `initial` gives, or leave it out here, e.g. in a scene with `without`";
        reader.error(Code::WrongAnalysis, entry.key_span.clone(), message, help.to_owned());
    }
}

/// Whether a joint's coordinate has a speed that follows the motion.
fn follows_motion(reader: &Reader, joint: &Joint) -> bool {
    let is_moving = |name: &str| reader.resolve(name, Context::Time).is_err();
    joint.kind.speed().is_some_and(|speed| speed.names().any(|(name, _)| is_moving(name)))
}

/// Reports speeds that jump at instants.
pub fn check_speeds(reader: &mut Reader, entries: &[Entry]) {
    let sampled: Vec<&str> = reader.model.effects.iter().filter(|own| is_sampled(own)).map(|own| &*own.name).collect();
    let with_speed: Vec<_> =
        reader.model.joints.iter().filter_map(|own| Some((&own.name, own.kind.speed()?))).collect();
    let jumping = |entry: &Entry| {
        let (_, speed) = with_speed.iter().find(|(joint, _)| **joint == entry.key)?;
        let name = speed.names().find(|(name, _)| sampled.contains(name))?.0;
        Some((entry.key_span.clone(), name.to_owned()))
    };
    let found: Vec<(Span, String)> = entries.iter().filter_map(jumping).collect();
    for (at, name) in found {
        let message = format!("`{}` jumps at instants, and no speed can", clip(&name));
        let help = "let a `filter` or a `rate_limit` follow it, and the motor that".to_owned();
        reader.error(Code::WrongAnalysis, at, message, help);
    }
}

/// Reports questions that an analysis cannot answer: reduced outputs of one configuration, forces in kinematics, and
/// Taylor bounds of modes. The entries are those of outputs and requirements.
pub fn check_requests(reader: &mut Reader, fields: &Fields, entries: [&[Entry]; 2]) {
    let analysis = reader.model.analysis;
    let over_time = match analysis {
        Analysis::Motion | Analysis::Kinematics | Analysis::Modes(LinearisedAt::Motion) => true,
        Analysis::BlackBox => reader.model.simulation.duration > 0.0,
        Analysis::Statics | Analysis::Modes(_) | Analysis::Dimensions => false,
    };
    let help = match analysis {
        Analysis::BlackBox => "with a `simulation`, which has a `duration`, it can be asked for",
        Analysis::Dimensions => "an output is one number already: limit it directly",
        _ => "with `analysis: motion` it can be asked for",
    };
    if !over_time && !reader.model.reduced.is_empty() {
        let message = format!("a reduced output is one number a motion, and `analysis: {}` has none", analysis.name());
        reader.error(Code::WrongAnalysis, fields.key_span("outputs"), message, help.to_owned());
    }
    if analysis == Analysis::Kinematics {
        check_reduced_without_forces(reader, entries);
    }
    let no_taylor = match reader.model.analysis {
        Analysis::Modes(_) => Some("modes have no Taylor bounds: which eigenvalue is which may change over the box"),
        Analysis::BlackBox => Some("a black box has no Taylor bounds: there are no equations of motion to expand"),
        _ => None,
    };
    if let (Some(message), Some(_)) = (no_taylor, &reader.model.bounds.taylor) {
        let help = "ask for `chebyshev` or `scan`".to_owned();
        reader.error(Code::WrongAnalysis, fields.key_span("bounds"), message, help);
    }
}

/// Reports outputs that kinematics cannot have: it knows no forces, and bodies may have no masses.
pub fn check_outputs(reader: &mut Reader, entries: &[Entry]) {
    stack::refuse_time(reader, entries);
    if reader.model.analysis != Analysis::Kinematics {
        return;
    }
    for entry in entries {
        let Some(scalar) = entry.value.scalar() else { continue };
        let Ok(formula) = symdiff::Formula::parse(&scalar.text) else { continue };
        for (name, span) in formula.names() {
            report_force(reader, name, scalar.place(&entry.value.span, span));
        }
    }
}

/// Reports reduced outputs and requirements that name quantities unknown to kinematics.
fn check_reduced_without_forces(reader: &mut Reader, [outputs, requirements]: [&[Entry]; 2]) {
    let model = &reader.model;
    let reduced = model.reduced.iter().map(|own| (&own.name, &own.sources, outputs));
    let required = model.requirements.iter().map(|own| (&own.name, &own.slacks, requirements));
    let mut named: Vec<(String, Span)> = Vec::new();
    for (own, formulas, entries) in reduced.chain(required) {
        let Some(entry) = entries.iter().find(|entry| entry.key == *own) else { continue };
        let names = formulas.iter().flat_map(symdiff::Formula::names);
        named.extend(names.map(|(name, _)| (name.to_owned(), entry.value.span.clone())));
    }
    named.dedup();
    for (name, at) in named {
        report_force(reader, &name, at);
    }
}

/// Reports a name that kinematics does not know.
fn report_force(reader: &mut Reader, name: &str, at: Span) {
    let what = match reader.symbol(name) {
        Some(Symbol::Reaction { .. }) => "a reaction",
        Some(Symbol::Energy(_)) => "an energy",
        Some(Symbol::Sensor { measure, .. }) if !measure.is_motion() => "a force",
        _ => return,
    };
    let message = format!("`{}` is {what}, but kinematics has no forces", clip(name));
    reader.error(
        Code::WrongAnalysis,
        at,
        message,
        "with `analysis: motion`, and masses, it can be asked for".to_owned(),
    );
}
