//! Completion at the cursor: keys, kinds of elements with snippets, words, names, members, functions and units.

use std::path::Path;

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionList, CompletionTextEdit, Documentation, InsertTextFormat, TextEdit,
};
use serde_json::Value;

use super::context::{Context, Slot, Step, context};
use super::hover::kind_in_words;
use super::members::members;
use super::proposal::Proposal;
use super::schema::{KeyInfo, Schema};
use super::text::Text;
use super::tuning::TUNING;
use super::values::Values;
use super::workspace::Model;
use crate::grammar::mentions::NameKind;
use crate::grammar::reference;
use crate::model::InstanceKind;

/// Sections whose keys are names of coordinates.
const OF_COORDINATES: [&str; 2] = ["initial", "guess"];

/// Proposals at byte `offset` of a document.
pub fn complete(
    schema: &Schema,
    model: Option<&Model>,
    path: &Path,
    text: &Text,
    offset: usize,
    snippets: bool,
) -> CompletionList {
    let at = context(text.as_str(), offset);
    let items = match at.slot {
        Slot::Comment => Vec::new(),
        Slot::Key => keys(schema, model, path, &at, snippets),
        Slot::Value => values(schema, model, path, text, &at),
    };
    let range = text.range(&at.word);
    let written = &text.as_str()[at.word.clone()];
    let edited = |(index, own): (usize, Proposal)| {
        let new_text = own.insert.clone().unwrap_or_else(|| own.label.clone());
        CompletionItem {
            kind: Some(own.kind),
            detail: own.detail,
            documentation: own.documentation.map(Documentation::String),
            // Editors filter by the word that is replaced.
            filter_text: Some(if written.contains('.') { new_text.clone() } else { own.label.clone() }),
            sort_text: Some(format!("{index:05}")),
            insert_text_format: Some(match own.is_snippet {
                true => InsertTextFormat::SNIPPET,
                false => InsertTextFormat::PLAIN_TEXT,
            }),
            text_edit: Some(CompletionTextEdit::Edit(TextEdit { range, new_text })),
            label: own.label,
            ..CompletionItem::default()
        }
    };
    // The editor asks again, with more letters, if names were omitted.
    let is_incomplete = model.is_some_and(|model| model.names_known.len() > TUNING.most_of_a_kind);
    CompletionList { is_incomplete, items: items.into_iter().enumerate().map(edited).collect() }
}

fn keys(schema: &Schema, model: Option<&Model>, path: &Path, at: &Context, snippets: bool) -> Vec<Proposal> {
    let is_new = |own: &KeyInfo| !at.siblings.iter().any(|known| known == own.name);
    let kinds = schema.kinds(&at.path);
    let mut items: Vec<Proposal> = Vec::new();
    if kinds.is_empty() {
        let mut keys: Vec<KeyInfo> = schema.keys(&at.path).into_iter().filter(is_new).collect();
        keys.sort_by_key(|own| !own.is_required);
        items.extend(keys.iter().map(|own| key(schema, own, snippets)));
    } else if at.siblings.is_empty() {
        items.extend(kinds.iter().map(|own| element(schema, own, None, snippets)));
    }
    let last = at.path.last();
    let is_section = |name: &str| matches!(last, Some(Step::Key(key)) if key == name);
    if OF_COORDINATES.iter().any(|section| is_section(section)) {
        items.extend(names(model, path, at, &[NameKind::Body, NameKind::Joint, NameKind::Instance]));
        items.extend(model.into_iter().flat_map(|model| members_at(model, path, at)));
    } else if is_section("design") || is_section("parameters") && at.path.len() > 1 {
        items.extend(names(model, path, at, &[NameKind::Parameter]));
    }
    if schema.has_free_keys(&at.path) && snippets {
        // A new entry with its kind.
        let inner: Vec<Step> = at.path.iter().cloned().chain([Step::Key(String::new())]).collect();
        items.extend(schema.kinds(&inner).iter().map(|own| element(schema, own, Some("name"), snippets)));
    }
    items
}

fn key(schema: &Schema, own: &KeyInfo, snippets: bool) -> Proposal {
    let is_mapping = schema.is_mapping(own.value);
    let insert = match (snippets, is_mapping) {
        (true, true) => format!("{}: {{ $0 }}", own.name),
        _ => format!("{}: ", own.name),
    };
    let proposal = Proposal::new(own.name, CompletionItemKind::PROPERTY).documentation(own.description);
    let detail = if own.is_required { "required" } else { "" };
    Proposal { insert: Some(insert), is_snippet: snippets && is_mapping, ..proposal.detail(detail) }
}

/// Proposal of a kind of element with the keys of its example, within an entry called `name` if that is given.
fn element(schema: &Schema, own: &KeyInfo, name: Option<&str>, snippets: bool) -> Proposal {
    let proposal = Proposal::new(own.name, CompletionItemKind::CLASS).documentation(own.description);
    let mut field = 0;
    let name = name.map(|name| {
        field += 1;
        format!("${{{field}:{name}}}")
    });
    let example = schema.example(own.value).filter(|_| snippets);
    let Some(example) = example else {
        return Proposal { insert: Some(format!("{}: ", own.name)), ..proposal };
    };
    let body = format!("{}: {}", own.name, snippet(example, &mut field));
    let insert = name.map_or_else(|| body.clone(), |name| format!("{name}: {{ {body} }}"));
    Proposal { insert: Some(insert), is_snippet: true, ..proposal.detail("snippet") }
}

/// Formats an example as YAML in braces, each value a field of the snippet.
fn snippet(value: &Value, field: &mut usize) -> String {
    match value {
        Value::Object(entries) if entries.is_empty() => "{}".to_owned(),
        Value::Object(entries) => {
            let entries: Vec<String> =
                entries.iter().map(|(key, value)| format!("{key}: {}", snippet(value, field))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Array(items) => {
            format!("[{}]", items.iter().map(|item| snippet(item, field)).collect::<Vec<_>>().join(", "))
        }
        scalar => {
            *field += 1;
            let text = scalar.as_str().map_or_else(|| scalar.to_string(), str::to_owned);
            // Protects characters that would end the field, or the value in braces.
            let text = if text.contains(',') { format!("\"{text}\"") } else { text };
            let text = text.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}");
            format!("${{{field}:{text}}}")
        }
    }
}

fn values(schema: &Schema, model: Option<&Model>, path: &Path, text: &Text, at: &Context) -> Vec<Proposal> {
    // A requirement is a formula with a comparison in it.
    let is_requirement =
        matches!(at.path.as_slice(), [.., Step::Key(section), Step::Key(_)] if section == "requirements");
    let is_number = is_requirement || schema.is_number(&at.path);
    let written = &text.as_str()[at.written.clone()];
    let before = written.get(..written.len() - at.word.len().min(written.len())).unwrap_or_default();
    let last = at.path.iter().rev().find_map(|step| match step {
        Step::Key(key) => Some(key.as_str()),
        Step::Item => None,
    });
    if last == Some("unit") || is_number && is_behind_number(before) {
        return units();
    }
    let mut items: Vec<Proposal> = Vec::new();
    items.extend(
        schema
            .words(&at.path)
            .into_iter()
            .map(|own| Proposal::new(own.word, CompletionItemKind::ENUM_MEMBER).documentation(own.description)),
    );
    let is_text = schema.is_text(&at.path);
    let Some(model) = model.filter(|_| is_text || is_number) else { return items };
    let of_members = members_at(model, path, at);
    if text.as_str()[at.word.clone()].contains('.') {
        items.extend(of_members);
        return items;
    }
    match last {
        Some("of") if at.path.len() == 3 => items.extend(names(Some(model), path, at, &[NameKind::Assembly])),
        Some("extends") => items.extend(names(Some(model), path, at, &[NameKind::Scene])),
        Some("description" | "model" | "include" | "urdf" | "mjcf") => {}
        _ if is_number => {
            use NameKind::{Body, Effect, Excitation, Instance, Joint, Output, Parameter, State, Trajectory};
            let kinds = [Parameter, State, Trajectory, Excitation, Body, Joint, Effect, Instance, Output];
            items.extend(names(Some(model), path, at, &kinds));
            items.extend(functions());
            items.push(Proposal::new("t", CompletionItemKind::VARIABLE).detail("time, s"));
            items.push(Proposal::new("pi", CompletionItemKind::CONSTANT).detail("the number π"));
        }
        _ => {
            use NameKind::{Body, Effect, Instance, Joint, Output, Parameter, Point};
            items.extend(names(Some(model), path, at, &[Body, Point, Joint, Instance, Effect, Output, Parameter]));
            items.push(Proposal::new("ground", CompletionItemKind::MODULE).detail("body"));
        }
    }
    items
}

/// Whether a text ends with a number and a space: `120 `.
fn is_behind_number(text: &str) -> bool {
    let number = text.trim_end();
    let last = number.rsplit(|c: char| c.is_whitespace() || "+-*/(,[±".contains(c)).next().unwrap_or_default();
    number.len() < text.len() && last.starts_with(|c: char| c.is_ascii_digit()) && last.parse::<f64>().is_ok()
}

fn units() -> Vec<Proposal> {
    let units = reference::units().into_iter();
    units.map(|own| Proposal::new(own.unit, CompletionItemKind::UNIT).detail(own.quantity)).collect()
}

fn functions() -> Vec<Proposal> {
    let functions = reference::functions().into_iter();
    let of = |own: reference::FunctionDocs| {
        let name = own.function.split('(').next().unwrap_or_default().to_owned();
        let insert = Some(format!("{name}("));
        let proposal = Proposal::new(name, CompletionItemKind::FUNCTION).detail(own.function);
        Proposal { insert, ..proposal.documentation(format!("{}, for {}", own.value, own.domain)) }
    };
    functions.map(of).collect()
}

/// Prefix of names at the cursor: in an assembly, the name of one of its instances with a dot, elsewhere nothing;
/// `None` if the assembly has no known instance.
fn prefix(model: &Model, path: &Path, at: &Context) -> Option<String> {
    let [Step::Key(section), Step::Key(assembly), ..] = at.path.as_slice() else { return Some(String::new()) };
    if section != "assemblies" {
        return Some(String::new());
    }
    let of = |known: &crate::model::Description| {
        let of_it = |kind: &InstanceKind| matches!(kind, InstanceKind::Assembly(name) if name == assembly);
        known.instances.iter().find(|own| of_it(&own.kind)).map(|own| format!("{}.", own.name))
    };
    if let Some(found) = model.known.as_deref().and_then(of) {
        return Some(found);
    }
    // Otherwise from a name that is defined inside the assembly.
    let symbols = &model.names.symbols;
    let own = symbols.iter().find(|own| own.kind == NameKind::Assembly && own.name == *assembly)?;
    let whole = own.extents.iter().find(|extent| extent.file.as_path() == path)?;
    let inside = symbols
        .iter()
        .filter(|own| matches!(own.kind, NameKind::Body | NameKind::Joint | NameKind::Parameter))
        .find(|own| {
            let is_inside = |extent: &super::names::Location| {
                extent.file == whole.file && whole.span.start <= extent.span.start && extent.span.end <= whole.span.end
            };
            own.extents.iter().any(is_inside)
        })?;
    inside.name.rsplit_once('.').map(|(instance, _)| format!("{instance}."))
}

/// Proposals of names of these kinds, as they are written at the cursor.
fn names(model: Option<&Model>, path: &Path, at: &Context, kinds: &[NameKind]) -> Vec<Proposal> {
    let Some(model) = model else { return Vec::new() };
    let is_global = kinds.iter().all(|kind| matches!(kind, NameKind::Assembly | NameKind::Scene));
    let Some(prefix) = (if is_global { Some(String::new()) } else { prefix(model, path, at) }) else {
        return Vec::new();
    };
    let typed = at.typed.to_lowercase();
    let mut found: Vec<(usize, &str, &str, NameKind)> = Vec::new();
    let mut counts = vec![0; kinds.len()];
    let parameters = model.known.as_deref().filter(|_| kinds.contains(&NameKind::Parameter)).map(Values::of);
    for (name, kind) in &model.names_known {
        let Some(order) = kinds.iter().position(|own| own == kind) else { continue };
        let Some(local) = name.strip_prefix(&prefix) else { continue };
        if counts[order] == TUNING.most_of_a_kind || !local.to_lowercase().contains(&typed) {
            continue;
        }
        let of_motion = matches!(kind, NameKind::Body | NameKind::Joint | NameKind::Effect | NameKind::Output);
        if local.contains('.')
            && prefix.is_empty()
            && of_motion
            && model.names_known.iter().any(|(own, kind)| {
                *kind == NameKind::Instance && name.strip_prefix(own.as_str()).is_some_and(|rest| rest.starts_with('.'))
            })
        {
            // Parts of an instance are proposed as its members.
            continue;
        }
        counts[order] += 1;
        found.push((order, local, name, *kind));
    }
    found.sort_by_key(|(order, ..)| *order);
    let of = |(_, local, name, kind)| proposal(model, parameters.as_ref(), local, name, kind);
    found.into_iter().map(of).collect()
}

fn proposal(model: &Model, parameters: Option<&Values>, local: &str, name: &str, kind: NameKind) -> Proposal {
    let item = match kind {
        NameKind::Parameter => CompletionItemKind::VARIABLE,
        NameKind::Body | NameKind::Instance | NameKind::Assembly => CompletionItemKind::MODULE,
        NameKind::Point | NameKind::Port => CompletionItemKind::FIELD,
        NameKind::Output | NameKind::State => CompletionItemKind::VALUE,
        _ => CompletionItemKind::REFERENCE,
    };
    let output = || model.known.as_ref()?.outputs.iter().find(|own| own.name == name).map(|own| own.unit.clone());
    let detail = match kind {
        NameKind::Parameter => parameters.and_then(|values| values.of_parameter(name)),
        NameKind::Output => output().filter(|unit| !unit.is_empty()).map(|unit| format!("output, {unit}")),
        _ => None,
    };
    Proposal::new(local, item).detail(detail.unwrap_or_else(|| kind_in_words(kind).to_owned()))
}

/// Members of the name before the last dot of the word.
fn members_at(model: &Model, path: &Path, at: &Context) -> Vec<Proposal> {
    let prefix = prefix(model, path, at).unwrap_or_default();
    members(model, &prefix, &at.owner)
}
