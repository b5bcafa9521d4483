//! `black_box: { fmu: FILE }`: the variables of a unit that a model sets and wants.

use mbint_fmu::{Access, Interface, NumberType, Task, Unit, Variable, digest};

use super::description::{BoxOutput, FmuProgram};
use super::parameters::unit;
use crate::expand::fmu::{Conversion, help, named, unit_of};
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Keys that belong to a command.
const OF_COMMANDS: [&str; 4] = ["command", "protocol", "persistent", "directory"];

/// Keys that belong to a unit.
const OF_UNITS: [&str; 3] = ["interface", "variables", "step"];

const INTERFACES: [(&str, Interface); 2] =
    [("co_simulation", Interface::CoSimulation), ("model_exchange", Interface::ModelExchange)];

/// Reports keys of `black_box` that do not go with its program.
pub fn refuse_others(reader: &mut Reader, fields: &Fields) {
    let is_unit = fields.get("fmu").is_some();
    let (others, why) = if is_unit { (&OF_COMMANDS[..], "`command`") } else { (&OF_UNITS[..], "`fmu`") };
    for key in others.iter().filter(|key| fields.get(key).is_some()) {
        let message = match *key {
            "command" => "`command` and `fmu` exclude each other".to_owned(),
            key => format!("`{key}` belongs to {why}"),
        };
        reader.error(Code::MisplacedKey, fields.key_span(key), message, None);
    }
}

/// Reads a unit and the outputs that are wanted of it.
pub fn read(
    reader: &mut Reader,
    fields: &Fields,
    file: &Node,
    entries: &[Entry],
) -> Option<(FmuProgram, Vec<BoxOutput>)> {
    let (path, unit) = unit_of(&mut reader.report, file)?;
    let interface = interface(reader, fields, &unit, file)?;
    let variables = fields.get("variables");
    let wanted = match fields.get("outputs") {
        Some(node) => reader.named_entries(node, "outputs of the unit").iter().map(Wanted::of_entry).collect(),
        None => Wanted::all(&unit, file),
    };
    if wanted.is_empty() {
        let message = "the unit has no outputs that are numbers: name variables under `outputs`";
        reader.error(Code::BadFmu, file.span.clone(), message, "e.g. `{ x: m, turns: 1 }`".to_owned());
        return None;
    }
    check_variables(reader, variables, &wanted);
    let parameters = parameters(reader, &unit, variables, entries);
    let step = fields.get("step").and_then(|node| {
        let step = reader.number(node, Dimension::TIME)?;
        if step <= 0.0 {
            reader.error(Code::OutOfRange, node.span.clone(), format!("`step` must be positive, but is {step}"), None);
        }
        (step > 0.0).then_some(step)
    });
    let outputs: Vec<Option<(Access, BoxOutput)>> =
        wanted.iter().map(|own| output(reader, &unit, named(variables, &own.name), own)).collect();
    let (access, outputs) = outputs.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    // Results are of its content.
    let digest = digest(&path).unwrap_or_default();
    reader.diagnostics.sources.add(path.display().to_string(), digest);
    let task = Task { interface, parameters, outputs: access };
    Some((FmuProgram { file: path, task, step }, outputs))
}

/// Reports parameters that neither the unit nor a formula uses, after all formulas.
pub fn check_parameters(reader: &mut Reader, fields: &Fields, entries: &[Entry]) {
    let Some(section) = fields.get("black_box") else { return };
    let Some(file) = section.get("fmu") else { return };
    let Some(own) = &reader.model.black_box else { return };
    let is_set = |name: &str| own.fmu().is_some_and(|own| own.task.parameters.iter().any(|own| own.name == name));
    let unknown: Vec<(String, Span)> = (0..reader.model.parameters.len())
        .filter(|&index| !reader.used[index] && !reader.used_by_parameters[index])
        .map(|index| reader.model.parameters[index].name.clone())
        .filter(|name| !is_set(name))
        .filter_map(|name| entries.iter().find(|entry| entry.key == name).map(|entry| (name, entry.key_span.clone())))
        .collect();
    if unknown.is_empty() {
        return;
    }
    let Some((_, unit)) = unit_of(&mut reader.report, file) else { return };
    for (name, span) in unknown {
        let name_in_unit = named(section.get("variables"), &name).to_owned();
        let message = format!("the unit has no variable `{}`, and no formula uses it", clip(&name_in_unit));
        reader.error(Code::BadFmu, span, message, help(&unit, &name_in_unit, |variable| variable.is_settable));
        if let Some(index) = reader.model.parameters.iter().position(|own| own.name == name) {
            reader.used[index] = true;
        }
    }
}

/// Interface of the unit: the one asked for, or co-simulation if the unit supports it.
fn interface(reader: &mut Reader, fields: &Fields, unit: &Unit, file: &Node) -> Option<Interface> {
    let has = |interface: Interface| unit.library(interface).is_some();
    let there: Vec<Interface> = INTERFACES.iter().map(|(_, own)| *own).filter(|own| has(*own)).collect();
    let Some(node) = fields.get("interface") else {
        if there.is_empty() {
            let message = "the unit has neither co-simulation nor model exchange";
            reader.error(Code::BadFmu, file.span.clone(), message, None);
        }
        return there.first().copied();
    };
    let asked = reader.choice(node, &INTERFACES)?;
    if !has(asked) {
        let help = INTERFACES.iter().find(|(_, own)| has(*own)).map(|(word, _)| format!("it has `{word}`"));
        reader.error(Code::BadFmu, node.span.clone(), "the unit does not have this interface", help);
        return None;
    }
    Some(asked)
}

/// An output that is wanted.
struct Wanted<'n> {
    name: String,
    span: Span,
    /// The unit in which it is to be shown.
    unit: Option<&'n Node>,
}

impl<'n> Wanted<'n> {
    fn of_entry(entry: &'n Entry) -> Self {
        Self { name: entry.key.clone(), span: entry.key_span.clone(), unit: Some(&entry.value) }
    }

    /// All outputs of a unit that are numbers and whose names can stand in formulas.
    fn all(unit: &Unit, file: &Node) -> Vec<Self> {
        let is_name = |name: &str| {
            name.starts_with(|c: char| c.is_ascii_alphabetic())
                && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        let outputs = unit.variables.iter().filter(|own| own.causality == "output" && own.kind.is_ok());
        let outputs = outputs.filter(|own| is_name(&own.name));
        outputs.map(|own| Self { name: own.name.clone(), span: file.span.clone(), unit: None }).collect()
    }
}

/// Reports names under `variables` that are of nothing in the model.
fn check_variables(reader: &mut Reader, variables: Option<&Node>, wanted: &[Wanted]) {
    let Some(node) = variables else { return };
    for entry in reader.named_entries(node, "variables of the unit") {
        reader.scalar(&entry.value, "the name of a variable of the unit");
        let parameters = reader.model.parameters.iter().map(|own| own.name.as_str());
        let known: Vec<&str> = parameters.chain(wanted.iter().map(|own| own.name.as_str())).collect();
        if !known.contains(&entry.key.as_str()) {
            let message = format!("`{}` is neither a parameter nor an output of the unit", clip(&entry.key));
            let help = suggest::help(&entry.key, "parameters and outputs", known);
            reader.error(Code::BadFmu, entry.key_span.clone(), message, help);
        }
    }
}

/// Variables that parameters of the model set.
fn parameters(reader: &mut Reader, unit: &Unit, variables: Option<&Node>, entries: &[Entry]) -> Vec<Access> {
    let mut found = Vec::new();
    for index in 0..reader.model.parameters.len() {
        let name = reader.model.parameters[index].name.clone();
        let Some(variable) = unit.variable(named(variables, &name)) else { continue };
        // Where `variables` names it, the error belongs there.
        let entry = match variables.map(|node| &node.value) {
            Some(Value::Mapping(entries)) => entries.iter().find(|entry| entry.key == name),
            _ => None,
        };
        let own = || entries.iter().find(|entry| entry.key == name).map(|entry| entry.key_span.clone());
        let Some(span) = entry.map(|entry| entry.value.span.clone()).or_else(own) else { continue };
        reader.used[index] = true;
        let Some(access) = access(reader, unit, variable, &name, &span) else { continue };
        if !variable.is_settable {
            let message =
                format!("`{}` cannot be set: it is calculated ({})", clip(&variable.name), variable.causality);
            reader.error(Code::BadFmu, span, message, help(unit, &variable.name, |own| own.is_settable));
            continue;
        }
        if let (Some(found), Some(own)) = (reader.kinds[index].dimension(), Conversion::of(unit, variable).dimension())
        {
            reader.check_fits(&span, found, own);
        }
        found.push(access);
    }
    found
}

fn output(reader: &mut Reader, unit_file: &Unit, variable: &str, own: &Wanted) -> Option<(Access, BoxOutput)> {
    if !reader.report.is_name(&own.name, &own.span, "an output") {
        return None;
    }
    if reader.model.parameters.iter().any(|parameter| parameter.name == own.name) {
        let message = format!("`{}` is a parameter: an output of the unit needs another name", clip(&own.name));
        reader.error(Code::BadFmu, own.span.clone(), message, "`variables` gives it one".to_owned());
        return None;
    }
    let Some(variable) = unit_file.variable(variable) else {
        let message = format!("the unit has no variable `{}`", clip(variable));
        let kind = |own: &Variable| own.kind.is_ok();
        reader.error(Code::BadFmu, own.span.clone(), message, help(unit_file, variable, kind));
        return None;
    };
    let mut access = access(reader, unit_file, variable, &own.name, &own.span)?;
    let conversion = Conversion::of(unit_file, variable);
    let declared = match own.unit {
        Some(node) => Some(DisplayUnit::new(&reader.scalar(node, "a unit")?.text.clone(), unit(reader, node)?)),
        None => None,
    };
    if let (Some(declared), Some(node)) = (&declared, own.unit) {
        match conversion.dimension() {
            Some(found) => {
                if !found.fits(declared.dimension()) {
                    let message = format!(
                        "`{}` is {found} in the unit, and cannot be shown in `{}`",
                        clip(&variable.name),
                        clip(&declared.text)
                    );
                    reader.error(Code::WrongDimension, node.span.clone(), message, None);
                    return None;
                }
            }
            None => access.factor = declared.si(),
        }
    }
    let unit = declared.or(conversion.shown).unwrap_or_else(DisplayUnit::number);
    Some((access, BoxOutput { name: own.name.clone(), unit }))
}

/// How a variable is set or read, under a name of the model.
fn access(reader: &mut Reader, unit: &Unit, variable: &Variable, name: &str, span: &Span) -> Option<Access> {
    let kind: NumberType = match &variable.kind {
        Ok(kind) => *kind,
        Err(word) => {
            let message = format!("`{}` is no number: its type is `{}`", clip(&variable.name), clip(word));
            reader.error(Code::BadFmu, span.clone(), message, None);
            return None;
        }
    };
    let Conversion { factor, offset, .. } = Conversion::of(unit, variable);
    Some(Access { name: name.to_owned(), kind, reference: variable.reference, factor, offset })
}
