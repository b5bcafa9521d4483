//! The tree of a model while scenes are laid over it.

use std::collections::{BTreeSet, HashSet};

use super::{OmittedEffects, unknown};
use crate::expand::notation::{self, field};
use crate::expand::parts::patterns;
use crate::grammar::mentions::NameKind;
use crate::grammar::report::{Fields, Report};
use crate::robots::urdf;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Sections whose entries can be omitted by name.
const NAMED: [&str; 4] = ["effects", "joints", "states", "outputs"];

/// Sections of bodies, joints and effects, and that of outputs.
const PARTS: &[&str] = &["effects", "joints", "states"];
const OUTPUTS: &[&str] = &["outputs"];

/// Sections of which a scene's entries replace the model's of the same name, or come on top.
const BY_NAME: [(&str, &str); 7] = [
    ("joints", "joints"),
    ("effects", "effects"),
    ("states", "states"),
    ("initial", "start values"),
    ("guess", "start values"),
    ("outputs", "outputs"),
    ("requirements", "requirements"),
];

/// Keys whose value in a scene stands instead of the model's.
const WHOLE: [&str; 6] = ["description", "limits", "bounds", "statistics", "analysis", "modes"];

/// Keys of a parameter's deviation.
const DEVIATION: [&str; 4] = ["tolerance", "interval", "plus", "minus"];

/// A tree in the making.
#[derive(Clone, Default)]
pub struct TreeDraft {
    pub entries: Vec<Entry>,
    /// Section and name.
    pub out: HashSet<(&'static str, String)>,
    pub robot: OmittedEffects,
}

impl TreeDraft {
    /// Lays a scene's changes over the tree.
    pub fn lay(&mut self, report: &mut Report, fields: &Fields) {
        if let Some(node) = fields.get("without") {
            self.without(report, node);
        }
        for (section, what) in BY_NAME {
            let Some(node) = fields.get(section) else { continue };
            if node.scalar().is_some_and(|scalar| !scalar.is_null()) {
                // `initial: equilibrium`; any other word is reported later.
                let entry = Entry { key: section.to_owned(), key_span: fields.key_span(section), value: node.clone() };
                replace(&mut self.entries, entry);
                continue;
            }
            for entry in report.entries(node, what) {
                self.out.remove(&(section, entry.key.clone()));
                if let Some(entries) = self.section(section, fields.key_span(section), node) {
                    replace(entries, entry.clone());
                }
            }
        }
        if let Some(node) = fields.get("parameters") {
            self.parameters(report, node, fields.key_span("parameters"));
        }
        if let Some(node) = fields.get("simulation") {
            self.simulation(node, fields.key_span("simulation"));
        }
        for key in WHOLE {
            if let Some(node) = fields.get(key) {
                let entry = Entry { key: key.to_owned(), key_span: fields.key_span(key), value: node.clone() };
                replace(&mut self.entries, entry);
            }
        }
        if let Some(node) = fields.get("with") {
            self.with(report, node);
        }
    }

    /// The entries of a section, which is created if it is absent; `None` if it is no mapping, which is reported for
    /// the model.
    fn section(&mut self, key: &str, key_span: Span, like: &Node) -> Option<&mut Vec<Entry>> {
        let is_word = |entry: &Entry| key == "initial" && entry.value.scalar().is_some();
        let found = self.entries.iter().position(|e| e.key == key && !e.value.is_null() && !is_word(e));
        let index = found.unwrap_or_else(|| {
            let value = Node { span: like.span.clone(), value: Value::Mapping(Vec::new()) };
            self.entries.retain(|entry| entry.key != key);
            self.entries.push(Entry { key: key.to_owned(), key_span, value });
            self.entries.len() - 1
        });
        match &mut self.entries[index].value.value {
            Value::Mapping(entries) => Some(entries),
            _ => None,
        }
    }

    /// The entries of a section that is there.
    fn entries_of(&self, section: &str) -> &[Entry] {
        let found = self.entries.iter().find(|entry| entry.key == section);
        match found.map(|entry| &entry.value.value) {
            Some(Value::Mapping(entries)) => entries,
            _ => &[],
        }
    }

    fn has_robot(&self) -> bool {
        self.entries.iter().any(|entry| entry.key == "urdf")
    }

    /// `without`: names of effects, joints and outputs, or `all` effects.
    pub fn without(&mut self, report: &mut Report, node: &Node) {
        if node.scalar().is_some_and(|scalar| scalar.text == "all") {
            let effects: Vec<_> =
                self.entries_of("effects").iter().map(|entry| ("effects", entry.key.clone())).collect();
            self.out.extend(effects);
            self.robot = OmittedEffects { all: true, ..OmittedEffects::default() };
            return;
        }
        for (name, span) in
            self.all_names(names(report, node, "`all`, or a list of effects, joints and outputs,"), false)
        {
            let sections = self.sections_with(&name);
            let robots = self.robot.names.iter().any(|(known, _)| *known == name);
            if sections.iter().all(|section| self.out.contains(&(*section, name.clone()))) && !sections.is_empty()
                || robots
            {
                report.error(Code::BadScene, span, format!("`{}` is omitted already", clip(&name)), None);
            } else if sections.is_empty() && self.has_robot() {
                // Perhaps one of the robot's, which are known when its file is read.
                self.robot.kept.retain(|(kept, _)| *kept != name);
                self.robot.names.push((name, span));
            } else if sections.is_empty() {
                self.unknown(report, &name, span);
            } else {
                self.out.extend(sections.into_iter().map(|section| (section, name.clone())));
            }
        }
    }

    /// `with`: adds omitted parts again.
    fn with(&mut self, report: &mut Report, node: &Node) {
        for (name, span) in self.all_names(names(report, node, "a list of effects, joints and outputs"), true) {
            let sections = self.sections_with(&name);
            let before = self.out.len() + self.robot.names.len();
            self.out.retain(|(_, known)| *known != name);
            self.robot.names.retain(|(known, _)| *known != name);
            if self.out.len() + self.robot.names.len() < before {
                continue;
            }
            if sections.is_empty() && self.robot.all && self.has_robot() {
                self.robot.kept.push((name, span));
            } else if sections.is_empty() && !self.has_robot() {
                self.unknown(report, &name, span);
            } else {
                let help = "`with` puts in entries that the model, an extended scene or this scene's `without` omits";
                report.error(Code::BadScene, span, format!("`{}` is not omitted", clip(&name)), help.to_owned());
            }
        }
    }

    /// The names, with those that patterns stand for, and the parts of effects on many: of them only those that are
    /// out, or in.
    fn all_names(&self, names: Vec<(String, Span)>, out: bool) -> Vec<(String, Span)> {
        let each = |(name, span): (String, Span)| {
            let entries =
                NAMED.iter().flat_map(|section| self.entries_of(section).iter().map(move |entry| (*section, entry)));
            let is_part = |known: &str| known.strip_prefix(&name).is_some_and(|rest| rest.starts_with('.'));
            let parts = entries.filter(|(section, entry)| match patterns::is_pattern(&name) {
                true => patterns::matches(&name, &entry.key),
                false => *section == "effects" && is_part(&entry.key),
            });
            let state = |section: &'static str, key: &str| self.out.contains(&(section, key.to_owned())) == out;
            let found = parts.filter(|(section, entry)| state(section, &entry.key));
            let found: BTreeSet<String> = found.map(|(_, entry)| entry.key.clone()).collect();
            if found.is_empty() || !self.sections_with(&name).is_empty() {
                vec![(name, span)]
            } else {
                found.into_iter().map(|found| (found, span.clone())).collect()
            }
        };
        names.into_iter().flat_map(each).collect()
    }

    /// Sections that have an entry of this name; that of outputs only where no effect and no joint has it.
    fn sections_with(&self, name: &str) -> Vec<&'static str> {
        let has = |section: &&str| self.entries_of(section).iter().any(|entry| entry.key == name);
        let [parts, outputs] =
            [PARTS, OUTPUTS].map(|sections| sections.iter().copied().filter(has).collect::<Vec<_>>());
        if parts.is_empty() { outputs } else { parts }
    }

    fn unknown(&self, report: &mut Report, name: &str, span: Span) {
        let known = NAMED.iter().flat_map(|section| self.entries_of(section)).map(|entry| entry.key.as_str());
        unknown(report, name, span, known);
    }

    /// A parameter's new value; its unit and description stay, its deviation does not.
    fn parameters(&mut self, report: &mut Report, node: &Node, key_span: Span) {
        let has_robot = self.has_robot();
        for entry in report.entries(node, "parameters") {
            report.mentions(Some(NameKind::Parameter), &entry.key, &entry.key_span);
            let Some(parameters) = self.section("parameters", key_span.clone(), node) else { return };
            let known = parameters.iter().position(|known| known.key == entry.key);
            match known {
                // A number of the URDF is there without being named.
                _ if has_robot && urdf::is_number(&entry.key) => replace(parameters, entry.clone()),
                Some(index) => {
                    notation::suspect_unit(report, &entry.value, &parameters[index].value);
                    parameters[index] = overridden(&parameters[index], entry);
                }
                None => {
                    let names = parameters.iter().map(|known| known.key.as_str());
                    let help = suggest::help(&entry.key, "parameters", names);
                    let message = format!("unknown parameter `{}`", clip(&entry.key));
                    report.error(Code::UnknownName, entry.key_span.clone(), message, help);
                }
            }
        }
    }

    /// Keys of a scene's `simulation` replace the model's; a step goes instead of a tolerance, and the other way round.
    fn simulation(&mut self, node: &Node, key_span: Span) {
        let Value::Mapping(changes) = &node.value else {
            replace(&mut self.entries, Entry { key: "simulation".to_owned(), key_span, value: node.clone() });
            return;
        };
        let Some(entries) = self.section("simulation", key_span, node) else { return };
        for change in changes {
            let other = match change.key.as_str() {
                "step" => "tolerance",
                "tolerance" => "step",
                _ => "",
            };
            if !changes.iter().any(|change| change.key == other) {
                entries.retain(|entry| entry.key != other);
            }
            replace(entries, change.clone());
        }
    }

    /// The tree's entries, without omitted parts.
    pub fn finished(mut self) -> Vec<Entry> {
        for section in NAMED {
            let found = self.entries.iter_mut().find(|entry| entry.key == section);
            if let Some(Value::Mapping(entries)) = found.map(|entry| &mut entry.value.value) {
                entries.retain(|entry| !self.out.contains(&(section, entry.key.clone())));
            }
        }
        self.entries
    }
}

/// Replaces the entry with the same key, or adds it at the end.
fn replace(entries: &mut Vec<Entry>, entry: Entry) {
    match entries.iter_mut().find(|known| known.key == entry.key) {
        Some(known) => *known = entry,
        None => entries.push(entry),
    }
}

/// The texts of a list, each with its location.
fn names(report: &mut Report, node: &Node, wanted: &str) -> Vec<(String, Span)> {
    let Value::Sequence(items) = &node.value else {
        let help = "write `[name, name]`".to_owned();
        report.error(
            Code::WrongShape,
            node.span.clone(),
            format!("{wanted} belongs here, but here is {}", node.kind()),
            help,
        );
        return Vec::new();
    };
    let name = |item: &Node| {
        report.mentions_node(None, item);
        Some((report.scalar(item, "a name")?.text.clone(), item.span.clone()))
    };
    items.iter().filter_map(name).collect()
}

/// A model's parameter as a scene has it.
pub fn overridden(model: &Entry, scene: &Entry) -> Entry {
    let changes = match &scene.value.value {
        Value::Mapping(changes) => changes.clone(),
        _ => {
            // In one piece as long as it is whole; a tolerance alone is one of the model's value.
            let parts = notation::fields(&scene.value);
            let whole = parts.iter().any(|part| part.key == "value");
            if whole { vec![field("value", scene.value.clone())] } else { parts }
        }
    };
    let says = |keys: &[&str]| changes.iter().any(|change| keys.contains(&change.key.as_str()));
    let mut fields = notation::fields_of_parameter(&model.value);
    if says(&["value"]) || says(&DEVIATION) {
        fields.retain(|field| !DEVIATION.contains(&field.key.as_str()));
    }
    if says(&["interval"]) {
        fields.retain(|field| field.key != "value");
    }
    changes.into_iter().for_each(|change| replace(&mut fields, change));
    let value = match fields.as_slice() {
        [only] if only.key == "value" => only.value.clone(),
        _ => Node { span: scene.value.span.clone(), value: Value::Mapping(fields) },
    };
    Entry { key: scene.key.clone(), key_span: scene.key_span.clone(), value }
}
