//! Names after a dot: points of a body, parts of its motion, reactions of a joint, measures of an effect, parts of an
//! instance; each with its unit.

use lsp_types::CompletionItemKind;

use super::hover::kind_in_words;
use super::proposal::Proposal;
use super::values::unit_of;
use super::workspace::Model;
use crate::grammar::mentions::NameKind;
use crate::grammar::reference;
use crate::grammar::{Symbol, SymbolTable};

/// Members of an owner, each with the owner before it; full names in the model begin with `prefix`.
pub fn members(model: &Model, prefix: &str, owner: &str) -> Vec<Proposal> {
    if owner.is_empty() {
        return Vec::new();
    }
    let full = format!("{prefix}{owner}");
    let mut found: Vec<Proposal> = Vec::new();
    let mut add = |member: &str, kind: CompletionItemKind, detail: String, documentation: String| {
        let insert = Some(format!("{owner}.{member}"));
        if !found.iter().any(|known| known.insert == insert) {
            let proposal = Proposal::new(member, kind).detail(detail).documentation(documentation);
            found.push(Proposal { insert, ..proposal });
        }
    };
    let within = |name: &str| name.strip_prefix(&full)?.strip_prefix('.').map(str::to_owned);
    for (name, kind) in &model.names_known {
        let Some(member) = within(name) else { continue };
        let item = if *kind == NameKind::Point { CompletionItemKind::FIELD } else { CompletionItemKind::MODULE };
        // Points of a part of an instance are among the part's own members.
        if *kind != NameKind::Point || !member.contains('.') {
            add(&member, item, kind_in_words(*kind).to_owned(), String::new());
        }
    }
    let Some(known) = &model.known else { return found };
    for docs in reference::outputs() {
        let member = docs.output.trim_start_matches(|c: char| c.is_uppercase() || c == '.');
        let name = format!("{full}.{member}");
        let is_of_point = matches!(known.symbol(&name), Some(Symbol::Point { .. }));
        if docs.of == "mechanism" || member.contains("POINT") || is_of_point != (docs.of == "point") {
            continue;
        }
        if let Some(unit) = unit_of(known, &name) {
            add(member, CompletionItemKind::VALUE, unit, docs.meaning);
        }
    }
    if let Some(effect) = known.effect(&full) {
        for (measure, dimension) in known.measures(effect) {
            let unit = if measure.has_unit() { dimension.unit() } else { String::new() };
            add(measure.name(), CompletionItemKind::VALUE, unit, String::new());
        }
    }
    found
}
