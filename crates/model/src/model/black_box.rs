//! `black_box:`, and the sections that a model with it cannot have.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use symdiff::Formula;
use symdiff::formula::Term;

use super::description::{Analysis, BlackBox, BoxOutput, Description, Formulation, Output, Program, Protocol, Refine};
use super::fmu;
use super::parameters::unit;
use super::tuning::TUNING;
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::suggest::{self, clip};
use crate::syntax::text_file::read_text;
use crate::syntax::tuning::TUNING as SYNTAX;
use crate::syntax::yaml::{Entry, Node, Value};

/// Sections of a mechanism.
pub(super) const OF_MECHANISMS: [&str; 18] = [
    "bodies",
    "joints",
    "effects",
    "states",
    "trajectories",
    "excitations",
    "urdf",
    "mjcf",
    "base",
    "controls",
    "assemblies",
    "instances",
    "analysis",
    "modes",
    "initial",
    "guess",
    "limits",
    "space",
];

/// Keys of `simulation` that choose steps, which are the program's own.
const OF_STEPS: [&str; 6] = ["step", "tolerance", "alpha", "formulation", "scheme", "extrapolation"];

const PROTOCOLS: [(&str, Protocol); 2] = [("json", Protocol::Json), ("csv", Protocol::Csv)];

const YES_OR_NO: [(&str, bool); 2] = [("true", true), ("false", false)];

/// Reads the section, after the names of the parameters, which are `entries`; `model` is the model's file.
pub fn read(reader: &mut Reader, fields: &Fields, entries: &[Entry], model: &Path) {
    let Some(node) = fields.get("black_box") else { return };
    let at = fields.key_span("black_box");
    reader.model.analysis = Analysis::BlackBox;
    reader.model.simulation.formulation = Formulation::Absolute;
    for key in OF_MECHANISMS.into_iter().filter(|key| fields.get(key).is_some()) {
        let message = format!("a program answers instead of a mechanism, so `{key}` has no meaning");
        reader.error(Code::MisplacedKey, fields.key_span(key), message, "leave out `black_box`, or this".to_owned());
    }
    refuse_steps(reader, fields);
    if fields.get("simulation").is_none() {
        // One row: the answers are numbers, not motions.
        (reader.model.simulation.duration, reader.model.simulation.output_step) = (0.0, 1e-3);
    }
    let place = reader
        .diagnostics
        .sources
        .locate(&at)
        .map_or_else(String::new, |(source, span)| format!("{}:{}", source.name, source.place(span.start).line));
    let Some(fields) = reader.fields::<keys::BlackBoxFile>(node, at) else { return };
    fmu::refuse_others(reader, &fields);
    let program = match fields.get("fmu") {
        Some(file) => fmu::read(reader, &fields, file, entries).map(|(own, outputs)| (Program::Fmu(own), outputs)),
        None => command_with_outputs(reader, &fields, model),
    };
    let protocol = match fields.get("protocol") {
        Some(node) => reader.choice(node, &PROTOCOLS),
        None => Some(Protocol::Json),
    };
    let is_json = protocol != Some(Protocol::Csv);
    let persistent = match fields.get("persistent").map(|node| (node, reader.choice(node, &YES_OR_NO))) {
        None => is_json,
        Some((node, Some(true))) if !is_json => {
            let message = "with `csv` a process ends with its call: the end of the points is the end of its input";
            reader.error(Code::BadProgram, node.span.clone(), message, "`protocol: json` keeps processes".to_owned());
            false
        }
        Some((_, asked)) => asked.unwrap_or(is_json),
    };
    let mut number = |key: &str| fields.get(key).and_then(|node| reader.count(node, 1, TUNING.most_of_black_box));
    let (processes, points) = (number("processes"), number("points"));
    let retries = fields.get("retries").and_then(|node| reader.count(node, 0, TUNING.most_of_black_box)).unwrap_or(1);
    let time_limit = fields.get("time_limit").and_then(|node| {
        let value = reader.number(node, Dimension::TIME)?;
        if value <= 0.0 {
            reader.error(
                Code::OutOfRange,
                node.span.clone(),
                format!("`time_limit` must be positive, but is {value}"),
                None,
            );
        }
        Some(value)
    });
    let refine = fields.get("refine").and_then(|node| refine(reader, node, &fields));
    let (Some((program, outputs)), Some(protocol)) = (program, protocol) else { return };
    let points = points.or(is_json.then_some(1));
    reader.model.mechanism_mut().black_box = Some(BlackBox {
        place,
        program,
        outputs,
        protocol,
        persistent,
        processes,
        points,
        time_limit,
        retries,
        refine,
    });
}

/// A command with its folder, and its outputs.
fn command_with_outputs(reader: &mut Reader, fields: &Fields, model: &Path) -> Option<(Program, Vec<BoxOutput>)> {
    // The program gets all of them.
    reader.used.iter_mut().for_each(|used| *used = true);
    let words = reader.required(fields, "command").and_then(|node| command(reader, node));
    let outputs = reader.required(fields, "outputs").and_then(|node| outputs(reader, node));
    let directory = fields.get("directory").and_then(|node| directory(reader, node, model));
    let (words, outputs) = (words?, outputs?);
    note_files(reader, &words, directory.as_deref());
    Some((Program::Command { words, directory }, outputs))
}

/// The outputs of a model that names none of its own: all that the program answers with.
pub fn all_outputs(model: &mut Description) {
    let mechanism = Arc::clone(&model.mechanism);
    let Some(own) = &mechanism.black_box else { return };
    let output = |own: &BoxOutput| {
        let dimension = own.unit.dimension();
        let formula = Formula::name(&own.name);
        Output {
            name: own.name.clone(),
            formula,
            unit: dimension.unit(),
            dimension: Some(dimension),
            of_results: false,
        }
    };
    if model.outputs.is_empty() && model.reduced.is_empty() {
        model.outputs = own.outputs.iter().map(output).collect();
    }
    // People see them as the program writes them.
    for output in &model.outputs {
        let [(Term::Name(name), _)] = output.formula.terms() else { continue };
        let named = own.outputs.iter().find(|own| own.name == *name);
        if let Some(own) = named.filter(|own| own.unit.si() != 1.0) {
            model.display.entry(output.name.clone()).or_insert_with(|| own.unit.clone());
        }
    }
}

/// Reports keys that choose steps.
fn refuse_steps(reader: &mut Reader, fields: &Fields) {
    let Some(Value::Mapping(entries)) = fields.get("simulation").map(|node| &node.value) else { return };
    for entry in entries.iter().filter(|entry| OF_STEPS.contains(&entry.key.as_str())) {
        let message = format!("the program takes steps of its own, so `{}` has no meaning", clip(&entry.key));
        let help = "`output_step` says where its rows are; a parameter can tell it its steps".to_owned();
        reader.error(Code::BadProgram, entry.key_span.clone(), message, help);
    }
}

/// The program and its arguments.
fn command(reader: &mut Reader, node: &Node) -> Option<Vec<String>> {
    let items = match &node.value {
        Value::Sequence(items) if !items.is_empty() => items,
        _ => {
            let message = format!("a program with its arguments is a list, but here is {}", node.kind());
            reader.error(
                Code::BadProgram,
                node.span.clone(),
                message,
                "e.g. `[python3, run.py]`: no shell reads it".to_owned(),
            );
            return None;
        }
    };
    let words = items.iter().map(|item| Some(reader.scalar(item, "a program or an argument")?.text.clone()));
    let words = words.collect::<Vec<Option<String>>>().into_iter().collect::<Option<Vec<String>>>()?;
    if words[0].trim().is_empty() {
        reader.error(Code::BadProgram, items[0].span.clone(), "the program has no name", None);
        return None;
    }
    Some(words)
}

/// Notes the texts that the command names, such as its script: results are of them, too.
fn note_files(reader: &mut Reader, command: &[String], directory: Option<&Path>) {
    for word in command {
        let path = directory.unwrap_or_else(|| Path::new("")).join(word);
        if path.is_file()
            && let Ok(text) = read_text(&path, SYNTAX.file_bytes)
        {
            reader.diagnostics.sources.add(path.display().to_string(), text);
        }
    }
}

fn outputs(reader: &mut Reader, node: &Node) -> Option<Vec<BoxOutput>> {
    let entries = reader.named_entries(node, "outputs of the program");
    if entries.is_empty() {
        reader.error(
            Code::BadProgram,
            node.span.clone(),
            "the program has no outputs",
            "e.g. `{ x: m, turns: 1 }`".to_owned(),
        );
        return None;
    }
    let read: Vec<Option<BoxOutput>> = entries.iter().map(|entry| output(reader, entry)).collect();
    read.into_iter().collect()
}

fn output(reader: &mut Reader, entry: &Entry) -> Option<BoxOutput> {
    let is_name = reader.name(entry, "an output");
    if reader.model.parameters.iter().any(|parameter| parameter.name == entry.key) {
        let message = format!("`{}` is a parameter: an output of the program needs another name", clip(&entry.key));
        reader.error(Code::NameTaken, entry.key_span.clone(), message, None);
        return None;
    }
    let found = unit(reader, &entry.value)?;
    // `unit` has read the same scalar.
    let text = entry.value.scalar()?.text.clone();
    is_name.then(|| BoxOutput { name: entry.key.clone(), unit: DisplayUnit::new(&text, found) })
}

fn refine(reader: &mut Reader, node: &Node, fields: &Fields) -> Option<Refine> {
    let fields = reader.fields::<keys::RefineFile>(node, fields.key_span("refine"))?;
    let [parameter, by] = ["parameter", "by"].map(|key| reader.required(&fields, key));
    let factor = by.and_then(|node| {
        let by = reader.number(node, Dimension::NUMBER)?;
        let is_factor = by > 0.0 && by != 1.0;
        if !is_factor {
            let help = "0.5 halves a step's length, 2 doubles a number of steps".to_owned();
            reader.error(Code::OutOfRange, node.span.clone(), format!("a factor of {by} refines nothing"), help);
        }
        is_factor.then_some(by)
    });
    let node = parameter?;
    let name = reader.scalar(node, "the name of a parameter")?.text.clone();
    let Some(parameter) = reader.model.parameters.iter().position(|own| own.name == name) else {
        let names: Vec<&str> = reader.model.parameters.iter().map(|own| own.name.as_str()).collect();
        let help = suggest::help(&name, "parameters", names);
        reader.error(Code::UnknownName, node.span.clone(), format!("unknown parameter `{}`", clip(&name)), help);
        return None;
    };
    if reader.is_uncertain(&Formula::name(&name)) {
        let message = format!("`{}` is uncertain, and cannot decide the steps", clip(&name));
        reader.error(Code::BadProgram, node.span.clone(), message, "name a parameter without a tolerance".to_owned());
        return None;
    }
    Some(Refine { parameter, by: factor? })
}

/// A folder, from the model's.
fn directory(reader: &mut Reader, node: &Node, model: &Path) -> Option<PathBuf> {
    let name = &reader.scalar(node, "a folder")?.text;
    let folder = model.parent().unwrap_or_else(|| Path::new("")).join(name);
    let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
    if !folder.is_dir() {
        let message = format!("there is no folder `{}`", clip(name));
        reader.error(
            Code::BadProgram,
            node.span.clone(),
            message,
            "paths are relative to the model's folder".to_owned(),
        );
        return None;
    }
    Some(folder)
}
