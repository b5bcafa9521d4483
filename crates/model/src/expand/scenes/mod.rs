//! `scenes:`, named variants of a model, and `without:`, omitted parts of a model.
//!
//! A scene is the model's tree with the scene's changes laid over it, read as a model of its own: an absent part was
//! never there, and every node keeps its location in the file.

pub mod draft;

use self::draft::TreeDraft;
use crate::expand::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::grammar::report::{Fields, Report};
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// A model, or a scene of it, as a tree to be read.
pub struct Variant {
    /// Name of the scene; `None` for the model itself.
    pub scene: Option<String>,
    /// The tree, without `scenes`, `without`, and the omitted parts.
    pub root: Node,
    /// Names of effects, joints and outputs that are not in it.
    pub left_out: Vec<String>,
    /// Omitted parts of a robot: their names are known only when its file is read.
    pub robot: OmittedEffects,
    /// Whether parameters may be unused because something else is omitted.
    pub partial: bool,
}

/// Omitted effects of a robot.
#[derive(Clone, Default)]
pub struct OmittedEffects {
    all: bool,
    /// Omitted by name.
    names: Vec<(String, Span)>,
    /// Effects put in again although all are omitted.
    kept: Vec<(String, Span)>,
}

impl OmittedEffects {
    /// Whether an effect is not in.
    pub fn leaves_out(&self, name: &str) -> bool {
        let among = |names: &[(String, Span)]| names.iter().any(|(known, _)| known == name);
        among(&self.names) || self.all && !among(&self.kept)
    }

    fn leaves_out_any(&self) -> bool {
        self.all || !self.names.is_empty()
    }

    /// Every name that was given, with its location.
    pub fn given(&self) -> impl Iterator<Item = &(String, Span)> {
        self.names.iter().chain(&self.kept)
    }
}

/// The model and its scenes, none of them laid over it yet.
pub struct Scenes<'n> {
    root: &'n Node,
    model: TreeDraft,
    layers: Vec<Layer<'n>>,
}

/// A scene as it is written.
struct Layer<'n> {
    entry: &'n Entry,
    fields: Fields<'n>,
    /// The scene that it extends.
    extends: Option<usize>,
}

impl<'n> Scenes<'n> {
    /// Reads the omitted parts of a model, and its scenes; errors of their names are reported.
    pub fn read(report: &mut Report, root: &'n Node) -> Self {
        let mut scenes = Self { root, model: TreeDraft::default(), layers: Vec::new() };
        let Value::Mapping(entries) = &root.value else { return scenes };
        let of_scenes = |entry: &&Entry| matches!(entry.key.as_str(), "scenes" | "without");
        scenes.model.entries = entries.iter().filter(|entry| !of_scenes(entry)).cloned().collect();
        let find = |key: &str| entries.iter().find(|entry| entry.key == key);
        if let Some(without) = find("without") {
            scenes.model.without(report, &without.value);
        }
        if let Some(section) = find("scenes") {
            let written = report.entries(&section.value, "scenes");
            scenes.layers = layers(report, written);
        }
        scenes
    }

    /// How many scenes there are.
    pub fn count(&self) -> usize {
        self.layers.len()
    }

    /// Locations of a scene's name, and of the whole scene.
    pub fn place(&self, scene: usize) -> (Span, Span) {
        let entry = self.layers[scene].entry;
        (entry.key_span.clone(), entry.key_span.start..entry.value.span.end.max(entry.key_span.end))
    }

    /// The model itself.
    pub fn model(&self) -> Variant {
        self.variant(self.model.clone(), None)
    }

    /// A scene: the model's tree with the changes of the scene it extends, and then its own.
    pub fn scene(&self, report: &mut Report, scene: usize) -> Variant {
        let mut chain = vec![scene];
        while let Some(next) = self.layers[chain[chain.len() - 1]].extends {
            chain.push(next);
        }
        let mut draft = self.model.clone();
        for &layer in chain.iter().rev() {
            draft.lay(report, &self.layers[layer].fields);
        }
        self.variant(draft, Some(self.layers[scene].entry.key.clone()))
    }

    fn variant(&self, draft: TreeDraft, scene: Option<String>) -> Variant {
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
fn layers<'n>(report: &mut Report, mut entries: &'n [Entry]) -> Vec<Layer<'n>> {
    if let Some(beyond) = entries.get(TUNING.scenes) {
        report.error(
            Code::TooLarge,
            beyond.key_span.clone(),
            format!("the model has more than {scenes} scenes", scenes = TUNING.scenes),
            None,
        );
        entries = &entries[..TUNING.scenes];
    }
    let mut layers: Vec<Layer> = Vec::new();
    for entry in entries {
        report.is_folder_name(&entry.key, entry.key_span.clone(), "a scene");
        let alike = |layer: &&Layer| layer.entry.key.to_lowercase() == entry.key.to_lowercase();
        if let Some(other) = layers.iter().find(alike) {
            let message = format!("`{}` and `{}` differ in upper and lower case only", other.entry.key, entry.key);
            let diagnostic = Diagnostic::error(Code::NameTaken, entry.key_span.clone(), message)
                .help("folders of results are called after scenes, and on some systems these would be one".to_owned());
            report.diagnostics.push(diagnostic.also(other.entry.key_span.clone(), "the other"));
        }
        report.defines(NameKind::Scene, &entry.key, entry);
        if let Some(fields) = report.fields::<keys::Scene>(&entry.value, entry.key_span.clone()) {
            layers.push(Layer { entry, fields, extends: None });
        }
    }
    for index in 0..layers.len() {
        layers[index].extends = extended(report, &layers, index);
    }
    for index in 0..layers.len() {
        break_circle(report, &mut layers, index);
    }
    layers
}

fn extended(report: &mut Report, layers: &[Layer], index: usize) -> Option<usize> {
    let node = layers[index].fields.get("extends")?;
    let name = &report.scalar(node, "the name of a scene")?.text;
    report.mentions_node(Some(NameKind::Scene), node);
    let found = layers.iter().position(|layer| layer.entry.key == *name);
    if found.is_none() {
        let others = layers.iter().map(|layer| layer.entry.key.as_str());
        let help = suggest::help(name, "scenes", others.filter(|other| *other != layers[index].entry.key));
        report.error(Code::UnknownName, node.span.clone(), format!("unknown scene `{}`", clip(name)), help);
    }
    found
}

/// Reports scenes that extend each other, and ends the chain there.
fn break_circle(report: &mut Report, layers: &mut [Layer], start: usize) {
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
            report.error(Code::Circle, place.unwrap_or_default(), message, None);
            layers[start].extends = None;
            return;
        }
    }
}

/// Reports a name of nothing that could be omitted.
pub fn unknown<'k>(report: &mut Report, name: &str, span: Span, known: impl IntoIterator<Item = &'k str>) {
    let message = format!("there is no effect, joint or output `{}`", clip(name));
    let help = suggest::help(name, "names", known);
    report.error(Code::UnknownName, span, message, help);
}
