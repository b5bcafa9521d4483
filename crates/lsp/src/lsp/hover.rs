//! Hover texts for names, formulas, keys, words, units and functions under the pointer.

use std::ops::Range;
use std::path::Path;

use symdiff::formula::Term;

use super::context::{Context, Slot, Step, context};
use super::names::Named;
use super::schema::Schema;
use super::text::Text;
use super::values::{Values, in_words, unit_of};
use super::workspace::Model;
use crate::elements::JointKind;
use crate::elements::effects::EffectKind;
use crate::grammar::mentions::{NameKind, ReadFormula};
use crate::grammar::{ElementDocs, reference};

/// Text in Markdown, and the bytes of the document that it describes.
pub struct Hover {
    /// Markdown.
    pub text: String,
    /// Bytes of the document.
    pub span: Range<usize>,
}

/// Hover text at byte `offset` of a document; `model` is the model that the document belongs to.
pub fn hover(schema: &Schema, model: Option<&Model>, path: &Path, text: &Text, offset: usize) -> Option<Hover> {
    let word = word_at(text.as_str(), offset);
    let at = context(text.as_str(), word.end);
    if at.slot == Slot::Comment {
        return None;
    }
    let around = |least: usize| model.and_then(|model| formula(model, path, offset, least));
    let name = model.and_then(|model| name(model, path, text, offset, &word));
    if let Some(mut own) = name {
        if let Some(around) = around(word.len() + 1) {
            own.text.push_str(&format!("\n\n---\n\n{}", around.text));
        }
        return Some(own);
    }
    let of_word = |text: String| Hover { text, span: word.clone() };
    let written = &text.as_str()[word.clone()];
    // A part of the motion has no definition of its own.
    if let Some(model) = model
        && let Some(meaning) = full_name(model, path, &word, written).and_then(|full| member(model, &full))
    {
        return Some(of_word(format!("**{written}**\n\n{meaning}")));
    }
    if at.slot == Slot::Value
        && let Some(text) = function_or_unit(written, schema.is_number(&at.path))
    {
        return Some(of_word(text));
    }
    around(0).or_else(|| key_or_word(schema, &at, text, &word).map(of_word))
}

/// Bytes of the dotted word at a byte.
fn word_at(text: &str, offset: usize) -> Range<usize> {
    let is_part = |c: &char| c.is_alphanumeric() || matches!(c, '_' | '.' | '°' | 'µ' | '%');
    let before: usize = text[..offset].chars().rev().take_while(is_part).map(char::len_utf8).sum();
    let behind: usize = text[offset..].chars().take_while(is_part).map(char::len_utf8).sum();
    offset - before..offset + behind
}

/// A name with its meaning: kind, unit, value and definition.
fn name(model: &Model, path: &Path, text: &Text, offset: usize, word: &Range<usize>) -> Option<Hover> {
    let found = model.names.at(path, offset)?;
    let symbol = &model.names.symbols[found.symbol];
    let mut lines = vec![headline(model, symbol)];
    if symbol.kind == NameKind::Parameter {
        lines.extend(model.known.as_ref().and_then(|known| Values::of(known).of_parameter(&symbol.name)));
    }
    // The whole word may mean more than its part with a definition: `crank.B.vx`.
    let written = text.as_str().get(word.clone()).unwrap_or_default();
    let full = full_name(model, path, word, written);
    let motion = full.as_deref().filter(|full| *full != symbol.name).and_then(|full| member(model, full));
    if let (Some(motion), false) = (motion, found.is_definition) {
        lines.push(format!("`{written}`: {motion}"));
    }
    let defined = model.names.of_symbol(found.symbol).find(|own| own.is_definition);
    if let Some(place) = defined.filter(|_| !found.is_definition)
        && let Some(line) = definition_line(model, &symbol.extents, &place.at.file)
    {
        lines.push(format!("```yaml\n{line}\n```"));
    }
    Some(Hover { text: lines.join("\n\n"), span: found.at.span.clone() })
}

fn headline(model: &Model, symbol: &Named) -> String {
    let kind = kind_in_words(symbol.kind);
    let unit = model.known.as_ref().and_then(|known| match symbol.kind {
        NameKind::Output => known.outputs.iter().find(|own| own.name == symbol.name).map(|own| own.unit.clone()),
        _ => unit_of(known, &symbol.name),
    });
    let unit = unit.filter(|unit| !unit.is_empty()).map_or_else(String::new, |unit| format!(", {unit}"));
    format!("{kind} **{}**{unit}", symbol.name)
}

/// `parameter`, `body`, ….
pub fn kind_in_words(kind: NameKind) -> &'static str {
    match kind {
        NameKind::Parameter => "parameter",
        NameKind::Body => "body",
        NameKind::Point => "point",
        NameKind::Joint => "joint",
        NameKind::Effect => "effect",
        NameKind::State => "state",
        NameKind::Output => "output",
        NameKind::Requirement => "requirement",
        NameKind::Table => "table",
        NameKind::Trajectory => "trajectory",
        NameKind::Excitation => "excitation",
        NameKind::Assembly => "assembly",
        NameKind::Instance => "instance",
        NameKind::Port => "port",
        NameKind::Scene => "scene",
    }
}

/// The full name of the mention at the bytes `word` of a document.
fn full_name(model: &Model, path: &Path, word: &Range<usize>, written: &str) -> Option<String> {
    let sources = &model.opened.reading.diagnostics.sources;
    let is_here = |span: &crate::grammar::Span| {
        sources.locate(span).is_some_and(|(source, span)| Path::new(&source.name) == path && span == *word)
    };
    let ends = |name: &str| name.ends_with(written);
    model.opened.mentions.uses.iter().find(|own| ends(&own.name) && is_here(&own.span)).map(|own| own.name.clone())
}

/// The meaning of a part of the motion: `velocity of the point along the ground's x, m/s`.
fn member(model: &Model, full: &str) -> Option<String> {
    let known = model.known.as_ref()?;
    let unit = unit_of(known, full)?;
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let meaning = reference::outputs().into_iter().find(|docs| {
        let behind = docs.output.trim_start_matches(|c: char| c.is_uppercase() || matches!(c, '_' | '.'));
        let of_point = docs.of == "point";
        let is_of = matches!(known.symbol(full), Some(crate::model::Symbol::Point { .. })) == of_point;
        is_of && !behind.is_empty() && full.strip_suffix(behind).is_some_and(|owner| owner.ends_with('.'))
    });
    Some(format!("{}{unit}", meaning.map_or_else(|| "a number".to_owned(), |docs| docs.meaning)))
}

/// The first line of a definition, clipped to 120 characters.
fn definition_line(model: &Model, extents: &[super::names::Location], file: &Path) -> Option<String> {
    let extent = extents.iter().find(|own| own.file.as_path() == file)?;
    let mut sources = model.opened.reading.diagnostics.sources.all();
    let source = sources.find(|source| Path::new(&source.name) == file)?;
    let text = source.text.get(extent.span.clone())?;
    let first = text.lines().next()?;
    Some(if first.chars().count() > 120 {
        format!("{}…", first.chars().take(119).collect::<String>())
    } else {
        first.to_owned()
    })
}

/// The formula at a byte: its smallest part of at least `least` bytes that is more than a number, with its value.
fn formula(model: &Model, path: &Path, offset: usize, least: usize) -> Option<Hover> {
    let known = model.known.as_ref()?;
    let sources = &model.opened.reading.diagnostics.sources;
    // Bytes of a span in the document, if the pointer is on them.
    let here = |span: Range<usize>| -> Option<Range<usize>> {
        let (source, span) = sources.locate(&span)?;
        (Path::new(&source.name) == path && span.contains(&offset)).then_some(span)
    };
    let mut best: Option<(Range<usize>, &ReadFormula, usize)> = None;
    for own in &model.opened.mentions.formulas {
        let Some(whole) = here(own.span.clone()) else { continue };
        let last = own.formula.terms().len() - 1;
        for (index, (term, span)) in own.formula.terms().iter().enumerate() {
            let part = || own.start.and_then(|start| here(start + span.start..start + span.end));
            let span = match index == last {
                true => Some(whole.clone()),
                false if matches!(term, Term::Number(_)) => None,
                false => part(),
            };
            let Some(span) = span.filter(|span| span.len() >= least) else { continue };
            if best.as_ref().is_none_or(|(known, ..)| span.len() < known.len()) {
                best = Some((span, own, index));
            }
        }
    }
    let (span, own, index) = best?;
    let dimension = own.kinds.get(index).and_then(|kind| kind.dimension());
    let what = dimension.map_or_else(|| "a number".to_owned(), |dimension| dimension.to_string());
    let unit = dimension.map_or_else(String::new, |dimension| dimension.unit());
    let value = match Values::of(known).resolve(&own.formula.part(index)) {
        Some(value) => in_words(value, &unit),
        None => "follows the motion: a run computes it".to_owned(),
    };
    Some(Hover { text: format!("{value}\n\n{what}"), span })
}

/// Text about a function or, if the value may be a number, a unit.
fn function_or_unit(word: &str, is_number: bool) -> Option<String> {
    let functions = reference::functions();
    let function = functions.iter().find(|own| own.function.split('(').next() == Some(word));
    if let Some(own) = function {
        return Some(format!("function **{}**\n\n{}\n\nfor {}", own.function, own.value, own.domain));
    }
    let units = reference::units();
    let unit = units.iter().find(|own| own.unit == word).filter(|_| is_number)?;
    let si = if unit.si.is_empty() { String::new() } else { format!(" {}", unit.si) };
    Some(format!("unit **{}** of {}: {}{si}", unit.unit, unit.quantity, super::values::shown(unit.value)))
}

/// Text about a key or a word of the language.
fn key_or_word(schema: &Schema, at: &Context, text: &Text, word: &Range<usize>) -> Option<String> {
    let written = text.as_str().get(word.clone())?;
    if at.slot == Slot::Value {
        let words = schema.words(&at.path);
        let own = words.iter().find(|own| own.word == written)?;
        return Some(format!("**{}**\n\n{}", own.word, own.description));
    }
    let path: Vec<Step> = at.path.iter().cloned().chain([Step::Key(written.to_owned())]).collect();
    let description = schema.description(&path)?;
    let mut found = format!("**{written}**\n\n{description}");
    if let Some(docs) = element(&at.path, written) {
        found.push_str(&docs);
    }
    Some(found)
}

/// Equations and example of an element.
fn element(path: &[Step], keyword: &str) -> Option<String> {
    let section = path.iter().rev().find_map(|step| match step {
        Step::Key(key) if key == "joints" || key == "effects" => Some(key.as_str()),
        _ => None,
    })?;
    let docs: Vec<ElementDocs> = match section {
        "joints" => JointKind::docs().into_iter().map(|own| own.element).collect(),
        _ => EffectKind::docs(),
    };
    let docs = docs.into_iter().find(|own| own.keyword == keyword)?;
    let equations: Vec<String> = docs.formulas.iter().map(|formula| format!("    {formula}")).collect();
    Some(format!("\n\n{}\n\n```yaml\n{}: {}\n```", equations.join("\n"), docs.keyword, docs.example))
}
