//! `dimensions:`: parameters and outputs, and the chains that close.
//!
//! Faces are nodes and dimensions are edges of a graph. Dimensions with a value or a formula are a forest, as on a
//! drawing without a dimension too many; one without both closes a chain: it is the sum of the dimensions on the one
//! path between its faces, each with the sign of its direction.

use std::collections::{HashMap, VecDeque};

use super::sections::entries_of;
use crate::grammar::report::{Fields, Report};
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// A chain of dimensions, and the output that closes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// The output: the closing dimension, from the first link's beginning to the last one's end.
    pub output: String,
    /// The dimensions on the way, one after another.
    pub links: Vec<ChainLink>,
}

/// A dimension of a chain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChainLink {
    /// The parameter, or the output where the dimension is a formula.
    pub name: String,
    /// The face where the way enters.
    pub from: String,
    /// The face where the way leaves.
    pub to: String,
    /// Whether the way goes along the dimension's direction: its sign in the sum.
    pub is_forward: bool,
}

/// Role of a dimension, by its entry other than the faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// A value: it is a parameter.
    Valued,
    /// A formula: it is an output.
    Measured,
    /// Neither: it is the sum of others.
    Closing,
}

/// A dimension as it is written.
struct Dimension<'n> {
    entry: &'n Entry,
    /// Numbers of its faces.
    ends: [usize; 2],
    spans: [Span; 2],
    role: Role,
}

/// Faces in the order in which they are named.
#[derive(Default)]
struct Faces {
    names: Vec<String>,
    by_name: HashMap<String, usize>,
}

impl Faces {
    fn number(&mut self, name: &str) -> usize {
        *self.by_name.entry(name.to_owned()).or_insert_with(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        })
    }
}

/// The model's tree with its dimensions written out as parameters and outputs, and the chains.
pub fn write_out(report: &mut Report, root: Node) -> (Node, Vec<Chain>) {
    let Value::Mapping(sections) = &root.value else { return (root, Vec::new()) };
    let Some(section) = sections.iter().find(|entry| entry.key == "dimensions") else { return (root, Vec::new()) };
    let mut faces = Faces::default();
    let written = report.entries(&section.value, "dimensions");
    let dimensions: Vec<Dimension> = written.iter().filter_map(|entry| read(report, entry, &mut faces)).collect();
    let forest = Forest::of(report, &dimensions, &faces);
    let mut sections: Vec<Entry> = sections.iter().filter(|entry| entry.key != "dimensions").cloned().collect();
    let mut chains = Vec::new();
    let mut outputs = 0;
    for dimension in &dimensions {
        let (key, value) = match dimension.role {
            Role::Valued => ("parameters", without_faces(dimension.entry)),
            Role::Measured => ("outputs", without_faces(dimension.entry)),
            Role::Closing => {
                let Some(chain) = forest.chain(report, dimension) else { continue };
                let value = closing(dimension.entry, &chain);
                chains.push(chain);
                ("outputs", value)
            }
        };
        let Some(entries) = entries_of(&mut sections, key, &section.key_span) else { continue };
        if entries.iter().any(|known| known.key == dimension.entry.key) {
            let message = format!("`{}` is in `{key}` as well", clip(&dimension.entry.key));
            let help = "give one of them another name".to_owned();
            report.error(Code::NameTaken, dimension.entry.key_span.clone(), message, help);
        } else {
            // Other outputs may name these.
            let at = if key == "outputs" { outputs } else { entries.len() };
            entries.insert(at, Entry { value, ..dimension.entry.clone() });
            outputs += usize::from(key == "outputs");
        }
    }
    (Node { span: root.span.clone(), value: Value::Mapping(sections) }, chains)
}

/// Reads the faces of a dimension, and which keys it has.
fn read<'n>(report: &mut Report, entry: &'n Entry, faces: &mut Faces) -> Option<Dimension<'n>> {
    let fields = report.fields::<keys::DimensionFile>(&entry.value, entry.key_span.clone())?;
    let mut face = |key: &str| {
        let node = report.required(&fields, key)?;
        let scalar = report.scalar(node, "the name of a face")?;
        Some((faces.number(scalar.text.trim()), node.span.clone()))
    };
    let (from, to) = (face("from"), face("to"));
    let role = role(report, &fields);
    let ((from, at_from), (to, at_to)) = (from?, to?);
    if from == to {
        let message = format!("a dimension leads to another face, but `{}` to its own", clip(&entry.key));
        report.error(Code::BadChain, at_to, message, "`from` and `to` are two faces".to_owned());
        return None;
    }
    Some(Dimension { entry, ends: [from, to], spans: [at_from, at_to], role: role? })
}

/// Whether a dimension has a value, a formula or neither; reports both.
fn role(report: &mut Report, fields: &Fields) -> Option<Role> {
    let of_value = ["value", "interval", "tolerance", "plus", "minus", "distribution", "cost"];
    let valued = of_value.into_iter().find(|key| fields.get(key).is_some());
    match (fields.get("formula"), valued) {
        (Some(_), Some(key)) => {
            let message = format!("a dimension with a `formula` has no `{key}`");
            report.error(
                Code::BadChain,
                fields.key_span(key),
                message,
                "the formula says how it varies; leave one out".to_owned(),
            );
            None
        }
        (Some(_), None) => Some(Role::Measured),
        (None, Some(_)) => Some(Role::Valued),
        (None, None) => Some(Role::Closing),
    }
}

/// Keys of a dimension that go to the section it is written to.
fn without_faces(entry: &Entry) -> Node {
    let Value::Mapping(entries) = &entry.value.value else { return entry.value.clone() };
    let is_formula = entries.iter().any(|entry| entry.key == "formula");
    let is_left = |key: &str| !(matches!(key, "from" | "to") || is_formula && key == "description");
    let left = entries.iter().filter(|entry| is_left(&entry.key)).cloned().collect();
    Node { span: entry.value.span.clone(), value: Value::Mapping(left) }
}

/// The output of a closing dimension: the signed sum of its links.
fn closing(entry: &Entry, chain: &Chain) -> Node {
    let mut sum = String::new();
    for ChainLink { name, is_forward, .. } in &chain.links {
        sum += match (is_forward, sum.is_empty()) {
            (true, true) => "",
            (true, false) => " + ",
            (false, true) => "-",
            (false, false) => " - ",
        };
        sum += name;
    }
    let at = entry.key_span.clone();
    let formula = Node { span: at.clone(), value: Value::Scalar(Scalar::plain(sum, None)) };
    let mut entries = vec![Entry { key: "formula".to_owned(), key_span: at, value: formula }];
    if let Value::Mapping(written) = &entry.value.value {
        entries.extend(written.iter().filter(|entry| entry.key == "unit").cloned());
    }
    Node { span: entry.value.span.clone(), value: Value::Mapping(entries) }
}

/// The dimensions that are known, as edges between faces.
struct Forest<'f, 'n> {
    dimensions: &'f [Dimension<'n>],
    faces: &'f Faces,
    /// Per face: the dimensions that it has, and the faces at their other ends.
    edges: Vec<Vec<(usize, usize)>>,
}

impl<'f, 'n> Forest<'f, 'n> {
    /// Reports a dimension between faces that others connect already.
    fn of(report: &mut Report, dimensions: &'f [Dimension<'n>], faces: &'f Faces) -> Self {
        let mut forest = Self { dimensions, faces, edges: vec![Vec::new(); faces.names.len()] };
        for (number, dimension) in dimensions.iter().enumerate().filter(|(_, own)| own.role != Role::Closing) {
            let [from, to] = dimension.ends;
            if let Some(path) = forest.path(from, to) {
                let names: Vec<&str> = path.iter().map(|&(edge, _)| dimensions[edge].entry.key.as_str()).collect();
                let message = format!(
                    "`{}` closes a loop: {} already {} from `{}` to `{}`",
                    clip(&dimension.entry.key),
                    suggest::list(&names),
                    if names.len() > 1 { "lead" } else { "leads" },
                    clip(&faces.names[from]),
                    clip(&faces.names[to]),
                );
                let help = "one dimension of a loop follows from the others: leave out its value".to_owned();
                report.error(Code::BadChain, dimension.entry.key_span.clone(), message, help);
                continue;
            }
            forest.edges[from].push((number, to));
            forest.edges[to].push((number, from));
        }
        forest
    }

    /// The dimensions on the way from one face to another, each with the face at its end.
    fn path(&self, from: usize, to: usize) -> Option<Vec<(usize, usize)>> {
        let before = self.reached(from);
        let mut path = Vec::new();
        let mut at = to;
        while at != from {
            let (edge, previous) = before[at]?;
            path.push((edge, at));
            at = previous;
        }
        path.reverse();
        Some(path)
    }

    /// Per face: the dimension by which the search from a face came to it, and the face before.
    fn reached(&self, from: usize) -> Vec<Option<(usize, usize)>> {
        let mut before = vec![None; self.edges.len()];
        let mut next = VecDeque::from([from]);
        while let Some(at) = next.pop_front() {
            for &(edge, to) in &self.edges[at] {
                if to != from && before[to].is_none() {
                    before[to] = Some((edge, at));
                    next.push_back(to);
                }
            }
        }
        before
    }

    /// The chain that a dimension closes; reports one that is open.
    fn chain(&self, report: &mut Report, closing: &Dimension) -> Option<Chain> {
        let [from, to] = closing.ends;
        let Some(path) = self.path(from, to) else {
            self.report_open(report, closing);
            return None;
        };
        let mut at = from;
        let mut links = Vec::with_capacity(path.len());
        for (edge, end) in path {
            let dimension = &self.dimensions[edge];
            links.push(ChainLink {
                name: dimension.entry.key.clone(),
                from: self.faces.names[at].clone(),
                to: self.faces.names[end].clone(),
                is_forward: dimension.ends[0] == at,
            });
            at = end;
        }
        Some(Chain { output: closing.entry.key.clone(), links })
    }

    /// A face that no dimension has is misspelt; else a dimension is missing.
    fn report_open(&self, report: &mut Report, closing: &Dimension) {
        let name = |face: usize| clip(&self.faces.names[face]);
        for (face, at) in closing.ends.into_iter().zip(&closing.spans) {
            if self.edges[face].is_empty() {
                let known = (0..self.edges.len()).filter(|&face| !self.edges[face].is_empty());
                let known = known.map(|face| self.faces.names[face].as_str());
                let help = suggest::help(&self.faces.names[face], "faces with dimensions", known);
                report.error(
                    Code::BadChain,
                    at.clone(),
                    format!("no dimension with a value leads to `{}`", name(face)),
                    help,
                );
                return;
            }
        }
        let [from, to] = closing.ends;
        let reached = |start: usize| {
            let before = self.reached(start);
            let faces = (0..before.len()).filter(|&face| face == start || before[face].is_some());
            suggest::list(&faces.map(|face| self.faces.names[face].as_str()).collect::<Vec<_>>())
        };
        let message = format!(
            "the chain of `{}` is open: no way leads from `{}` to `{}`",
            clip(&closing.entry.key),
            name(from),
            name(to)
        );
        let help = format!("give a dimension between one of {} and one of {}", reached(from), reached(to));
        report.error(Code::BadChain, closing.entry.key_span.clone(), message, help);
    }
}
