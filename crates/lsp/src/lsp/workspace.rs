//! Open documents, and the models that they belong to, read again after a text changed.
//!
//! A document is a model, or a file of assemblies. The latter belongs to the models that include it: open ones, else
//! those in its folder and the folders above it within the workspace, because an included file lies below its model. A
//! file of assemblies without a model is read with an instance of each of them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_types::Uri;

use super::names::Names;
use super::text::Text;
use super::tuning::TUNING;
use crate::model::{Description, Opened, read_open};
use crate::syntax::Diagnostics;
use crate::syntax::text_file::read_text;
use crate::syntax::tuning::TUNING as SYNTAX;
use crate::syntax::within::OpenTexts;
use crate::syntax::yaml::{self, Entry, Value};

/// Keys of a file of assemblies.
const KEYS_OF_PART: [&str; 3] = ["description", "include", "assemblies"];

/// A text that an editor has open.
#[derive(Clone, Debug)]
pub struct Document {
    /// Its address, as the editor writes it.
    pub uri: Uri,
    /// Its present text.
    pub text: Text,
    /// Its version, which the editor counts.
    pub version: i32,
}

/// A model with its names.
#[derive(Clone, Debug)]
pub struct Model {
    /// The model's file; for assemblies alone, one that does not exist.
    pub path: PathBuf,
    /// Result of the last reading.
    pub opened: Opened,
    /// Its names.
    pub names: Names,
    /// The last model that could be read.
    pub known: Option<Arc<Description>>,
    /// All names of the last reading that had any.
    pub names_known: Vec<(String, crate::grammar::mentions::NameKind)>,
    /// Its files.
    files: BTreeSet<PathBuf>,
    /// Whether it has no file of its own.
    pub is_made_up: bool,
}

impl Model {
    /// Whether a file is one of its files.
    pub fn has(&self, file: &Path) -> bool {
        self.files.contains(file)
    }
}

/// Documents and models.
#[derive(Default)]
pub struct Workspace {
    /// Open documents.
    pub documents: BTreeMap<PathBuf, Document>,
    /// Folders that the editor has open.
    folders: Vec<PathBuf>,
    /// Folder whose files models may name, in addition to those of their own folders.
    pub root: Option<PathBuf>,
    /// Models of the open documents.
    models: BTreeMap<PathBuf, Model>,
    /// Documents that changed since models were read.
    changed: BTreeSet<PathBuf>,
}

impl Workspace {
    /// A workspace of these folders; models may name files of `root`, in addition to those of their own folders.
    pub fn new(folders: Vec<PathBuf>, root: Option<PathBuf>) -> Self {
        Self { folders, root, ..Self::default() }
    }

    /// Opens or changes a document.
    pub fn set(&mut self, path: PathBuf, document: Document) {
        self.changed.insert(path.clone());
        self.documents.insert(path, document);
    }

    /// Closes a document: its stored text is used again.
    pub fn close(&mut self, path: &Path) {
        self.documents.remove(path);
        self.changed.insert(path.to_owned());
    }

    /// Files on the disk have changed: every model is read again.
    pub fn stale(&mut self) {
        self.changed.extend(self.documents.keys().cloned());
    }

    /// Reads the models whose texts changed. Returns the paths of those that were read.
    pub fn refresh(&mut self) -> Vec<PathBuf> {
        let changed = std::mem::take(&mut self.changed);
        if changed.is_empty() {
            return Vec::new();
        }
        let texts = self.documents.iter().map(|(path, own)| (path.clone(), own.text.as_str().to_owned()));
        let open = OpenTexts::new(texts);
        let wanted: BTreeSet<PathBuf> = self.documents.keys().filter(|path| !self.is_part(path)).cloned().collect();
        let of_models = |model: &&Model| !model.files.is_disjoint(&changed);
        let mut stale: BTreeSet<PathBuf> = self.models.values().filter(of_models).map(|own| own.path.clone()).collect();
        stale.extend(wanted.iter().filter(|path| !self.models.contains_key(*path) || changed.contains(*path)).cloned());
        self.models.retain(|path, _| wanted.contains(path) || stale.contains(path));
        for path in stale.iter().filter(|path| wanted.contains(*path)) {
            self.read(path.clone(), &open, false);
        }
        let mut read = stale;
        let mut used = wanted;
        let parts: Vec<PathBuf> = self.documents.keys().filter(|path| self.is_part(path)).cloned().collect();
        for part in parts {
            let path = match self.models.values().find(|own| !own.is_made_up && own.files.contains(&part)) {
                Some(model) if !changed.contains(&part) => model.path.clone(),
                _ => self.read_including(&part, &open),
            };
            read.insert(path.clone());
            used.insert(path);
        }
        self.models
            .retain(|path, model| used.contains(path) || self.documents.keys().any(|own| model.files.contains(own)));
        read.into_iter().filter(|path| self.models.contains_key(path)).collect()
    }

    /// Reads a model that includes a file. Returns the model's path.
    fn read_including(&mut self, part: &Path, open: &OpenTexts) -> PathBuf {
        let known = |own: &&Model| !own.is_made_up && own.files.contains(part);
        if let Some(path) = self.models.values().find(known).map(|own| own.path.clone()) {
            return path;
        }
        for candidate in self.including(part) {
            let text = read_text(&candidate, SYNTAX.file_bytes).unwrap_or_default();
            let open = open.with(candidate.clone(), text);
            self.read(candidate.clone(), &open, false);
            if self.models.get(&candidate).is_some_and(|own| own.files.contains(part)) {
                return candidate;
            }
            self.models.remove(&candidate);
        }
        let (path, text) = self.made_up(part);
        self.read(path.clone(), &open.with(path.clone(), text), true);
        path
    }

    /// Stored models that may include a file, in its folder and the folders above.
    fn including(&self, part: &Path) -> Vec<PathBuf> {
        let Some(name) = part.file_name().and_then(|name| name.to_str()) else { return Vec::new() };
        let within = |folder: &&Path| self.folders.iter().any(|own| folder.starts_with(own));
        let own = part.parent();
        let above = part.ancestors().skip(2).take_while(within);
        let mut found = Vec::new();
        for folder in own.into_iter().chain(above) {
            let Ok(entries) = std::fs::read_dir(folder) else { continue };
            let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
            // Open models have been examined with their open texts.
            files.retain(|path| path != part && !self.documents.contains_key(path));
            files.retain(|path| path.extension().is_some_and(|own| own == "yaml" || own == "yml"));
            files.sort_unstable();
            files.truncate(TUNING.most_files);
            found.extend(files.into_iter().filter(|path| {
                let text = read_text(path, SYNTAX.file_bytes).unwrap_or_default();
                text.contains("include") && text.contains(name)
            }));
        }
        found
    }

    /// Path and text of a model with an instance of each assembly of a file.
    fn made_up(&self, part: &Path) -> (PathBuf, String) {
        let name = part.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let text = self.documents.get(part).map_or("", |own| own.text.as_str());
        let mut model = format!("include: {}\ninstances:\n", serde_json::Value::from(name.as_str()));
        for entry in section(text, "assemblies") {
            let of = serde_json::Value::from(entry.key.as_str());
            model.push_str(&format!("  one_{}: {{ of: {of} }}\n", entry.key));
        }
        model.push_str("outputs: { time: t }\nsimulation: { duration: 1, step: 1e-3 }\n");
        (part.with_file_name(format!("{name}?")), model)
    }

    fn read(&mut self, path: PathBuf, open: &OpenTexts, is_made_up: bool) {
        let opened = read_open(&path, open, self.root.as_deref());
        let before = self.models.remove(&path);
        let (known, names_known) = before.map(|own| (own.known, own.names_known)).unwrap_or_default();
        let scenes = opened.reading.scenes.iter().map(|scene| &scene.description);
        let known = opened.reading.description.iter().chain(scenes).next().cloned().map(Arc::new).or(known);
        let names = Names::of(&opened, known.as_deref());
        let all: Vec<_> = names.all().into_iter().map(|(name, kind)| (name.to_owned(), kind)).collect();
        let names_known = if all.is_empty() { names_known } else { all };
        let sources = opened.reading.diagnostics.sources.all();
        let files = sources.map(|source| PathBuf::from(&source.name)).chain([path.clone()]).collect();
        let model = Model { path: path.clone(), opened, names, known, names_known, files, is_made_up };
        self.models.insert(path, model);
    }

    /// Whether an open document is a file of assemblies and no model.
    fn is_part(&self, path: &Path) -> bool {
        let text = self.documents.get(path).map_or("", |own| own.text.as_str());
        // Cheaper than a tree, and works on half-typed text.
        let keys = text.lines().filter(|line| line.starts_with(|c: char| c.is_alphabetic() || c == '_'));
        let mut keys = keys.filter_map(|line| line.split_once(':')).map(|(key, _)| key.trim_end()).peekable();
        keys.peek().is_some() && keys.all(|key| KEYS_OF_PART.contains(&key))
    }

    /// The model that a document belongs to.
    pub fn model_of(&self, path: &Path) -> Option<&Model> {
        self.models.get(path).or_else(|| self.models.values().find(|own| own.files.contains(path)))
    }

    /// A model by its path.
    pub fn model(&self, path: &Path) -> Option<&Model> {
        self.models.get(path)
    }

    /// All models.
    pub fn models(&self) -> impl Iterator<Item = &Model> {
        self.models.values()
    }

    /// Texts of all open documents, some of them changed.
    pub fn texts_with(&self, changed: &BTreeMap<PathBuf, String>) -> OpenTexts {
        let own = self.documents.iter().map(|(path, own)| (path.clone(), own.text.as_str().to_owned()));
        OpenTexts::new(own.chain(changed.iter().map(|(path, text)| (path.clone(), text.clone()))))
    }

    /// The text of a file of a model: the open one, else as it was read.
    pub fn text_of(&self, model: &Model, path: &Path) -> Option<Text> {
        if let Some(document) = self.documents.get(path) {
            return Some(document.text.clone());
        }
        let mut sources = model.opened.reading.diagnostics.sources.all();
        sources.find(|source| Path::new(&source.name) == path).map(|source| Text::new(source.text.clone()))
    }
}

/// The entries of a section of a text.
fn section(text: &str, name: &str) -> Vec<Entry> {
    let root = yaml::parse(text, &mut Diagnostics::new("", text));
    match root.as_ref().and_then(|root| root.get(name)).map(|node| &node.value) {
        Some(Value::Mapping(entries)) => entries.clone(),
        _ => Vec::new(),
    }
}
