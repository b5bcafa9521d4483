//! The outline of a text, and the lines that can be folded.

use lsp_types::{DocumentSymbol, FoldingRange, FoldingRangeKind, SymbolKind};

use super::text::Text;
use crate::syntax::Diagnostics;
use crate::syntax::yaml::{self, Entry, Node, Value};

/// The tree of a text; `None` if it is not YAML.
pub fn tree(text: &Text) -> Option<Node> {
    yaml::parse(text.as_str(), &mut Diagnostics::new("", text.as_str()))
}

/// Kind of entries of the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level<'t> {
    /// Sections of a model, an assembly or a scene.
    Sections,
    /// Names in a section.
    Names(&'t str),
    /// Points of a body.
    Points,
}

/// Sections with their names, and bodies with their points.
pub fn outline(text: &Text) -> Vec<DocumentSymbol> {
    tree(text).map_or_else(Vec::new, |root| symbols(text, &root, Level::Sections))
}

fn symbols(text: &Text, node: &Node, level: Level) -> Vec<DocumentSymbol> {
    let Value::Mapping(entries) = &node.value else { return Vec::new() };
    entries.iter().map(|entry| symbol(text, entry, level)).collect()
}

fn symbol(text: &Text, entry: &Entry, level: Level) -> DocumentSymbol {
    let whole = entry.key_span.start..entry.value.span.end.max(entry.key_span.end);
    let children = match level {
        Level::Sections => symbols(text, &entry.value, Level::Names(&entry.key)),
        Level::Names("assemblies" | "scenes") => symbols(text, &entry.value, Level::Sections),
        Level::Names("bodies") => {
            entry.value.get("points").map_or_else(Vec::new, |points| symbols(text, points, Level::Points))
        }
        Level::Names(_) | Level::Points => Vec::new(),
    };
    let detail = entry.value.scalar().map(|scalar| scalar.text.clone()).filter(|text| !text.is_empty());
    // The library deprecates a field, and has no other way to make the struct.
    #[allow(deprecated)]
    DocumentSymbol {
        // The protocol allows no empty name.
        name: if entry.key.trim().is_empty() { "…".to_owned() } else { entry.key.clone() },
        detail,
        kind: match level {
            Level::Sections => SymbolKind::NAMESPACE,
            Level::Names(section) => kind(section),
            Level::Points => SymbolKind::FIELD,
        },
        tags: None,
        deprecated: None,
        range: text.range(&whole),
        selection_range: text.range(&entry.key_span),
        children: (!children.is_empty()).then_some(children),
    }
}

fn kind(section: &str) -> SymbolKind {
    match section {
        "parameters" => SymbolKind::VARIABLE,
        "bodies" => SymbolKind::CLASS,
        "joints" => SymbolKind::INTERFACE,
        "effects" => SymbolKind::EVENT,
        "outputs" | "requirements" => SymbolKind::PROPERTY,
        "tables" | "trajectories" | "excitations" => SymbolKind::FUNCTION,
        "assemblies" | "instances" => SymbolKind::MODULE,
        _ => SymbolKind::KEY,
    }
}

/// Mappings and lists of several lines, and comments of several lines.
pub fn folding(text: &Text) -> Vec<FoldingRange> {
    let mut found = Vec::new();
    let mut add = |start: usize, end: usize, kind: FoldingRangeKind| {
        if start < end {
            let (start_line, end_line) = (start as u32, end as u32);
            found.push(FoldingRange { start_line, end_line, kind: Some(kind), ..FoldingRange::default() });
        }
    };
    let mut open: Vec<Node> = tree(text).into_iter().collect();
    while let Some(node) = open.pop() {
        match node.value {
            Value::Mapping(entries) => {
                for entry in entries {
                    let end = text.line_of(entry.value.span.end.max(1) - 1);
                    add(text.line_of(entry.key_span.start), end, FoldingRangeKind::Region);
                    open.push(entry.value);
                }
            }
            Value::Sequence(items) => {
                for item in items {
                    let end = text.line_of(item.span.end.max(1) - 1);
                    add(text.line_of(item.span.start), end, FoldingRangeKind::Region);
                    open.push(item);
                }
            }
            Value::Scalar(_) => {}
        }
    }
    let mut first = None;
    for line in 0..=text.line_count() {
        let is_comment = text.as_str()[text.line(line)].trim_start().starts_with('#');
        match (is_comment, first) {
            (true, None) => first = Some(line),
            (false, Some(start)) => {
                add(start, line - 1, FoldingRangeKind::Comment);
                first = None;
            }
            _ => {}
        }
    }
    found.sort_by_key(|own| (own.start_line, own.end_line));
    found.dedup_by(|next, own| next.start_line == own.start_line && next.end_line == own.end_line);
    found
}
