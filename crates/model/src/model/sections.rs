//! Sections that a model has or lacks, and its title.

use super::analysis;
use super::description::Analysis;
use crate::grammar::names::GROUND;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::suggest;
use crate::syntax::yaml::{Entry, Node, Value};

/// The model's name, which is also that of its folder, and its description.
pub(super) fn title(reader: &mut Reader, fields: &Fields, scene: Option<&str>) {
    // Where all is missing, one message says so.
    let is_begun = |node: &Node| {
        let says_nothing = ["bodies", "outputs", "simulation", "urdf", "black_box", "dimensions"]
            .iter()
            .all(|key| fields.get(key).is_none());
        !says_nothing || node.scalar().is_none_or(|scalar| !scalar.text.is_empty())
    };
    if let Some(node) = fields.get("model").filter(|node| is_begun(node))
        && let Some(scalar) = reader.scalar(node, "a name")
        && reader.is_folder_name(&scalar.text, node.span.clone(), "a model")
    {
        reader.model.name.clone_from(&scalar.text);
    }
    if let Some(scene) = scene {
        reader.model.name = format!("{}/{scene}", reader.model.name);
    }
    if let Some(node) = fields.get("description") {
        let text = reader.scalar(node, "a text").map(|scalar| scalar.text.clone());
        reader.model.description = text;
    }
}

/// Reports sections that a model lacks; one with a robot has bodies and outputs.
pub(super) fn missing_sections(
    reader: &mut Reader,
    fields: &Fields,
    is_robot: bool,
    bodies: &[Entry],
    outputs: &[Entry],
) {
    // Misread, it has been reported.
    let is_answered = fields.get("black_box").is_some();
    let is_stack = reader.model.analysis == Analysis::Dimensions;
    let no_body = !is_robot && !is_answered && !is_stack && bodies.iter().all(|entry| entry.key == GROUND);
    let no_output = !is_robot && !is_answered && outputs.is_empty();
    let no_time = analysis::needs_time(&reader.model) && fields.get("simulation").is_none();
    let asked = [
        (no_body, "bodies", "a model needs at least one body", "e.g. `slider: { mass: 0.45, coordinates: [x] }`"),
        (no_output, "outputs", "a model needs at least one output", "name the observed quantities, e.g. `x: slider.x`"),
        (no_time, "simulation", "a model needs `simulation`", "e.g. `simulation: { duration: 2, step: 1e-3 }`"),
    ];
    // Misspelt, or not a mapping.
    let is_reported = |key: &str| match fields.get(key) {
        Some(node) => !node.is_null() && !matches!(node.value, Value::Mapping(_)),
        None => !fields.lacks(key),
    };
    let missing: Vec<_> = asked.into_iter().filter(|(missing, key, ..)| *missing && !is_reported(key)).collect();
    let keys: Vec<&str> = missing.iter().map(|(_, key, ..)| *key).filter(|key| fields.lacks(key)).collect();
    if keys.len() > 1 {
        let help = "`mbint new NAME` writes a model to begin with".to_owned();
        reader.error(Code::MissingSection, fields.at.clone(), format!("a model needs {}", suggest::list(&keys)), help);
    }
    for (_, key, message, help) in missing {
        let is_said = keys.contains(&key) && (keys.len() > 1 || reader.is_strange(fields, key));
        if !is_said {
            reader.error(Code::MissingSection, fields.key_span(key), message, help.to_owned());
        }
    }
}

/// Reports keys about a robot that the model does not have.
pub(super) fn no_robot(reader: &mut Reader, fields: &Fields) {
    if fields.get("limits").is_some() {
        let message = "`limits` are those of a robot's joints, but the model names no `urdf`";
        reader.error(
            Code::MisplacedKey,
            fields.key_span("limits"),
            message,
            "the effect `stop` limits a joint of the model's own".to_owned(),
        );
    }
    if fields.get("controls").is_some() {
        let message = "`controls` are those of a robot's actuators, but the model names no `mjcf`";
        reader.error(
            Code::MisplacedKey,
            fields.key_span("controls"),
            message,
            "an effect acts by a formula of its own".to_owned(),
        );
    }
    if fields.get("base").is_some() {
        let message = "`base` says how a robot stands, but the model names no `urdf`";
        reader.error(
            Code::MisplacedKey,
            fields.key_span("base"),
            message,
            "a body that no joint holds is free".to_owned(),
        );
    }
}
