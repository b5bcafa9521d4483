//! `scenes:`, named variants of a model, and `without:`, what of a model is not in.
//!
//! A scene is the model's tree with the scene's changes laid over it, read as a model of its own: what is absent was never
//! there, and every node keeps its place in the file.

use std::collections::HashSet;

use super::file;
use super::urdf;
use crate::grammar::reader::Fields;
use crate::model::names::Reader;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Most scenes of a model: each is read, compiled and run.
const MOST: usize = 200;

/// Sections whose entries can be left out by name.
const NAMED: [&str; 3] = ["effects", "joints", "outputs"];

/// Sections of which a scene's entries replace the model's of the same name, or come on top.
const BY_NAME: [(&str, &str); 5] = [
    ("joints", "joints"),
    ("effects", "effects"),
    ("initial", "start values"),
    ("guess", "start values"),
    ("outputs", "outputs"),
];

/// Keys whose value in a scene stands instead of the model's.
const WHOLE: [&str; 3] = ["description", "limits", "bounds"];

/// What says how far a parameter may be off.
const DEVIATION: [&str; 4] = ["tolerance", "interval", "plus", "minus"];

/// A model, or a scene of it, as a tree to be read.
pub struct Variant {
    /// Of the scene; absent for the model itself.
    pub scene: Option<String>,
    /// The tree, without `scenes`, `without`, and what is left out.
    pub root: Node,
    /// Names of effects, joints and outputs that are not in it.
    pub left_out: Vec<String>,
    /// What of a robot is left out: its names are known only when its file is read.
    pub robot: LeftOut,
    /// Whether parameters that nothing speaks of are there because something else is not.
    pub partial: bool,
}

/// Effects of a robot that are left out.
#[derive(Clone, Default)]
pub struct LeftOut {
    all: bool,
    /// Left out by name.
    names: Vec<(String, Span)>,
    /// Of all, those that are in again.
    kept: Vec<(String, Span)>,
}

impl LeftOut {
    /// Whether an effect is not in.
    pub fn leaves_out(&self, name: &str) -> bool {
        let among = |names: &[(String, Span)]| names.iter().any(|(known, _)| known == name);
        among(&self.names) || self.all && !among(&self.kept)
    }

    fn leaves_out_any(&self) -> bool {
        self.all || !self.names.is_empty()
    }

    /// Every name that was given, with its place.
    pub fn given(&self) -> impl Iterator<Item = &(String, Span)> {
        self.names.iter().chain(&self.kept)
    }
}

/// The model and its scenes, none of them laid over it yet.
pub struct Scenes<'n> {
    root: &'n Node,
    model: Draft,
    layers: Vec<Layer<'n>>,
}

/// A scene as it is written.
struct Layer<'n> {
    entry: &'n Entry,
    fields: Fields<'n>,
    /// The scene that it extends.
    extends: Option<usize>,
}

/// A tree in the making.
#[derive(Clone, Default)]
struct Draft {
    entries: Vec<Entry>,
    /// Section and name.
    out: HashSet<(&'static str, String)>,
    robot: LeftOut,
}

impl<'n> Scenes<'n> {
    /// Reads what a model leaves out, and which scenes it has; what is wrong with their names is reported.
    pub fn read(reader: &mut Reader, root: &'n Node) -> Self {
        let mut scenes = Self { root, model: Draft::default(), layers: Vec::new() };
        let Value::Mapping(entries) = &root.value else { return scenes };
        let of_scenes = |entry: &&Entry| matches!(entry.key.as_str(), "scenes" | "without");
        scenes.model.entries = entries.iter().filter(|entry| !of_scenes(entry)).cloned().collect();
        let find = |key: &str| entries.iter().find(|entry| entry.key == key);
        if let Some(without) = find("without") {
            scenes.model.without(reader, &without.value);
        }
        if let Some(section) = find("scenes") {
            let written = reader.entries(&section.value, "scenes");
            scenes.layers = layers(reader, written);
        }
        scenes
    }

    /// How many scenes there are.
    pub fn count(&self) -> usize {
        self.layers.len()
    }

    /// The place of a scene's name, and of all of it.
    pub fn place(&self, scene: usize) -> (Span, Span) {
        let entry = self.layers[scene].entry;
        (entry.key_span.clone(), entry.key_span.start..entry.value.span.end.max(entry.key_span.end))
    }

    /// The model itself.
    pub fn model(&self) -> Variant {
        self.variant(self.model.clone(), None)
    }

    /// A scene: the model's tree with the changes of what it extends, and then its own.
    pub fn scene(&self, reader: &mut Reader, scene: usize) -> Variant {
        let mut chain = vec![scene];
        while let Some(next) = self.layers[chain[chain.len() - 1]].extends {
            chain.push(next);
        }
        let mut draft = self.model.clone();
        for &layer in chain.iter().rev() {
            draft.lay(reader, &self.layers[layer].fields);
        }
        self.variant(draft, Some(self.layers[scene].entry.key.clone()))
    }

    fn variant(&self, draft: Draft, scene: Option<String>) -> Variant {
        let partial = scene.is_some() || !draft.out.is_empty() || draft.robot.leaves_out_any();
        let robot = draft.robot.clone();
        let left_out = draft.out.iter().map(|(_, name)| name.clone()).collect();
        let value = match self.root.value {
            Value::Mapping(_) => Value::Mapping(draft.finished()),
            _ => self.root.value.clone(),
        };
        Variant { scene, root: Node { span: self.root.span.clone(), value }, left_out, robot, partial }
    }
}

/// The scenes, each with the one that it extends.
fn layers<'n>(reader: &mut Reader, mut entries: &'n [Entry]) -> Vec<Layer<'n>> {
    if let Some(beyond) = entries.get(MOST) {
        reader.error(beyond.key_span.clone(), format!("the model has more than {MOST} scenes"), None);
        entries = &entries[..MOST];
    }
    let mut layers: Vec<Layer> = Vec::new();
    for entry in entries {
        reader.folder_name(&entry.key, entry.key_span.clone(), "a scene");
        let alike = |layer: &&Layer| layer.entry.key.to_lowercase() == entry.key.to_lowercase();
        if let Some(other) = layers.iter().find(alike) {
            let message = format!("`{}` and `{}` differ in upper and lower case only", other.entry.key, entry.key);
            let diagnostic = Diagnostic::error(entry.key_span.clone(), message)
                .help("folders of results are called after scenes, and on some systems these would be one".to_owned());
            reader.diagnostics.push(diagnostic.also(other.entry.key_span.clone(), "the other"));
        }
        if let Some(fields) = reader.fields::<file::Scene>(&entry.value, entry.key_span.clone()) {
            layers.push(Layer { entry, fields, extends: None });
        }
    }
    for index in 0..layers.len() {
        layers[index].extends = extended(reader, &layers, index);
    }
    for index in 0..layers.len() {
        break_circle(reader, &mut layers, index);
    }
    layers
}

fn extended(reader: &mut Reader, layers: &[Layer], index: usize) -> Option<usize> {
    let node = layers[index].fields.get("extends")?;
    let name = &reader.scalar(node, "the name of a scene")?.text;
    let found = layers.iter().position(|layer| layer.entry.key == *name);
    if found.is_none() {
        let others = layers.iter().map(|layer| layer.entry.key.as_str());
        let help = suggest::help(name, "scenes", others.filter(|other| *other != layers[index].entry.key));
        reader.error(node.span.clone(), format!("unknown scene `{}`", clip(name)), help);
    }
    found
}

/// Reports scenes that extend each other, and ends the chain there.
fn break_circle(reader: &mut Reader, layers: &mut [Layer], start: usize) {
    let mut chain = vec![start];
    while let Some(next) = layers[chain[chain.len() - 1]].extends {
        if next != start && chain.contains(&next) {
            // A circle further on: it is reported from there.
            return;
        }
        chain.push(next);
        if next == start {
            let names: Vec<String> = chain.iter().map(|&layer| clip(&layers[layer].entry.key)).collect();
            let message = format!("scenes extend each other in a circle: {}", names.join(" → "));
            let place = layers[start].fields.get("extends").map(|node| node.span.clone());
            reader.error(place.unwrap_or_default(), message, None);
            layers[start].extends = None;
            return;
        }
    }
}

impl Draft {
    /// Lays a scene's changes over the tree.
    fn lay(&mut self, reader: &mut Reader, fields: &Fields) {
        if let Some(node) = fields.get("without") {
            self.without(reader, node);
        }
        for (section, what) in BY_NAME {
            let Some(node) = fields.get(section) else { continue };
            for entry in reader.entries(node, what) {
                self.out.remove(&(section, entry.key.clone()));
                if let Some(entries) = self.section(section, fields.key_span(section), node) {
                    replace(entries, entry.clone());
                }
            }
        }
        if let Some(node) = fields.get("parameters") {
            self.parameters(reader, node, fields.key_span("parameters"));
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
            self.with(reader, node);
        }
    }

    /// The entries of a section, which is made if it is not there; nothing where it is no mapping, as is reported of the model.
    fn section(&mut self, key: &str, key_span: Span, like: &Node) -> Option<&mut Vec<Entry>> {
        let found = self.entries.iter().position(|entry| entry.key == key && !entry.value.is_null());
        let place = found.unwrap_or_else(|| {
            let value = Node { span: like.span.clone(), value: Value::Mapping(Vec::new()) };
            self.entries.retain(|entry| entry.key != key);
            self.entries.push(Entry { key: key.to_owned(), key_span, value });
            self.entries.len() - 1
        });
        match &mut self.entries[place].value.value {
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
    fn without(&mut self, reader: &mut Reader, node: &Node) {
        if node.scalar().is_some_and(|scalar| scalar.text == "all") {
            let effects: Vec<_> =
                self.entries_of("effects").iter().map(|entry| ("effects", entry.key.clone())).collect();
            self.out.extend(effects);
            self.robot = LeftOut { all: true, ..LeftOut::default() };
            return;
        }
        for (name, span) in names(reader, node, "`all`, or a list of effects, joints and outputs,") {
            let sections = self.sections_with(&name);
            let robots = self.robot.names.iter().any(|(known, _)| *known == name);
            if sections.iter().all(|section| self.out.contains(&(*section, name.clone()))) && !sections.is_empty()
                || robots
            {
                reader.error(span, format!("`{}` is left out already", clip(&name)), None);
            } else if sections.is_empty() && self.has_robot() {
                // Perhaps one of the robot's, which are known when its file is read.
                self.robot.kept.retain(|(kept, _)| *kept != name);
                self.robot.names.push((name, span));
            } else if sections.is_empty() {
                self.unknown(reader, &name, span);
            } else {
                self.out.extend(sections.into_iter().map(|section| (section, name.clone())));
            }
        }
    }

    /// `with`: puts in again what is left out.
    fn with(&mut self, reader: &mut Reader, node: &Node) {
        for (name, span) in names(reader, node, "a list of effects, joints and outputs") {
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
                self.unknown(reader, &name, span);
            } else {
                let help = "`with` puts in what the model, a scene that is extended or this one's `without` leaves out";
                reader.error(span, format!("`{}` is not left out", clip(&name)), help.to_owned());
            }
        }
    }

    /// Sections that have an entry of this name.
    fn sections_with(&self, name: &str) -> Vec<&'static str> {
        let has = |section: &&str| self.entries_of(section).iter().any(|entry| entry.key == name);
        NAMED.into_iter().filter(has).collect()
    }

    fn unknown(&self, reader: &mut Reader, name: &str, span: Span) {
        let known = NAMED.iter().flat_map(|section| self.entries_of(section)).map(|entry| entry.key.as_str());
        unknown(reader, name, span, known);
    }

    /// A parameter's new value; its unit and description stay, what is said of its deviation does not.
    fn parameters(&mut self, reader: &mut Reader, node: &Node, key_span: Span) {
        for entry in reader.entries(node, "parameters") {
            let Some(parameters) = self.section("parameters", key_span.clone(), node) else { return };
            let known = parameters.iter().position(|known| known.key == entry.key);
            match known {
                // A number of the URDF is there without being named.
                _ if urdf::is_number(&entry.key) => replace(parameters, entry.clone()),
                Some(place) => parameters[place] = overridden(&parameters[place], entry),
                None => {
                    let names = parameters.iter().map(|known| known.key.as_str());
                    let help = suggest::help(&entry.key, "parameters", names);
                    let message = format!("unknown parameter `{}`", clip(&entry.key));
                    reader.error(entry.key_span.clone(), message, help);
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

    /// The tree's entries, without what is left out.
    fn finished(mut self) -> Vec<Entry> {
        for section in NAMED {
            let found = self.entries.iter_mut().find(|entry| entry.key == section);
            if let Some(Value::Mapping(entries)) = found.map(|entry| &mut entry.value.value) {
                entries.retain(|entry| !self.out.contains(&(section, entry.key.clone())));
            }
        }
        self.entries
    }
}

/// Reports a name of nothing that could be left out.
pub fn unknown<'k>(reader: &mut Reader, name: &str, span: Span, known: impl IntoIterator<Item = &'k str>) {
    let message = format!("there is no effect, joint or output `{}`", clip(name));
    let help = suggest::help(name, "names", known);
    reader.error(span, message, help);
}

/// Puts an entry in the place of the one with its key, or behind the others.
fn replace(entries: &mut Vec<Entry>, entry: Entry) {
    match entries.iter_mut().find(|known| known.key == entry.key) {
        Some(known) => *known = entry,
        None => entries.push(entry),
    }
}

/// The texts of a list, each with its place.
fn names(reader: &mut Reader, node: &Node, wanted: &str) -> Vec<(String, Span)> {
    let Value::Sequence(items) = &node.value else {
        let help = "write `[name, name]`".to_owned();
        reader.error(node.span.clone(), format!("{wanted} belongs here, but here is {}", node.kind()), help);
        return Vec::new();
    };
    let name = |item: &Node| Some((reader.scalar(item, "a name")?.text.clone(), item.span.clone()));
    items.iter().filter_map(name).collect()
}

/// A model's parameter as a scene has it.
fn overridden(model: &Entry, scene: &Entry) -> Entry {
    let field =
        |key: &str, value: &Node| Entry { key: key.to_owned(), key_span: value.span.clone(), value: value.clone() };
    let mut fields = match &model.value.value {
        Value::Mapping(fields) => fields.clone(),
        _ => vec![field("value", &model.value)],
    };
    let changes = match &scene.value.value {
        Value::Mapping(changes) => changes.clone(),
        _ => vec![field("value", &scene.value)],
    };
    let says = |keys: &[&str]| changes.iter().any(|change| keys.contains(&change.key.as_str()));
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
