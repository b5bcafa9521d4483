//! Readers' records of names and formulas, for an editor.

use symdiff::formula::Term;
use symdiff::{Formula, Unary};

use super::dimension::KnownDimension;
use super::mentions::{Definition, Mention, Mentions, NameKind, ReadFormula};
use super::reader::Reader;
use super::report::Report;
use super::symbols::SymbolTable;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar};

impl Report<'_> {
    fn note(&self, note: impl FnOnce(&mut Mentions)) {
        if let Some(mentions) = self.mentions {
            note(&mut mentions.borrow_mut());
        }
    }

    /// Records that an entry defines a name.
    pub fn defines(&self, kind: NameKind, name: &str, entry: &Entry) {
        self.note(|all| {
            let extent = entry.key_span.start..entry.value.span.end.max(entry.key_span.end);
            let definition = Definition { kind, name: name.to_owned(), span: entry.key_span.clone(), extent };
            all.definitions.push(definition);
        });
    }

    /// Records the use of a name.
    pub fn mentions(&self, kind: Option<NameKind>, name: &str, span: &Span) {
        self.note(|all| all.uses.push(Mention { name: name.to_owned(), kind, span: span.clone() }));
    }

    /// Records the use of the name in a node.
    pub fn mentions_node(&self, kind: Option<NameKind>, node: &Node) {
        if let Some(scalar) = node.scalar() {
            let text = 0..scalar.text.len();
            self.note(|all| {
                let span = scalar.place(&node.span, text);
                all.uses.push(Mention { name: scalar.name().into_owned(), kind, span });
            });
        }
    }

    /// Records the names of a formula that begins at a byte of a scalar.
    pub fn mentions_names(&self, node: &Node, scalar: &Scalar, formula: &Formula, offset: usize) {
        self.note(|all| {
            all.uses.extend(formula.names().map(|(name, span)| {
                let span = scalar.place(&node.span, offset + span.start..offset + span.end);
                Mention { name: name.to_owned(), kind: None, span }
            }));
        });
    }

    /// Records a formula that begins at a byte of a node, with the dimensions of its terms.
    pub fn mentions_formula(&self, node: &Node, offset: usize, formula: &Formula, kinds: &[KnownDimension]) {
        self.note(|all| {
            let start = node.scalar().and_then(|scalar| scalar.start).map(|start| start + offset);
            let (formula, kinds) = (formula.clone(), kinds.to_vec());
            all.formulas.push(ReadFormula { start, span: node.span.clone(), formula, kinds });
        });
    }
}

impl<S: SymbolTable> Reader<'_, S> {
    /// Records the tables of a formula that begins at a byte of a scalar: a call begins with the name of its table.
    pub(super) fn mentions_tables(&self, node: &Node, scalar: &Scalar, formula: &Formula, offset: usize) {
        for (term, span) in formula.terms() {
            let Term::Unary(Unary::Spline(spline, _), _) = term else { continue };
            let Some(table) = self.tables.iter().find(|table| table.spline == *spline) else { continue };
            let start = offset + span.start;
            if scalar.text.get(start..).is_some_and(|text| text.starts_with(&table.name)) {
                let span = scalar.place(&node.span, start..start + table.name.len());
                self.mentions(Some(NameKind::Table), &table.name, &span);
            }
        }
    }
}
