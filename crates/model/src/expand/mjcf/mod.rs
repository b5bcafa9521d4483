//! `mjcf:`, a robot's file as the beginning of a model; or alone, as a model of a second.
//!
//! The robot of the file ([`crate::robots::mjcf`]) → parameters (`numbers`) → entries of the model's tree with their
//! locations in the MJCF (`build`, `start`, `effects`). All later stages read the tree as if it were written out
//! (decision 0086).

mod build;
mod drives;
mod effects;
mod start;
mod tree;

use std::collections::HashSet;
use std::path::Path;

use self::build::PlacedRobot;
use self::tree::{Sections, text};
use super::numbers::{self, Format};
use super::overrides::Override;
use crate::grammar::report::Report;
use crate::robots::mjcf::values::Values;
use crate::robots::mjcf::{document, is_mjcf, is_number, read};
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Value};

const FORMAT: Format = Format {
    name: "MJCF",
    forms: "e.g. `body.NAME.mass`, `.pos.x`, `.inertia.xx`, `joint.NAME.damping`, `.stiffness`, `actuator.NAME.kp`",
    is_number,
};

/// The model that an MJCF is by itself: a second, at rest in the file's configuration.
pub fn model_of(path: &Path) -> String {
    let file = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().replace('\'', "''"));
    format!("mjcf: '{file}'\nsimulation: {{ duration: 1, step: 1e-3, output_step: 0.01 }}\n")
}

/// The model's tree with the robot that it names written out; `None` if it names none.
pub fn write_out(report: &mut Report, root: &Node, model: &Path, overrides: &[(Override, Span)]) -> Option<Node> {
    let Value::Mapping(entries) = &root.value else { return None };
    let entry = entries.iter().find(|entry| entry.key == "mjcf")?;
    let mut sections: Vec<Entry> = Vec::new();
    let mut own = Vec::new();
    for entry in entries {
        let is_own = matches!(entry.key.as_str(), "mjcf" | "controls" | "limits");
        if is_own { own.push(entry.clone()) } else { sections.push(entry.clone()) }
    }
    for key in ["urdf", "base"] {
        if let Some(other) = sections.iter().find(|entry| entry.key == key) {
            let message = format!("`{key}` and `mjcf` exclude each other");
            report.error(Code::ExclusiveKeys, other.key_span.clone(), message, None);
            return None;
        }
    }
    let file = report.scalar(&entry.value, "the path of an MJCF")?.text.clone();
    let path = match report.files.find(Path::new(""), &file) {
        Ok(path) => path,
        Err(error) => {
            report.error(error.code, entry.value.span.clone(), error.message, error.help);
            return None;
        }
    };
    let errors = report.diagnostics.errors();
    let at = (!is_mjcf(model)).then(|| entry.value.span.clone());
    let document = document::read(&path, at, &report.files, report.diagnostics)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut values = Values::new(&document, &report.files, folder, report.diagnostics);
    let robot = read::robot(&document, &mut values)?;
    // The parts that could not be read may be those that move.
    let is_whole = report.diagnostics.errors() == errors;
    if is_whole && robot.joints.is_empty() && !sections.iter().any(|entry| entry.key == "bodies") {
        let place = if is_mjcf(model) { document.span.clone() } else { entry.value.span.clone() };
        let help = if robot.bodies.len() > 1 {
            "a body moves that has a `<joint>` or a `<freejoint>`, and here none has"
        } else {
            "the file has no `<body>` in its `<worldbody>`: it may be one that others include"
        };
        report.error(Code::NothingMoves, place, "nothing of this robot can move", help.to_owned());
        return None;
    }
    let words = numbers::words(root, overrides);
    let written = match sections.iter().find(|entry| entry.key == "parameters").map(|entry| &entry.value.value) {
        Some(Value::Mapping(entries)) => entries.clone(),
        _ => Vec::new(),
    };
    let parameters = numbers::entries(report, &FORMAT, robot.numbers(), &words, &written);
    let named: HashSet<String> =
        parameters.iter().filter(|entry| is_number(&entry.key)).map(|entry| entry.key.clone()).collect();
    let span = &entry.value.span;
    let mut sections = Sections(sections);
    if let Some(section) = sections.of("parameters", span) {
        *section = parameters;
    }
    if !sections.0.iter().any(|entry| entry.key == "space") {
        let node = text(span, "spatial");
        sections.0.push(Entry { key: "space".to_owned(), key_span: span.clone(), value: node });
    }
    let source = PlacedRobot::new(&robot, &named, &words);
    let limits = own.iter().find(|entry| entry.key == "limits");
    let controls = own.iter().find(|entry| entry.key == "controls");
    let controls = controls.map_or(&[][..], |entry| report.entries(&entry.value, "controls"));
    build::bodies(&mut sections, &source);
    effects::add(&mut sections, &source, limits, controls, report.diagnostics);
    start::start(&mut sections, &source);
    start::outputs(&mut sections, &source);
    Some(Node { span: root.span.clone(), value: Value::Mapping(sections.0) })
}
