//! `include:`, `assemblies:`, `instances:` and `repeat:`: the model's tree with all of them written out.
//!
//! Every copy keeps the locations of its original: an instance's copy of the definition's text has offsets of its own
//! among the sources, which know the instance. Names stay as they are written; a [`Scope`] at each scalar gives their
//! meaning. So all that comes after reads the tree as if it were written out.

mod in_model;
mod include;
mod instances;
mod many;
mod mirror;
mod parameters;
pub mod patterns;
mod placement;
mod ports;
mod repeat;
mod starts;
mod turned;

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use super::instance::Instance;
use super::overrides::Override;
use super::sections::entries_of;
use crate::expand::tuning::TUNING;
use crate::grammar::report::Report;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::mirrors::Mirrors;
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Value};
pub use in_model::Inclined;
pub use placement::{GROUND, is_ground};
use ports::Port;

/// Data of the written-out tree, in addition to its nodes.
#[derive(Clone, Default)]
pub struct Parts {
    /// Instances and effects on many.
    pub instances: Vec<Instance>,
    /// Parameters of assemblies, `quarter.mass`, with those of the instances that follow them.
    followers: BTreeMap<String, Vec<String>>,
    /// Parameters that say how often something is repeated.
    counts: BTreeSet<String>,
    pub ports: Vec<Port>,
    /// Instances with a ground of their own by the prefix of their names, with the axes across which they are mirrored.
    pub grounds: HashMap<String, Mirrors>,
    /// Effects of instances on joints that turn.
    pub turning_effects: BTreeSet<String>,
    /// Effects on level ground of instances that are turned.
    pub inclined: Vec<Inclined>,
}

/// A tree that is written out.
pub struct WrittenOut {
    pub root: Node,
    pub parts: Parts,
}

/// Writes out a model's tree; `None` if there is nothing to be written out.
pub fn write_out(report: &mut Report, root: &Node, text: &str, overrides: &[(Override, Span)]) -> Option<WrittenOut> {
    let words = ["include", "assemblies", "instances", "repeat", "sum", "all "];
    if !words.iter().any(|word| text.contains(word)) {
        return None;
    }
    let Value::Mapping(entries) = &root.value else { return None };
    let given = overrides.iter().map(|(wanted, _)| (wanted.name.clone(), wanted.value.clone())).collect();
    let mut writer = Writer {
        report,
        definitions: HashMap::new(),
        overrides: given,
        model: Arc::default(),
        parts: Parts::default(),
        sections: Vec::new(),
        bodies: HashSet::new(),
        turning: HashMap::new(),
        nodes: 0,
        is_full: false,
    };
    include::read(&mut writer, entries);
    writer.define(root);
    writer.model = Arc::new(Scope::of_model(Arc::new(writer.counts_of_model(root))));
    for entry in entries {
        match entry.key.as_str() {
            "assemblies" | "instances" | "include" => {}
            "scenes" => {
                let value = writer.scenes(&entry.value);
                writer.sections.push(Entry { value, ..entry.clone() });
            }
            _ => {
                let value = writer.node(&entry.value, 0, None);
                writer.sections.push(Entry { value, ..entry.clone() });
            }
        }
    }
    writer.instances_of_model(root);
    many::write_out(&mut writer);
    let Writer { sections, parts, .. } = writer;
    Some(WrittenOut { root: Node { span: root.span.clone(), value: Value::Mapping(sections) }, parts })
}

/// A tree while it is written out.
struct Writer<'w, 'd> {
    report: &'w mut Report<'d>,
    /// Assemblies by their names.
    definitions: HashMap<String, Arc<Entry>>,
    /// Values from the command line, by parameter.
    overrides: HashMap<String, Node>,
    /// Scope of the model itself.
    model: Arc<Scope>,
    parts: Parts,
    /// Sections of the tree.
    sections: Vec<Entry>,
    /// Bodies of instances.
    bodies: HashSet<String>,
    /// Joints of instances, and whether they turn.
    turning: HashMap<String, bool>,
    /// How many there are so far.
    nodes: usize,
    /// Whether that is too many, as was reported.
    is_full: bool,
}

impl Writer<'_, '_> {
    /// The entries of a section, which is made if it is not there.
    fn section(&mut self, key: &str, at: &Span) -> Option<&mut Vec<Entry>> {
        entries_of(&mut self.sections, key, at)
    }

    /// Entries of a section that are there already.
    fn entries(&self, key: &str) -> &[Entry] {
        match self.sections.iter().find(|entry| entry.key == key).map(|entry| &entry.value.value) {
            Some(Value::Mapping(entries)) => entries,
            _ => &[],
        }
    }

    /// Adds an entry to a section.
    fn add(&mut self, section: &str, entry: Entry) {
        let at = entry.key_span.clone();
        if let Some(entries) = self.section(section, &at) {
            entries.push(entry);
        }
    }

    /// Copies of some entries of a section.
    fn taken(&self, section: &str, range: &Range<usize>) -> Vec<Entry> {
        self.entries(section).get(range.clone()).unwrap_or_default().to_vec()
    }

    /// Replaces a range of entries.
    fn put(&mut self, section: &str, range: &Range<usize>, entries: Vec<Entry>) {
        if let Some(found) = self.section(section, &(0..0)).and_then(|found| found.get_mut(range.clone())) {
            found.iter_mut().zip(entries).for_each(|(index, entry)| *index = entry);
        }
    }

    /// Reports that a name is there twice.
    fn twice(&mut self, name: &str, span: &Span, first: &Span) {
        let message = format!("`{}` is given twice", crate::syntax::suggest::clip(name));
        let diagnostic = Diagnostic::error(Code::GivenTwice, span.clone(), message).label("again here");
        self.report.diagnostics.push(diagnostic.also(first.clone(), "first here"));
    }

    /// Counts nodes; whether there is room for another.
    fn has_room(&mut self, at: &Span) -> bool {
        self.nodes += 1;
        if self.nodes > TUNING.nodes && !self.is_full {
            self.is_full = true;
            let message = format!("written out, the model has more than {nodes} entries", nodes = TUNING.nodes);
            let help = "have fewer instances and repetitions".to_owned();
            self.report.error(Code::TooLarge, at.clone(), message, help);
        }
        !self.is_full
    }
}

impl Parts {
    /// Overrides of the command line, with an assembly's parameter set in every instance that follows it.
    pub fn follow(&self, overrides: Vec<(Override, Span)>) -> Vec<(Override, Span)> {
        let follow = |(wanted, span): (Override, Span)| match self.followers.get(&wanted.name) {
            None => vec![(wanted, span)],
            Some(names) => {
                let of = |name: &String| (Override { name: name.clone(), ..wanted.clone() }, span.clone());
                names.iter().map(of).collect()
            }
        };
        overrides.into_iter().flat_map(follow).collect()
    }

    /// The body or the point that a port of an instance is.
    fn port(&self, name: &str) -> Option<&str> {
        let port = self.ports.iter().find(|port| port.name == name)?;
        Some(self.port(&port.target).unwrap_or(&port.target))
    }

    /// Whether a parameter says how often something is repeated.
    pub fn is_count(&self, parameter: &str) -> bool {
        self.counts.contains(parameter)
    }
}
